// The six values of each dynamic data type (manual table 12), computed only when a slot shows the type.
#pragma once

#include <array>
#include <cstdint>

#include "sim/configuration.hpp"
#include "sim/robot.hpp"
#include "sim/settings.hpp"
#include "sim/tool.hpp"
#include "sim/torque.hpp"
#include "sim/variables.hpp"
#include "sim/zones.hpp"

namespace meca::sim {

// What the values are made of; refers to the robot's own state for the time of one call.
struct DynamicSource {
  const RobotOptions& options;
  const Settings& settings;
  const Configuration& configuration;
  const Zones& zones;
  const Variables& variables;
  const ExternalTool& tool;
  const Joints& joints;              // target, deg
  const Joints& joint_velocity;      // target, deg/s
  const Joints& joint_acceleration;  // target, deg/s^2
  const Joints& push;                // what outside forces add to the motors' torques, %
  bool powered;                      // motors on
  std::uint64_t cycle;               // the noise of one cycle is the same in all slots
};

// Without power the motors give no torque: the brakes hold the arm.
Torques torques(const DynamicSource& source) noexcept;

// Types that no Meca500 has, or that no document names, give zeros (inferred: the manual only says what the known ones
// hold).
std::array<float, 6> dynamic_values(std::uint32_t type, const DynamicSource& source) noexcept;

}  // namespace meca::sim
