// Where the arm's axes and corners are for a joint set: what shapes and torques are built on. Base frame, mm.
#pragma once

#include "sim/kinematics.hpp"

namespace meca::sim {

struct Skeleton {
  Vec3 shoulder;  // on axis 1 at the height of axis 2
  Vec3 elbow;     // on axis 3
  Vec3 bend;      // where the forearm's axis (axis 4) begins
  Vec3 wrist;     // axes 4, 5 and 6 meet
  Vec3 pointing;  // unit: from the wrist out of the flange
  Transform flange;
  std::array<Vec3, 6> axis;  // unit, in the positive sense of each joint
};

Skeleton skeleton(const Joints& q) noexcept;

}  // namespace meca::sim
