// meca-ctl's side of a command when bridges come and go: the bridges here are nothing but participants that answer.
#include "cli/client.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "e2e.hpp"

namespace meca::test {
namespace {

constexpr int kDomain = 58;
constexpr const char* kRobot = "arm1";

// Writes what a bridge would write.
class SpokenBridge {
 public:
  explicit SpokenBridge(const std::string& name) : participant_(local(kDomain, name)) {
    const dds::Qos state{.durability = dds::Durability::kTransientLocal};
    status_ = participant_.create_writer<meca500::BridgeStatus>("meca500/BridgeStatus", state);
    control_ = participant_.create_writer<meca500::ControlStatus>("meca500/ControlStatus", state);
    receipts_ = participant_.create_writer<meca500::CommandReceipt>("meca500/CommandReceipt", state);
    commands_ = participant_.create_reader<meca500::Command>("meca500/Command", {.depth = 16});
  }
  void say_status(std::uint64_t cycles) {
    meca500::BridgeStatus sample;
    sample.robot(kRobot);
    sample.cycles(cycles);
    EXPECT_TRUE(status_.write(sample));
  }
  void say_owner() {
    meca500::ControlStatus sample;
    sample.robot(kRobot);
    EXPECT_TRUE(control_.write(sample));
  }
  // Takes the next command and acknowledges it.
  void acknowledge() {
    dds::SampleInfo info;
    ASSERT_TRUE(eventually([&] { return commands_.take(command_, info) && info.valid_data; }));
    answer(meca500::ReceiptState::ACKNOWLEDGED);
  }
  void complete() { answer(meca500::ReceiptState::COMPLETED); }

 private:
  void answer(meca500::ReceiptState state) {
    meca500::CommandReceipt receipt;
    receipt.robot(kRobot);
    receipt.client(command_.client());
    receipt.command_id(command_.command_id());
    receipt.state(state);
    EXPECT_TRUE(receipts_.write(receipt));
  }

  dds::Participant participant_;
  dds::Writer<meca500::BridgeStatus> status_;
  dds::Writer<meca500::ControlStatus> control_;
  dds::Writer<meca500::CommandReceipt> receipts_;
  dds::Reader<meca500::Command> commands_;
  meca500::Command command_;  // the last one taken
};

// A move that is sent to the robot and waited for, beside the test.
class Mover {
 public:
  Mover() : thread_([this] { run(); }) {}
  ~Mover() { thread_.join(); }

  bool is_acknowledged() const { return acknowledged_; }
  cli::Ended ended() {
    EXPECT_TRUE(eventually([this] { return done_.load(); }));
    return ended_;
  }

 private:
  void run() {
    cli::Invocation call;
    call.domain = kDomain;
    call.interfaces = {"127.0.0.1"};
    call.client = "mover";
    cli::Bus bus(call);
    cli::Observer observer(bus, cli::Interest::kControl);
    observer.discover(kRobot, kPatience);
    cli::Client client(bus, observer, kRobot);
    cli::CommandPlan plan;
    plan.kind = meca500::CommandKind::MOTION;
    ended_ = client
                 .execute(plan, cli::WaitFor::kEnd, kPatience,
                          {.receipt = [this](const auto&) { acknowledged_ = true; }, .link = [](bool) {}})
                 .ended;
    done_ = true;
  }

  std::atomic<bool> acknowledged_ = false;
  std::atomic<bool> done_ = false;
  cli::Ended ended_ = cli::Ended::kReached;
  std::thread thread_;  // last: it uses all of the above
};

TEST(CtlClient, KnowsAnotherBridgeByItsParticipant) {
  SpokenBridge first("first");
  first.say_status(1000);
  Mover mover;
  first.acknowledge();
  ASSERT_TRUE(eventually([&] { return mover.is_acknowledged(); }));
  SpokenBridge second("second");
  second.say_status(2000);  // older than the first one was when it was last heard of
  EXPECT_EQ(mover.ended(), cli::Ended::kBridgeGone);
}

// A bridge may be killed before its BridgeStatus came.
TEST(CtlClient, KnowsAnotherBridgeWithoutTheStatusOfTheFirst) {
  SpokenBridge first("first");
  first.say_owner();
  Mover mover;
  first.acknowledge();
  ASSERT_TRUE(eventually([&] { return mover.is_acknowledged(); }));
  SpokenBridge second("second");
  second.say_status(1);
  EXPECT_EQ(mover.ended(), cli::Ended::kBridgeGone);
}

// The status of the bridge before the one that takes the command is still known, and says nothing about it.
TEST(CtlClient, WaitsForTheBridgeThatTookTheCommandWhateverWasThereBefore) {
  auto first = std::make_unique<SpokenBridge>("first");
  first->say_status(1000);
  SpokenBridge second("second");
  second.say_owner();
  Mover mover;
  second.acknowledge();
  ASSERT_TRUE(eventually([&] { return mover.is_acknowledged(); }));
  first.reset();
  second.say_status(1);
  std::this_thread::sleep_for(100ms);  // time to fall for it
  second.complete();
  EXPECT_EQ(mover.ended(), cli::Ended::kReached);
}

}  // namespace
}  // namespace meca::test
