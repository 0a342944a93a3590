// Words and numbers of the command line -> commands for the bridge. Pure; mistakes are sentences.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/invocation.hpp"

namespace meca::cli {

// A mistake on the command line; what() says what was wanted instead.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ActionVerb {
  std::string_view name;  // "reset-error"
  meca500::CommandKind kind;
  bool on_off;  // takes the word "on" or "off"
  std::string_view about;
};
std::span<const ActionVerb> action_verbs();

struct MotionVerb {
  std::string_view name;  // "move-joints"
  std::uint32_t motion_command_id;
  std::string_view about;
};
std::span<const MotionVerb> motion_verbs();

// Each throws UsageError. Ranges are the bridge's to check: it knows the robot's own limits.
CommandPlan plan_action(const ActionVerb& verb, std::string_view on_off);
CommandPlan plan_motion(const MotionVerb& verb, std::span<const std::string> words);
CommandPlan plan_send(std::string_view id_or_name, std::span<const std::string> words, bool use_variables);
VelocityPlan plan_velocity(std::string_view kind, std::span<const std::string> words);

// "q1 q2 q3 q4 q5 q6 (deg)", "x y z (mm) alpha beta gamma (deg)"; empty for a command without arguments.
std::string expected_arguments(std::uint32_t motion_command_id);

// A finite number, whole word; UsageError names the argument.
double parse_number(std::string_view word, std::string_view name);

}  // namespace meca::cli
