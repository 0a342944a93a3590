// Pause and resume, firmware 9, safety stops, R3 against R4.
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using image::Layout;

TEST(Pause, SlowsDownAtOnceKeepsTheQueueAndWaitsForARisingEdge) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {3});
  rig.run(500ms);
  rig.out.motion_control.pause_motion = true;
  rig.step();
  EXPECT_TRUE(rig.motion().paused);
  const double at_pause = rig.joint(1);
  rig.run(400ms);
  EXPECT_TRUE(rig.motion().eom);
  EXPECT_FALSE(rig.motion().eob);
  const double stopped = rig.joint(1);
  EXPECT_GT(stopped, at_pause);      // along the path
  EXPECT_LT(stopped, at_pause + 4);  // 37.5 deg/s for half a ramp of 0.125 s
  rig.run(200ms);
  EXPECT_EQ(rig.joint(1), stopped);

  rig.resume();  // PauseMotion is still set
  EXPECT_TRUE(rig.motion().paused);
  rig.out.motion_control.pause_motion = false;
  EXPECT_TRUE(rig.run(100ms).motion_status.paused);  // letting go is not resuming
  EXPECT_EQ(rig.joint(1), stopped);
  rig.resume();
  EXPECT_FALSE(rig.motion().paused);
  rig.run_until([](const auto& in) { return in.motion_status.checkpoint_reached == 3; });
  EXPECT_NEAR(rig.joint(1), 90, 1e-4);
}

TEST(Pause, ResumeIsAnEdgeAndNotALevel) {
  Rig rig;
  rig.make_ready();
  rig.out.motion_control.resume_motion = true;
  rig.step();
  rig.out.motion_control.pause_motion = true;
  rig.step();
  rig.out.motion_control.pause_motion = false;
  EXPECT_TRUE(rig.run(50ms).motion_status.paused);  // the bit stayed 1 all the time
}

TEST(Pause, InterruptsAVelocityStreamWhichComesBackAfterTheResume) {
  Rig rig;
  rig.make_ready();
  rig.out.motion_control.set_point = true;
  rig.out.motion_command = {image::kMoveJointsVel, {20, 0, 0, 0, 0, 0}};
  rig.run(200ms);
  rig.out.motion_control.pause_motion = true;
  rig.run(200ms);
  EXPECT_TRUE(rig.motion().eom);
  EXPECT_EQ(rig.motion().fifo_space, 13000);
  rig.out.motion_control.pause_motion = false;
  rig.resume();
  rig.run(50ms);
  EXPECT_FALSE(rig.motion().eom);
}

TEST(Firmware9, GoesOnByItselfWhenPauseAndClearAreBothZero) {
  Rig rig(Rig::quick(Layout::kFirmware9));
  rig.make_ready();
  rig.send(image::kMoveJoints, {60, 0, 0, 0, 0, 0});
  rig.run(300ms);
  rig.out.motion_control.pause_motion = true;
  rig.run(400ms);
  EXPECT_TRUE(rig.motion().paused);
  EXPECT_TRUE(rig.motion().eom);
  rig.out.motion_control.pause_motion = false;
  EXPECT_FALSE(rig.step().motion_status.paused);
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  EXPECT_NEAR(rig.joint(1), 60, 1e-4);
}

TEST(Firmware9, PStop2IsResetByItsOwnBit) {
  Rig rig(Rig::quick(Layout::kFirmware9));
  rig.make_ready();
  rig.robot.press_p_stop2();
  rig.step();
  EXPECT_TRUE(rig.motion().p_stop2);
  EXPECT_FALSE(rig.motion().p_stop2_resettable);
  rig.robot.release_p_stop2();
  rig.step();
  EXPECT_TRUE(rig.motion().p_stop2);
  EXPECT_TRUE(rig.motion().p_stop2_resettable);
  EXPECT_TRUE(rig.motion().paused);
  rig.out.motion_control.resume_motion = true;  // byte 6 bit 3 is ResetPStop2 here
  rig.step();
  EXPECT_FALSE(rig.motion().p_stop2);
  EXPECT_FALSE(rig.motion().paused);
}

TEST(Firmware9, NeverClaimsToKnowItsSafetyStatus) {
  Rig rig(Rig::quick(Layout::kFirmware9));
  rig.robot.press_p_stop2();
  EXPECT_FALSE(rig.step().safety_status.known);
  EXPECT_EQ(rig.robot.inputs().safety_status, image::SafetyStatus{});
}

TEST(PStop2, IsPresentThenResettableThenResetByResume) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {6});
  rig.run(300ms);
  rig.robot.press_p_stop2();
  rig.run(300ms);
  const auto& safety = rig.robot.inputs().safety_status;
  EXPECT_TRUE(safety.known);
  EXPECT_TRUE(safety.stop.p_stop2);
  EXPECT_FALSE(safety.resettable.p_stop2);
  EXPECT_TRUE(rig.motion().cleared);
  EXPECT_TRUE(rig.motion().paused);
  EXPECT_EQ(rig.motion().checkpoint_discarded, 6);

  rig.resume();  // the signal is still there
  EXPECT_TRUE(rig.motion().paused);
  rig.send(image::kSetCheckpoint, {7});
  EXPECT_EQ(rig.motion().fifo_space, 13000);

  rig.robot.release_p_stop2();
  rig.step();
  EXPECT_TRUE(safety.stop.p_stop2);
  EXPECT_TRUE(safety.resettable.p_stop2);
  EXPECT_TRUE(rig.motion().p_stop2);
  rig.resume();
  EXPECT_FALSE(safety.stop.p_stop2);
  EXPECT_FALSE(safety.resettable.p_stop2);
  EXPECT_FALSE(rig.motion().paused);
  rig.send(image::kSetCheckpoint, {8});
  EXPECT_EQ(rig.step().motion_status.checkpoint_reached, 8u);
}

TEST(PStop2, WithSeverityPauseKeepsTheQueue) {
  RobotOptions o = Rig::quick();
  o.p_stop2_severity = StopSeverity::kPause;
  Rig rig(o);
  rig.make_ready();
  rig.send(image::kMoveJoints, {60, 0, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {6});
  rig.run(300ms);
  rig.robot.press_p_stop2();
  rig.run(300ms);
  EXPECT_TRUE(rig.motion().paused);
  EXPECT_FALSE(rig.motion().cleared);
  rig.robot.release_p_stop2();
  rig.resume();
  rig.run_until([](const auto& in) { return in.motion_status.checkpoint_reached == 6; });
  EXPECT_NEAR(rig.joint(1), 60, 1e-4);
}

TEST(ConnectionDropped, IsASafetyStopThatResumeClears) {
  Rig rig;
  rig.make_ready();
  rig.robot.drop_connection();
  EXPECT_TRUE(rig.step().safety_status.stop.connection_dropped);
  EXPECT_TRUE(rig.motion().paused);
  rig.robot.restore_connection();
  EXPECT_TRUE(rig.step().safety_status.resettable.connection_dropped);
  rig.resume();
  EXPECT_FALSE(rig.robot.inputs().safety_status.stop.connection_dropped);
  EXPECT_FALSE(rig.motion().paused);
}

TEST(EStop, OnAnR4IsReportedAndNeedsTheResetButton) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.run(300ms);
  const auto& in = rig.robot.inputs();
  EXPECT_TRUE(in.safety_status.vmotor_on);
  rig.robot.press_e_stop();
  rig.step();
  EXPECT_FALSE(in.robot_status.activated);
  EXPECT_TRUE(in.robot_status.brakes_engaged);
  EXPECT_TRUE(in.robot_status.e_stop);
  EXPECT_TRUE(in.safety_status.stop.e_stop);
  EXPECT_FALSE(in.safety_status.resettable.e_stop);
  EXPECT_FALSE(in.safety_status.reset_ready);
  EXPECT_FALSE(in.safety_status.vmotor_on);
  EXPECT_TRUE(in.motion_status.eom);
  EXPECT_TRUE(in.motion_status.cleared);

  rig.robot.press_reset_button();  // too early
  rig.robot.release_e_stop();
  rig.step();
  EXPECT_TRUE(in.safety_status.stop.e_stop);
  EXPECT_TRUE(in.safety_status.resettable.e_stop);
  EXPECT_TRUE(in.safety_status.reset_ready);
  rig.out.robot_control.activate = true;
  EXPECT_FALSE(rig.run(20ms).robot_status.activated);
  rig.out.robot_control.activate = false;

  rig.robot.press_reset_button();
  rig.step();
  EXPECT_FALSE(in.safety_status.stop.e_stop);
  EXPECT_FALSE(in.safety_status.reset_ready);
  EXPECT_TRUE(in.safety_status.vmotor_on);
  rig.activate();
  EXPECT_TRUE(in.robot_status.activated);
}

TEST(EStop, OnAnR3IsNeverReportedAndCostsTheHoming) {
  Rig rig(Rig::quick(Layout::kFirmware11, Product::kMeca500R3));
  rig.make_ready();
  rig.robot.press_e_stop();
  rig.step();
  const auto& in = rig.robot.inputs();
  EXPECT_FALSE(in.robot_status.activated);
  EXPECT_FALSE(in.robot_status.e_stop);
  EXPECT_FALSE(in.safety_status.stop.e_stop);
  rig.robot.release_e_stop();
  rig.activate();
  EXPECT_TRUE(in.robot_status.activated);
  EXPECT_FALSE(in.robot_status.homed);
}

}  // namespace
}  // namespace meca::sim
