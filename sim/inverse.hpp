// Inverse kinematics of the Meca500: a flange pose to the joint sets that reach it, by posture, in closed form.
#pragma once

#include <array>
#include <cstddef>

#include "sim/kinematics.hpp"

namespace meca::sim {

struct JointLimits {
  Joints minimum, maximum;  // degrees
  bool contains(const Joints& q) const noexcept;
};
// Spec 6.2: manual 9.2 and the vendor's URDF; joint 6 turns 100 times each way.
inline constexpr JointLimits kModelLimits{{-175, -70, -135, -170, -115, -36000}, {175, 90, 70, 170, 115, 36000}};
// Meca500 R3, manual 9.2 page 18, deg/s; SetJointVel is in percent of these on the R4 too.
inline constexpr Joints kTopSpeed{150, 150, 180, 300, 300, 500};

// The joint set of one posture (shoulder, elbow, wrist each -1 or 1), whatever the limits; -180 < q <= 180. At the
// wrist or shoulder singularity what is not determined is taken from `near`. False: out of reach.
bool inverse(const Transform& flange, const Posture& posture, const Joints& near, Joints& out) noexcept;

struct Solution {
  Joints joints;
  Posture posture;  // as asked for, so never 0
};
struct Solutions {
  std::array<Solution, 8> all;
  std::size_t count = 0;
};
// All postures that reach the pose (up to 8), whatever the limits.
Solutions inverse_all(const Transform& flange, const Joints& near) noexcept;

// q6 plus whole turns: the one of `turn`, or the one nearest to `near` that is within [minimum, maximum].
double with_turn(double q6, int turn) noexcept;
double with_nearest_turn(double q6, double near, double minimum, double maximum) noexcept;

}  // namespace meca::sim
