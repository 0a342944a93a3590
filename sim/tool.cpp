#include "sim/tool.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/error.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

constexpr double kTopSpeed = 50;     // mm/s at SetGripperVel 100 (manual: about)
constexpr double kTolerance = 0.01;  // mm; inferred: what counts as being there

// inferred from public data sheets: strokes of 6 mm and 48 mm.
double stroke_of(ToolType type) noexcept {
  switch (type) {
    case ToolType::kMegp25e:
      return 6;
    case ToolType::kMegp25ls:
      return 48;
    case ToolType::kNone:
    case ToolType::kMpm500:
      break;
  }
  return 0;
}

template <class T>
float f(T v) noexcept {
  return static_cast<float>(v);
}

}  // namespace

ExternalTool::ExternalTool(ToolType type) noexcept : type_(type), stroke_(stroke_of(type)), open_(stroke_) {}

bool ExternalTool::takes(std::uint32_t id) noexcept {
  return id == image::kGripper || id == image::kSetGripperVel || id == image::kSetGripperForce ||
         id == image::kSetValveState || id == image::kSetGripperRange || id == image::kMoveGripper;
}

std::uint16_t ExternalTool::missing(std::uint32_t id) const noexcept {
  if (!takes(id)) return error::kNone;
  if (id == image::kSetValveState) return type_ == ToolType::kMpm500 ? error::kNone : error::kNoPneumaticModule;
  return is_gripper() ? error::kNone : error::kNoGripper;
}

std::uint16_t ExternalTool::run(const Command& command) noexcept {
  if (const auto code = missing(command.id); code != error::kNone) return code;
  const auto& a = command.arguments;
  switch (command.id) {
    case image::kGripper:
      return move_to(a[0] != 0 ? open_ : closed_);
    case image::kMoveGripper:
      return move_to(a[0]);
    case image::kSetGripperRange:
      return set_range(a[0], a[1]);
    case image::kSetGripperVel:
      speed_ = a[0];
      settings_changed_ = true;
      break;
    case image::kSetGripperForce:
      force_ = a[0];
      settings_changed_ = state_changed_ = true;
      break;
    case image::kSetValveState:
      for (std::size_t i = 0; i < 2; ++i) {
        if (a[i] >= 0) valves_[i] = static_cast<int>(a[i]);  // -1: unchanged
      }
      state_changed_ = true;
      break;
    default:
      break;  // takes() lets nothing else through
  }
  return error::kNone;
}

std::uint16_t ExternalTool::move_to(double opening) noexcept {
  if (!homed_) return error::kNotHomed;
  // inferred: an opening outside of the range is an error, not cut short.
  if (opening < closed_ - kTolerance || opening > open_ + kTolerance) return error::kArguments;
  target_ = std::clamp(opening, closed_, open_);
  state_changed_ = true;
  return error::kNone;
}

// inferred: two zeros give back the whole stroke. Fingers that stand outside of a narrower range stay there.
std::uint16_t ExternalTool::set_range(double closed, double open) noexcept {
  const bool reset = closed == 0 && open == 0;
  if (!reset && (closed < 0 || open <= closed || open > stroke_)) return error::kArguments;
  closed_ = closed;
  open_ = reset ? stroke_ : open;
  settings_changed_ = state_changed_ = true;
  return error::kNone;
}

bool ExternalTool::holds_part() const noexcept {
  return part_ > 0 && opening_ <= part_ + kTolerance && target_ < part_ - kTolerance;
}

void ExternalTool::advance(double seconds) noexcept {
  const double goal = std::max(target_, part_);
  if (opening_ == goal) return;
  const double step = kTopSpeed * speed_ / 100 * seconds;
  opening_ += std::clamp(goal - opening_, -step, step);
  state_changed_ = true;
}

void ExternalTool::home() noexcept {
  if (!is_gripper() || homed_) return;
  homed_ = true;
  opening_ = target_ = stroke_;
  state_changed_ = true;
}

void ExternalTool::forget_homing() noexcept {
  homed_ = false;
  state_changed_ = true;
}

void ExternalTool::relax() noexcept {
  target_ = opening_;
  state_changed_ = true;
}

void ExternalTool::cut() noexcept {
  relax();
  forget_homing();
  valves_ = {};
}

void ExternalTool::restore_defaults() noexcept {
  force_ = speed_ = 40;
  closed_ = 0;
  open_ = stroke_;
  settings_changed_ = true;
}

bool ExternalTool::place_part(double width) noexcept {
  if (width != 0 && !(is_gripper() && width > 0 && width < opening_)) return false;
  part_ = width;
  state_changed_ = true;
  return true;
}

std::array<float, 6> ExternalTool::gripper_state() const noexcept {
  const bool held = holds_part();
  // inferred: the force is 0 unless the fingers press on something.
  return {f(held),
          f(std::abs(opening_ - target_) <= kTolerance),
          f(opening_ <= closed_ + kTolerance),
          f(opening_ >= open_ - kTolerance),
          f(held ? force_ : 0),
          f(opening_)};
}

std::array<float, 6> ExternalTool::values(std::uint32_t type) const noexcept {
  switch (type) {
    case 16:
      // inferred: laid out like type 1; the version itself is made up.
      return type_ == ToolType::kNone ? std::array<float, 6>{} : std::array<float, 6>{1, 0, 0, 0};
    case 23:
      return is_gripper() ? std::array<float, 6>{f(force_), f(speed_), f(closed_), f(open_)}
                          : std::array<float, 6>{f(force_), f(speed_)};
    case 52:
      return {f(static_cast<int>(type_)), f(homed_)};  // no error, not overheated
    case 53:
      if (type_ == ToolType::kMpm500) return {f(valves_[0]), f(valves_[1])};
      return is_gripper() ? gripper_state() : std::array<float, 6>{};
    default:
      return {};  // types from the wire, not an enumeration
  }
}

bool ExternalTool::take_settings_changed() noexcept { return std::exchange(settings_changed_, false); }
bool ExternalTool::take_state_changed() noexcept { return std::exchange(state_changed_, false); }

}  // namespace meca::sim
