// The arm's body as capsules, and how far they are apart. The vendor does not publish what its robot takes itself for:
// the radii are inferred, from drawings, and rather slim, so that what the arm can do in earnest is no collision here.
#pragma once

#include <array>

#include "sim/skeleton.hpp"

namespace meca::sim {

// All points within `radius` of the line from `a` to `b`; a sphere where they are the same. mm, base frame.
struct Capsule {
  Vec3 a{}, b{};
  double radius = 0;
};

// Distance between the surfaces, mm; negative where they overlap.
double gap(const Capsule& one, const Capsule& other) noexcept;

// SetToolSphere: fixed to the flange. Radius 0: there is none.
struct ToolSphere {
  Vec3 centre{};  // mm, FRF
  double radius = 0;
};

struct ArmShape {
  std::array<Capsule, 7> links;  // the base, then links 1..6, numbered as dynamic data 37 and 38 do
  Capsule tool;                  // radius 0: none
  Vec3 flange{};                 // the flange centre point
};

ArmShape arm_shape(const Joints& q, const ToolSphere& tool) noexcept;

}  // namespace meca::sim
