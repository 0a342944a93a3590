// Torques and their limits: SetTorqueLimits (27), SetTorqueLimitsCfg (28), dynamic data 24, 25, 33 and 43.
#include "sim/torque.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/skeleton.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using Six = std::array<float, 6>;

// Severity and mode of SetTorqueLimitsCfg (spec 2.1).
constexpr double kNone = 0, kStatus = 1, kPause = 2, kError = 4;
constexpr double kAbsolute = 0, kSkipAcceleration = 1, kDeviation = 2;

class Torque : public testing::Test {
 protected:
  Torque() { rig.make_ready(); }
  void limit_joint1(double percent, double severity, double mode) {
    rig.perform(image::kSetTorqueLimits, {percent, 100, 100, 100, 100, 100});
    rig.perform(image::kSetTorqueLimitsCfg, {severity, mode});
  }
  Six values(std::uint32_t type) {
    rig.out.dynamic_data_configuration.type_ids[2] = type;
    rig.run(2ms);
    return rig.robot.inputs().dynamic_data[2].values;
  }
  bool excessive() const { return rig.motion().excessive_torque; }
  Rig rig;
};

TEST(Skeleton, FollowsTheArmsLengthsAndAgreesWithTheFlange) {
  const Skeleton zero = skeleton({});
  EXPECT_NEAR(norm(zero.elbow - Vec3{0, 0, 270}), 0, 1e-9);
  EXPECT_NEAR(norm(zero.bend - Vec3{0, 0, 308}), 0, 1e-9);
  EXPECT_NEAR(norm(zero.wrist - Vec3{120, 0, 308}), 0, 1e-9);
  EXPECT_NEAR(norm(zero.flange.p - Vec3{190, 0, 308}), 0, 1e-9);
  const Skeleton s = skeleton({40, 30, -50, 60, 70, 80});
  EXPECT_NEAR(norm(s.elbow - s.shoulder), kUpperArm, 1e-9);
  EXPECT_NEAR(norm(s.bend - s.elbow), kElbowOffset, 1e-9);
  EXPECT_NEAR(norm(s.wrist - s.bend - kForearm * s.axis[3]), 0, 1e-9);
  // The axes are what the Jacobian turns around.
  const Jacobian j = jacobian({40, 30, -50, 60, 70, 80}, {});
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(s.axis[i][k], j[k + 3][i], 1e-9);
  }
}

TEST(CalculatedTorque, OfAnArmStraightUpIsNothingAndOfOneStretchedOutIsOnJoint2) {
  const Joints straight_up{0, 0, -72.43, 0, 0, 0};  // the wrist above the elbow above the shoulder, nearly
  const Joints stretched_out{0, 90, -72.43, 0, 0, 0};
  EXPECT_LT(std::abs(calculated_torques(straight_up, {}, {})[1]), 5);
  EXPECT_GT(std::abs(calculated_torques(stretched_out, {}, {})[1]), 25);
  EXPECT_EQ(calculated_torques(stretched_out, {}, {})[0], 0);  // axis 1 stands upright
}

TEST(CalculatedTorque, GrowsWithThePayloadAndWithWhereItsCentreOfMassIs) {
  const Joints q{0, 20, 10, 0, 30, 0};
  const auto size = [&](const std::array<double, 4>& payload, std::size_t joint) {
    return std::abs(calculated_torques(q, {}, payload)[joint]);
  };
  EXPECT_GT(size({0.5, 0, 0, 0}, 1), size({}, 1) + 5);
  EXPECT_GT(size({0.5, 0, 0, 60}, 4), size({0.5, 0, 0, 0}, 4) + 5);
  EXPECT_EQ(size({0.5, 0, 0, 60}, 5), size({}, 5));      // on axis 6
  EXPECT_GT(size({0.5, 0, 40, 0}, 5), size({}, 5) + 5);  // beside it
  EXPECT_LE(size({1e30, 1e30, 1e30, 1e30}, 1), 1000);    // SetPayload has no upper limit
}

TEST(CalculatedTorque, HasAShareThatAcceleratesAndOneThatBrakes) {
  const Joints q{};
  const double rest = calculated_torques(q, {}, {})[0];
  EXPECT_GT(calculated_torques(q, {400, 0, 0, 0, 0, 0}, {})[0], rest + 5);
  EXPECT_LT(calculated_torques(q, {-400, 0, 0, 0, 0, 0}, {})[0], rest - 5);
}

TEST(CalculatedTorque, StaysBelow100PercentUpToOneKilogram) {
  std::mt19937 random(3);
  double most = 0;
  for (int n = 0; n < 20'000; ++n) {
    Joints q, a;
    for (std::size_t i = 0; i < 6; ++i) {
      q[i] = std::uniform_real_distribution<double>(kModelLimits.minimum[i], kModelLimits.maximum[i])(random);
      a[i] = std::uniform_real_distribution<double>(-50'000, 50'000)(random);
    }
    for (const double t : calculated_torques(q, a, {1, 0, 0, 0})) most = std::max(most, std::abs(t));
  }
  EXPECT_LT(most, 99);  // half a percent is left for noise
  EXPECT_GT(most, 60);
}

TEST_F(Torque, IsShownCalculatedAndActual) {
  rig.perform(image::kMoveJoints, {0, 60, -60, 0, 0, 0});
  const Joints expected = calculated_torques({0, 60, -60, 0, 0, 0}, {}, {});
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(values(33)[i], expected[i], 1e-3);
    EXPECT_NEAR(values(43)[i], expected[i], 1e-3);
  }
  rig.robot.push(2, 15);
  EXPECT_NEAR(values(33)[1], expected[1], 1e-3);
  EXPECT_NEAR(values(43)[1], expected[1] + 15, 1e-3);
  rig.robot.push(7, 15);  // there is no such joint
  rig.robot.push(2, 0);
  EXPECT_NEAR(values(43)[1], expected[1], 1e-3);
}

TEST_F(Torque, ComesFromTheMotorsSoThereIsNoneWhileTheyAreOff) {
  EXPECT_NE(values(43)[1], 0);
  rig.out.robot_control.deactivate = true;
  rig.run(10ms);
  EXPECT_EQ(values(33), Six{});
  EXPECT_EQ(values(43), Six{});
}

TEST_F(Torque, OfTheTargetIsNotImplementedInFirmware9) {
  rig = Rig(Rig::quick(image::Layout::kFirmware9));  // manual 9.2
  rig.make_ready();
  EXPECT_EQ(values(33), Six{});
  EXPECT_NE(values(43)[1], 0);
}

TEST_F(Torque, LimitsAndTheirConfigurationAreShownAndComeBackToTheirDefaultsWithTheNextActivation) {
  EXPECT_EQ(values(24), Six{});
  EXPECT_EQ(values(25), (Six{100, 100, 100, 100, 100, 100}));
  rig.perform(image::kSetTorqueLimits, {60, 61, 62, 63, 64, 65});
  rig.perform(image::kSetTorqueLimitsCfg, {kError, kDeviation});
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(values(24), (Six{4, 2}));
  EXPECT_EQ(values(25), (Six{60, 61, 62, 63, 64, 65}));
  rig.out.robot_control.deactivate = true;
  rig.run(10ms);
  rig.out.robot_control.deactivate = false;
  rig.activate();
  EXPECT_EQ(values(24), Six{});
  EXPECT_EQ(values(25), (Six{100, 100, 100, 100, 100, 100}));
}

TEST_F(Torque, OverItsLimitDoesNothingWithSeverity0) {
  limit_joint1(20, kNone, kAbsolute);
  rig.robot.push(1, 90);
  rig.run(10ms);
  EXPECT_FALSE(excessive());
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(Torque, OverItsLimitIsOnlyShownWithSeverity1) {
  limit_joint1(20, kStatus, kAbsolute);
  rig.send(image::kMoveJoints, {0, 20, 0, 0, 0, 0});
  EXPECT_FALSE(excessive());
  rig.robot.push(1, -21);  // either direction
  rig.step();
  EXPECT_TRUE(excessive());
  rig.robot.push(1, 19);
  rig.step();
  EXPECT_FALSE(excessive());
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  EXPECT_NEAR(rig.joint(2), 20, 1e-4);
}

TEST_F(Torque, OverItsLimitPausesWithSeverity2AndKeepsTheQueue) {
  limit_joint1(20, kPause, kAbsolute);
  rig.send(image::kMoveJoints, {0, 40, 0, 0, 0, 0});
  rig.run(300ms);
  rig.robot.push(1, 50);
  rig.run(400ms);
  EXPECT_TRUE(excessive());
  EXPECT_TRUE(rig.motion().paused);
  EXPECT_FALSE(rig.motion().cleared);
  EXPECT_EQ(rig.error(), 0);
  const double stopped = rig.joint(2);

  rig.resume();  // something still leans on the arm
  EXPECT_TRUE(rig.motion().paused);
  EXPECT_NEAR(rig.joint(2), stopped, 0.01);
  rig.robot.push(1, 0);
  rig.resume();
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  EXPECT_NEAR(rig.joint(2), 40, 1e-4);
}

TEST_F(Torque, OverItsLimitIsError3029WithSeverity4) {
  limit_joint1(20, kError, kAbsolute);
  rig.send(image::kMoveJoints, {0, 40, 0, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {9});
  rig.run(300ms);
  rig.robot.push(1, 50);
  rig.run(400ms);
  EXPECT_EQ(rig.error(), 3029);
  EXPECT_TRUE(excessive());
  EXPECT_TRUE(rig.motion().cleared);
  EXPECT_EQ(rig.motion().checkpoint_discarded, 9);
}

TEST_F(Torque, AnErrorCanBeResetWhileTheForceStaysAndComesBackWithResume) {
  limit_joint1(20, kError, kAbsolute);
  rig.robot.push(1, 50);
  rig.run(5ms);
  EXPECT_EQ(rig.error(), 3029);
  rig.reset_error();
  rig.run(100ms);
  EXPECT_EQ(rig.error(), 0);
  rig.resume();
  EXPECT_EQ(rig.error(), 3029);
  // The way out without help: higher limits, queued while paused.
  rig.reset_error();
  rig.send(image::kSetTorqueLimits, {80, 100, 100, 100, 100, 100});
  rig.resume();
  EXPECT_EQ(rig.error(), 0);
  EXPECT_FALSE(excessive());
}

TEST_F(Torque, WithMode0AccelerationCounts) {
  rig.perform(image::kSetJointVel, {100});
  limit_joint1(10, kStatus, kAbsolute);
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.run(60ms);  // in the ramp
  EXPECT_TRUE(excessive());
  rig.run(200ms);  // at full speed
  EXPECT_FALSE(excessive());
}

TEST_F(Torque, WithMode1AccelerationPhasesAreLeftOut) {
  rig.perform(image::kSetJointVel, {100});
  limit_joint1(10, kStatus, kSkipAcceleration);
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  while (!rig.motion().eob) {
    rig.step();
    ASSERT_FALSE(excessive()) << rig.joint(1);
  }
  rig.send(image::kMoveJoints, {0, 0, 0, 0, 0, 0});
  rig.robot.push(1, 50);
  rig.run(60ms);
  EXPECT_FALSE(excessive());  // still in the ramp
  rig.run(200ms);
  EXPECT_TRUE(excessive());
}

TEST_F(Torque, WithMode2OnlyTheDeviationFromTheCalculatedTorqueCounts) {
  rig.perform(image::kMoveJoints, {0, 80, -60, 0, 0, 0});
  ASSERT_GT(std::abs(values(43)[1]), 15);
  rig.perform(image::kSetTorqueLimits, {5, 5, 5, 5, 5, 5});
  rig.perform(image::kSetTorqueLimitsCfg, {kStatus, kDeviation});
  EXPECT_FALSE(excessive());
  rig.robot.push(2, -6);
  rig.step();
  EXPECT_TRUE(excessive());
  rig.robot.push(2, 0);
  rig.perform(image::kSetTorqueLimitsCfg, {kStatus, kAbsolute});
  EXPECT_TRUE(excessive());
}

TEST(OrdinaryRobot, NeverTripsOverItsOwnDefaultLimits) {
  RobotOptions o = Rig::quick();
  o.noise = true;
  Rig rig(o);
  rig.make_ready();
  rig.perform(image::kSetTorqueLimitsCfg, {kError, kAbsolute});  // limits stay at 100 %
  rig.perform(image::kSetPayload, {0.5, 0, 0, 20});
  rig.perform(image::kSetJointVel, {150});
  rig.perform(image::kSetJointAcc, {150});
  std::mt19937 random(11);
  for (int n = 0; n < 60; ++n) {
    std::vector<double> q;
    for (std::size_t i = 0; i < 6; ++i) {
      const double reach = i == 5 ? 360 : kModelLimits.maximum[i];
      q.push_back(std::uniform_real_distribution<double>(i == 5 ? -360 : kModelLimits.minimum[i], reach)(random));
    }
    rig.perform(image::kMoveJoints, q);
    ASSERT_EQ(rig.error(), 0) << "move " << n;
  }
}

}  // namespace
}  // namespace meca::sim
