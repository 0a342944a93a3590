// What each action needs to start, what confirms it, and what makes it fail.
#include <algorithm>

#include "bridge/control/actions.hpp"

namespace meca::control {
namespace {

using image::Layout;

// Dynamic data follows 1-2 cycles after the request (spec 5.7); a type the robot does not have never comes.
constexpr Time kDynamicDataTimeout = std::chrono::seconds(3);

bool motion_events(const image::Inputs& in) noexcept {
  return safety_stop(in) || in.robot_status.collision_status || in.robot_status.work_zone_status;
}

// An E-Stop, or the stop after a boot, takes the motors' supply; a P-Stop does not (spec 5.6).
bool motors_cut(const image::Inputs& in) noexcept {
  const image::SafetyStatus& s = in.safety_status;
  return in.robot_status.e_stop || (s.known && (s.stop.e_stop || s.stop.reboot));
}

}  // namespace

std::optional<Refusal> Actions::check_start(const Action& a, const View& view) const noexcept {
  const image::RobotStatus& s = view.in.robot_status;
  const auto error = [&s]() { return Refusal{Reason::kRobotError, {.robot_error = s.error_code}}; };
  switch (a.ticket.kind) {
    case CommandKind::kActivate:
      if (s.activated) return std::nullopt;
      if (s.error_code != 0) return error();
      // A P-Stop is no hindrance: only an activated robot can be resumed, and only resuming resets a P-Stop.
      if (motors_cut(view.in)) return Refusal{Reason::kSafetyStop};
      return std::nullopt;
    case CommandKind::kHome:
      if (!s.activated) return Refusal{Reason::kNotActivated};
      if (s.homed) return std::nullopt;
      if (s.error_code != 0) return error();
      if (safety_stop(view.in)) return Refusal{Reason::kSafetyStop};
      return std::nullopt;
    case CommandKind::kResumeMotion:
      if (s.error_code != 0) return error();
      if (!s.activated) return Refusal{Reason::kNotActivated};
      if (unresettable_stop(view.in, view.layout)) return Refusal{Reason::kSafetyStop};
      return std::nullopt;
    case CommandKind::kPauseMotion:
      if (!s.activated && !view.in.motion_status.paused) return Refusal{Reason::kNotActivated};
      return std::nullopt;
    case CommandKind::kSimMode:
      if (s.sim_activated == a.wanted) return std::nullopt;
      if (s.activated || s.busy) return Refusal{Reason::kWrongState};
      if (safety_stop(view.in)) return Refusal{Reason::kSafetyStop};
      return std::nullopt;
    case CommandKind::kBrakes:
      if (!settings_.allow_brakes) return Refusal{Reason::kNotAllowed};
      if (s.activated || s.busy) return Refusal{Reason::kWrongState};
      return std::nullopt;
    case CommandKind::kSetHostTime:
      if (view.unix_ns <= 0) return Refusal{Reason::kWrongState};
      return std::nullopt;
    case CommandKind::kDeactivate:
    case CommandKind::kResetError:
    case CommandKind::kClearMotion:
    case CommandKind::kRecoveryMode:
    case CommandKind::kDynamicData:
    case CommandKind::kTakeControl:
    case CommandKind::kReleaseControl:
    case CommandKind::kMotion:
      return std::nullopt;
  }
  return std::nullopt;
}

// The status bit that answers the action.
bool Actions::confirmed(const Action& a, const View& view) const noexcept {
  const image::RobotStatus& s = view.in.robot_status;
  const image::MotionStatus& m = view.in.motion_status;
  switch (a.ticket.kind) {
    case CommandKind::kActivate:
      return s.activated;
    case CommandKind::kDeactivate:
      return !s.activated && !s.busy;
    case CommandKind::kHome:
      return s.homed && s.activated;
    case CommandKind::kResetError:
      return s.error_code == 0;
    case CommandKind::kPauseMotion:
      return m.paused;
    case CommandKind::kResumeMotion:
      return !m.paused && !(view.layout == Layout::kFirmware9 && m.p_stop2);
    case CommandKind::kClearMotion:
      return m.cleared;
    case CommandKind::kSimMode:
      return s.sim_activated == a.wanted;
    case CommandKind::kRecoveryMode:
      return s.recovery_mode == a.wanted;
    case CommandKind::kBrakes:
      return s.brakes_engaged == a.wanted;
    case CommandKind::kDynamicData:
      return a.type == 0 || view.in.dynamic_data[a.slot].type_id == a.type;
    case CommandKind::kSetHostTime:
      return true;  // not published: nothing confirms it; three images long is enough
    case CommandKind::kTakeControl:
    case CommandKind::kReleaseControl:
    case CommandKind::kMotion:
      return true;
  }
  return true;
}

bool Actions::already_done(const Action& a, const View& view, bool nothing_queued) const noexcept {
  if (!confirmed(a, view)) return false;
  switch (a.ticket.kind) {
    case CommandKind::kPauseMotion:
      return pause_ || view.layout != Layout::kFirmware9;
    case CommandKind::kResumeMotion:
      return !pause_ && !motion_events(view.in);
    case CommandKind::kClearMotion:
      return nothing_queued;
    case CommandKind::kDeactivate:
      return !running(CommandKind::kActivate);
    case CommandKind::kBrakes:
      return a.wanted != brakes_gate_;  // engaged: the gate is closed; released: it is open
    case CommandKind::kDynamicData:
      return dynamic_data_[a.slot] == a.type;
    case CommandKind::kSetHostTime:
      return false;
    case CommandKind::kActivate:
    case CommandKind::kHome:
    case CommandKind::kResetError:
    case CommandKind::kSimMode:
    case CommandKind::kRecoveryMode:
    case CommandKind::kTakeControl:
    case CommandKind::kReleaseControl:
    case CommandKind::kMotion:
      return true;
  }
  return true;
}

std::optional<Refusal> Actions::failed(const Action& a, const View& view) const noexcept {
  const CommandKind kind = a.ticket.kind;
  const image::RobotStatus& s = view.in.robot_status;
  const bool moves = kind == CommandKind::kActivate || kind == CommandKind::kHome;
  const bool needs_health = moves || kind == CommandKind::kResumeMotion || kind == CommandKind::kSimMode ||
                            kind == CommandKind::kRecoveryMode;
  if (needs_health && view.fresh && s.error_code != 0) {
    return Refusal{Reason::kRobotError, {.robot_error = s.error_code}};
  }
  // Not raised yet: what came in between is not resumed over.
  const bool raised = a.phase == Phase::kRaise || a.phase == Phase::kRelease;
  if (kind == CommandKind::kResumeMotion && view.fresh && !raised && unresettable_stop(view.in, view.layout)) {
    return Refusal{Reason::kSafetyStop};
  }
  // A P-Stop only holds it up; an E-Stop takes the motors.
  if (moves && view.fresh && motors_cut(view.in)) return Refusal{Reason::kSafetyStop};
  if (kind == CommandKind::kHome && view.fresh && !s.activated) return Refusal{Reason::kNotActivated};
  const Time timeout =
      kind == CommandKind::kDynamicData ? std::min(kDynamicDataTimeout, settings_.timeout) : settings_.timeout;
  if (view.now - a.started > timeout) return Refusal{Reason::kTimeOut, {.robot_error = s.error_code}};
  return std::nullopt;
}

}  // namespace meca::control
