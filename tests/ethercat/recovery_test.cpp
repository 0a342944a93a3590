// What breaks between bridge and robots, by programs whose cables are cut and that are killed and started again: what
// is said of it, what becomes of the command that was under way, that the neighbours miss nothing, that all come
// together again by themselves, and that nothing moves by itself.
#include <gmock/gmock.h>

#include "tests/ethercat/cell.hpp"

namespace meca::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Recovery : public EthercatCell {
 protected:
  // Stands, goes on standing when it is resumed, and moves when somebody says so.
  void expect_that_only_a_command_moves(const std::string& robot) {
    expect_standstill(robot);
    EXPECT_EQ(bridge_->status(robot)["control_status"]["owned"], false);
    ctl(robot, {"resume"});
    expect_standstill(robot);
    ctl(robot, {"--wait", "send", "SetJointVel", "100"});
    move(robot);
  }
  // By the lost link, or by the stop that the robot shows when it is back: whichever is known first.
  static void expect_aborted(Process& mover, const std::string& robot) {
    EXPECT_EQ(mover.wait(), 1);
    EXPECT_THAT(mover.output(), HasSubstr(robot + ": move-joints: aborted ("));
  }
};

TEST_F(Recovery, OfACutCableBeforeTheLastRobot) {
  Simulator& sim = start_robots(3);
  BridgeProcess& bridge = start_bridge(3);
  make_ready("arm1");
  const auto mover = under_way("arm3");
  ASSERT_EQ(sim.say("cut", "arm3"), "ok: the cable before this robot is cut");
  EXPECT_TRUE(mover->wait_for_output("arm3: move-joints: the link to the robot is lost; waiting up to 30 s"));
  EXPECT_EQ(mover->wait(), 1);
  EXPECT_THAT(mover->output(), HasSubstr("arm3: move-joints: aborted (LINK_LOST): MoveJoints aborted: the link to the "
                                         "robot was lost"));
  EXPECT_TRUE(bridge.until_told("position 2 is not there: 2 devices answer", "arm3")) << bridge.status("arm3");
  EXPECT_THAT(bridge.ctl({"status", "--robot", "arm3"}).output, HasSubstr("no link to the robot"));
  move("arm1");
  ASSERT_EQ(sim.say("heal", "arm3"), "ok: the cable before this robot is whole");
  expect_that_only_a_command_moves("arm3");
  EXPECT_EQ(losses("arm1"), 0);
  EXPECT_EQ(losses("arm2"), 0);
  EXPECT_EQ(bridge.stop(), 0);
  EXPECT_THAT(bridge.log(), HasSubstr("arm3: link down: position 2 is not there"));
}

TEST_F(Recovery, OfARobotThatIsUnpluggedWithAnotherBehindIt) {
  Simulator& sim = start_robots(3);
  BridgeProcess& bridge = start_bridge(3);
  make_ready("arm1");
  const auto mover = under_way("arm3");
  ASSERT_EQ(sim.say("unplug", "arm2"), "ok: the cable is out");
  EXPECT_TRUE(bridge.until_told("position 1 is not there", "arm2")) << bridge.status("arm2");
  move("arm1");
  ASSERT_EQ(sim.say("plug", "arm2"), "ok: the cable is in");
  expect_aborted(*mover, "arm3");
  EXPECT_TRUE(bridge.until_up("arm2"));
  expect_that_only_a_command_moves("arm3");
  EXPECT_EQ(losses("arm1"), 0);
}

TEST_F(Recovery, OfAPowerCycleOfTheRobot) {
  Simulator& sim = start_robots(3);
  BridgeProcess& bridge = start_bridge(3);
  make_ready("arm1");
  const auto mover = under_way("arm2");
  ASSERT_THAT(sim.say("power cycle", "arm2"), StartsWith("ok: "));
  expect_aborted(*mover, "arm2");
  expect_standstill("arm2");
  EXPECT_EQ(losses("arm2"), 1);
  EXPECT_EQ(bridge.status("arm2")["robot_status"]["activated"], false);
  EXPECT_THAT(bridge.ctl({"status", "--robot", "arm2"}).output, HasSubstr("meca-ctl activate"));
  make_ready("arm2");
  move("arm2");
  EXPECT_TRUE(bridge.until_up("arm3"));
  EXPECT_EQ(losses("arm1"), 0);
}

TEST_F(Recovery, OfAnAlErrorThatTheRobotRaises) {
  Simulator& sim = start_robots(2);
  BridgeProcess& bridge = start_bridge(2);
  const auto mover = under_way("arm1");
  ASSERT_THAT(sim.say("al error 0x001A"), StartsWith("ok: "));
  expect_aborted(*mover, "arm1");
  expect_that_only_a_command_moves("arm1");
  EXPECT_EQ(losses("arm1"), 1);
  EXPECT_EQ(losses("arm2"), 0);
  EXPECT_EQ(bridge.stop(), 0);
  EXPECT_THAT(bridge.log(), HasSubstr("0x001A"));
}

TEST_F(Recovery, OfLostFramesCostsNobodyItsLink) {
  Simulator& sim = start_robots(2);
  BridgeProcess& bridge = start_bridge(2);
  make_ready("arm1");
  ASSERT_TRUE(bridge.until_up("arm2"));
  const int lost = counter(bridge.status(), "lost_frames");
  ASSERT_THAT(sim.say("lose every 20"), StartsWith("ok: "));
  move("arm1");
  EXPECT_TRUE(bridge.until([&](const auto& now) { return counter(now, "lost_frames") >= lost + 50; }));
  EXPECT_EQ(losses("arm1") + losses("arm2"), 0);
}

TEST_F(Recovery, OfRobotsThatAreAllReplaced) {
  Simulator& sim = start_robots(2);
  BridgeProcess& bridge = start_bridge(2);
  const auto mover = under_way("arm2");
  sim.kill();
  EXPECT_TRUE(bridge.until([](const auto& now) { return now["bridge_status"]["link"] != "LINK_UP"; }));
  sim.start();
  expect_aborted(*mover, "arm2");
  expect_standstill("arm2");
  make_ready("arm2");
  move("arm2");
}

TEST_F(Recovery, OfAKilledBridge) {
  start_robots(2);
  BridgeProcess& bridge = start_bridge(2);
  const auto mover = under_way("arm2");
  bridge.kill();
  bridge.start();
  EXPECT_EQ(mover->wait(), 4);
  EXPECT_THAT(mover->output(),
              HasSubstr("move-joints: the bridge that took it is gone, or was started again; last it was "
                        "ACKNOWLEDGED, what became of it is not known"));
  expect_that_only_a_command_moves("arm2");
}

TEST_F(Recovery, OfARingThatIsCutWhileARobotMoves) {
  Simulator& sim = start_robots(3, {"--redundant-interface", "ring1"});
  BridgeProcess& bridge = start_bridge(3, ", redundant_interface: ring0");
  for (const char* robot : {"arm1", "arm2", "arm3"}) make_ready(robot);
  for (const char* robot : {"arm1", "arm2", "arm3"}) {
    ASSERT_THAT(sim.say("cut", robot), StartsWith("ok: "));
    move(robot);
    ctl(robot, {"--wait", "move-joints", "--", "0", "0", "0", "0", "0", "0"});
    ASSERT_THAT(sim.say("heal", robot), StartsWith("ok: "));
  }
  for (const char* robot : {"arm1", "arm2", "arm3"}) EXPECT_EQ(losses(robot), 0) << robot;
  EXPECT_EQ(bridge.stop(), 0);
}

}  // namespace
}  // namespace meca::test
