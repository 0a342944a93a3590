// The tool on the flange: an electric gripper or a pneumatic module. Stepped by time, without allocation.
#pragma once

#include <array>
#include <cstdint>

#include "sim/equipment.hpp"
#include "sim/journal.hpp"

namespace meca::sim {

class ExternalTool {
 public:
  explicit ExternalTool(ToolType type) noexcept;

  // Commands 18, 19, 20, 30, 31 and 32: they run beside the motion, not in turn with it (spec 6.3).
  static bool takes(std::uint32_t command_id) noexcept;
  // 0, or the error code of a tool command on a robot without that tool: 1038 gripper, 1041 pneumatic module.
  std::uint16_t missing(std::uint32_t command_id) const noexcept;
  // A command whose arguments are known to be good, when its turn comes. 0, or the code it fails with: 1003 outside of
  // the fingers' range, 1006 before homing.
  std::uint16_t run(const Command& command) noexcept;

  void advance(double seconds) noexcept;
  // The fingers close and open fully as part of the robot's homing (manual, Home); afterwards they are open. Nothing
  // happens to a gripper that is homed already.
  void home() noexcept;
  void forget_homing() noexcept;
  // inferred: without motors the fingers stay where they are and press no longer; valves keep their state.
  void relax() noexcept;
  // No power at all: the valves close (inferred), the homing is lost.
  void cut() noexcept;
  // Force, velocity and range as after an activation (spec 6.3).
  void restore_defaults() noexcept;

  // A part between the fingers, on which they close; 0 takes it away. False: no gripper, or the fingers are not open
  // wider than the part, so there is no room for it.
  bool place_part(double width_mm) noexcept;

  // The six values of the dynamic data types 16, 23, 52 and 53.
  std::array<float, 6> values(std::uint32_t type) const noexcept;
  // Whether the values of 23, or of 52 and 53, changed since it was asked last.
  bool take_settings_changed() noexcept;
  bool take_state_changed() noexcept;

 private:
  bool is_gripper() const noexcept { return type_ == ToolType::kMegp25e || type_ == ToolType::kMegp25ls; }
  bool holds_part() const noexcept;
  std::uint16_t move_to(double opening) noexcept;
  std::uint16_t set_range(double closed, double open) noexcept;
  std::array<float, 6> gripper_state() const noexcept;

  ToolType type_;
  double stroke_;                    // mm
  double force_ = 40, speed_ = 40;   // %
  double closed_ = 0, open_;         // mm, SetGripperRange
  double opening_ = 0, target_ = 0;  // mm, between the fingers
  double part_ = 0;                  // mm, 0: none
  bool homed_ = false;
  std::array<int, 2> valves_{};  // 1 open
  bool settings_changed_ = false, state_changed_ = false;
};

}  // namespace meca::sim
