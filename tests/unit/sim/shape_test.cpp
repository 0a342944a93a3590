// The arm as capsules, and when they meet. The radii are inferred (sim/shape.cpp); what must hold is that an arm in
// ordinary use does not meet itself.
#include "sim/shape.hpp"

#include <gtest/gtest.h>

#include "sim/zones.hpp"

namespace meca::sim {
namespace {

using Group = Part::Group;

TEST(Gap, IsTheDistanceOfTheSurfaces) {
  const Capsule x{{-10, 0, 0}, {10, 0, 0}, 1}, above{{0, -10, 5}, {0, 10, 5}, 2}, beside{{-5, 7, 0}, {30, 7, 0}, 1};
  EXPECT_NEAR(gap(x, above), 2, 1e-12);   // crossing
  EXPECT_NEAR(gap(x, beside), 5, 1e-12);  // parallel
  const Capsule ball{{13, 4, 0}, {13, 4, 0}, 1};
  EXPECT_NEAR(gap(x, ball), 3, 1e-12);  // beyond the end: 3, 4, 5
  EXPECT_NEAR(gap(ball, x), 3, 1e-12);
  EXPECT_NEAR(gap(ball, ball), -2, 1e-12);
  const Capsule ahead{{14, 3, 0}, {14, 30, 0}, 1};
  EXPECT_NEAR(gap(x, ahead), 3, 1e-12);  // end to end
}

TEST(ArmShape, IsOneChainFromTheBaseToTheFlange) {
  const ArmShape arm = arm_shape({20, 30, -40, 50, 60, 70}, {{0, 0, 25}, 10});
  for (const std::size_t i : {2u, 3u, 4u}) EXPECT_NEAR(norm(arm.links[i].b - arm.links[i + 1].a), 0, 1e-9);
  EXPECT_NEAR(norm(arm.links[6].b - arm.flange), arm.links[6].radius, 1e-9);
  EXPECT_NEAR(norm(arm.tool.a - arm.flange), 25, 1e-9);
  EXPECT_EQ(arm_shape({}, {}).tool.radius, 0);
}

TEST(Collision, IsNoneInThePosesOfOrdinaryUse) {
  for (const Joints& q :
       {Joints{}, Joints{0, 0, 0, 0, 90, 0}, Joints{0, 0, 0, 0, -90, 0}, Joints{0, 10, 10, 0, 40, 0},
        Joints{30, 20, -10, 15, 40, 0}, Joints{170, 20, 20, 0, 40, 0}, Joints{60, 30, -40, 90, 50, -200},
        Joints{100, 50, 60, -160, 100, 400}, Joints{0, 90, 0, 0, 10, 0}, Joints{0, -60, -60, 0, 10, 0},
        Joints{0, 60, -60, 0, 0, 0}, Joints{0, -20, 20, 0, 90, 0}, Joints{0, -60, 60, 0, 0, 0},
        Joints{90, 40, 30, 0, 20, 0}, Joints{0, -70, -135, 0, 0, 0}, Joints{0, 0, 70, 0, 0, 0}}) {
    const Breach b = collision(arm_shape(q, {}), std::nullopt);
    EXPECT_LT(b.depth, -3) << testing::PrintToString(q) << " link " << b.first.id << " with " << b.second.id;
  }
}

TEST(Collision, IsTheForearmInTheBaseWhenTheArmFoldsDownOntoIt) {
  const Breach b = collision(arm_shape({0, 90, 70, 0, 0, 0}, {}), std::nullopt);
  EXPECT_GT(b.depth, 0);
  EXPECT_EQ(b.first, (Part{Group::kRobot, 0}));
}

}  // namespace
}  // namespace meca::sim
