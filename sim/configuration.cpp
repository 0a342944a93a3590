#include "sim/configuration.hpp"

#include <algorithm>

#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

// Six zeros restore the factory's zone (spec 6.3). inferred: else a zone without inside is refused.
bool set_work_zone(const Command& c, WorkZone& zone) noexcept {
  const auto& a = c.arguments;
  if (std::ranges::all_of(a, [](float v) { return v == 0; })) {
    zone.minimum = WorkZone{}.minimum;
    zone.maximum = WorkZone{}.maximum;
    return true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(a[i] < a[i + 3])) return false;
  }
  std::copy_n(a.begin(), 3, zone.minimum.begin());
  std::copy_n(a.begin() + 3, 3, zone.maximum.begin());
  return true;
}

}  // namespace

bool configure(const Command& command, Configuration& out) noexcept {
  const auto& a = command.arguments;
  switch (command.id) {
    case image::kSetJointLimits:
      return out.joint_limits.set(static_cast<int>(a[0]), a[1], a[2]);
    case image::kSetJointLimitsCfg:
      out.joint_limits.enable(a[0] != 0);
      return true;
    case image::kSetWorkZoneCfg:
      out.work_zone.severity = static_cast<int>(a[0]);
      out.work_zone.mode = static_cast<WorkZone::Mode>(static_cast<int>(a[1]));
      return true;
    case image::kSetWorkZoneLimits:
      return set_work_zone(command, out.work_zone);
    case image::kSetCollisionCfg:
      out.collision_severity = static_cast<int>(a[0]);
      return true;
    case image::kSetToolSphere:
      out.tool_sphere = {{a[0], a[1], a[2]}, a[3]};
      return true;
    case image::kSetCalibrationCfg:
      out.calibration_enabled = a[0] != 0;
      return true;
    default:
      return false;  // an id from the wire, not an enumeration
  }
}

std::span<const std::uint32_t> shown_by(std::uint32_t command_id) noexcept {
  static constexpr std::uint32_t kJointLimits[] = {14, 15, 61, 62}, kJointLimitsCfg[] = {11, 14, 15},
                                 kWorkZoneCfg[] = {17}, kWorkZoneLimits[] = {18}, kToolSphere[] = {19},
                                 kCalibration[] = {30}, kCollision[] = {36};
  switch (command_id) {
    case image::kSetJointLimits:
      return kJointLimits;
    case image::kSetJointLimitsCfg:
      return kJointLimitsCfg;
    case image::kSetWorkZoneCfg:
      return kWorkZoneCfg;
    case image::kSetWorkZoneLimits:
      return kWorkZoneLimits;
    case image::kSetToolSphere:
      return kToolSphere;
    case image::kSetCalibrationCfg:
      return kCalibration;
    case image::kSetCollisionCfg:
      return kCollision;
    default:
      return {};
  }
}

}  // namespace meca::sim
