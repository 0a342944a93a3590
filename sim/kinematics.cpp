#include "sim/kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meca::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct SinCos {
  double s, c;
  explicit SinCos(double degrees) noexcept : s(std::sin(degrees * kDegree)), c(std::cos(degrees * kDegree)) {}
};

Mat3 rx(const SinCos& a) noexcept { return {{{{1, 0, 0}, {0, a.c, -a.s}, {0, a.s, a.c}}}}; }
Mat3 ry(const SinCos& a) noexcept { return {{{{a.c, 0, a.s}, {0, 1, 0}, {-a.s, 0, a.c}}}}; }
Mat3 rz(const SinCos& a) noexcept { return {{{{a.c, -a.s, 0}, {a.s, a.c, 0}, {0, 0, 1}}}}; }

const Mat3 kFlangeTurn = {{{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}}};  // Ry(90): the flange's z points out of the arm

}  // namespace

Vec3 operator+(const Vec3& a, const Vec3& b) noexcept { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec3 operator-(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 operator*(double k, const Vec3& v) noexcept { return {k * v[0], k * v[1], k * v[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double norm(const Vec3& v) noexcept { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

Mat3 operator*(const Mat3& a, const Mat3& b) noexcept {
  Mat3 out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    }
  }
  return out;
}
Vec3 operator*(const Mat3& a, const Vec3& v) noexcept {
  return {a.m[0][0] * v[0] + a.m[0][1] * v[1] + a.m[0][2] * v[2],
          a.m[1][0] * v[0] + a.m[1][1] * v[1] + a.m[1][2] * v[2],
          a.m[2][0] * v[0] + a.m[2][1] * v[1] + a.m[2][2] * v[2]};
}
Mat3 transpose(const Mat3& a) noexcept {
  Mat3 out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out.m[i][j] = a.m[j][i];
  }
  return out;
}
Vec3 column(const Mat3& a, std::size_t i) noexcept { return {a.m[0][i], a.m[1][i], a.m[2][i]}; }
Transform operator*(const Transform& a, const Transform& b) noexcept { return {a.r * b.r, a.r * b.p + a.p}; }
Transform inverse(const Transform& a) noexcept {
  const Mat3 t = transpose(a.r);
  return {t, -1.0 * (t * a.p)};
}

Mat3 rotation(const Vec3& axis, double degrees) noexcept {
  const SinCos a(degrees);
  const double v = 1 - a.c;
  const auto [x, y, z] = axis;
  return {{{{x * x * v + a.c, x * y * v - z * a.s, x * z * v + y * a.s},
            {x * y * v + z * a.s, y * y * v + a.c, y * z * v - x * a.s},
            {x * z * v - y * a.s, y * z * v + x * a.s, z * z * v + a.c}}}};
}

AxisAngle axis_angle(const Mat3& r) noexcept {
  const Vec3 w{r.m[2][1] - r.m[1][2], r.m[0][2] - r.m[2][0], r.m[1][0] - r.m[0][1]};
  const double sine2 = norm(w);  // 2 sin
  const double cosine2 = r.m[0][0] + r.m[1][1] + r.m[2][2] - 1;
  const double degrees = std::atan2(sine2, cosine2) / kDegree;
  if (sine2 > 1e-6) return {(1 / sine2) * w, degrees};
  if (cosine2 > 0) return {{0, 0, 1}, degrees < 1e-9 ? 0 : degrees};
  // Half a turn: the axis is the largest column of R + I.
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (r.m[i][i] > r.m[best][best]) best = i;
  }
  Vec3 axis = column(r, best);
  axis[best] += 1;
  return {(1 / norm(axis)) * axis, degrees};
}

Transform to_transform(const PoseNumbers& pose) noexcept {
  return {rx(SinCos(pose[3])) * ry(SinCos(pose[4])) * rz(SinCos(pose[5])), {pose[0], pose[1], pose[2]}};
}

PoseNumbers to_pose(const Transform& t) noexcept {
  const auto& m = t.r.m;
  const double cos_beta = std::hypot(m[0][0], m[0][1]);
  const double beta = std::atan2(m[0][2], cos_beta);
  double alpha = 0, gamma = 0;
  if (cos_beta > 1e-7) {
    alpha = std::atan2(-m[1][2], m[2][2]);
    gamma = std::atan2(-m[0][1], m[0][0]);
  } else {
    gamma = std::atan2(m[1][0], m[1][1]);
  }
  return {t.p[0], t.p[1], t.p[2], alpha / kDegree, beta / kDegree, gamma / kDegree};
}

image::Pose to_image(const PoseNumbers& pose) noexcept {
  return {static_cast<float>(pose[0]), static_cast<float>(pose[1]), static_cast<float>(pose[2]),
          static_cast<float>(pose[3]), static_cast<float>(pose[4]), static_cast<float>(pose[5])};
}

Transform forward(const Joints& q) noexcept {
  const SinCos q1(q[0]), q2(q[1]), q23(q[1] + q[2]);
  const Mat3 r3 = rz(q1) * ry(q23);
  const double radius = kUpperArm * q2.s + kElbowOffset * q23.s + kForearm * q23.c;  // wrist centre from axis 1
  const double height = kBaseHeight + kUpperArm * q2.c + kElbowOffset * q23.c - kForearm * q23.s;
  const Mat3 r6 = r3 * rx(SinCos(q[3])) * ry(SinCos(q[4])) * rx(SinCos(q[5]));
  const Vec3 wrist{radius * q1.c, radius * q1.s, height};
  return {r6 * kFlangeTurn, wrist + kWristToFlange * column(r6, 0)};
}

Jacobian jacobian(const Joints& q, const Vec3& tool_point_in_flange) noexcept {
  const SinCos q1(q[0]), q2(q[1]), q23(q[1] + q[2]);
  const Mat3 r1 = rz(q1);
  const Mat3 r3 = r1 * ry(q23);
  const Mat3 r4 = r3 * rx(SinCos(q[3]));
  const Mat3 r5 = r4 * ry(SinCos(q[4]));
  const Transform flange = forward(q);
  const Vec3 tool = flange.r * tool_point_in_flange + flange.p;
  const Vec3 shoulder{0, 0, kBaseHeight};
  const Vec3 elbow = shoulder + r1 * Vec3{kUpperArm * q2.s, 0, kUpperArm * q2.c};
  const Vec3 wrist = flange.p - kWristToFlange * column(r5, 0);
  const std::array<Vec3, 6> axis{Vec3{0, 0, 1}, column(r1, 1), column(r1, 1),
                                 column(r3, 0), column(r4, 1), column(r5, 0)};
  const std::array<Vec3, 6> point{shoulder, shoulder, elbow, wrist, wrist, wrist};
  Jacobian out{};
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec3 linear = kDegree * cross(axis[i], tool - point[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      out[k][i] = linear[k];
      out[k + 3][i] = axis[i][k];
    }
  }
  return out;
}

Twist multiply(const Jacobian& j, const Joints& velocity) noexcept {
  Twist out{};
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t i = 0; i < 6; ++i) out[row] += j[row][i] * velocity[i];
  }
  return out;
}

bool solve(const Jacobian& j, const Twist& twist, Joints& velocity) noexcept {
  // Damped least squares, (J'J + l I) v = J' t: exact to 1e-6 away from singularities, and at one it still makes the
  // twists that are possible there. Linear rows are scaled so that 1 deg/s weighs like 2 mm/s.
  constexpr double kDamping = 1e-9;
  std::array<std::array<double, 7>, 6> a{};
  std::array<std::array<double, 6>, 6> scaled{};
  Twist t = twist;
  for (std::size_t row = 0; row < 6; ++row) {
    const double k = row < 3 ? 0.5 : 1.0;
    t[row] *= k;
    for (std::size_t i = 0; i < 6; ++i) scaled[row][i] = k * j[row][i];
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t row = 0; row < 6; ++row) a[i][k] += scaled[row][i] * scaled[row][k];
    }
    a[i][i] += kDamping;
    for (std::size_t row = 0; row < 6; ++row) a[i][6] += scaled[row][i] * t[row];
  }
  for (std::size_t i = 0; i < 6; ++i) {  // symmetric and positive: no pivoting needed
    for (std::size_t row = i + 1; row < 6; ++row) {
      const double f = a[row][i] / a[i][i];
      for (std::size_t k = i; k < 7; ++k) a[row][k] -= f * a[i][k];
    }
  }
  for (std::size_t i = 6; i-- > 0;) {
    double sum = a[i][6];
    for (std::size_t k = i + 1; k < 6; ++k) sum -= a[i][k] * velocity[k];
    velocity[i] = sum / a[i][i];
  }
  double error = 0, wanted = 0;
  for (std::size_t row = 0; row < 6; ++row) {
    double made = 0;
    for (std::size_t i = 0; i < 6; ++i) made += scaled[row][i] * velocity[i];
    error += (made - t[row]) * (made - t[row]);
    wanted += t[row] * t[row];
  }
  return error <= 1e-4 * wanted;
}

Posture posture(const Joints& q) noexcept {
  const auto sign = [](double value, double near) { return value > near ? 1 : value < -near ? -1 : 0; };
  const SinCos q2(q[1]), q23(q[1] + q[2]);
  const double radius = kUpperArm * q2.s + kElbowOffset * q23.s + kForearm * q23.c;
  const double stretched = -std::atan2(kForearm, kElbowOffset) / kDegree;  // q3 of the straight arm, -72.43
  return {sign(radius, 0.05), sign(std::remainder(q[2] - stretched, 360.0), 0.05), sign(q[4], 0.05)};
}

int turn(double q6) noexcept { return static_cast<int>(std::clamp(std::ceil((q6 - 180) / 360), -100.0, 100.0)); }

}  // namespace meca::sim
