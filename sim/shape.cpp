#include "sim/shape.hpp"

#include <algorithm>

namespace meca::sim {
namespace {

double dot(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Closest distance of two lines of finite length (Ericson, Real-Time Collision Detection, 5.1.9).
double distance(const Capsule& one, const Capsule& other) noexcept {
  constexpr double kPoint = 1e-12;  // mm^2: shorter is a point
  const Vec3 d1 = one.b - one.a, d2 = other.b - other.a, r = one.a - other.a;
  const double a = dot(d1, d1), e = dot(d2, d2), f = dot(d2, r), c = dot(d1, r), b = dot(d1, d2);
  const auto part = [](double value) { return std::clamp(value, 0.0, 1.0); };
  double s = 0, t = 0;  // where on each
  if (a <= kPoint) {
    t = e <= kPoint ? 0 : part(f / e);
  } else if (e <= kPoint) {
    s = part(-c / a);
  } else {
    const double skew = a * e - b * b;
    s = skew > kPoint ? part((b * f - c * e) / skew) : 0;
    t = (b * s + f) / e;
    if (t < 0 || t > 1) {
      t = part(t);
      s = part((b * t - c) / a);
    }
  }
  return norm(r + s * d1 - t * d2);
}

}  // namespace

double gap(const Capsule& one, const Capsule& other) noexcept {
  return distance(one, other) - one.radius - other.radius;
}

ArmShape arm_shape(const Joints& q, const ToolSphere& tool) noexcept {
  const Skeleton s = skeleton(q);
  const auto out_of_wrist = [&s](double mm) { return s.wrist + mm * s.pointing; };
  ArmShape out;
  out.links = {Capsule{{0, 0, 40}, {0, 0, 60}, 40},
               {{0, 0, 100}, s.shoulder, 38},
               {s.shoulder, s.elbow, 30},
               {s.elbow, s.bend, 30},
               {s.bend, s.wrist, 24},
               {s.wrist, out_of_wrist(30), 22},
               {out_of_wrist(45), out_of_wrist(58), 12}};
  out.flange = s.flange.p;
  if (tool.radius > 0) {
    const Vec3 centre = s.flange.r * tool.centre + s.flange.p;
    out.tool = {centre, centre, tool.radius};
  }
  return out;
}

}  // namespace meca::sim
