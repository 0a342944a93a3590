#include "sim/inverse.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meca::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const double kLowerArm = std::hypot(kElbowOffset, kForearm);
const double kLowerArmAngle = std::atan2(kForearm, kElbowOffset);  // of the lower arm from its z axis at q3 = 0

double wrapped(double degrees) noexcept {
  const double r = std::remainder(degrees, 360.0);
  return r <= -180 ? r + 360 : r;
}

// Joints 4..6 from the rotation behind joint 3: R = Rx(q4) Ry(q5) Rx(q6).
void solve_wrist(const Mat3& r, int wrist, const Joints& near, Joints& out) noexcept {
  const auto& m = r.m;
  const double sine = std::hypot(m[1][0], m[2][0]);
  out[4] = wrist * std::atan2(sine, m[0][0]) / kDegree;
  if (sine < 1e-9) {  // singular: only q4 + q6 is determined
    out[3] = near[3];
    out[5] = wrapped(std::atan2(m[2][1], m[1][1]) / kDegree - near[3]);
    return;
  }
  out[3] = wrapped(std::atan2(wrist * m[1][0], -wrist * m[2][0]) / kDegree);
  out[5] = wrapped(std::atan2(wrist * m[0][1], wrist * m[0][2]) / kDegree);
}

}  // namespace

bool JointLimits::contains(const Joints& q) const noexcept {
  constexpr double kRounding = 1e-6;  // arguments arrive as binary32 and inverse kinematics rounds
  for (std::size_t i = 0; i < 6; ++i) {
    if (!(q[i] >= minimum[i] - kRounding && q[i] <= maximum[i] + kRounding)) return false;
  }
  return true;
}

bool inverse(const Transform& flange, const Posture& posture, const Joints& near, Joints& out) noexcept {
  const Vec3 wrist = flange.p - kWristToFlange * column(flange.r, 2);
  const double distance = std::hypot(wrist[0], wrist[1]);
  const double height = wrist[2] - kBaseHeight;
  const double cosine = (distance * distance + height * height - kUpperArm * kUpperArm - kLowerArm * kLowerArm) /
                        (2 * kUpperArm * kLowerArm);
  if (!(std::abs(cosine) <= 1 + 1e-12)) return false;

  const double radius = posture.shoulder * distance;
  if (distance < 1e-9) {
    out[0] = near[0];
  } else {
    out[0] = wrapped(std::atan2(posture.shoulder * wrist[1], posture.shoulder * wrist[0]) / kDegree);
  }
  const double elbow = posture.elbow * std::acos(std::clamp(cosine, -1.0, 1.0));
  const double q2 =
      std::atan2(radius, height) - std::atan2(kLowerArm * std::sin(elbow), kUpperArm + kLowerArm * std::cos(elbow));
  out[1] = wrapped(q2 / kDegree);
  out[2] = wrapped((elbow - kLowerArmAngle) / kDegree);

  const double s1 = std::sin(out[0] * kDegree), c1 = std::cos(out[0] * kDegree);
  const double s = std::sin((out[1] + out[2]) * kDegree), c = std::cos((out[1] + out[2]) * kDegree);
  const Mat3 r3{{{{c1 * c, -s1, c1 * s}, {s1 * c, c1, s1 * s}, {-s, 0, c}}}};  // Rz(q1) Ry(q2 + q3)
  const Mat3& f = flange.r;  // R6 Ry(90): its columns are -z, y, x of R6
  const Mat3 r6{
      {{{f.m[0][2], f.m[0][1], -f.m[0][0]}, {f.m[1][2], f.m[1][1], -f.m[1][0]}, {f.m[2][2], f.m[2][1], -f.m[2][0]}}}};
  solve_wrist(transpose(r3) * r6, posture.wrist, near, out);
  return true;
}

Solutions inverse_all(const Transform& flange, const Joints& near) noexcept {
  Solutions out;
  for (const int shoulder : {1, -1}) {
    for (const int elbow : {1, -1}) {
      for (const int wrist : {1, -1}) {
        Solution& s = out.all[out.count];
        s.posture = {shoulder, elbow, wrist};
        if (inverse(flange, s.posture, near, s.joints)) ++out.count;
      }
    }
  }
  return out;
}

double with_turn(double q6, int turn) noexcept { return wrapped(q6) + 360.0 * turn; }

double with_nearest_turn(double q6, double near, double minimum, double maximum) noexcept {
  double out = near + wrapped(q6 - near);
  while (out > maximum && out - 360 >= minimum) out -= 360;
  while (out < minimum && out + 360 <= maximum) out += 360;
  return out;
}

}  // namespace meca::sim
