#include "sim/skeleton.hpp"

namespace meca::sim {

Skeleton skeleton(const Joints& q) noexcept {
  const Vec3 up{0, 0, 1};
  const Mat3 r1 = rotation(up, q[0]);
  const Vec3 lateral = column(r1, 1);  // axes 2 and 3 are parallel
  const Mat3 r2 = r1 * rotation({0, 1, 0}, q[1]);
  const Mat3 r3 = r1 * rotation({0, 1, 0}, q[1] + q[2]);
  Skeleton s;
  s.flange = forward(q);
  s.pointing = column(s.flange.r, 2);
  s.shoulder = {0, 0, kBaseHeight};
  s.elbow = s.shoulder + kUpperArm * column(r2, 2);
  s.bend = s.elbow + kElbowOffset * column(r3, 2);
  s.wrist = s.flange.p - kWristToFlange * s.pointing;
  const Vec3 axis5 = r3 * (rotation({1, 0, 0}, q[3]) * Vec3{0, 1, 0});
  s.axis = {up, lateral, lateral, column(r3, 0), axis5, s.pointing};
  return s;
}

}  // namespace meca::sim
