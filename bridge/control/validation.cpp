#include "bridge/control/validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bridge/control/move_sequencer.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::control {
namespace {

using image::CommandClass;
using image::Layout;

constexpr std::uint32_t kProductR3 = 3;
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNarrowestJoint = 25;  // the robot takes no joint limits closer to each other, degrees (spec 6.2)

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

std::optional<Refusal> check_joints(const CommandRequest& r, const JointLimits& limits) noexcept {
  for (std::size_t i = 0; i < r.argument_count; ++i) {
    const JointLimits::Range range = limits.range(i);
    // As floats: a client that asks for a limit of 60.1 as the robot tells it means the limit.
    const auto within = [&](double value) {
      const auto v = static_cast<float>(value);
      return v >= static_cast<float>(range.minimum) && v <= static_cast<float>(range.maximum);
    };
    if (!fits_float(r.arguments[i]) || !within(r.arguments[i])) {
      return out_of_range(i, r.arguments[i], range.minimum, range.maximum);
    }
  }
  return std::nullopt;
}

// Steps from where the arm stands. A joint outside its limits (after recovery mode) may move back towards them.
std::optional<Refusal> check_joint_steps(const CommandRequest& r, const RobotFacts& robot) noexcept {
  if (!robot.standing_at) return std::nullopt;  // the sum is not known: the robot itself checks it when it is
  constexpr double kRounding = 0.001;           // of positions that are told as floats, degrees
  for (std::size_t i = 0; i < r.argument_count; ++i) {
    const double from = (*robot.standing_at)[i], step = r.arguments[i];
    const JointLimits::Range range = robot.limits.range(i);
    const bool outside =
        (step > 0 && from + step > range.maximum + kRounding) || (step < 0 && from + step < range.minimum - kRounding);
    if (outside) return out_of_range(i, step, std::min(0.0, range.minimum - from), std::max(0.0, range.maximum - from));
  }
  return std::nullopt;
}

// (n, 0, 0) gives joint n its model's limits back (spec 6.3).
std::optional<Refusal> check_new_joint_limits(const CommandRequest& r, const JointLimits& limits) noexcept {
  const double minimum = r.arguments[1], maximum = r.arguments[2];
  if (minimum == 0 && maximum == 0) return std::nullopt;
  const JointLimits::Range model = limits.model(static_cast<std::size_t>(r.arguments[0]) - 1);
  if (minimum < model.minimum || minimum > model.maximum - kNarrowestJoint) {
    return out_of_range(1, minimum, model.minimum, model.maximum - kNarrowestJoint);
  }
  if (maximum < minimum + kNarrowestJoint || maximum > model.maximum) {
    return out_of_range(2, maximum, minimum + kNarrowestJoint, model.maximum);
  }
  return std::nullopt;
}

// Six zeros give back the factory's zone (spec 6.3). inferred: else a zone without inside is refused.
std::optional<Refusal> check_work_zone(const CommandRequest& r) noexcept {
  const bool reset = std::all_of(r.arguments.begin(), r.arguments.end(), [](double v) { return v == 0; });
  for (std::size_t i = 0; i < 3 && !reset; ++i) {
    if (!(r.arguments[i + 3] > r.arguments[i])) return out_of_range(i + 3, r.arguments[i + 3], r.arguments[i], kInf);
  }
  return std::nullopt;
}

// What the range of each argument alone does not say.
std::optional<Refusal> check_together(const CommandRequest& r, const image::MotionCommandInfo& info,
                                      const RobotFacts& robot) noexcept {
  switch (r.motion_command_id) {
    case image::kMoveJointsRel:
      return check_joint_steps(r, robot);
    case image::kSetJointVel:
    case image::kSetJointVelLimit:
      if (robot.product_type != kProductR3 || r.arguments[0] <= 100) return std::nullopt;
      return out_of_range(0, r.arguments[0], info.arguments[0].minimum, 100);
    case image::kSetJointLimits:
      return check_new_joint_limits(r, robot.limits);
    case image::kSetWorkZoneLimits:
      return check_work_zone(r);
  }
  return std::nullopt;
}

}  // namespace

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

std::optional<Refusal> check_motion_arguments(const CommandRequest& r, const RobotFacts& robot) noexcept {
  const image::MotionCommandInfo* info = image::find_motion_command(r.motion_command_id);
  if (!info || info->since > robot.layout || info->command_class == CommandClass::kOtherRobots ||
      info->command_class == CommandClass::kVelocity || (r.use_variables && robot.layout != Layout::kFirmware11)) {
    return Refusal{Reason::kUnknownCommand};
  }
  const std::size_t most = info->arguments.size();
  if (r.argument_count < info->minimum_arguments || r.argument_count > most) {
    return wrong_count(r.argument_count, info->minimum_arguments, most);
  }
  if (r.use_variables) return check_arguments(r, *info);
  if (info->id == image::kMoveJoints) return check_joints(r, robot.limits);
  if (const auto refusal = check_arguments(r, *info)) return refusal;
  return check_together(r, *info, robot);
}

std::optional<Refusal> check_motion_state(const CommandRequest& r, const View& view) noexcept {
  const image::MotionCommandInfo* info = image::find_motion_command(r.motion_command_id);
  const image::RobotStatus& status = view.in.robot_status;
  // inferred: a reboot takes the motors from under whatever the arm is doing, so it is for a robot at rest.
  const bool reboot = r.motion_command_id == image::kRebootRobot;
  if (reboot && (status.activated || status.busy)) return Refusal{Reason::kWrongState};
  // inferred: a reboot is for errors that nothing else clears, so a robot takes it in one.
  if (status.error_code != 0 && !reboot) return Refusal{Reason::kRobotError, {.robot_error = status.error_code}};
  if (!info || info->command_class == CommandClass::kImmediate) return std::nullopt;
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
