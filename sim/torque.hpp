// Motor torques in percent of what each motor can give, and when they are too high (SetTorqueLimits,
// SetTorqueLimitsCfg). The vendor publishes neither masses nor motor torques: everything here is inferred, and chosen
// so that an arm with up to 1 kg at its flange stays below 100 % whatever it does.
#pragma once

#include "sim/kinematics.hpp"
#include "sim/settings.hpp"

namespace meca::sim {

struct Torques {
  Joints calculated{};  // from posture, payload and acceleration
  Joints actual{};      // what the motors really give
};

// `acceleration` is the target's, in deg/s^2.
Joints calculated_torques(const Joints& q, const Joints& acceleration, const std::array<double, 4>& payload) noexcept;

// Whether a motor is over its limit in the way SetTorqueLimitsCfg asks for. `accelerating`: in the acceleration phase
// of a move, which mode 1 leaves out.
bool excessive(const Torques& torques, const Settings& settings, bool accelerating) noexcept;

}  // namespace meca::sim
