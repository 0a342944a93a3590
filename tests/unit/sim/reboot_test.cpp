// RebootRobot (id 200), power cycles, and the stop that waits for the Reset button after a boot (spec 5.6).
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using Six = std::array<float, 6>;

RobotOptions quick_boot(Product product = Product::kMeca500R4, image::Layout layout = image::Layout::kFirmware11) {
  RobotOptions o = Rig::quick(layout, product);
  o.boot_time = 1s;
  o.tool = ToolType::kMegp25e;
  o.variables = {{.cyclic_id = 10000, .size = 1, .values = {50}}};
  return o;
}

class Reboot : public testing::Test {
 protected:
  // Steps until the robot is away, then until it is back; returns how long it was away.
  Time away() {
    for (int i = 0; i < 1000 && rig.robot.present(); ++i) rig.step();
    EXPECT_FALSE(rig.robot.present());
    Time t{};
    for (; t < 10s && !rig.robot.present(); t += 1ms) rig.step();
    return t;
  }
  void power_cycle() {
    rig.robot.power_cycle();
    away();
  }
  Six value(std::uint32_t type) {
    rig.out.dynamic_data_configuration.type_ids[0] = type;
    rig.run(2ms);
    return rig.robot.inputs().dynamic_data[0].values;
  }
  Rig rig{quick_boot()};
};

TEST_F(Reboot, IsAcknowledgedBeforeTheRobotGoesAwayForItsBootTime) {
  rig.send(image::kRebootRobot);
  EXPECT_TRUE(rig.robot.present());
  EXPECT_EQ(rig.robot.journal().back().command.id, image::kRebootRobot);
  EXPECT_EQ(rig.robot.journal().back().outcome, Outcome::kExecuted);
  EXPECT_NEAR(static_cast<double>(away().count()), 1e9, 2e6);
  EXPECT_EQ(rig.motion().move_id, 0);
}

TEST_F(Reboot, IsRefusedUnlessDeactivatedWith1026) {
  rig.activate();
  rig.send(image::kRebootRobot);
  EXPECT_EQ(rig.error(), 1026);
  rig.run(500ms);
  EXPECT_TRUE(rig.robot.present());
}

TEST_F(Reboot, IsRefusedOnOlderFirmwareWith1001) {
  rig = Rig(quick_boot(Product::kMeca500R4, image::Layout::kFirmware10));
  rig.send(image::kRebootRobot);
  EXPECT_EQ(rig.error(), 1001);
}

TEST_F(Reboot, IsTakenInAnErrorThatNothingElseClears) {
  rig.robot.raise_error(3006);
  rig.reset_error();
  EXPECT_EQ(rig.error(), 3006);
  rig.send(image::kRebootRobot);
  away();
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(Reboot, HearsNothingWhileItGoesDownAndBoots) {
  rig.send(image::kRebootRobot);
  rig.out.robot_control.activate = true;
  rig.out.motion_control.set_point = false;
  for (int i = 0; i < 1050; ++i) {
    rig.step();
    ASSERT_FALSE(rig.robot.inputs().robot_status.busy);
    ASSERT_FALSE(rig.robot.inputs().robot_status.activated);
  }
  EXPECT_FALSE(rig.robot.present());
}

TEST_F(Reboot, AfterAPowerCycleInAMoveNothingOfItIsLeft) {
  rig.make_ready();
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {5});
  rig.send(image::kMoveJoints, {0, 0, 0, 0, 0, 0});
  rig.run(500ms);
  const double at = rig.joint(1);
  rig.robot.power_cycle();
  EXPECT_FALSE(rig.robot.present());
  EXPECT_EQ(rig.robot.journal().size(), 3u);
  for (std::uint64_t i = 0; i < 3; ++i) EXPECT_EQ(rig.robot.journal()[i].outcome, Outcome::kDiscarded);
  rig.out.motion_control.set_point = false;
  away();
  const image::Inputs& in = rig.run(1s);
  EXPECT_FALSE(in.robot_status.activated);
  EXPECT_FALSE(in.robot_status.homed);
  EXPECT_FALSE(in.motion_status.paused);
  EXPECT_TRUE(in.motion_status.cleared);
  EXPECT_EQ(in.motion_status.fifo_space, 13000);
  EXPECT_EQ(in.motion_status.checkpoint_reached, 0);
  EXPECT_EQ(in.motion_status.checkpoint_discarded, 0);
  EXPECT_EQ(in.motion_status.move_id, 0);
  EXPECT_EQ(rig.joint(1), at) << "the arm stays where its brakes hold it";
}

TEST_F(Reboot, PutsSettingsBackToTheirDefaults) {
  rig.make_ready();
  rig.perform(image::kSetBlending, {30});
  rig.perform(image::kSetTimeScaling, {50});
  rig.perform(image::kSetGripperForce, {70});
  rig.out.robot_control.recovery_mode = true;
  rig.step();
  rig.out = {};
  power_cycle();
  EXPECT_EQ(value(21)[0], 100);
  EXPECT_EQ(value(54)[0], 100);
  EXPECT_EQ(value(23)[0], 40);
  EXPECT_EQ(value(52)[1], 0) << "the gripper needs homing too";
  EXPECT_FALSE(rig.robot.inputs().robot_status.recovery_mode);
}

TEST_F(Reboot, KeepsWhatTheRobotSaves) {
  rig.send(image::kSetJointLimits, {1, -30, 30});
  rig.send(image::kSetJointLimitsCfg, {1});
  rig.send(10000, {7});
  rig.out.motion_control = {};
  power_cycle();
  EXPECT_EQ(value(11)[0], 1);
  EXPECT_EQ(value(14), (Six{-30, -70, -135, 30, 90, 70}));
  EXPECT_EQ(value(10000), (Six{7}));
}

TEST_F(Reboot, NeedsActivationAndHomingAgain) {
  rig.make_ready();
  power_cycle();
  rig.activate();
  EXPECT_FALSE(rig.robot.inputs().robot_status.homed);
  rig.home();
  rig.perform(image::kMoveJoints, {5, 0, 0, 0, 0, 0});
  EXPECT_NEAR(rig.joint(1), 5, 1e-4);
}

TEST_F(Reboot, StartsTheRobotsClockAgain) {
  const std::uint32_t booted = rig.robot.inputs().robot_timestamp.seconds;
  rig.run(5s);
  EXPECT_EQ(rig.robot.inputs().robot_timestamp.seconds, booted + 5);
  power_cycle();
  EXPECT_EQ(rig.robot.inputs().robot_timestamp.seconds, booted);
}

TEST_F(Reboot, DoesNotReleaseAnEmergencyStop) {
  rig.robot.press_e_stop();
  power_cycle();
  EXPECT_TRUE(rig.step().robot_status.e_stop);
}

// ---------------------------------------------------------------- the Reboot stop (byte 128 bit 7)

RobotOptions stopping(Product product) {
  RobotOptions o = quick_boot(product);
  o.reboot_stop = true;
  return o;
}

TEST_F(Reboot, OfAnR4CanWaitForTheResetButton) {
  rig = Rig(stopping(Product::kMeca500R4));
  rig.robot.press_reset_button();  // after the first boot
  rig.make_ready();
  rig.out = {};
  power_cycle();
  EXPECT_TRUE(rig.step().safety_status.stop.reboot);
  EXPECT_TRUE(rig.robot.inputs().safety_status.resettable.reboot);
  EXPECT_TRUE(rig.robot.inputs().safety_status.reset_ready);
  EXPECT_FALSE(rig.robot.inputs().safety_status.vmotor_on);
  rig.out.robot_control.activate = true;
  EXPECT_FALSE(rig.run(1s).robot_status.activated);
  rig.out.robot_control.activate = false;
  rig.robot.press_reset_button();
  EXPECT_FALSE(rig.step().safety_status.stop.reboot);
  EXPECT_FALSE(rig.robot.inputs().safety_status.reset_ready);
  rig.make_ready();
}

TEST_F(Reboot, StopIsThereAfterTheFirstBootToo) {
  rig = Rig(stopping(Product::kMeca500R4));
  EXPECT_TRUE(rig.robot.inputs().safety_status.stop.reboot);
}

TEST_F(Reboot, StopIsNotResetWhileTheEmergencyStopIsPressed) {
  rig = Rig(stopping(Product::kMeca500R4));
  rig.robot.press_e_stop();
  rig.robot.press_reset_button();
  EXPECT_TRUE(rig.step().safety_status.stop.reboot);
  EXPECT_FALSE(rig.robot.inputs().safety_status.reset_ready);
  rig.robot.release_e_stop();
  rig.robot.press_reset_button();
  EXPECT_EQ(rig.step().safety_status.stop, image::StopSignals{});
}

TEST_F(Reboot, StopDoesNotExistOnAnR3) {
  rig = Rig(stopping(Product::kMeca500R3));
  EXPECT_FALSE(rig.robot.inputs().safety_status.stop.reboot);
  rig.make_ready();
}

}  // namespace
}  // namespace meca::sim
