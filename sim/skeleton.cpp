#include "sim/skeleton.hpp"

#include <cmath>
#include <numbers>

namespace meca::sim {

Skeleton skeleton(const Joints& q) noexcept {
  constexpr double kDegree = std::numbers::pi / 180;
  const double s1 = std::sin(q[0] * kDegree), c1 = std::cos(q[0] * kDegree);
  const double s4 = std::sin(q[3] * kDegree), c4 = std::cos(q[3] * kDegree);
  // In the plane that joint 1 turns: a direction `degrees` from upright.
  const auto leaning = [&](double degrees) -> Vec3 {
    const double s = std::sin(degrees * kDegree), c = std::cos(degrees * kDegree);
    return {s * c1, s * s1, c};
  };
  const Vec3 lateral{-s1, c1, 0};  // axes 2 and 3 are parallel
  const Vec3 lower = leaning(q[1] + q[2]), along = cross(lateral, lower);
  Skeleton s;
  s.flange = forward(q);
  s.pointing = column(s.flange.r, 2);
  s.shoulder = {0, 0, kBaseHeight};
  s.elbow = s.shoulder + kUpperArm * leaning(q[1]);
  s.bend = s.elbow + kElbowOffset * lower;
  s.wrist = s.bend + kForearm * along;
  s.axis = {Vec3{0, 0, 1}, lateral, lateral, along, c4 * lateral + s4 * lower, s.pointing};
  return s;
}

}  // namespace meca::sim
