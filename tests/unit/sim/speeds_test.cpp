// How fast the arm is allowed to be: R3 and R4, recovery mode, velocity limit, time scaling, time-based moves
// (spec 5.6, 6.2, 6.3).
#include <algorithm>
#include <cmath>

#include "sim/inverse.hpp"
#include "sim/kinematics.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

double seconds(Time t) { return std::chrono::duration<double>(t).count(); }

class Speed : public testing::Test {
 protected:
  Speed() { rig.make_ready(); }
  void replace(Product product) {
    rig = Rig(Rig::quick(image::Layout::kFirmware11, product));
    rig.make_ready();
  }
  void stream(std::uint32_t id, const std::array<float, 6>& arguments) {
    rig.out.motion_control.set_point = true;
    rig.out.motion_control.move_id = 0;
    rig.out.motion_command = {id, arguments};
  }
  // Of joint 1 over the next 100 ms, deg/s.
  double speed_of_joint1() {
    const double before = rig.joint(1);
    rig.run(100ms);
    return (rig.joint(1) - before) / 0.1;
  }
  // Of the flange over the next 100 ms, mm/s.
  double speed_of_flange() {
    const image::Pose a = rig.robot.inputs().target_end_effector_pose;
    rig.run(100ms);
    const image::Pose& b = rig.robot.inputs().target_end_effector_pose;
    return std::hypot(b.x - a.x, b.y - a.y, b.z - a.z) / 0.1;
  }
  // Steps until the arm rests; the largest speed of each joint, in percent of kTopSpeed.
  double fastest_joint() {
    double out = 0;
    image::TargetJointSet before = rig.robot.inputs().target_joint_set;
    while (!rig.motion().eob) {
      rig.step();
      const image::TargetJointSet& now = rig.robot.inputs().target_joint_set;
      for (std::size_t i = 0; i < 6; ++i) {
        out = std::max(out, std::abs(now.joints[i] - before.joints[i]) / 1e-3 / kTopSpeed[i] * 100);
      }
      before = now;
    }
    return out;
  }
  Rig rig;
};

// --- R3 and R4

TEST_F(Speed, OfVelocitiesEndsAt100PercentOnAnR3AndAt150PercentOnAnR4) {
  for (const auto& [product, top] : {std::pair{Product::kMeca500R3, 150.0}, {Product::kMeca500R4, 225.0}}) {
    replace(product);
    stream(image::kMoveJointsVel, {400, 0, 0, 0, 0, 0});
    rig.run(300ms);
    EXPECT_NEAR(speed_of_joint1(), top, 0.5);
  }
}

TEST_F(Speed, OfMovesAt150PercentIsThatMuchOfTheR3sOnAnR4) {
  rig.perform(image::kSetJointVel, {150});
  rig.send(image::kMoveJoints, {160, 0, 0, 0, 0, 0});
  EXPECT_NEAR(fastest_joint(), 150, 0.1);
}

TEST_F(Speed, LimitAbove100PercentIs1003OnAnR3) {
  replace(Product::kMeca500R3);
  rig.perform(image::kSetJointVelLimit, {101});
  EXPECT_EQ(rig.error(), 1003);
}

// --- SetJointVelLimit, SetCartLinVel, SetCartAngVel

TEST_F(Speed, LimitHoldsForJointMovesLinesAndVelocities) {
  rig.perform(image::kMoveJoints, {0, 10, 10, 0, 40, 0});
  rig.perform(image::kSetJointVelLimit, {10});
  rig.perform(image::kSetCartLinVel, {1000});
  rig.send(image::kMoveLinRelWrf, {0, 0, -60, 0, 0, 0});
  EXPECT_NEAR(fastest_joint(), 9.8, 0.3);  // where a line needs most of a joint may be in its ramp
  rig.perform(image::kSetJointVel, {100});
  rig.send(image::kMoveJoints, {30, 10, 10, 0, 40, 0});
  EXPECT_NEAR(fastest_joint(), 10, 0.1);
  stream(image::kMoveJointsVel, {-100, 0, 0, 0, 0, 0});
  rig.run(300ms);
  EXPECT_NEAR(speed_of_joint1(), -15, 0.1);
}

TEST_F(Speed, LimitLeavesTheRampAsLongAsItIsSoTheArmAcceleratesLess) {
  // The ramp's time is the parameter (spec 6.2): at 5 % of the speed, 5 % of the acceleration.
  const auto time_to_full_speed = [&](double percent) {
    rig.perform(image::kSetJointVelLimit, {percent});
    rig.perform(image::kSetJointVel, {100});
    const double top = kTopSpeed[0] * percent / 100, start = rig.joint(1);
    rig.send(image::kMoveJoints, {start > 45 ? start - 60 : start + 60, 0, 0, 0, 0, 0});
    double before = rig.joint(1), speed = 0;
    Time t = 1ms;
    while (speed < 0.99 * top) {
      rig.step();
      t += 1ms;
      speed = std::abs(rig.joint(1) - before) / 1e-3;
      before = rig.joint(1);
    }
    rig.run_until([](const auto& in) { return in.motion_status.eob; });
    return seconds(t);
  };
  const double fast = time_to_full_speed(100), slow = time_to_full_speed(5);
  EXPECT_NEAR(slow, fast, 0.005);
}

TEST_F(Speed, OfTurningOnTheSpotIsThatOfSetCartAngVel) {
  rig.perform(image::kMoveJoints, {0, 10, 10, 0, 40, 0});
  rig.perform(image::kSetCartAngVel, {20});
  const Time t = rig.perform(image::kMoveLinRelTrf, {0, 0, 0, 0, 0, 40});
  EXPECT_NEAR(seconds(t), 40.0 / 20 + 0.2, 0.01);  // ramp of 0.2 s at SetCartAcc 50 (inferred)
}

// --- recovery mode: 5 % joint speed, 40 % accelerations, 20 mm/s, 30 deg/s (spec 5.6)

TEST_F(Speed, OfLinesAndTurnsInRecoveryModeIsCapped) {
  rig.perform(image::kMoveJoints, {0, 10, 10, 0, 40, 0});
  rig.perform(image::kSetCartLinVel, {1000});
  rig.perform(image::kSetCartAngVel, {300});
  rig.perform(image::kSetCartAcc, {600});
  rig.out.robot_control.recovery_mode = true;
  const double ramp = 0.1 / 0.4;  // capped as well
  EXPECT_NEAR(seconds(rig.perform(image::kMoveLinRelWrf, {0, 0, -10, 0, 0, 0})), 10.0 / 20 + ramp, 0.01);
  // Joint 6 may do 25 deg/s, which is less than 30.
  EXPECT_NEAR(seconds(rig.perform(image::kMoveLinRelTrf, {0, 0, 0, 0, 0, 20})), 20.0 / 25 + ramp, 0.02);
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(Speed, OfVelocitiesInRecoveryModeIsCapped) {
  rig.perform(image::kMoveJoints, {0, 10, 10, 0, 40, 0});
  rig.out.robot_control.recovery_mode = true;
  stream(image::kMoveLinVelWrf, {0, 0, -100, 0, 0, 0});
  rig.run(500ms);
  EXPECT_NEAR(speed_of_flange(), 20, 0.2);
  stream(image::kMoveJointsVel, {100, 0, 0, 0, 0, 0});
  rig.run(500ms);
  EXPECT_NEAR(speed_of_joint1(), 7.5, 0.01);
}

// --- SetTimeScaling

TEST_F(Speed, OfVelocitiesIsScaledAndSoIsTheirTimeout) {
  rig.perform(image::kSetVelTimeout, {0.2});
  rig.perform(image::kSetTimeScaling, {50});
  rig.send(image::kMoveJointsVel, {20, 0, 0, 0, 0, 0});
  rig.run(200ms);
  EXPECT_NEAR(speed_of_joint1(), 10, 0.01);
  rig.run(90ms);  // 391 ms since the command: 0.2 s are 0.4 s
  EXPECT_FALSE(rig.motion().eom);
  rig.run(150ms);
  EXPECT_TRUE(rig.motion().eob);
}

TEST_F(Speed, ScalingStretchesMovesAndTimeBasedMovesAlike) {
  const Time plain = rig.perform(image::kMoveJoints, {40, 0, 0, 0, 0, 0});
  rig.perform(image::kSetTimeScaling, {50});
  EXPECT_NEAR(seconds(rig.perform(image::kMoveJoints, {0, 0, 0, 0, 0, 0})), 2 * seconds(plain), 0.005);
  rig.perform(image::kSetMoveMode, {1});
  rig.perform(image::kSetMoveDuration, {1});
  EXPECT_NEAR(seconds(rig.perform(image::kMoveJoints, {20, 0, 0, 0, 0, 0})), 2, 0.005);
}

TEST_F(Speed, ScalingTakesEffectInTheMiddleOfAMove) {
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.run(300ms);
  EXPECT_NEAR(speed_of_joint1(), 37.5, 0.1);
  rig.send(image::kSetTimeScaling, {10});  // immediate (inferred), so it does not wait for the move
  EXPECT_NEAR(speed_of_joint1(), 3.75, 0.1);
}

// --- SetMoveMode, SetMoveDuration, SetMoveDurationCfg

TEST_F(Speed, OfATimeBasedMoveDoesNotDependOnSetJointVel) {
  rig.perform(image::kSetJointVel, {1});
  rig.perform(image::kSetMoveMode, {1});
  rig.perform(image::kSetMoveDuration, {1});
  EXPECT_NEAR(seconds(rig.perform(image::kMoveJoints, {60, 0, 0, 0, 0, 0})), 1, 0.003);
  rig.perform(image::kSetMoveMode, {0});
  EXPECT_NEAR(seconds(rig.perform(image::kMoveJoints, {57, 0, 0, 0, 0, 0})), 3 / 1.5 + 0.125, 0.005);
}

TEST_F(Speed, OfAMoveWithTooShortADurationIsWhatTheArmCanDo) {
  rig.perform(image::kSetMoveMode, {1});
  rig.perform(image::kSetMoveDuration, {0.1});
  for (const double severity : {0.0, 1.0}) {
    rig.perform(image::kSetMoveDurationCfg, {severity});
    const double target = severity == 0 ? 90 : 0;
    EXPECT_NEAR(seconds(rig.perform(image::kMoveJoints, {target, 0, 0, 0, 0, 0})), 90.0 / 225 + 0.125, 0.005);
    EXPECT_EQ(rig.error(), 0);
  }
}

TEST_F(Speed, OfAMoveThatIsTooShortWithSeverity4IsErrorAndNoMotion) {
  rig.perform(image::kSetMoveMode, {1});
  rig.perform(image::kSetMoveDuration, {0.1});
  rig.perform(image::kSetMoveDurationCfg, {4});
  rig.perform(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  EXPECT_EQ(rig.error(), 3051);
  EXPECT_EQ(rig.joint(1), 0);
}

// --- lines

TEST_F(Speed, OfALineIsSuchThatNoJointIsFasterThanItMay) {
  // Close to the wrist singularity joints 4 and 6 would have to be faster than they can.
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 12, 25});
  rig.perform(image::kSetCartLinVel, {5000});
  rig.perform(image::kSetCartAngVel, {1000});
  rig.send(image::kMoveLinRelTrf, {0, 0, 0, 0, -20, 0});
  EXPECT_LE(fastest_joint(), 150.5);
  EXPECT_EQ(rig.error(), 0);
}

class AboveAxis1 : public Speed {
 protected:
  // The wrist 33 mm in front of axis 1, the tool down; back by half as much again, the wrist passes exactly over
  // axis 1.
  AboveAxis1() { rig.perform(image::kMoveJoints, {0, -40, 40, 0, 90, 0}); }
  void go_over() {
    const double x = rig.robot.inputs().target_end_effector_pose.x;
    rig.perform(image::kMoveLinRelWrf, {-1.5 * x, 0, 0, 0, 0, 0});
  }
};

TEST_F(AboveAxis1, ALineCrossesTheShoulderSingularityExactlyThroughItWithAutomaticPosture) {
  ASSERT_EQ(rig.robot.inputs().target_configuration.shoulder, 1);
  const double x = rig.robot.inputs().target_end_effector_pose.x;
  go_over();
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(rig.robot.inputs().target_configuration.shoulder, -1);
  EXPECT_NEAR(rig.robot.inputs().target_end_effector_pose.x, -x / 2, 1e-3);
  EXPECT_NEAR(rig.joint(1), 0, 1e-3);
}

TEST_F(AboveAxis1, ALineDoesNotStartWhenThePostureIsFixed) {
  rig.send(image::kSetConf, {1, 1, 1});
  const float before = rig.robot.inputs().target_end_effector_pose.x;
  go_over();
  EXPECT_EQ(rig.error(), 1012);
  EXPECT_EQ(rig.robot.inputs().target_end_effector_pose.x, before);
}

}  // namespace
}  // namespace meca::sim
