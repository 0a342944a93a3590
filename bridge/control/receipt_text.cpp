#include "bridge/control/receipt_text.hpp"

#include <array>
#include <cstdio>

#include "bridge/control/move_sequencer.hpp"
#include "transports/image/error_codes.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::control {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string in_quotes(const ClientName& name) { return "'" + std::string(name.view()) + "'"; }

std::string action_name(CommandKind kind) {
  switch (kind) {
    case CommandKind::kTakeControl:
      return "taking control";
    case CommandKind::kReleaseControl:
      return "releasing control";
    case CommandKind::kActivate:
      return "activation";
    case CommandKind::kDeactivate:
      return "deactivation";
    case CommandKind::kHome:
      return "homing";
    case CommandKind::kResetError:
      return "resetting the error";
    case CommandKind::kPauseMotion:
      return "pausing";
    case CommandKind::kResumeMotion:
      return "resuming";
    case CommandKind::kClearMotion:
      return "clearing the queue";
    case CommandKind::kSimMode:
      return "changing simulation mode";
    case CommandKind::kRecoveryMode:
      return "changing recovery mode";
    case CommandKind::kBrakes:
      return "brakes control";
    case CommandKind::kDynamicData:
      return "the dynamic data request";
    case CommandKind::kSetHostTime:
      return "setting the robot's clock";
    case CommandKind::kMotion:
      return "the motion command";
  }
  return "the command";
}

// "MoveJoints" or "activation"
std::string subject(const Receipt& r) {
  if (r.kind != CommandKind::kMotion) return action_name(r.kind);
  const image::MotionCommandInfo* info = image::find_motion_command(r.motion_command_id);
  return info ? std::string(info->name) : "motion command " + std::to_string(r.motion_command_id);
}

std::string error_text(std::uint16_t code) {
  const image::ErrorInfo* info = image::find_error_code(code);
  std::string text = "error " + std::to_string(code);
  if (info) text += " (" + std::string(info->text) + ")";
  return text;
}

std::string robot_error_text(const Receipt& r) {
  const image::ErrorInfo* info = image::find_error_code(r.robot_error);
  const bool permanent = info && !info->resettable;
  return "the robot is in " + error_text(r.robot_error) +
         (permanent ? "; a reset does not clear it: " + std::string(info->remedy)
                    : "; remove its cause and reset it first");
}

struct ArgumentNames {
  std::string name, unit;
};

ArgumentNames argument_names(const Receipt& r) {
  const image::MotionCommandInfo* info =
      r.kind == CommandKind::kMotion ? image::find_motion_command(r.motion_command_id) : nullptr;
  if (info && r.argument < info->arguments.size()) {
    return {std::string(info->arguments[r.argument].name), std::string(info->arguments[r.argument].unit)};
  }
  if (r.kind == CommandKind::kDynamicData) return {r.argument == 0 ? "slot" : "type", ""};
  return {};
}

std::string bounds(const Receipt& r, const std::string& unit) {
  const std::string tail = unit.empty() ? "" : " " + unit;
  const bool low = r.minimum > -1e300, high = r.maximum < 1e300;
  if (low && high && r.minimum == r.maximum) return "only " + number(r.minimum) + tail;
  if (low && high) return number(r.minimum) + " to " + number(r.maximum) + tail;
  if (low) return number(r.minimum) + tail + " or more";
  if (high) return number(r.maximum) + tail + " or less";
  return "any finite number";
}

std::string range_text(const Receipt& r) {
  const auto [name, unit] = argument_names(r);
  std::string text = "argument " + std::to_string(r.argument + 1);
  if (!name.empty()) text += " (" + name + ")";
  text += " is " + number(r.value);
  if (!unit.empty()) text += " " + unit;
  const bool motion = r.kind == CommandKind::kMotion;
  const bool steps = motion && r.motion_command_id == image::kMoveJointsRel;
  const bool joints = motion && r.motion_command_id == image::kMoveJoints;
  const std::string who = joints || steps ? "joint " + std::to_string(r.argument + 1) : subject(r);
  text += "; " + who + " allows " + bounds(r, unit) + (steps ? " from where it stands" : "");
  if (r.motion_command_id == image::kSetCheckpoint && r.value >= kFirstOwnCheckpoint && r.value <= kLastOwnCheckpoint) {
    text += " (the numbers above are the bridge's own)";
  }
  const image::MotionCommandInfo* info =
      r.kind == CommandKind::kMotion ? image::find_motion_command(r.motion_command_id) : nullptr;
  const bool whole = !info || (r.argument < info->arguments.size() && info->arguments[r.argument].integer);
  if (whole) text += ", whole numbers";
  return text;
}

std::string count_text(const Receipt& r) {
  const auto plural = [](double n) { return number(n) + (n == 1 ? " argument" : " arguments"); };
  std::string text = subject(r) + " got " + plural(r.value) + " and takes ";
  if (r.minimum != r.maximum) return text + number(r.minimum) + " to " + plural(r.maximum);
  text += r.maximum == 0 ? "none" : plural(r.maximum);
  const image::MotionCommandInfo* info =
      r.kind == CommandKind::kMotion ? image::find_motion_command(r.motion_command_id) : nullptr;
  if (!info) return text;
  for (std::size_t i = 0; i < info->arguments.size(); ++i) {
    text += (i == 0 ? ": " : ", ") + std::string(info->arguments[i].name);
  }
  return text;
}

std::string unknown_text(const Receipt& r) {
  if (r.kind != CommandKind::kMotion) return "there is no such kind of command; CommandKind lists those there are";
  const image::MotionCommandInfo* info = image::find_motion_command(r.motion_command_id);
  if (!info) {
    return "there is no motion command " + std::to_string(r.motion_command_id) +
           "; the robot manual's table of MotionCommandID lists those there are";
  }
  const std::string name(info->name);
  if (info->command_class == image::CommandClass::kVelocity) {
    return name + " is a velocity command: send it as a VelocityCommand stream";
  }
  if (info->command_class == image::CommandClass::kOtherRobots) {
    return name + " is a command of other robots; a Meca500 does not have it, leave it out";
  }
  const std::string variables = "variables as arguments, which came with firmware 11; send numbers";
  if (info->since == image::Layout::kFirmware9) return "this robot's firmware does not know " + variables;
  return "this robot's firmware does not know " + name + ", which came with firmware " +
         std::string(image::to_string(info->since)) + ", or not " + variables;
}

// "'cell-plc' has control of the robot (priority 10, yours is 0)"
std::string owner_text(const Receipt& r) {
  std::string text = in_quotes(r.other) + " has control of the robot";
  if (r.value != 0 || r.minimum != 0) text += " (priority " + number(r.minimum) + ", yours is " + number(r.value) + ")";
  return text;
}

std::string not_owner_text(const Receipt& r) {
  switch (r.hint) {
    case ControlHint::kNone:
      break;
    case ControlHint::kTakeFirst:
      return "nobody has control of the robot, and " + subject(r) + " does not take it; take control first";
    case ControlHint::kMayTakeOver:
      return owner_text(r) + "; to take over, send TAKE_CONTROL";
    case ControlHint::kContended:
      return owner_text(r) + ", and a client of priority " + number(r.maximum) +
             " is taking over; wait until it releases control";
    case ControlHint::kWaiting:
      return owner_text(r) + " until its grace is over; wait for the receipt of your TAKE_CONTROL";
    case ControlHint::kOutranked:
      return in_quotes(r.other) + ", of higher priority, takes over instead; wait until it releases control";
  }
  if (r.other.empty()) {
    return in_quotes(r.client) + " lost control of the robot; take control again before commanding it";
  }
  return owner_text(r) + "; wait until it releases control";
}

std::string owner_lost_text(const Receipt& r) {
  if (r.kind == CommandKind::kTakeControl) {
    return "its client gave up, or did not renew its lease while the owner's grace ran; renew it while waiting";
  }
  return "its client lost or released control; take control and send it again if it is still wanted";
}

std::string not_allowed_text(const Receipt& r) {
  if (r.maximum > 0) {
    return "releasing the brakes lets the arm fall: hold the arm and send it again within " + number(r.maximum) +
           " s (with a new command id)";
  }
  return "the configuration does not allow " + subject(r) + "; control: {allow_brakes: true} of this robot would";
}

std::string not_activated_text(const Receipt& r) {
  if (r.state != ReceiptState::kRejected) return "the robot's motors went off; activate it again first";
  return "the robot is not activated; activate it first";
}

// Which stop it is, BridgeStatus says: when this is read it may be another one.
std::string safety_stop_text(const Receipt& r) {
  const std::string stop = "a safety stop is active; remove its cause, then ";
  const std::string reset = "press Reset on the power supply and activate";
  if (r.kind == CommandKind::kActivate) return stop + reset + " again";
  if (r.kind == CommandKind::kMotion && r.state == ReceiptState::kAborted) {
    return "a safety stop ended it, how far it got is not known; remove its cause, then resume (after an E-Stop: " +
           reset + ")";
  }
  return stop + "resume (after an E-Stop: " + reset + ")";
}

std::string paused_text(const Receipt& r) {
  if (r.kind == CommandKind::kResumeMotion) return "somebody paused the robot meanwhile; resume it again";
  return "motion is paused after a stop; resume it first";
}

std::string time_out_text(const Receipt& r) {
  if (r.kind == CommandKind::kMotion) {
    return r.state == ReceiptState::kDiscarded
               ? "a command before it was not acknowledged by the robot in time; it was not sent, look where the arm "
                 "is "
                 "before sending it again"
               : "the robot did not acknowledge or clear it in time; whether it took the command is not known, look "
                 "where the arm is before sending it again";
  }
  const std::string text = "the robot did not confirm it in time";
  if (r.robot_error != 0) return text + "; " + robot_error_text(r);
  if (r.kind == CommandKind::kActivate) return text + "; check E-Stop, which a Meca500 R3 does not report";
  return text + "; look at its state before trying again";
}

std::string link_lost_text(const Receipt& r) {
  return r.state == ReceiptState::kDiscarded
             ? "the link to the robot was lost before it was executed; send it again when the link is back"
             : "the link to the robot was lost; how far it got is not known, look where the arm is before sending it "
               "again";
}

std::string wrong_state_text(const Receipt& r) {
  if (r.kind == CommandKind::kSetHostTime) return "the clock of the bridge's computer is not set; set it first";
  return "the robot takes it only while it is deactivated; deactivate the robot first";
}

std::string reason_text(const Receipt& r) {
  switch (r.reason) {
    case Reason::kNone:
      return {};
    case Reason::kNotOwner:
      return not_owner_text(r);
    case Reason::kMonitoringOnly:
      return "this bridge may only monitor this robot; BridgeStatus says whether its configuration or the robot "
             "forbids more";
    case Reason::kNoLink:
      return "there is no link to the robot; the bridge keeps trying, BridgeStatus says what is missing";
    case Reason::kFirmwareUnknown:
      return "the robot's firmware is not known yet, or not the one configured; BridgeStatus says which";
    case Reason::kUnknownCommand:
      return unknown_text(r);
    case Reason::kArgumentCount:
      return count_text(r);
    case Reason::kArgumentRange:
      return range_text(r);
    case Reason::kNotActivated:
      return not_activated_text(r);
    case Reason::kNotHomed:
      return "the robot is not homed; home it first";
    case Reason::kWrongState:
      return wrong_state_text(r);
    case Reason::kRobotError:
      return robot_error_text(r);
    case Reason::kSafetyStop:
      return safety_stop_text(r);
    case Reason::kPaused:
      return paused_text(r);
    case Reason::kQueueFull:
      return "the bridge's queue is full; wait for receipts before sending more";
    case Reason::kTimeOut:
      return time_out_text(r);
    case Reason::kLinkLost:
      return link_lost_text(r);
    case Reason::kOwnerLost:
      return owner_lost_text(r);
    case Reason::kCleared:
      if (r.kind == CommandKind::kMotion && r.state == ReceiptState::kAborted) {
        return "the robot cleared its queue by itself; how far this one got is not known, look where the arm is before "
               "sending it again";
      }
      return "the motion queue was cleared; send it again if it is still wanted";
    case Reason::kNotAllowed:
      return not_allowed_text(r);
    case Reason::kShutdown:
      return "the bridge is shutting down; send it again when it is back";
    case Reason::kDuplicate:
      return "command id " + std::to_string(r.command_id) +
             " was used before, for another command or too long ago to remember; ids count up";
  }
  return {};
}

std::string state_text(const Receipt& r) {
  switch (r.state) {
    case ReceiptState::kAccepted:
      if (!r.other.empty())
        return "taking over accepted: " + in_quotes(r.other) + " keeps control until its grace is over";
      return subject(r) + " accepted";
    case ReceiptState::kSent:
      return subject(r) + " sent to the robot";
    case ReceiptState::kAcknowledged:
      return subject(r) + " taken by the robot";
    case ReceiptState::kCompleted:
      return subject(r) + " done";
    case ReceiptState::kDiscarded:
      return subject(r) + " discarded";
    case ReceiptState::kRejected:
      return subject(r) + " refused";
    case ReceiptState::kAborted:
      return subject(r) + " aborted";
  }
  return {};
}

}  // namespace

std::string describe(const Receipt& receipt) {
  const std::string reason = reason_text(receipt);
  return reason.empty() ? state_text(receipt) : state_text(receipt) + ": " + reason;
}

}  // namespace meca::control
