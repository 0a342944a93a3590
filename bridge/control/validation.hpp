// The checks before anything is sent: a command that the robot would refuse, or that would mean something else to it,
// is refused here with the field, the value and the range.
#pragma once

#include <array>
#include <optional>

#include "bridge/control/ledger.hpp"
#include "bridge/control/messages.hpp"
#include "bridge/control/view.hpp"

namespace meca::control {

struct Refusal {
  Reason reason = Reason::kNone;
  Detail detail{};
};

// The joint limits that hold now, degrees: the robot's own where it has reported them, else those of the model.
class JointLimits {
 public:
  struct Range {
    double minimum, maximum;
  };
  // Reads dynamic data types 12-15 wherever a slot happens to show them. 14 and 15 (effective) win over 12 and 13
  // (model).
  void observe(const View& view) noexcept;
  void forget() noexcept { *this = JointLimits{}; }
  Range range(std::size_t joint) const noexcept;  // 0..5

 private:
  struct Live {
    bool known = false;
    Range range{};
  };
  std::array<Live, 6> effective_{}, model_{};
};

// Arguments of an action (any kind but kMotion): how many, and their ranges.
std::optional<Refusal> check_action_arguments(const CommandRequest& request) noexcept;

// A queued command (kMotion): exists on this firmware and this robot, arguments, joint limits.
std::optional<Refusal> check_motion_arguments(const CommandRequest& request, image::Layout layout,
                                              const JointLimits& limits) noexcept;

// Whether the robot's state allows a queued command of request.motion_command_id now.
std::optional<Refusal> check_motion_state(const CommandRequest& request, const View& view) noexcept;

}  // namespace meca::control
