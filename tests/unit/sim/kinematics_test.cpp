#include "sim/kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/inverse.hpp"

namespace meca::sim {
namespace {

double largest_difference(const Transform& a, const Transform& b) {
  double out = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    out = std::max(out, std::abs(a.p[i] - b.p[i]));
    for (std::size_t j = 0; j < 3; ++j) out = std::max(out, std::abs(a.r.m[i][j] - b.r.m[i][j]));
  }
  return out;
}

struct Golden {
  Joints joints;
  PoseNumbers pose;
};

// Spec 6.1, computed there with an independent DH chain; the last row is what a real robot put on an EtherCAT wire
// (public LinuxCNC capture, firmware 9), beta and gamma completed by the same chain.
const Golden kGolden[] = {
    {{30, 25, 20, 15, 10, 5}, {179.6164, 107.3343, 142.3210, -158.0887, 28.5473, 163.3228}},
    {{-30, -25, -20, -15, -10, -5}, {37.4027, -17.9617, 426.1222, 17.0512, 31.5221, -53.8070}},
    {{-0.7311, -1.2126, 0.0815, -1.1524, -1.2052, -1.0505}, {186.2966, -2.3478, 313.184, 16.826, 87.559, -19.044}},
};

TEST(Kinematics, TheArmIsWhereThePublishedTableSaysItIs) {
  for (const Golden& g : kGolden) {
    const PoseNumbers pose = to_pose(forward(g.joints));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(pose[i], g.pose[i], 5e-4) << i;
    // Near beta = 90 the angles amplify the rounding of the joints, so the last row is compared less finely.
    const double tolerance = std::abs(g.pose[4]) > 80 ? 5e-3 : 1e-4;
    for (std::size_t i = 3; i < 6; ++i) EXPECT_NEAR(pose[i], g.pose[i], tolerance) << i;
  }
}

TEST(Kinematics, TheZeroPoseIs190_0_308_0_90_0) {
  const PoseNumbers expected{190, 0, 308, 0, 90, 0};
  const PoseNumbers pose = to_pose(forward({}));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(pose[i], expected[i], 1e-9) << i;
}

TEST(Kinematics, EulerAnglesAndMatricesAreTheSameOrientationAlsoAtBeta90) {
  for (const PoseNumbers& p : {PoseNumbers{1, 2, 3, 10, 20, 30}, PoseNumbers{0, 0, 0, -170, -80, 175},
                               PoseNumbers{0, 0, 0, 12, 90, 34}, PoseNumbers{0, 0, 0, 12, -90, 34}}) {
    EXPECT_LT(largest_difference(to_transform(p), to_transform(to_pose(to_transform(p)))), 1e-9);
  }
}

TEST(Kinematics, MobileXyzMeansRxThenRyThenRz) {
  // R = Rx(90) Ry(0) Rz(90): the tool's x axis points along the world's z axis.
  const Vec3 x = to_transform({0, 0, 0, 90, 0, 90}).r * Vec3{1, 0, 0};
  EXPECT_NEAR(x[0], 0, 1e-12);
  EXPECT_NEAR(x[1], 0, 1e-12);
  EXPECT_NEAR(x[2], 1, 1e-12);
}

class RandomArm : public testing::Test {
 protected:
  Joints joints() {
    Joints q;
    for (std::size_t i = 0; i < 6; ++i) {
      const double end = i == 5 ? 179.9 : kModelLimits.maximum[i], begin = i == 5 ? -179.9 : kModelLimits.minimum[i];
      q[i] = std::uniform_real_distribution<double>(begin, end)(random);
    }
    return q;
  }
  std::mt19937_64 random{20240511};
};

TEST_F(RandomArm, InverseKinematicsInTheSamePostureGivesTheJointsBack) {
  int checked = 0;
  for (int n = 0; n < 5000; ++n) {
    const Joints q = joints();
    const Posture p = posture(q);
    if (p.shoulder == 0 || p.elbow == 0 || p.wrist == 0) continue;
    Joints back;
    ASSERT_TRUE(inverse(forward(q), p, q, back));
    for (std::size_t i = 0; i < 6; ++i) ASSERT_NEAR(back[i], q[i], 1e-6) << "joint " << i + 1 << ", set " << n;
    ++checked;
  }
  EXPECT_GT(checked, 4900);
}

TEST_F(RandomArm, EverySolutionReachesThePoseInThePostureItClaims) {
  int eight = 0;
  for (int n = 0; n < 2000; ++n) {
    const Joints q = joints();
    const Transform pose = forward(q);
    const Solutions s = inverse_all(pose, q);
    ASSERT_GE(s.count, 1u);
    if (s.count == 8) ++eight;
    for (std::size_t i = 0; i < s.count; ++i) {
      ASSERT_LT(largest_difference(forward(s.all[i].joints), pose), 1e-7);
      const Posture is = posture(s.all[i].joints);
      ASSERT_TRUE(is.shoulder == 0 || is.shoulder == s.all[i].posture.shoulder) << n;
      ASSERT_TRUE(is.elbow == 0 || is.elbow == s.all[i].posture.elbow) << n;
      ASSERT_TRUE(is.wrist == 0 || is.wrist == s.all[i].posture.wrist) << n;
    }
  }
  EXPECT_EQ(eight, 2000);  // without limits, a pose in reach has all eight
}

TEST_F(RandomArm, TheJacobianIsTheDerivativeOfForwardKinematics) {
  const Vec3 tool{10, -20, 30};
  for (int n = 0; n < 200; ++n) {
    const Joints q = joints();
    const Jacobian j = jacobian(q, tool);
    for (std::size_t i = 0; i < 6; ++i) {
      constexpr double h = 1e-4;
      Joints forth = q, back = q;
      forth[i] += h;
      back[i] -= h;
      const Transform a = forward(back), b = forward(forth);
      const Vec3 v = (1 / (2 * h)) * ((b.r * tool + b.p) - (a.r * tool + a.p));
      const AxisAngle turn = axis_angle(b.r * transpose(a.r));
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_NEAR(j[k][i], v[k], 1e-5);
        ASSERT_NEAR(j[k + 3][i], turn.axis[k] * turn.degrees / (2 * h), 1e-5);
      }
    }
  }
}

TEST_F(RandomArm, SolvingForATwistGivesItBack) {
  int solved = 0;
  for (int n = 0; n < 500; ++n) {
    const Joints q = joints();
    const Posture p = posture(q);
    if (p.shoulder == 0 || p.elbow == 0 || std::abs(q[4]) < 5) continue;
    const Jacobian j = jacobian(q, {});
    const Twist wanted{10, -5, 3, 1, 2, -4};
    Joints v{};
    if (!solve(j, wanted, v)) continue;  // too close to the elbow or shoulder singularity
    const Twist made = multiply(j, v);
    for (std::size_t i = 0; i < 6; ++i) ASSERT_NEAR(made[i], wanted[i], 0.2);
    ++solved;
  }
  EXPECT_GT(solved, 400);
}

TEST(Posture, IsZeroAtTheWristSingularityAndOneAtTheZeroPose) {
  EXPECT_EQ(posture({}), (Posture{1, 1, 0}));
  EXPECT_EQ(posture({0, 0, 0, 0, 10, 0}), (Posture{1, 1, 1}));
  EXPECT_EQ(posture({0, 0, 0, 0, -10, 0}), (Posture{1, 1, -1}));
}

TEST(Posture, TheElbowTurnsOverAtMinus72Point43) {
  // Spec 6.4: the arm is straight at q3 = -atan(120 / 38).
  EXPECT_EQ(posture({0, 0, -72.0, 0, 10, 0}).elbow, 1);
  EXPECT_EQ(posture({0, 0, -72.43, 0, 10, 0}).elbow, 0);
  EXPECT_EQ(posture({0, 0, -73.0, 0, 10, 0}).elbow, -1);
}

TEST(Posture, TheShoulderTurnsOverWhenTheWristPassesAxis1) {
  EXPECT_EQ(posture({0, 90, 0, 0, 10, 0}).shoulder, 1);
  EXPECT_EQ(posture({0, -60, -60, 0, 10, 0}).shoulder, -1);
}

TEST(Posture, TurnsOfJoint6CountFromMinus180To180) {
  // Manual 9.2, 2.2.1: q6 = q6' + 360 ct with -180 < q6' <= 180.
  EXPECT_EQ(turn(0), 0);
  EXPECT_EQ(turn(180), 0);
  EXPECT_EQ(turn(180.1), 1);
  EXPECT_EQ(turn(-180), -1);
  EXPECT_EQ(turn(-179.9), 0);
  EXPECT_EQ(turn(36000), 100);
  EXPECT_EQ(turn(-36000), -100);
}

TEST(Inverse, SaysWhenThePoseIsOutOfReach) {
  Joints q;
  EXPECT_FALSE(inverse(to_transform({500, 0, 308, 0, 90, 0}), {1, 1, 1}, {}, q));
  EXPECT_EQ(inverse_all(to_transform({500, 0, 308, 0, 90, 0}), {}).count, 0u);
}

TEST(Inverse, AtTheWristSingularityKeepsJoint4WhereItWas) {
  const Joints near{0, 0, 0, 33, 0, 0};
  Joints q;
  ASSERT_TRUE(inverse(forward({}), {1, 1, 1}, near, q));
  EXPECT_NEAR(q[3], 33, 1e-9);
  EXPECT_NEAR(q[3] + q[5], 0, 1e-7);
}

TEST(Inverse, TheNearestTurnStaysInsideTheLimits) {
  EXPECT_DOUBLE_EQ(with_nearest_turn(10, 350, -36000, 36000), 370);
  EXPECT_DOUBLE_EQ(with_nearest_turn(10, 350, -200, 200), 10);
  EXPECT_DOUBLE_EQ(with_turn(10, -2), -710);
}

}  // namespace
}  // namespace meca::sim
