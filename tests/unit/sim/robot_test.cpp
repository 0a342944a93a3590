// The robot's states: activation, homing, errors, simulation and recovery mode, brakes, timestamps.
#include "sim/robot.hpp"

#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

TEST(Activation, TakesItsTimeAndIsBusyMeanwhile) {
  RobotOptions o;
  o.activation_time = 2s;
  Rig rig(o);
  EXPECT_FALSE(rig.step().robot_status.busy);
  EXPECT_TRUE(rig.robot.inputs().robot_status.brakes_engaged);
  rig.out.robot_control.activate = true;
  EXPECT_TRUE(rig.step().robot_status.busy);
  EXPECT_FALSE(rig.run(1990ms).robot_status.activated);
  EXPECT_TRUE(rig.run(20ms).robot_status.activated);
  EXPECT_FALSE(rig.robot.inputs().robot_status.busy);
  EXPECT_FALSE(rig.robot.inputs().robot_status.homed);
  EXPECT_FALSE(rig.robot.inputs().robot_status.brakes_engaged);
}

TEST(Activation, DeactivateWinsOverActivate) {
  Rig rig;
  rig.out.robot_control.activate = rig.out.robot_control.deactivate = true;
  EXPECT_FALSE(rig.run(20ms).robot_status.activated);
  EXPECT_FALSE(rig.robot.inputs().robot_status.busy);
}

TEST(Activation, AnAllZeroImageDoesNothing) {
  Rig rig;
  const image::Inputs before = rig.step();
  const image::Inputs& after = rig.run(100ms);
  EXPECT_EQ(after.robot_status, before.robot_status);
  EXPECT_EQ(after.motion_status, before.motion_status);
  EXPECT_EQ(after.target_joint_set, before.target_joint_set);
  EXPECT_EQ(rig.robot.journal().size(), 0u);
}

TEST(Homing, NeedsAnActivatedRobotAndSurvivesDeactivation) {
  Rig rig;
  rig.out.robot_control.home = true;
  EXPECT_FALSE(rig.run(20ms).robot_status.homed);
  rig.out.robot_control.home = false;
  rig.make_ready();
  EXPECT_TRUE(rig.robot.inputs().robot_status.homed);

  rig.out.robot_control.deactivate = true;
  EXPECT_TRUE(rig.step().robot_status.busy);
  rig.run(10ms);
  EXPECT_FALSE(rig.robot.inputs().robot_status.activated);
  EXPECT_FALSE(rig.robot.inputs().robot_status.homed);
  rig.out.robot_control.deactivate = false;
  rig.activate();
  EXPECT_TRUE(rig.robot.inputs().robot_status.homed);
}

TEST(Homing, ClearHomingForcesANewHomingAfterActivation) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kClearHoming);
  rig.out.robot_control.deactivate = true;
  rig.run(10ms);
  rig.out.robot_control.deactivate = false;
  rig.activate();
  EXPECT_FALSE(rig.robot.inputs().robot_status.homed);
}

TEST(Deactivation, DiscardsTheQueueAndKeepsClearedSet) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kDelay, {10});
  rig.send(image::kSetCheckpoint, {77});
  EXPECT_FALSE(rig.motion().cleared);
  rig.out.robot_control.deactivate = true;
  rig.run(10ms);
  EXPECT_TRUE(rig.motion().cleared);
  EXPECT_EQ(rig.motion().fifo_space, 13000);
  EXPECT_EQ(rig.motion().checkpoint_discarded, 77);
  EXPECT_TRUE(rig.robot.inputs().robot_status.brakes_engaged);
}

TEST(SimulationMode, FollowsItsBitOnlyWhileDeactivatedAndWithoutSafetyStop) {
  Rig rig;
  rig.out.robot_control.sim_mode = true;
  EXPECT_TRUE(rig.step().robot_status.sim_activated);
  rig.activate();
  rig.out.robot_control.sim_mode = false;
  EXPECT_TRUE(rig.step().robot_status.sim_activated);
  rig.out.robot_control.deactivate = true;
  EXPECT_FALSE(rig.run(10ms).robot_status.sim_activated);
  rig.robot.press_p_stop2();
  rig.out.robot_control.sim_mode = true;
  EXPECT_FALSE(rig.step().robot_status.sim_activated);
}

TEST(RecoveryMode, MovesWithoutHomingAtFivePercent) {
  Rig rig;
  rig.activate();
  rig.out.robot_control.recovery_mode = true;
  EXPECT_TRUE(rig.step().robot_status.recovery_mode);
  rig.send(image::kSetJointVel, {100});
  const Time t = rig.perform(image::kMoveJoints, {15, 0, 0, 0, 0, 0});
  EXPECT_EQ(rig.error(), 0);
  EXPECT_NEAR(rig.joint(1), 15, 1e-4);
  // 15 degrees at 5 % of 150 deg/s: 2 s, and a ramp of 0.1 s / 40 %.
  EXPECT_NEAR(std::chrono::duration<double>(t).count(), 2.25, 0.01);
}

TEST(Brakes, AreReleasedByHandOnlyWithTheGateAndOnlyWhileDeactivated) {
  Rig rig;
  rig.out.brakes_control = {false, false};
  EXPECT_TRUE(rig.step().robot_status.brakes_engaged);
  rig.out.brakes_control = {true, false};
  EXPECT_FALSE(rig.step().robot_status.brakes_engaged);
  rig.out.brakes_control = {true, true};
  EXPECT_TRUE(rig.step().robot_status.brakes_engaged);
  rig.activate();
  EXPECT_FALSE(rig.step().robot_status.brakes_engaged);
}

TEST(Error, StopsMotionClearsTheQueueAndNeedsResetAndResume) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {5});
  rig.run(500ms);
  EXPECT_FALSE(rig.motion().eom);
  rig.robot.raise_error(3005);
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3005);
  EXPECT_TRUE(rig.motion().eom);
  EXPECT_TRUE(rig.motion().cleared);
  EXPECT_TRUE(rig.motion().paused);
  EXPECT_EQ(rig.motion().checkpoint_discarded, 5);
  const double stopped_at = rig.joint(1);
  EXPECT_GT(stopped_at, 1);
  EXPECT_LT(stopped_at, 89);

  rig.resume();  // refused: the error is still there
  EXPECT_TRUE(rig.motion().paused);
  rig.reset_error();
  EXPECT_EQ(rig.error(), 0);
  EXPECT_TRUE(rig.motion().paused);
  rig.send(image::kMoveJoints, {0, 0, 0, 0, 0, 0});
  rig.run(200ms);
  EXPECT_FLOAT_EQ(rig.joint(1), stopped_at);  // still paused
  rig.resume();
  EXPECT_FALSE(rig.motion().paused);
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  EXPECT_NEAR(rig.joint(1), 0, 1e-4);
}

TEST(Error, OneThatCannotBeResetStays) {
  Rig rig;
  rig.robot.raise_error(3006);  // communication with the drives
  rig.reset_error();
  EXPECT_EQ(rig.error(), 3006);
}

TEST(Error, TheFirstCauseStaysOnTheDisplay) {
  Rig rig;
  rig.robot.raise_error(3005);
  rig.robot.raise_error(3029);
  rig.step();
  EXPECT_EQ(rig.error(), 3005);
}

TEST(Error, HoldsActivationBackUntilReset) {
  Rig rig;
  rig.robot.raise_error(1013);
  rig.out.robot_control.activate = true;
  EXPECT_FALSE(rig.run(20ms).robot_status.activated);
  rig.out.robot_control.activate = false;
  rig.reset_error();
  rig.activate();
  EXPECT_TRUE(rig.robot.inputs().robot_status.activated);
}

TEST(Timestamp, IsMonotonicAndItsMicrosecondsStayBelowAMillion) {
  Rig rig;
  const auto microseconds = [&] {
    const auto& t = rig.robot.inputs().robot_timestamp;
    EXPECT_LT(t.microseconds, 1'000'000u);
    return std::uint64_t{t.seconds} * 1'000'000 + t.microseconds;
  };
  rig.step();
  const auto before = microseconds();
  for (int i = 0; i < 3000; ++i) {
    const auto a = microseconds();
    rig.step(777us);
    ASSERT_EQ(microseconds() - a, 777u);
  }
  EXPECT_EQ(microseconds() - before, 3000u * 777);
}

TEST(Monitoring, AConnectionThatMayOnlyWatchIsNotObeyed) {
  Rig rig;
  rig.robot.set_monitoring(true);
  rig.out.robot_control.activate = true;
  EXPECT_FALSE(rig.run(50ms).robot_status.activated);
  EXPECT_TRUE(rig.robot.inputs().robot_status.monitoring_mode);
}

TEST(Strictness, ALevelDroppedBeforeItsConfirmationIsAViolation) {
  RobotOptions o;
  Rig rig(o);
  rig.out.robot_control.activate = true;
  rig.run(100ms);
  rig.out.robot_control.activate = false;
  rig.step();
  ASSERT_EQ(rig.robot.violations().size(), 1u);
  EXPECT_EQ(rig.robot.violations()[0].what, "Activate was dropped before Activated confirmed it");
}

class LateEcho : public testing::Test {
 protected:
  static RobotOptions two_cycles() {
    RobotOptions o = Rig::quick();
    o.echo_cycles = 2;
    return o;
  }
  LateEcho() : rig(two_cycles()) {
    rig.make_ready();
    rig.out.motion_command = {image::kMoveJoints, {10, 0, 0, 0, 0, 0}};
    rig.out.motion_control.move_id = 1;
    rig.out.motion_control.set_point = true;
    rig.step();
  }
  std::string_view violation() const {
    return rig.robot.violations().size() == 1 ? rig.robot.violations()[0].what : "not one violation";
  }
  Rig rig;
};

TEST_F(LateEcho, ComesAfterItsCyclesAndWhoWaitsForItIsNotAccused) {
  EXPECT_EQ(rig.robot.inputs().motion_status.move_id, 0);
  EXPECT_EQ(rig.step().motion_status.move_id, 0);
  EXPECT_EQ(rig.step().motion_status.move_id, 1);
  rig.out.motion_command.arguments[0] = 20;
  rig.out.motion_control.move_id = 2;
  rig.step();
  EXPECT_EQ(rig.robot.violations().size(), 0u);
}

TEST_F(LateEcho, AMoveIdThatChangesBeforeItIsAViolation) {
  rig.out.motion_control.move_id = 2;
  rig.step();
  EXPECT_EQ(violation(), "MoveID was changed before the robot had echoed it");
}

TEST_F(LateEcho, ArgumentsThatChangeBeforeItAreAViolation) {
  rig.out.motion_command.arguments[0] = 20;
  rig.step();
  EXPECT_EQ(violation(), "a command or its arguments were changed before the robot had echoed its MoveID");
}

TEST_F(LateEcho, ASetPointThatFallsBeforeItIsNone) {  // a stop must not wait
  rig.out.motion_control.set_point = false;
  rig.step();
  EXPECT_EQ(rig.robot.violations().size(), 0u);
}

TEST(Strictness, AReservedBitIsAViolationOnceUntilItFalls) {
  Rig rig;
  image::OutputBytes bytes{};
  rig.robot.step(bytes, std::endian::little, 1ms);
  EXPECT_EQ(rig.robot.violations().size(), 0u);
  bytes[43] = std::byte{0x80};  // the last of the 30 reserved bits behind BrakesEngaged
  for (int i = 0; i < 3; ++i) rig.robot.step(bytes, std::endian::little, 1ms);
  ASSERT_EQ(rig.robot.violations().size(), 1u);
  EXPECT_EQ(rig.robot.violations()[0].what, "a reserved bit of the output image was set");
  bytes[43] = {};
  bytes[6] = std::byte{0x10};  // UseVariables, which firmware 11 has
  rig.robot.step(bytes, std::endian::little, 1ms);
  EXPECT_EQ(rig.robot.violations().size(), 1u);
}

TEST(Strictness, UseVariablesIsAReservedBitBeforeFirmware11) {
  Rig rig(Rig::quick(image::Layout::kFirmware10));
  image::OutputBytes bytes{};
  bytes[6] = std::byte{0x10};
  rig.robot.step(bytes, std::endian::little, 1ms);
  EXPECT_EQ(rig.robot.violations().size(), 1u);
}

TEST(Strictness, AGoodHostIsNotAccused) {
  Rig rig;
  rig.make_ready();
  rig.perform(image::kMoveJoints, {10, 0, 0, 0, 0, 0});
  EXPECT_EQ(rig.robot.violations().size(), 0u);
}

}  // namespace
}  // namespace meca::sim
