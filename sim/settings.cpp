#include "sim/settings.hpp"

#include <algorithm>

#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

// Calibrated: a published log of an R4 at SetJointAcc 50 has ramps of 0.20 s; "the ramp time is the parameter" follows
// from the manual's remark that SetJointVelLimit changes acceleration durations.
constexpr double kJointRampAt100 = 0.1;
// Not published; inferred to be like the joints'.
constexpr double kCartesianRampAt100 = 0.1;

// What SetCartLinVel and SetCartAngVel take at most (spec 6.2).
constexpr double kTopLinearSpeed = 5000, kTopAngularSpeed = 1000;

PoseNumbers six(const Command& c) noexcept {
  PoseNumbers out;
  std::copy(c.arguments.begin(), c.arguments.end(), out.begin());
  return out;
}

int sign_or_one(int value) noexcept { return value == 0 ? 1 : value; }

bool apply_speeds(const Command& c, Settings& s) noexcept {
  const double a = c.arguments[0];
  switch (c.id) {
    case image::kSetBlending:
      s.blending = a;
      return true;
    case image::kSetJointVel:
      s.joint_velocity = a;
      return true;
    case image::kSetJointAcc:
      s.joint_acceleration = a;
      return true;
    case image::kSetJointVelLimit:
      s.joint_velocity_limit = a;
      return true;
    case image::kSetCartLinVel:
      s.linear_velocity = a;
      return true;
    case image::kSetCartAngVel:
      s.angular_velocity = a;
      return true;
    case image::kSetCartAcc:
      s.cartesian_acceleration = a;
      return true;
    case image::kSetVelTimeout:
      s.velocity_timeout = a;
      return true;
    case image::kSetTimeScaling:
      s.time_scaling = a;
      return true;
    case image::kSetPayload:
      std::copy_n(c.arguments.begin(), 4, s.payload.begin());
      return true;
    default:
      return false;  // an id from the wire, not an enumeration
  }
}

bool apply_move_mode(const Command& c, Settings& s) noexcept {
  const float a = c.arguments[0];
  switch (c.id) {
    case image::kSetMoveMode:
      s.move_mode = static_cast<int>(a);
      return true;
    case image::kSetMoveDurationCfg:
      s.move_duration_severity = static_cast<int>(a);
      return true;
    case image::kSetMoveDuration:
      s.move_duration = a;
      return true;
    default:
      return false;
  }
}

bool apply_conf(const Command& c, const Joints& now, Settings& s) noexcept {
  const int a = static_cast<int>(c.arguments[0]);  // range checked on reception
  switch (c.id) {
    case image::kSetConf:
      s.conf = {a, static_cast<int>(c.arguments[1]), static_cast<int>(c.arguments[2])};
      s.auto_conf = false;
      return true;
    case image::kSetAutoConf: {
      // inferred: switching the choice off keeps the posture of the moment.
      const Posture p = posture(now);
      if (a == 0 && s.auto_conf) s.conf = {sign_or_one(p.shoulder), sign_or_one(p.elbow), sign_or_one(p.wrist)};
      s.auto_conf = a != 0;
      return true;
    }
    case image::kSetConfTurn:
      s.conf_turn = a;
      s.auto_conf_turn = false;
      return true;
    case image::kSetAutoConfTurn:
      if (a == 0 && s.auto_conf_turn) s.conf_turn = turn(now[5]);
      s.auto_conf_turn = a != 0;
      return true;
    default:
      return false;
  }
}

bool apply_torque(const Command& c, Settings& s) noexcept {
  switch (c.id) {
    case image::kSetTorqueLimits:
      std::copy(c.arguments.begin(), c.arguments.end(), s.torque_limits.begin());
      return true;
    case image::kSetTorqueLimitsCfg:
      s.torque_severity = static_cast<int>(c.arguments[0]);
      s.torque_mode = static_cast<int>(c.arguments[1]);
      return true;
    default:
      return false;
  }
}

}  // namespace

bool apply(const Command& command, const Joints& now, Settings& settings) noexcept {
  if (apply_speeds(command, settings) || apply_move_mode(command, settings) || apply_conf(command, now, settings) ||
      apply_torque(command, settings)) {
    return true;
  }
  if (command.id == image::kSetTrf) {
    settings.trf = six(command);
    settings.trf_transform = to_transform(settings.trf);
    return true;
  }
  if (command.id == image::kSetWrf) {
    settings.wrf = six(command);
    settings.wrf_transform = to_transform(settings.wrf);
    return true;
  }
  return false;
}

bool needs_full_stop(std::uint32_t id) noexcept {
  return id == image::kSetTrf || id == image::kSetWrf || id == image::kSetJointAcc || id == image::kSetCartAcc;
}

Dynamics dynamics(const Settings& s, bool recovery_mode) noexcept {
  const auto capped = [recovery_mode](double value, double cap) {
    return recovery_mode ? std::min(value, cap) : value;
  };
  Dynamics out;
  const double limit = capped(s.joint_velocity_limit, 5);
  const double speed = std::min(s.joint_velocity, limit);
  for (std::size_t i = 0; i < 6; ++i) {
    out.joint_speed[i] = kTopSpeed[i] * speed / 100;
    out.speed_limit[i] = kTopSpeed[i] * limit / 100;
  }
  out.joint_ramp = kJointRampAt100 * 100 / capped(s.joint_acceleration, 40);
  out.linear_limit = capped(kTopLinearSpeed, 20);
  out.angular_limit = capped(kTopAngularSpeed, 30);
  out.linear_speed = capped(s.linear_velocity, 20);
  out.angular_speed = capped(s.angular_velocity, 30);
  if (s.move_mode == 1) {
    // Time-based moves take the time they are given; inferred: what bounds them is what the robot can do at most.
    out.joint_speed = out.speed_limit;
    out.linear_speed = out.linear_limit;
    out.angular_speed = out.angular_limit;
  }
  out.cartesian_ramp = kCartesianRampAt100 * 100 / capped(s.cartesian_acceleration, 40);
  return out;
}

}  // namespace meca::sim
