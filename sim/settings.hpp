// What the Set* commands set, with the values a robot has after activation, and the speeds that follow from them.
#pragma once

#include <array>

#include "sim/inverse.hpp"
#include "sim/journal.hpp"
#include "sim/kinematics.hpp"

namespace meca::sim {

// Restored at every activation (spec 6.3: constants of the vendor's Python package, firmware 11.3 generation).
struct Settings {
  double blending = 100;               // %
  double joint_velocity = 25;          // % of kTopSpeed
  double joint_acceleration = 80;      // %
  double joint_velocity_limit = 100;   // %; 150 on the R4
  double linear_velocity = 150;        // mm/s
  double angular_velocity = 45;        // deg/s
  double cartesian_acceleration = 50;  // %
  double velocity_timeout = 0.05;      // s
  Posture conf{1, 1, 1};
  bool auto_conf = true;
  int conf_turn = 0;
  bool auto_conf_turn = true;
  PoseNumbers trf{}, wrf{};  // TRF in FRF, WRF in BRF
  Transform trf_transform, wrf_transform;
  double time_scaling = 100;                                          // %
  std::array<double, 6> torque_limits{100, 100, 100, 100, 100, 100};  // %
  int torque_severity = 0, torque_mode = 0;
  int move_mode = 0, move_duration_severity = 1;  // velocity based; warning
  double move_duration = 3;                       // s
  std::array<double, 4> payload{};                // kg, mm, mm, mm
};

// Applies a Set* command whose arguments are known to be good. `now` is where the arm is when its turn comes.
// False: the command is not one that only sets something.
bool apply(const Command& command, const Joints& now, Settings& settings) noexcept;

// Set commands that make the arm stop before they act, even with blending (manual, SetTrf, SetWrf, SetJointAcc,
// SetCartAcc).
bool needs_full_stop(std::uint32_t command_id) noexcept;

// Speeds and ramps that hold now.
struct Dynamics {
  Joints joint_speed;                  // deg/s, for joint moves
  Joints speed_limit;                  // deg/s, never exceeded by any move
  double joint_ramp;                   // s from rest to full speed
  double linear_speed, angular_speed;  // mm/s, deg/s, for lines
  double linear_limit, angular_limit;  // mm/s, deg/s, never exceeded by a line or a Cartesian velocity
  double cartesian_ramp;               // s
};
// In recovery mode everything is capped: 5 % joint speed, 40 % accelerations, 20 mm/s, 30 deg/s (spec 5.6).
Dynamics dynamics(const Settings& settings, bool recovery_mode) noexcept;

}  // namespace meca::sim
