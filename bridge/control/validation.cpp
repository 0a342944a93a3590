#include "bridge/control/validation.hpp"

#include <cmath>
#include <limits>

#include "bridge/control/move_sequencer.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::control {
namespace {

using image::CommandClass;
using image::Layout;

constexpr std::uint32_t kModelLimits123 = 12, kModelLimits456 = 13, kEffectiveLimits123 = 14, kEffectiveLimits456 = 15;

Refusal out_of_range(std::size_t index, double value, double minimum, double maximum) noexcept {
  return {Reason::kArgumentRange,
          {.argument = static_cast<std::uint8_t>(index), .value = value, .minimum = minimum, .maximum = maximum}};
}

Refusal wrong_count(std::size_t count, std::size_t minimum, std::size_t maximum) noexcept {
  return {Reason::kArgumentCount,
          {.argument = static_cast<std::uint8_t>(count),
           .value = static_cast<double>(count),
           .minimum = static_cast<double>(minimum),
           .maximum = static_cast<double>(maximum)}};
}

bool whole_between(double value, double minimum, double maximum) noexcept {
  return std::isfinite(value) && value >= minimum && value <= maximum && value == std::trunc(value);
}

// As the robot's argument is a float: what does not fit would arrive as something else.
bool fits_float(double value) noexcept {
  return std::isfinite(value) && std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
}

struct Whole {
  double minimum, maximum;
};

std::optional<Refusal> check_whole(const CommandRequest& r, std::initializer_list<Whole> ranges) noexcept {
  if (r.argument_count != ranges.size()) return wrong_count(r.argument_count, ranges.size(), ranges.size());
  std::size_t i = 0;
  for (const Whole& w : ranges) {
    if (!whole_between(r.arguments[i], w.minimum, w.maximum)) {
      return out_of_range(i, r.arguments[i], w.minimum, w.maximum);
    }
    ++i;
  }
  return std::nullopt;
}

bool plausible(JointLimits::Range r) noexcept {
  return std::isfinite(r.minimum) && std::isfinite(r.maximum) && r.minimum < r.maximum;
}

std::optional<Refusal> check_arguments(const CommandRequest& r, const image::MotionCommandInfo& info) noexcept {
  for (std::size_t i = 0; i < r.argument_count; ++i) {
    const double value = r.arguments[i];
    if (r.use_variables) {
      if (!whole_between(value, image::kFirstVariable, image::kLastVariable)) {
        return out_of_range(i, value, image::kFirstVariable, image::kLastVariable);
      }
      continue;
    }
    const image::Argument& argument = info.arguments[i];
    const bool checkpoint = info.id == image::kSetCheckpoint;  // the numbers above are the bridge's own
    const double maximum = checkpoint ? kFirstOwnCheckpoint - 1 : argument.maximum;
    if (!fits_float(value) || !image::allows(argument, static_cast<float>(value)) || (checkpoint && value > maximum)) {
      return out_of_range(i, value, argument.minimum, maximum);
    }
  }
  return std::nullopt;
}

}  // namespace

void JointLimits::observe(const View& view) noexcept {
  if (!view.fresh) return;
  for (const image::DynamicData& data : view.in.dynamic_data) {
    if (data.type_id < kModelLimits123 || data.type_id > kEffectiveLimits456) continue;
    const bool effective = data.type_id >= kEffectiveLimits123;
    const std::size_t first = data.type_id == kModelLimits456 || data.type_id == kEffectiveLimits456 ? 3 : 0;
    // Firmware 9 interleaves the effective limits: min, max of one joint after the other (spec 2.2, types 14 and 15).
    const bool interleaved = effective && view.layout == Layout::kFirmware9;
    for (std::size_t i = 0; i < 3; ++i) {
      const Range range{data.values[interleaved ? 2 * i : i], data.values[interleaved ? 2 * i + 1 : i + 3]};
      if (plausible(range)) (effective ? effective_ : model_)[first + i] = {true, range};
    }
  }
}

JointLimits::Range JointLimits::range(std::size_t joint) const noexcept {
  if (effective_[joint].known) return effective_[joint].range;
  if (model_[joint].known) return model_[joint].range;
  const image::Argument& argument = image::find_motion_command(image::kMoveJoints)->arguments[joint];
  return {argument.minimum, argument.maximum};
}

std::optional<Refusal> check_action_arguments(const CommandRequest& r) noexcept {
  switch (r.kind) {
    case CommandKind::kSimMode:
    case CommandKind::kRecoveryMode:
    case CommandKind::kBrakes:
      return check_whole(r, {{0, 1}});
    case CommandKind::kDynamicData:
      return check_whole(r, {{0, image::kDynamicSlots - 1}, {0, image::kLastVariable}});
    case CommandKind::kTakeControl:
    case CommandKind::kReleaseControl:
    case CommandKind::kActivate:
    case CommandKind::kDeactivate:
    case CommandKind::kHome:
    case CommandKind::kResetError:
    case CommandKind::kPauseMotion:
    case CommandKind::kResumeMotion:
    case CommandKind::kClearMotion:
    case CommandKind::kSetHostTime:
      return check_whole(r, {});
    case CommandKind::kMotion:
      return std::nullopt;
  }
  return Refusal{Reason::kUnknownCommand};  // a number that is no CommandKind
}

std::optional<Refusal> check_motion_arguments(const CommandRequest& r, Layout layout,
                                              const JointLimits& limits) noexcept {
  const image::MotionCommandInfo* info = image::find_motion_command(r.motion_command_id);
  if (!info || info->since > layout || info->command_class == CommandClass::kOtherRobots ||
      info->command_class == CommandClass::kVelocity || (r.use_variables && layout != Layout::kFirmware11)) {
    return Refusal{Reason::kUnknownCommand};
  }
  const std::size_t most = info->arguments.size();
  if (r.argument_count < info->minimum_arguments || r.argument_count > most) {
    return wrong_count(r.argument_count, info->minimum_arguments, most);
  }
  if (info->id == image::kMoveJoints && !r.use_variables) {
    for (std::size_t i = 0; i < r.argument_count; ++i) {
      const JointLimits::Range range = limits.range(i);
      if (!(r.arguments[i] >= range.minimum && r.arguments[i] <= range.maximum)) {
        return out_of_range(i, r.arguments[i], range.minimum, range.maximum);
      }
    }
    return std::nullopt;
  }
  return check_arguments(r, *info);
}

std::optional<Refusal> check_motion_state(const CommandRequest& r, const View& view) noexcept {
  const image::MotionCommandInfo* info = image::find_motion_command(r.motion_command_id);
  const image::RobotStatus& status = view.in.robot_status;
  if (!info || info->command_class == CommandClass::kImmediate) return std::nullopt;
  if (status.error_code != 0) return Refusal{Reason::kRobotError, {.robot_error = status.error_code}};
  if (info->command_class == CommandClass::kConfiguration) {
    if (status.activated || status.busy) return Refusal{Reason::kWrongState};
    return std::nullopt;
  }
  if (safety_stop(view.in)) return Refusal{Reason::kSafetyStop};
  if (!status.activated) return Refusal{Reason::kNotActivated};
  // Recovery mode lets the robot move slowly without homing (spec 5.6).
  if (!status.homed && !status.recovery_mode) return Refusal{Reason::kNotHomed};
  return std::nullopt;
}

}  // namespace meca::control
