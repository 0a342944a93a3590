#include "sim/reception.hpp"

#include "sim/error.hpp"

namespace meca::sim {
namespace {

// Not published what a robot answers to commands of other robots; inferred: it does not know them.
const image::MotionCommandInfo* known_command(std::uint32_t id, image::Layout layout) noexcept {
  const image::MotionCommandInfo* info = image::find_motion_command(id);
  const bool known =
      info != nullptr && info->since <= layout && info->command_class != image::CommandClass::kOtherRobots;
  return known ? info : nullptr;
}

bool arguments_are_good(const Command& c, const image::MotionCommandInfo& info, Product product) noexcept {
  for (std::size_t i = 0; i < info.minimum_arguments; ++i) {
    image::Argument rule = info.arguments[i];
    if (c.id == image::kMoveJoints) rule.minimum = -(rule.maximum = 1e30);  // a joint limit is error 1007, not 1003
    const bool percent_of_r3 = c.id == image::kSetJointVel || c.id == image::kSetJointVelLimit;
    if (percent_of_r3 && product == Product::kMeca500R3) rule.maximum = 100;
    if (!image::allows(rule, c.arguments[i])) return false;
  }
  return true;
}

bool is_variable(std::uint32_t id) noexcept { return id >= image::kFirstVariable && id <= image::kLastVariable; }

// Equipment and features that this robot does not have.
std::uint16_t missing(const Command& command, const Readiness& r) noexcept {
  const std::uint32_t id = command.id;
  if (const auto code = r.tool.missing(id); code != error::kNone) return code;
  if (id == image::kStartProgram) return r.programs.check(command.arguments[0]);
  return is_variable(id) && r.variables.find(id) == nullptr ? error::kSetVariable : error::kNone;
}

// How many arguments are numbers of variables when UseVariables is set.
std::size_t variable_arguments(std::uint32_t id, const image::MotionCommandInfo& info, const Variables& all) noexcept {
  if (!is_variable(id)) return info.minimum_arguments;
  const Variable* target = all.find(id);
  return target != nullptr ? target->size : 0;
}

}  // namespace

Verdict examine(const Command& received, bool use_variables, const Readiness& r) noexcept {
  Command command = received;
  const image::MotionCommandInfo* info = known_command(command.id, r.layout);
  if (info == nullptr) return {error::kUnknownCommand};
  if (use_variables && r.layout == image::Layout::kFirmware11) {
    const std::size_t count = variable_arguments(command.id, *info, r.variables);
    if (const auto code = r.variables.resolve(command, count); code != error::kNone) return {code};
  }
  if (!arguments_are_good(command, *info, r.product)) return {error::kArguments};
  if (const auto code = missing(command, r); code != error::kNone) return {code};

  using enum image::CommandClass;
  switch (info->command_class) {
    case kImmediate:
      if (command.id == image::kRebootRobot && !r.off) return {error::kMustBeDeactivated};
      break;
    case kOtherRobots:
      break;
    case kConfiguration:
      if (!r.off) return {error::kMustBeDeactivated};
      break;
    case kQueued:
      if (!r.activated) return {error::kNotActivated};
      break;
    case kMotion:
    case kVelocity:
      if (!r.activated) return {error::kNotActivated};
      // Recovery mode moves slowly without homing (spec 5.6).
      if (!r.homed && !r.recovery_mode) return {error::kNotHomed};
      break;
  }
  return {error::kNone, info, command};
}

bool belongs_in_program(const Command& command, Product product, image::Layout layout) noexcept {
  using enum image::CommandClass;
  const image::MotionCommandInfo* info = known_command(command.id, layout);
  return info != nullptr && info->command_class != kImmediate && info->command_class != kConfiguration &&
         arguments_are_good(command, *info, product);
}

}  // namespace meca::sim
