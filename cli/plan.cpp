#include "cli/plan.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/suggest.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::cli {
namespace {

using meca500::CommandKind;
using meca500::VelocityKind;

constexpr ActionVerb kActions[] = {
    {"activate", CommandKind::ACTIVATE, false, "Switch the motors on"},
    {"home", CommandKind::HOME, false, "Home the robot; the joints move a little"},
    {"deactivate", CommandKind::DEACTIVATE, false, "Switch the motors off"},
    {"reset-error", CommandKind::RESET_ERROR, false, "Clear the robot's error; motion stays paused until resume"},
    {"pause", CommandKind::PAUSE_MOTION, false, "Pause motion, keep the queue"},
    {"resume", CommandKind::RESUME_MOTION, false, "Go on after a pause, an error or a safety stop"},
    {"clear", CommandKind::CLEAR_MOTION, false, "Stop and empty the queue"},
    {"sim-mode", CommandKind::SIM_MODE, true, "Let the robot only simulate motion; only while deactivated"},
    {"recovery-mode", CommandKind::RECOVERY_MODE, true, "Slow motion without homing and joint limits"},
    {"release", CommandKind::RELEASE_CONTROL, false, "Give control back"},
};

constexpr MotionVerb kMotions[] = {
    {"move-joints", image::kMoveJoints, "Move to joint angles"},
    {"move-pose", image::kMovePose, "Move to a pose, joints moving together"},
    {"move-lin", image::kMoveLin, "Move to a pose in a straight line"},
};

struct VelocityWord {
  std::string_view name;
  VelocityKind kind;
  std::uint32_t motion_command_id;
};
constexpr VelocityWord kVelocities[] = {
    {"joints", VelocityKind::MOVE_JOINTS_VEL, image::kMoveJointsVel},
    {"lin-wrf", VelocityKind::MOVE_LIN_VEL_WRF, image::kMoveLinVelWrf},
    {"lin-trf", VelocityKind::MOVE_LIN_VEL_TRF, image::kMoveLinVelTrf},
};

constexpr std::size_t kMostArguments = 6;

std::string in_quotes(std::string_view word) { return "'" + std::string(word) + "'"; }

std::string plural(std::size_t n, std::string_view noun) {
  return std::to_string(n) + " " + std::string(noun) + (n == 1 ? "" : "s");
}

std::vector<double> parse_arguments(std::string_view title, const image::MotionCommandInfo& info,
                                    std::span<const std::string> words) {
  if (words.size() < info.minimum_arguments || words.size() > info.arguments.size()) {
    const std::string wanted =
        info.arguments.empty() ? "takes no arguments"
        : info.minimum_arguments == info.arguments.size()
            ? "wants " + plural(info.arguments.size(), "number") + ": " + expected_arguments(info.id)
            : "wants " + std::to_string(info.minimum_arguments) + " to " + plural(info.arguments.size(), "number") +
                  ": " + expected_arguments(info.id);
    throw UsageError(std::string(title) + " " + wanted + "; " +
                     (words.empty() ? "none came" : std::to_string(words.size()) + " came"));
  }
  std::vector<double> numbers;
  for (std::size_t i = 0; i < words.size(); ++i) numbers.push_back(parse_number(words[i], info.arguments[i].name));
  return numbers;
}

// A plain number from 0 to 2^32-1, or nothing.
std::optional<std::uint32_t> as_id(std::string_view word) {
  std::uint32_t id = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), id);
  return error == std::errc{} && end == word.data() + word.size() ? std::optional(id) : std::nullopt;
}

[[noreturn]] void refuse_unknown_name(std::string_view name) {
  std::vector<std::string> known;
  for (const auto& command : image::motion_commands()) known.emplace_back(command.name);
  const std::string hint = did_you_mean(name, known);
  throw UsageError(
      "send: no motion command is called " + in_quotes(name) +
      (hint.empty() ? "; names are those of the robot manual, as in 'meca-ctl send SetJointVel 50'" : hint));
}

void refuse_velocity(const image::MotionCommandInfo& info) {
  for (const auto& word : kVelocities) {
    if (word.motion_command_id != info.id) continue;
    throw UsageError(std::string(info.name) + " has to be repeated while the robot moves: use 'meca-ctl velocity " +
                     std::string(word.name) + " ... --for SECONDS'");
  }
}

}  // namespace

std::span<const ActionVerb> action_verbs() { return kActions; }
std::span<const MotionVerb> motion_verbs() { return kMotions; }

double parse_number(std::string_view word, std::string_view name) {
  double value = 0;
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole_word = error == std::errc{} && end == digits.data() + digits.size();
  if (!whole_word || !std::isfinite(value)) {
    throw UsageError(std::string(name) + ": " + in_quotes(word) + " is not a finite number");
  }
  return value;
}

std::string expected_arguments(std::uint32_t motion_command_id) {
  const auto* info = image::find_motion_command(motion_command_id);
  if (info == nullptr) return {};
  std::string text;
  for (std::size_t i = 0; i < info->arguments.size(); ++i) {
    const auto& argument = info->arguments[i];
    if (i != 0) text += ' ';
    text += argument.name;
    const bool unit_ends = i + 1 == info->arguments.size() || info->arguments[i + 1].unit != argument.unit;
    if (unit_ends && !argument.unit.empty()) text += " (" + std::string(argument.unit) + ")";
  }
  return text;
}

CommandPlan plan_action(const ActionVerb& verb, std::string_view on_off) {
  CommandPlan plan;
  plan.title = verb.name;
  plan.kind = verb.kind;
  if (verb.on_off) {
    if (on_off != "on" && on_off != "off") {
      throw UsageError(std::string(verb.name) + " wants 'on' or 'off', not " +
                       (on_off.empty() ? "nothing" : in_quotes(on_off)));
    }
    plan.title += " " + std::string(on_off);
    plan.arguments = {on_off == "on" ? 1.0 : 0.0};
  }
  return plan;
}

CommandPlan plan_motion(const MotionVerb& verb, std::span<const std::string> words) {
  CommandPlan plan;
  plan.title = verb.name;
  plan.kind = CommandKind::MOTION;
  plan.motion_command_id = verb.motion_command_id;
  plan.arguments = parse_arguments(verb.name, *image::find_motion_command(verb.motion_command_id), words);
  return plan;
}

CommandPlan plan_send(std::string_view id_or_name, std::span<const std::string> words, bool use_variables) {
  CommandPlan plan;
  plan.kind = CommandKind::MOTION;
  plan.use_variables = use_variables;
  const auto id = as_id(id_or_name);
  const auto* info = id ? image::find_motion_command(*id) : image::find_motion_command(id_or_name);
  if (info == nullptr && !id) refuse_unknown_name(id_or_name);
  plan.motion_command_id = id ? *id : info->id;
  plan.title = info != nullptr ? std::string(info->name) : "command " + std::to_string(*id);
  if (info != nullptr) {
    refuse_velocity(*info);
    plan.arguments = parse_arguments(plan.title, *info, words);
    return plan;
  }
  // A number that no table has: the bridge has the last word, and its receipt says why not.
  if (words.size() > kMostArguments) {
    throw UsageError("send: a command has at most 6 arguments, " + std::to_string(words.size()) + " came");
  }
  for (const auto& word : words) plan.arguments.push_back(parse_number(word, plan.title));
  return plan;
}

VelocityPlan plan_velocity(std::string_view kind, std::span<const std::string> words) {
  const auto* word = std::ranges::find(kVelocities, kind, &VelocityWord::name);
  if (word == std::end(kVelocities)) {
    throw UsageError("velocity wants joints, lin-wrf or lin-trf first, not " + in_quotes(kind));
  }
  const auto numbers =
      parse_arguments("velocity " + std::string(kind), *image::find_motion_command(word->motion_command_id), words);
  VelocityPlan plan;
  plan.kind = word->kind;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    // The wire carries REAL; beyond its range a conversion would be undefined.
    if (std::abs(numbers[i]) > 1e6) throw UsageError(words[i] + " is no velocity a robot could have");
    plan.velocity[i] = static_cast<float>(numbers[i]);
  }
  return plan;
}

}  // namespace meca::cli
