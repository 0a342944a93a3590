// What the configuration commands (150..156) set. It outlives deactivation, activation and a reboot; everything else
// that a host can set is restored at activation (settings.hpp). Spec 6.3.
#pragma once

#include <cstdint>
#include <span>

#include "sim/journal.hpp"
#include "sim/severity.hpp"
#include "sim/shape.hpp"
#include "sim/user_limits.hpp"

namespace meca::sim {

// SetWorkZoneCfg and SetWorkZoneLimits.
struct WorkZone {
  enum class Mode : std::uint8_t { kFlange = 1, kTool = 2, kToolAndLinks = 3 };
  static constexpr double kFactoryLimit = 10'000;  // mm each way
  int severity = severity::kSilent;                // the factory's value is not published; inferred, as the mode
  Mode mode = Mode::kFlange;
  Vec3 minimum{-kFactoryLimit, -kFactoryLimit, -kFactoryLimit};  // mm, BRF
  Vec3 maximum{kFactoryLimit, kFactoryLimit, kFactoryLimit};
};

struct Configuration {
  UserLimits joint_limits;
  WorkZone work_zone;
  int collision_severity = severity::kSilent;  // inferred
  ToolSphere tool_sphere;
  // Remembered and shown; the model's geometry is the nominal one, calibrated or not.
  bool calibration_enabled = true;
};

// Applies a configuration command whose arguments are in range each. False, and nothing changes: they contradict each
// other.
bool configure(const Command& command, Configuration& configuration) noexcept;

// The dynamic data types that show what the command sets.
std::span<const std::uint32_t> shown_by(std::uint32_t command_id) noexcept;

}  // namespace meca::sim
