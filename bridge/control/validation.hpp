// The checks before anything is sent: a command that the robot would refuse, or that would mean something else to it,
// is refused here with the field, the value and the range.
#pragma once

#include <array>
#include <optional>

#include "bridge/control/joint_limits.hpp"
#include "bridge/control/ledger.hpp"
#include "bridge/control/messages.hpp"
#include "bridge/control/view.hpp"

namespace meca::control {

struct Refusal {
  Reason reason = Reason::kNone;
  Detail detail{};
};

// What a check needs to know of the robot besides the command.
struct RobotFacts {
  image::Layout layout;
  std::uint32_t product_type = 0;  // dynamic data type 2: 3 = R3, 4 = R4, 0 = not known
  const JointLimits& limits;
  // Where the arm stands, degrees; empty while it moves or will before the command is executed.
  std::optional<std::array<float, 6>> standing_at{};
};

// Arguments of an action (any kind but kMotion): how many, and their ranges.
std::optional<Refusal> check_action_arguments(const CommandRequest& request) noexcept;

// A queued command (kMotion): exists on this firmware and this robot, arguments, joint limits.
std::optional<Refusal> check_motion_arguments(const CommandRequest& request, const RobotFacts& robot) noexcept;

// Whether the robot's state allows a queued command of request.motion_command_id now.
std::optional<Refusal> check_motion_state(const CommandRequest& request, const View& view) noexcept;

}  // namespace meca::control
