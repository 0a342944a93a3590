#include "sim/dynamic_values.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sim/noise.hpp"

#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

using Values = std::array<float, 6>;

Values floats(const std::array<double, 6>& v) noexcept {
  Values out;
  for (std::size_t i = 0; i < 6; ++i) out[i] = static_cast<float>(v[i]);
  return out;
}

float f(double v) noexcept { return static_cast<float>(v); }

double noise(const DynamicSource& s, std::uint64_t channel) noexcept { return sim::noise(s.options, s.cycle, channel); }

// A real robot at rest moves by about 0.001 degrees (published 1 kHz log).
Joints actual_joints(const DynamicSource& s) noexcept {
  Joints out = s.joints;
  for (std::size_t i = 0; i < 6; ++i) out[i] += 0.001 * noise(s, i);
  return out;
}

Joints actual_velocity(const DynamicSource& s) noexcept {
  Joints out = s.joint_velocity;
  for (std::size_t i = 0; i < 6; ++i) out[i] += 0.05 * noise(s, 8 + i);  // inferred size
  return out;
}

Twist cartesian_velocity(const DynamicSource& s, const Joints& velocity) noexcept {
  const Twist base = multiply(jacobian(s.joints, s.settings.trf_transform.p), velocity);
  const Mat3 to_wrf = transpose(s.settings.wrf_transform.r);
  const Vec3 v = to_wrf * Vec3{base[0], base[1], base[2]}, w = to_wrf * Vec3{base[3], base[4], base[5]};
  return {v[0], v[1], v[2], w[0], w[1], w[2]};
}

Values actual_pose(const DynamicSource& s) noexcept {
  return floats(to_pose(inverse(s.settings.wrf_transform) * forward(actual_joints(s)) * s.settings.trf_transform));
}

Values actual_configuration(const DynamicSource& s) noexcept {
  const Joints q = actual_joints(s);
  const Posture p = posture(q);
  return {f(p.shoulder), f(p.elbow), f(p.wrist), f(turn(q[5]))};
}

// Gravity as link 5 feels it, in 1/16000 g; upright and at rest 0, 0, -16000.
Values accelerometer(const DynamicSource& s) noexcept {
  const Joints& q = s.joints;
  const Mat3 link5 = rotation({0, 0, 1}, q[0]) * rotation({0, 1, 0}, q[1] + q[2]) * rotation({1, 0, 0}, q[3]) *
                     rotation({0, 1, 0}, q[4]);
  const Vec3 g = transpose(link5) * Vec3{0, 0, -16000};
  return {f(g[0] + 20 * noise(s, 16)), f(g[1] + 20 * noise(s, 17)), f(g[2] + 20 * noise(s, 18))};
}

Values limits(const JointLimits& l, std::size_t first) noexcept {
  return {f(l.minimum[first]), f(l.minimum[first + 1]), f(l.minimum[first + 2]),
          f(l.maximum[first]), f(l.maximum[first + 1]), f(l.maximum[first + 2])};
}

// Firmware 9 gives minimum and maximum of each joint in turn for types 14 and 15.
Values effective_limits(const DynamicSource& s, std::size_t first) noexcept {
  const Values v = limits(s.configuration.joint_limits.effective(), first);
  if (s.options.layout != image::Layout::kFirmware9) return v;
  return {v[0], v[3], v[1], v[4], v[2], v[5]};
}

Values firmware(const RobotOptions& o) noexcept {
  const int major = o.layout == image::Layout::kFirmware9 ? 9 : o.layout == image::Layout::kFirmware10 ? 10 : 11;
  return {f(major), f(o.firmware_minor), f(o.firmware_patch), f(o.firmware_build)};
}

Values wanted_configuration(const Settings& s) noexcept {
  constexpr float kAutomatic = std::numeric_limits<float>::quiet_NaN();
  const float turn = s.auto_conf_turn ? kAutomatic : f(s.conf_turn);
  if (s.auto_conf) return {kAutomatic, kAutomatic, kAutomatic, turn};
  return {f(s.conf.shoulder), f(s.conf.elbow), f(s.conf.wrist), turn};
}

Values speeds(const DynamicSource& source) noexcept {
  const Settings& s = source.settings;
  Values v = floats({s.joint_velocity, s.joint_acceleration, s.linear_velocity, s.angular_velocity,
                     s.cartesian_acceleration, s.joint_velocity_limit});
  if (source.options.layout == image::Layout::kFirmware9) v[5] = 0;  // five values in manual 9.2
  return v;
}

Values work_zone_limits(const WorkZone& z) noexcept {
  return {f(z.minimum[0]), f(z.minimum[1]), f(z.minimum[2]), f(z.maximum[0]), f(z.maximum[1]), f(z.maximum[2])};
}

float number(Part::Group group) noexcept { return f(static_cast<int>(group)); }

Values collision_status(const Watch& watch) noexcept {
  if (!watch.event()) return {};
  const Breach& b = watch.breach();
  return {1, number(b.first.group), f(b.first.id), number(b.second.group), f(b.second.id)};
}

Values work_zone_status(const Watch& watch) noexcept {
  if (!watch.event()) return {};
  return {1, number(watch.breach().first.group), f(watch.breach().first.id)};
}

// Work zone, tool sphere, calibration and collisions, types 17..19, 30 and 36..38.
Values surroundings(std::uint32_t type, const DynamicSource& source) noexcept {
  const Configuration& c = source.configuration;
  switch (type) {
    case 17:
      return {f(c.work_zone.severity), f(static_cast<int>(c.work_zone.mode))};
    case 18:
      return work_zone_limits(c.work_zone);
    case 19:
      return {f(c.tool_sphere.centre[0]), f(c.tool_sphere.centre[1]), f(c.tool_sphere.centre[2]),
              f(c.tool_sphere.radius)};
    case 30:
      return {c.calibration_enabled ? 1.0f : 0.0f, 1};  // calibrated at the factory
    case 36:
      return {f(c.collision_severity)};
    case 37:
      return collision_status(source.zones.collision_watch());
    case 38:
      return work_zone_status(source.zones.work_zone_watch());
    default:
      return {};  // types from the wire, not an enumeration
  }
}

// Settings of the queue and the robot, types 1..31, 54, 61 and 62.
Values configured(std::uint32_t type, const DynamicSource& source) noexcept {
  const Settings& s = source.settings;
  const UserLimits& l = source.configuration.joint_limits;
  switch (type) {
    case 1:
      return firmware(source.options);
    case 2:
      return {f(static_cast<int>(source.options.product))};
    case 3:
      return {f(source.options.serial_number), std::bit_cast<float>(source.options.serial_number)};
    case 11:
      return {l.enabled() ? 1.0f : 0.0f};
    case 12:
      return limits(kModelLimits, 0);
    case 13:
      return limits(kModelLimits, 3);
    case 14:
      return effective_limits(source, 0);
    case 15:
      return effective_limits(source, 3);
    case 20:
      return wanted_configuration(s);
    case 21:
      return {f(s.blending), f(s.velocity_timeout)};
    case 22:
      return speeds(source);
    case 24:
      return {f(s.torque_severity), f(s.torque_mode)};
    case 25:
      return floats(s.torque_limits);
    case 29:
      return {f(s.move_mode), f(s.move_duration_severity), f(s.move_duration)};
    case 31:
      return {f(s.payload[0]), f(s.payload[1]), f(s.payload[2]), f(s.payload[3])};
    case 54:
      return {f(s.time_scaling)};
    case 61:
      return limits(l.configured(), 0);
    case 62:
      return limits(l.configured(), 3);
    default:
      return surroundings(type, source);
  }
}

}  // namespace

Torques torques(const DynamicSource& s) noexcept {
  if (!s.powered) return {};
  Torques out;
  out.calculated = calculated_torques(s.joints, s.joint_acceleration, s.settings.payload);
  for (std::size_t i = 0; i < 6; ++i) out.actual[i] = out.calculated[i] + s.push[i] + 0.5 * noise(s, 24 + i);
  return out;
}

std::array<float, 6> dynamic_values(std::uint32_t type, const DynamicSource& s) noexcept {
  const bool variable = type >= image::kFirstVariable && s.options.layout == image::Layout::kFirmware11;
  if (variable) return s.variables.values(type);
  switch (type) {
    case 32:
      return floats(s.joint_velocity);
    case 33:
      // Manual 9.2 calls it not implemented yet.
      return s.options.layout == image::Layout::kFirmware9 ? Values{} : floats(torques(s).calculated);
    case 34:
      return floats(cartesian_velocity(s, s.joint_velocity));
    case 40:
      return floats(actual_joints(s));
    case 41:
      return actual_pose(s);
    case 42:
      return floats(actual_velocity(s));
    case 43:
      return floats(torques(s).actual);
    case 44:
      return floats(cartesian_velocity(s, actual_velocity(s)));
    case 45:
      return actual_configuration(s);
    case 46:
      return accelerometer(s);
    case 16:
    case 23:
    case 52:
    case 53:
      return s.tool.values(type);
    default:
      return configured(type, s);
  }
}

}  // namespace meca::sim
