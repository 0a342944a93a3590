// Geometry of the Meca500: forward kinematics, poses as Mecademic writes them, posture, Jacobian. Pure functions,
// double. Lengths in mm, angles in degrees at every interface. Sources: manual 9.2 (figure of the arm), the vendor's
// URDF.
#pragma once

#include <array>
#include <cstdint>

#include "transports/image/image.hpp"

namespace meca::sim {

using Joints = std::array<double, 6>;  // degrees, or degrees per second
using Vec3 = std::array<double, 3>;
using Twist = std::array<double, 6>;  // vx, vy, vz (mm/s), wx, wy, wz (deg/s)

struct Mat3 {
  std::array<std::array<double, 3>, 3> m{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

struct Transform {
  Mat3 r;
  Vec3 p{};
};

Vec3 operator+(const Vec3& a, const Vec3& b) noexcept;
Vec3 operator-(const Vec3& a, const Vec3& b) noexcept;
Vec3 operator*(double k, const Vec3& v) noexcept;
Vec3 cross(const Vec3& a, const Vec3& b) noexcept;
double norm(const Vec3& v) noexcept;
Mat3 operator*(const Mat3& a, const Mat3& b) noexcept;
Vec3 operator*(const Mat3& a, const Vec3& v) noexcept;
Mat3 transpose(const Mat3& a) noexcept;
Vec3 column(const Mat3& a, std::size_t i) noexcept;
Transform operator*(const Transform& a, const Transform& b) noexcept;
Transform inverse(const Transform& a) noexcept;

// Rotation by `degrees` around the unit vector `axis`.
Mat3 rotation(const Vec3& axis, double degrees) noexcept;
// The axis (unit) and the angle in degrees (0..180) of a rotation.
struct AxisAngle {
  Vec3 axis{0, 0, 1};
  double degrees = 0;
};
AxisAngle axis_angle(const Mat3& r) noexcept;

// Six numbers x, y, z (mm), alpha, beta, gamma (degrees): R = Rx(alpha) Ry(beta) Rz(gamma), mobile XYZ Euler angles.
using PoseNumbers = std::array<double, 6>;
Transform to_transform(const PoseNumbers& pose) noexcept;
// At beta = +-90 only alpha +- gamma is defined; alpha is then 0 (a real robot shows any pair).
PoseNumbers to_pose(const Transform& t) noexcept;
image::Pose to_image(const PoseNumbers& pose) noexcept;

// The flange in the base frame. At zero: 190, 0, 308, 0, 90, 0.
Transform forward(const Joints& q) noexcept;

// Velocity of `tool` (a point and frame fixed to the flange) in base axes for joint velocities in deg/s: columns are
// mm/s and deg/s per deg/s.
using Jacobian = std::array<std::array<double, 6>, 6>;  // [row][joint]
Jacobian jacobian(const Joints& q, const Vec3& tool_point_in_flange) noexcept;
Twist multiply(const Jacobian& j, const Joints& velocity) noexcept;
// Joint velocities for a twist. False when the arm is so close to a singularity that the twist cannot be made.
bool solve(const Jacobian& j, const Twist& twist, Joints& velocity) noexcept;

// Posture: -1, 1, or 0 close to the singularity; turn of joint 6 (manual 2.2.1). How close is not published; inferred:
// 0.05 mm of the wrist centre from axis 1, 0.05 degrees for elbow and wrist.
struct Posture {
  int shoulder = 1, elbow = 1, wrist = 1;
  friend bool operator==(const Posture&, const Posture&) = default;
};
Posture posture(const Joints& q) noexcept;
int turn(double q6) noexcept;  // q6 = q6' + 360 turn with -180 < q6' <= 180

// The arm's lengths.
inline constexpr double kBaseHeight = 135, kUpperArm = 135, kElbowOffset = 38, kForearm = 120, kWristToFlange = 70;

}  // namespace meca::sim
