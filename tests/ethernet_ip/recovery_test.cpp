// What breaks between bridge and robot, by programs that are cut off, killed and started again: what is said of it,
// what becomes of the command that was under way, that both come together again by themselves, and that nothing moves
// by itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ethernet_ip/programs.hpp"

namespace meca::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

const std::vector<std::string> kMove{"--wait", "move-joints", "--", "-10", "5", "5", "0", "20", "0"};

class Recovery : public testing::Test {
 protected:
  // Ready, and on a move that takes minutes.
  static std::unique_ptr<Process> under_way(const BridgeProgram& bridge) {
    EXPECT_TRUE(bridge.until_up());
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"activate"}, {"home"}, {"--wait", "send", "SetJointVel", "0.1"}}) {
      const Result result = bridge.ctl(words);
      EXPECT_EQ(result.exit_code, 0) << result.output;
    }
    auto mover = bridge.ctl_beside({"--wait", "move-joints", "--", "-100", "0", "0", "0", "0", "0"});
    EXPECT_TRUE(mover->wait_for_output("acknowledged")) << mover->output();
    EXPECT_TRUE(bridge.until([](const json& now) { return joint1(now) < 0; }));
    return mover;
  }

  static double joint1(const json& now) { return now["target_joint_set"]["joints"][0].get<double>(); }

  // Over a hundred images.
  static void expect_standstill(const BridgeProgram& bridge) {
    ASSERT_TRUE(bridge.until_up());
    const json before = bridge.status();
    json after;
    const auto images = [](const json& now) { return now["bridge_status"]["fresh_images"].get<int>(); };
    ASSERT_TRUE(bridge.until([&](const json& now) {
      after = now;
      return images(now) >= images(before) + 100;
    }));
    EXPECT_EQ(after["target_joint_set"]["joints"], before["target_joint_set"]["joints"]);
    EXPECT_EQ(after["motion_status"]["fifo_space"], 13000);
  }

  // Stands, goes on standing when it is resumed, and moves when somebody says so.
  static void expect_that_only_a_command_moves(const BridgeProgram& bridge) {
    expect_standstill(bridge);
    EXPECT_EQ(bridge.status()["control_status"]["owned"], false);
    const Result resume = bridge.ctl({"resume"});
    EXPECT_EQ(resume.exit_code, 0) << resume.output;
    expect_standstill(bridge);
    EXPECT_EQ(bridge.ctl({"--wait", "send", "SetJointVel", "100"}).exit_code, 0);
    const Result move = bridge.ctl(kMove);
    EXPECT_EQ(move.exit_code, 0) << move.output;
  }

  SimProgram arm1_{arm1_address()};
};

TEST_F(Recovery, OfACutCable) {
  BridgeProgram bridge({robot("arm1", arm1_address())});
  const auto mover = under_way(bridge);
  ASSERT_EQ(arm1_.say("unplug"), "ok: the cable is out");
  EXPECT_TRUE(mover->wait_for_output("arm1: move-joints: the link to the robot is lost; waiting up to 30 s"));
  EXPECT_EQ(mover->wait(), 1);
  EXPECT_THAT(mover->output(),
              HasSubstr("arm1: move-joints: aborted (LINK_LOST): MoveJoints aborted: the link to the robot was lost"));
  EXPECT_TRUE(bridge.until_told("from " + arm1_address()));
  EXPECT_THAT(bridge.ctl({"status"}).output, HasSubstr("no link to the robot"));
  EXPECT_EQ(bridge.ctl({"health"}).exit_code, 1);
  ASSERT_EQ(arm1_.say("plug"), "ok: the cable is in");
  expect_that_only_a_command_moves(bridge);
  EXPECT_EQ(bridge.status()["bridge_status"]["transport_counters"]["watchdog_trips"], 1);
  EXPECT_EQ(bridge.stop(), 0);
  EXPECT_THAT(bridge.log(),
              HasSubstr("arm1: link down: no packet from " + arm1_address() + " for 2560 ms (10 ms x 256)"));
}

TEST_F(Recovery, OfAPowerCycleOfTheRobot) {
  BridgeProgram bridge({robot("arm1", arm1_address())});
  const auto mover = under_way(bridge);
  ASSERT_THAT(arm1_.say("power cycle"), StartsWith("ok: "));
  EXPECT_EQ(mover->wait(), 1);
  EXPECT_THAT(mover->output(), HasSubstr("arm1: move-joints: aborted ("));
  expect_standstill(bridge);
  EXPECT_EQ(bridge.status()["bridge_status"]["link_losses"], 1);
  EXPECT_EQ(bridge.status()["robot_status"]["activated"], false);
  EXPECT_THAT(bridge.ctl({"status"}).output, HasSubstr("meca-ctl activate"));
  EXPECT_EQ(bridge.ctl({"activate"}).exit_code, 0);
  EXPECT_EQ(bridge.ctl({"home"}).exit_code, 0);
  const Result move = bridge.ctl(kMove);
  EXPECT_EQ(move.exit_code, 0) << move.output;
}

TEST_F(Recovery, OfARobotThatIsReplacedByAnother) {
  BridgeProgram bridge({robot("arm1", arm1_address())});
  const auto mover = under_way(bridge);
  arm1_.kill();
  EXPECT_EQ(mover->wait(), 1);
  EXPECT_THAT(mover->output(), HasSubstr("arm1: move-joints: aborted ("));
  EXPECT_TRUE(bridge.until_told("TCP connection to " + arm1_address() + " port 44818 failed: connection refused"));
  arm1_.start();
  expect_standstill(bridge);
  EXPECT_EQ(bridge.ctl({"activate"}).exit_code, 0);
  EXPECT_EQ(bridge.ctl({"home"}).exit_code, 0);
  EXPECT_EQ(bridge.ctl(kMove).exit_code, 0);
}

// ---- The bridge

TEST_F(Recovery, OfAKilledBridge) {
  BridgeProgram bridge({robot("arm1", arm1_address())});
  const auto mover = under_way(bridge);
  bridge.kill();
  bridge.start();
  EXPECT_EQ(mover->wait(), 4);
  EXPECT_THAT(mover->output(),
              HasSubstr("move-joints: the bridge that took it is gone, or was started again; last it was "
                        "ACKNOWLEDGED, what became of it is not known"));
  expect_that_only_a_command_moves(bridge);
}

// A robot that reserves its outputs for the owner it lost.
TEST(Ownership, ComesBackToTheSameBridgeAfterItWasKilledAndToNoOther) {
  const SimProgram arm1(arm1_address(), {"--ownership", "keep"});
  BridgeProgram bridge({robot("arm1", arm1_address())});
  ASSERT_TRUE(bridge.until_up());
  bridge.kill();
  ASSERT_TRUE(eventually([&] { return arm1.say("status").find("connection dropped") != std::string::npos; }));
  {
    const BridgeProgram stranger({robot("arm1", arm1_address())},
                                 "bind: " + second_bridge_address() + ", serial_number: 4711");
    EXPECT_TRUE(stranger.until_told("Forward Open refused (0x01/0x0106)"));
  }
  bridge.start();
  EXPECT_TRUE(bridge.until_up());
}

TEST(Ownership, OfASecondBridgeBeginsWhenTheFirstHasLeft) {
  const SimProgram arm1(arm1_address());
  BridgeProgram first({robot("arm1", arm1_address())});
  ASSERT_TRUE(first.until_up());
  const BridgeProgram second({robot("arm1", arm1_address())},
                             "bind: " + second_bridge_address() + ", serial_number: 4711");
  ASSERT_TRUE(second.until_told("Forward Open refused (0x01/0x0106)"));
  EXPECT_EQ(second.ctl({"activate"}).exit_code, 1);
  EXPECT_EQ(first.ctl({"activate"}).exit_code, 0);
  EXPECT_EQ(first.ctl({"home"}).exit_code, 0);
  const Result move = first.ctl(kMove);
  EXPECT_EQ(move.exit_code, 0) << move.output;
  EXPECT_EQ(first.status()["bridge_status"]["link_losses"], 0);
  EXPECT_EQ(first.stop(), 0);
  EXPECT_TRUE(second.until_up());
}

// ---- Two robots

// Packets every 50 ms, so that a busy machine is not what is judged: numbers, no times.
TEST(TwoRobots, OfOneBridgeDoNotMissEachOther) {
  const SimProgram arm1(arm1_address()), arm2(arm2_address());
  const BridgeProgram bridge({robot("arm1", arm1_address(), "", "50ms"), robot("arm2", arm2_address(), "", "50ms")});
  ASSERT_TRUE(bridge.until_up("arm1"));
  ASSERT_TRUE(bridge.until_up("arm2"));
  const json before = bridge.status("arm1")["bridge_status"];
  ASSERT_EQ(arm2.say("unplug"), "ok: the cable is out");
  ASSERT_TRUE(bridge.until_told("from " + arm2_address(), "arm2"));
  ASSERT_EQ(arm2.say("plug"), "ok: the cable is in");
  ASSERT_TRUE(bridge.until_up("arm2"));
  EXPECT_EQ(bridge.status("arm2")["bridge_status"]["link_losses"], 1);

  const json after = bridge.status("arm1")["bridge_status"];
  EXPECT_EQ(after["link_losses"], 0);
  EXPECT_GT(after["fresh_images"], before["fresh_images"]);
  // The machine may be late now and then; a robot that waited for the other would stand still for its watchdog, 64
  // cycles.
  EXPECT_LT(after["stale_cycles"].get<int>() - before["stale_cycles"].get<int>(), 16);
  for (const char* counter : {"lost_packets", "stale_packets", "failed_sends", "watchdog_trips"}) {
    EXPECT_EQ(after["transport_counters"][counter], before["transport_counters"][counter]) << counter;
  }
  const auto skipped = [](const json& bridge) { return bridge["transport_counters"]["skipped_sends"].get<int>(); };
  EXPECT_LT(skipped(after) - skipped(before), 16);
  EXPECT_EQ(arm1.say("violations"), "ok: the host broke no rule");
}

}  // namespace
}  // namespace meca::test
