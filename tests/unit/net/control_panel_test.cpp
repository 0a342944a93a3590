// The buttons of a simulated robot, from the socket to the image and back, with a thread that steps the robot.
#include "transports/panel/control_panel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "tests/unit/net/temporary_directory.hpp"
#include "transports/builtin/builtin.hpp"
#include "transports/image/codec.hpp"
#include "transports/net/line_client.hpp"

namespace meca::transports {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::StartsWith;

constexpr auto kPatience = 60s;

std::string ask(const fs::path& path, std::string_view line) {
  auto client = net::LineClient::connect(path);
  if (!client) return "(nobody)";
  return client->ask(line, kPatience).value_or("(no answer)");
}

// A bus with two robots and a thread that exchanges it, as the bridge has it.
class RunningBus {
 public:
  RunningBus(const fs::path& first, const fs::path& second) {
    std::vector<std::unique_ptr<ControlPanel>> panels;
    panels.push_back(std::make_unique<ControlPanel>(first));
    panels.push_back(std::make_unique<ControlPanel>(second));
    bus_ = make_builtin({{}, {}}, std::move(panels));
    bus_->open(Time(0));
    thread_ = std::jthread([this](const std::stop_token& stop) {
      std::array<Exchange, 2> exchanges{};
      for (Time now = 1ms; !stop.stop_requested(); now += 1ms) {
        bus_->exchange(now, exchanges);
        for (std::size_t i = 0; i < 2; ++i) {
          stopped_[i] = image::decode_inputs(exchanges[i].input, {}).motion_status.p_stop2;
        }
        std::this_thread::sleep_for(200us);
      }
    });
  }
  void wait_for_a_stop(std::size_t robot) const {
    while (!stopped_[robot]) std::this_thread::sleep_for(1ms);
  }
  bool stopped(std::size_t robot) const { return stopped_[robot]; }

 private:
  std::array<std::atomic<bool>, 2> stopped_{};
  std::unique_ptr<Transport> bus_;
  std::jthread thread_;
};

class Panels : public testing::Test {
 protected:
  test::TemporaryDirectory directory_;
  const fs::path first_ = directory_ / "first.sock", second_ = directory_ / "second.sock";
};

TEST_F(Panels, PressTheButtonsOfTheirOwnRobot) {
  const RunningBus bus(first_, second_);
  EXPECT_EQ(ask(second_, "press p-stop2"), "ok: P-Stop 2 pressed\n");
  bus.wait_for_a_stop(1);
  EXPECT_FALSE(bus.stopped(0));
  EXPECT_THAT(ask(second_, "status"), StartsWith("ok: P-Stop 2 pressed; "));
  EXPECT_THAT(ask(first_, "status"), StartsWith("ok: nothing pressed; "));
}

TEST_F(Panels, AnswerMistakesWithoutTheRobot) {
  const ControlPanel panel(first_);  // nobody steps a robot
  EXPECT_EQ(ask(first_, "pres e-stop"), "error: there is no word 'pres e-stop', did you mean 'press e-stop'?\n");
}

TEST_F(Panels, SayThatNobodyStepsTheRobotAndLaterAnswerWhatIsAskedThen) {
  ControlPanel panel(first_);
  EXPECT_THAT(ask(first_, "press p-stop2"), StartsWith("error: nobody steps the robot"));
  std::jthread stepping([&panel](const std::stop_token& stop) {
    sim::Robot robot;
    while (!stop.stop_requested()) {
      panel.serve(robot);
      robot.step_without_outputs(1ms);
      std::this_thread::sleep_for(200us);
    }
  });
  EXPECT_THAT(ask(first_, "status"), StartsWith("ok: P-Stop 2 pressed; "));  // done late, as announced
}

TEST_F(Panels, ServeSeveralClientsAtOnceWhileTheRobotIsStepped) {
  const RunningBus bus(first_, second_);
  std::vector<std::jthread> clients;
  std::atomic<int> wrong{0};
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back([&, i] {
      for (int round = 0; round < 20; ++round) {
        const auto& path = i % 2 == 0 ? first_ : second_;
        const auto answer = ask(path, round % 2 == 0 ? "journal" : "press e-stop");
        if (!answer.starts_with(round % 2 == 0 ? "ok: no command" : "ok: E-Stop")) ++wrong;
      }
    });
  }
  clients.clear();
  EXPECT_EQ(wrong, 0);
}

TEST_F(Panels, GoWithTheirBus) {
  { const RunningBus bus(first_, second_); }
  EXPECT_FALSE(fs::exists(first_));
  EXPECT_FALSE(fs::exists(second_));
}

// XDG_RUNTIME_DIR points into the test's directory, so that no bridge of this machine is met.
class UsualPlace : public Panels {
 protected:
  void SetUp() override {
    if (const char* before = getenv("XDG_RUNTIME_DIR")) before_ = before;
    setenv("XDG_RUNTIME_DIR", directory_.path().c_str(), 1);
  }
  void TearDown() override {
    if (before_.empty()) unsetenv("XDG_RUNTIME_DIR");
    if (!before_.empty()) setenv("XDG_RUNTIME_DIR", before_.c_str(), 1);
  }
  std::string before_;
};

TEST_F(UsualPlace, IsNamedAfterDomainPrefixAndRobot) {
  EXPECT_EQ(default_control_socket(7, "hall3/cell7/", "arm1"),
            directory_.path() / "meca500" / "sim-7-hall3.cell7.arm1.sock");
  EXPECT_EQ(control_socket_name(0, "", "arm1"), "sim-0-arm1.sock");
  EXPECT_TRUE(net::is_private_directory(directory_ / "meca500"));
}

TEST_F(UsualPlace, IsFoundByDomainAndPrefixWhereSomebodyListens) {
  const ControlPanel b(default_control_socket(211, "net_test/", "b")), a(default_control_socket(211, "net_test/", "a")),
      other_domain(default_control_socket(212, "net_test/", "c")), no_prefix(default_control_socket(211, "", "d"));
  std::ofstream(directory_ / "meca500" / control_socket_name(211, "net_test/", "dead"));
  EXPECT_THAT(find_control_panels(211, "net_test/"),
              ElementsAre(Field(&FoundPanel::robot, "a"), Field(&FoundPanel::robot, "b")));
  EXPECT_THAT(find_control_panels(211, ""), ElementsAre(Field(&FoundPanel::robot, "d")));
  EXPECT_THAT(find_control_panels(213, "net_test/"), ElementsAre());
}

TEST_F(UsualPlace, IsInTmpWhenTheRuntimeDirectoryIsNotThere) {
  setenv("XDG_RUNTIME_DIR", (directory_ / "gone").c_str(), 1);
  EXPECT_THAT(default_control_socket(0, "meca500/", "arm1").string(), StartsWith("/tmp/meca500-"));
}

TEST_F(UsualPlace, IsTheNextOneWhenAnotherUserCouldWriteIntoTheFirst) {
  fs::create_directory(directory_ / "meca500");
  fs::permissions(directory_ / "meca500", fs::perms::all);
  EXPECT_THAT(default_control_socket(0, "meca500/", "arm1").string(), StartsWith("/tmp/meca500-"));
  EXPECT_THAT(find_control_panels(211, "net_test/"), ElementsAre());
}

}  // namespace
}  // namespace meca::transports
