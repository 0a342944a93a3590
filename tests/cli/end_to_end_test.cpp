// meca-ctl against a running meca-bridge: what a person types, reads and gets as exit code.
// Each test has its own bridge with a robot that homes at once; topics carry our process id, so that parallel runs of
// the tests on one machine do not meet. Waits are bounded by meca-ctl's --timeout and ctest's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "tests/cli/process.hpp"

namespace meca::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kDomain = "70";

std::vector<json> lines_of(const std::string& text) {
  std::vector<json> objects;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) objects.push_back(json::parse(line));
  return objects;
}

class MecaCtl : public testing::Test {
 protected:
  // A killed bridge leaves its control socket behind: in a directory that goes with the test.
  void SetUp() override {
    std::filesystem::create_directory(runtime_);
    setenv("XDG_RUNTIME_DIR", runtime_.c_str(), 1);
    start_bridge({"arm1"});
  }
  void TearDown() override {
    bridge_.reset();
    std::remove(config_.c_str());
    std::filesystem::remove_all(runtime_);
  }

  // `last` goes into the transport section of the last robot.
  void start_bridge(const std::vector<std::string>& robots, const std::string& last = "") {
    bridge_.reset();
    std::ofstream file(config_);
    file << "dds:\n  domain: " << kDomain << "\n  interfaces: [127.0.0.1]\n  topic_prefix: " << prefix_
         << "\nrobots:\n";
    for (const auto& robot : robots) {
      file << "  - name: " << robot << "\n    transport:\n      type: builtin\n      instant_homing: true\n";
      if (&robot == &robots.back()) file << last;
      file << "    control: {lease: 2s}\n";  // the machine may be busy; the short lease has tests of its own
    }
    file.close();
    bridge_.emplace(std::vector<std::string>{MECA_BRIDGE, "--config", config_});
    const auto health = ctl({"health", "--timeout", "20"});
    ASSERT_EQ(health.exit_code, 0) << health.output;
  }

  std::vector<std::string> command(std::vector<std::string> words) const {
    words.insert(words.begin(), {MECA_CTL, "--domain", kDomain, "--interface", "127.0.0.1", "--prefix", prefix_});
    return words;
  }
  Result ctl(const std::vector<std::string>& words) const { return run(command(words)); }

  void make_ready() const {
    ASSERT_EQ(ctl({"activate"}).exit_code, 0);
    ASSERT_EQ(ctl({"home"}).exit_code, 0);
  }
  json status(const std::string& robot = "arm1") const {
    const auto result = ctl({"status", "--json", "--robot", robot});
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return json::parse(result.output);
  }

  const std::string prefix_ = "cli_e2e_" + std::to_string(getpid()) + "/";
  const std::string runtime_ = testing::TempDir() + "meca_e2e_" + std::to_string(getpid());
  const std::string config_ = testing::TempDir() + "meca_ctl_e2e_" + std::to_string(getpid()) + ".yaml";
  std::optional<Process> bridge_;
};

TEST_F(MecaCtl, TakesARobotFromColdToAPlaceAndSaysWhatBecomesOfEachCommand) {
  const auto activate = ctl({"activate"});
  EXPECT_EQ(activate.exit_code, 0);
  EXPECT_THAT(activate.output, HasSubstr("arm1: activate: completed"));
  EXPECT_EQ(ctl({"home"}).exit_code, 0);

  const auto move = ctl({"move-joints", "-10", "0", "0", "0", "5", "0", "--wait"});
  EXPECT_EQ(move.exit_code, 0);
  EXPECT_THAT(move.output, HasSubstr("acknowledged"));
  EXPECT_THAT(move.output, HasSubstr("arm1: move-joints: completed"));
  const auto there = status();
  EXPECT_NEAR(there["target_joint_set"]["joints"][0].get<double>(), -10, 1e-3);
  EXPECT_NEAR(there["target_joint_set"]["joints"][4].get<double>(), 5, 1e-3);
  EXPECT_EQ(there["robot_status"]["homed"], true);
  EXPECT_EQ(there["motion_status"]["eob"], true);
}

TEST_F(MecaCtl, GivesControlBackWhenItIsDone) {
  ASSERT_EQ(ctl({"activate"}).exit_code, 0);
  const auto after = status()["control_status"];
  EXPECT_EQ(after["owned"], false);
  EXPECT_THAT(after["last_owner"].get<std::string>(), HasSubstr("meca-ctl@"));
  EXPECT_EQ(after["last_loss"], "released");
}

TEST_F(MecaCtl, WithoutWaitReturnsOnceTheRobotHasTheMotionAndTheMotionGoesOn) {
  make_ready();
  const auto move = ctl({"move-joints", "--", "-20", "0", "0", "0", "0", "0"});
  EXPECT_EQ(move.exit_code, 0) << move.output;
  EXPECT_THAT(move.output, Not(HasSubstr("move-joints: completed")));
  EXPECT_EQ(ctl({"send", "Delay", "0", "--wait"}).exit_code, 0);  // queued behind the motion
  EXPECT_NEAR(status()["target_joint_set"]["joints"][0].get<double>(), -20, 1e-3);
}

TEST_F(MecaCtl, SameClientNameTwiceIsNotMistakenForARepeatedCommand) {
  ASSERT_EQ(ctl({"activate", "--client", "cell"}).exit_code, 0);
  const auto home = ctl({"home", "--client", "cell"});
  EXPECT_EQ(home.exit_code, 0);
  EXPECT_THAT(home.output, HasSubstr("arm1: home: completed"));
  EXPECT_EQ(status()["robot_status"]["homed"], true);
}

TEST_F(MecaCtl, RefusalsHaveExitCodeOneAndTheReason) {
  const auto early = ctl({"move-joints", "0", "0", "0", "0", "0", "0"});
  EXPECT_EQ(early.exit_code, 1);
  EXPECT_THAT(early.output, HasSubstr("NOT_ACTIVATED"));
  make_ready();
  const auto far = ctl({"move-joints", "0", "400", "0", "0", "0", "0", "--json"});
  EXPECT_EQ(far.exit_code, 1);
  const auto receipts = lines_of(far.output);
  ASSERT_EQ(receipts.size(), 1u);
  EXPECT_EQ(receipts[0]["state"], "REJECTED");
  EXPECT_EQ(receipts[0]["reason"], "ARGUMENT_RANGE");
  EXPECT_THAT(receipts[0]["text"].get<std::string>(), HasSubstr("400"));
  EXPECT_EQ(ctl({"send", "77"}).exit_code, 1);
}

TEST_F(MecaCtl, VelocityMovesForAWhileAndThenTheRobotStands) {
  make_ready();
  const auto result = ctl({"velocity", "joints", "-20", "0", "0", "0", "0", "0", "--for", "0.5"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  const auto after = status();
  EXPECT_LT(after["target_joint_set"]["joints"][0].get<double>(), -1);
  EXPECT_EQ(after["control_status"]["owned"], false);
}

TEST_F(MecaCtl, VelocityIsRefusedWithCauseAndRemedyWhenTheRobotWouldNotMove) {
  const auto result = ctl({"velocity", "joints", "1", "0", "0", "0", "0", "0", "--for", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("arm1 would not move: no: "));
}

TEST_F(MecaCtl, TakeKeepsOthersOutUntilCtrlC) {
  Process holder(command({"take", "--client", "holder"}));
  ASSERT_TRUE(holder.wait_for_output("Holding arm1")) << holder.output();
  const auto other = ctl({"activate", "--client", "other"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.output, HasSubstr("NOT_OWNER"));
  EXPECT_THAT(other.output, HasSubstr("holder"));
  EXPECT_EQ(status()["control_status"]["owner"], "holder");
  holder.signal(SIGINT);
  EXPECT_EQ(holder.wait(), 0);
  EXPECT_EQ(status()["control_status"]["owned"], false);
  EXPECT_EQ(ctl({"activate", "--client", "other"}).exit_code, 0);
}

TEST_F(MecaCtl, PauseAndResumeAreVisibleInTheStatus) {
  make_ready();
  ASSERT_EQ(ctl({"pause"}).exit_code, 0);
  EXPECT_EQ(status()["motion_status"]["paused"], true);
  EXPECT_THAT(ctl({"status"}).output, HasSubstr("Doing    paused"));
  ASSERT_EQ(ctl({"resume"}).exit_code, 0);
  EXPECT_EQ(status()["motion_status"]["paused"], false);
}

TEST_F(MecaCtl, StatusTellsWhatTheRobotDoesAndWhyNot) {
  const auto text = ctl({"status"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.output, HasSubstr("arm1  Meca500 R4"));
  EXPECT_THAT(text.output, HasSubstr("Doing    deactivated, motors off"));
  EXPECT_THAT(text.output, HasSubstr("Ready    no: "));
  EXPECT_THAT(text.output, HasSubstr("Safety   no stop signal"));
}

TEST_F(MecaCtl, WatchPrintsLinesWhenItIsNotOnATerminal) {
  const auto lines = ctl({"watch", "--for", "1", "--rate", "10"});
  EXPECT_EQ(lines.exit_code, 0);
  EXPECT_THAT(lines.output, HasSubstr("arm1  deactivated, motors off"));
  EXPECT_THAT(lines.output, Not(HasSubstr("\033")));
  const auto objects = lines_of(ctl({"watch", "--for", "1", "--json"}).output);
  ASSERT_FALSE(objects.empty());
  EXPECT_EQ(objects.back()["robot"], "arm1");
}

TEST_F(MecaCtl, WatchEndsOrderlyOnCtrlC) {
  Process watch(command({"watch"}));
  ASSERT_TRUE(watch.wait_for_output("arm1"));
  watch.signal(SIGINT);
  EXPECT_EQ(watch.wait(), 0);
}

TEST_F(MecaCtl, TopicsListsEveryTopicWithTheBridgeBehindIt) {
  const auto objects = lines_of(ctl({"topics", "--for", "0.5", "--json"}).output);
  EXPECT_EQ(objects.size(), 23u);
  bool joints_arrive = false;
  for (const auto& topic : objects) {
    if (topic["topic"] != "CyclicState") {
      EXPECT_EQ(topic["bridges"], 1) << topic["topic"];
    }
    if (topic["topic"] == "TargetJointSet") joints_arrive = topic["received_per_second"] > 0;
  }
  EXPECT_TRUE(joints_arrive);
}

TEST_F(MecaCtl, ReceiptsShowsWhatBecameOfEverybodysCommands) {
  ASSERT_EQ(ctl({"activate", "--client", "cell-plc"}).exit_code, 0);
  EXPECT_THAT(ctl({"receipts", "--for", "1"}).output, HasSubstr("arm1: cell-plc #"));
}

TEST_F(MecaCtl, WithSeveralRobotsACommandAsksWhichOne) {
  start_bridge({"arm1", "arm2"});
  const auto vague = ctl({"activate"});
  EXPECT_EQ(vague.exit_code, 2);
  EXPECT_THAT(vague.output, HasSubstr("there are several robots, arm1, arm2: say which with --robot NAME"));
  EXPECT_EQ(ctl({"activate", "--robot", "arm2"}).exit_code, 0);
  EXPECT_EQ(status("arm1")["robot_status"]["activated"], false);
  EXPECT_EQ(status("arm2")["robot_status"]["activated"], true);
  EXPECT_EQ(lines_of(ctl({"status", "--json"}).output).size(), 2u);
  const auto wrong = ctl({"activate", "--robot", "arm3", "--timeout", "6"});
  EXPECT_EQ(wrong.exit_code, 4);
  EXPECT_THAT(wrong.output, HasSubstr("no robot 'arm3'"));
  EXPECT_THAT(wrong.output, HasSubstr("there are arm1, arm2"));
}

TEST_F(MecaCtl, HealthIsOneLineAndFailsWhenTheBridgeIsGoneOrHangs) {
  EXPECT_EQ(ctl({"health"}).output, "healthy: arm1 ok\n");
  bridge_->signal(SIGSTOP);
  EXPECT_NE(ctl({"health", "--timeout", "1"}).exit_code, 0);
  bridge_->signal(SIGCONT);
  EXPECT_EQ(ctl({"health", "--timeout", "20"}).exit_code, 0);
  bridge_.reset();
  const auto gone = ctl({"health", "--timeout", "0.5"});
  EXPECT_EQ(gone.exit_code, 4);
  EXPECT_THAT(gone.output, HasSubstr("Is meca-bridge running"));
}

TEST_F(MecaCtl, WaitingEndsWithExitCodeFiveAndSaysThatTheCommandGoesOn) {
  make_ready();
  const auto result = ctl({"send", "Delay", "600", "--wait", "--timeout", "8"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.output, HasSubstr("Delay: not finished after 8.0 s"));
  EXPECT_THAT(result.output, HasSubstr("it goes on"));
}

// No bridge is asked, so that it answers at a desk as well.
TEST(MecaCtlErrors, ExplainsACodeWithoutABridge) {
  const auto one = run({MECA_CTL, "errors", "1007"});
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_THAT(one.output, HasSubstr("1007  JOINT_OVER_LIMIT\n"));
  EXPECT_EQ(lines_of(run({MECA_CTL, "errors", "--json"}).output).size(), 86U);
  const auto unknown = run({MECA_CTL, "errors", "4711"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, HasSubstr("no document names an error or stop '4711'"));
}

TEST_F(MecaCtl, PStop2PressedWhileMovingIsShownWithItsRemedyAndTheRemedyHelps) {
  make_ready();
  ASSERT_EQ(ctl({"send", "SetJointVel", "1"}).exit_code, 0);
  ASSERT_EQ(ctl({"move-joints", "90", "0", "0", "0", "0", "0"}).exit_code, 0);  // 90 degrees take a minute
  EXPECT_EQ(status()["motion_status"]["eom"], false);
  const auto press = ctl({"sim", "press", "p-stop2"});
  EXPECT_EQ(press.exit_code, 0) << press.output;
  EXPECT_EQ(press.output, "arm1: P-Stop 2 pressed\n");
  const auto stopped = ctl({"status"}).output;
  EXPECT_THAT(stopped, HasSubstr("Ready    no: P-Stop 2 is active; release it, then 'meca-ctl resume'"));
  EXPECT_THAT(ctl({"sim", "status"}).output, HasSubstr("arm1: P-Stop 2 pressed; no error; activated, homed; 0 in"));
  EXPECT_THAT(ctl({"sim", "journal", "1"}).output, HasSubstr("MoveJoints(90, 0, 0, 0, 0, 0)"));

  EXPECT_EQ(ctl({"resume"}).exit_code, 1);  // it is still pressed
  EXPECT_EQ(ctl({"sim", "release", "p-stop2"}).exit_code, 0);
  EXPECT_EQ(ctl({"resume"}).exit_code, 0);
  EXPECT_THAT(ctl({"sim", "status"}).output, HasSubstr("arm1: nothing pressed"));
  EXPECT_EQ(ctl({"send", "SetJointVel", "50"}).exit_code, 0);
  EXPECT_EQ(ctl({"move-joints", "10", "0", "0", "0", "0", "0", "--wait"}).exit_code, 0);
  EXPECT_NEAR(status()["target_joint_set"]["joints"][0].get<double>(), 10, 1e-3);
}

TEST_F(MecaCtl, SimAnswersMistakesWithExitCodeOneAndNeedsNoBridgeForItsWords) {
  const auto unknown = ctl({"sim", "raise", "error", "7"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.output, HasSubstr("meca-ctl: arm1: 7 is no error code"));
  const auto json = lines_of(ctl({"sim", "raise", "error", "1007", "--json"}).output);
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0]["robot"], "arm1");
  EXPECT_EQ(json[0]["answer"][0], "the robot is in error");
  bridge_.reset();
  for (const std::vector<std::string>& asked : {std::vector<std::string>{"sim"}, {"sim", "help"}}) {
    const auto words = ctl(asked);
    EXPECT_EQ(words.exit_code, 0);
    EXPECT_THAT(words.output, HasSubstr("press p-stop2"));
  }
  const auto nobody = ctl({"sim", "status", "--robot", "arm1"});
  EXPECT_EQ(nobody.exit_code, 4);
  EXPECT_THAT(nobody.output, HasSubstr("no simulated robot 'arm1' on this machine in domain 70"));
  EXPECT_THAT(nobody.output, HasSubstr("is the bridge, or meca-sim, running here, as this user?"));
}

TEST_F(MecaCtl, SimFindsItsRobotAmongSeveralByNameOrByItsSocket) {
  const std::string socket = runtime_ + "/arm2.sock";
  start_bridge({"arm1", "arm2"}, "      control_socket: " + socket + "\n");
  EXPECT_EQ(ctl({"sim", "status", "--robot", "arm1"}).exit_code, 0);
  EXPECT_EQ(ctl({"sim", "status"}).exit_code, 0);  // arm2 is not at the usual place
  EXPECT_EQ(ctl({"sim", "press", "e-stop", "--socket", socket}).exit_code, 0);
  EXPECT_EQ(status("arm1")["robot_status"]["e_stop"], false);
  EXPECT_EQ(status("arm2")["robot_status"]["e_stop"], true);
  start_bridge({"arm1", "arm2"});
  const auto vague = ctl({"sim", "status"});
  EXPECT_EQ(vague.exit_code, 2);
  EXPECT_THAT(vague.output, HasSubstr("there are several robots, arm1, arm2: say which with --robot NAME"));
  const auto wrong = ctl({"sim", "status", "--robot", "arm3"});
  EXPECT_EQ(wrong.exit_code, 4);
  EXPECT_THAT(wrong.output, HasSubstr("there are arm1, arm2"));
}

TEST_F(MecaCtl, ASecondBridgeWarnsAndGoesOnWithoutTheButtonsOfTheFirst) {
  Process second(std::vector<std::string>{MECA_BRIDGE, "--config", config_});
  ASSERT_TRUE(second.wait_for_output("link up")) << second.output();
  EXPECT_THAT(second.output(), HasSubstr("arm1: no control socket, its buttons cannot be pressed: "));
  EXPECT_THAT(second.output(), HasSubstr("is in use by another process that is alive"));
  second.signal(SIGTERM);
  EXPECT_EQ(second.wait(), 0);
  EXPECT_EQ(ctl({"sim", "status"}).exit_code, 0);
}

TEST_F(MecaCtl, ABridgeThatWasKilledLeavesNothingInTheWayOfTheNext) {
  bridge_->signal(SIGKILL);
  bridge_->wait();
  EXPECT_EQ(ctl({"sim", "status", "--robot", "arm1"}).exit_code, 4);
  start_bridge({"arm1"});
  EXPECT_EQ(ctl({"sim", "status"}).exit_code, 0);
}

TEST_F(MecaCtl, TyposAreAnsweredWithoutTouchingTheRobot) {
  const auto typo = ctl({"actvate"});
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_THAT(typo.output, HasSubstr("did you mean 'activate'?"));
  EXPECT_EQ(status()["robot_status"]["activated"], false);
}

}  // namespace
}  // namespace meca::test
