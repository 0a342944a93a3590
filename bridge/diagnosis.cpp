#include "bridge/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "transports/image/error_codes.hpp"
#include "transports/image/stop_signals.hpp"

namespace meca::bridge {
namespace {

using Finding = std::optional<Diagnosis>;

constexpr std::uint32_t kProductR3 = 3, kProductR4 = 4;  // dynamic data type 2

Finding because(std::string cause, std::string remedy) { return Diagnosis{false, std::move(cause), std::move(remedy)}; }

std::string version_text(const transports::FirmwareVersion& v) {
  return std::to_string(v.major) + "." + std::to_string(v.minor) + "." + std::to_string(v.patch) + "." +
         std::to_string(v.build);
}

// A firmware 9 image has no safety section: silence there does not mean that nothing is pressed.
std::string safety_caveat(const CycleRecord& record) {
  if (record.inputs.safety_status.known) return {};
  return " (safety stops are not reported by this firmware: check E-Stop and P-Stop as well)";
}

// Every stop that waits for a Resume; P-Stop 2 has bits of its own in firmware 9.
bool waits_for_resume(const image::Inputs& in, const image::StopInfo& stop) {
  const bool p_stop2 = stop.bit == &image::StopSignals::p_stop2 && in.motion_status.p_stop2;
  return stop.reset_by == image::ResetBy::kResume &&
         (p_stop2 || (in.safety_status.known && in.safety_status.stop.*stop.bit));
}
bool any_waits_for_resume(const image::Inputs& in) {
  return std::ranges::any_of(image::stop_signals(),
                             [&](const image::StopInfo& stop) { return waits_for_resume(in, stop); });
}
bool resettable(const image::Inputs& in, const image::StopInfo& stop) {
  const bool p_stop2 = stop.bit == &image::StopSignals::p_stop2;
  return in.safety_status.known ? in.safety_status.resettable.*stop.bit
                                : p_stop2 && in.motion_status.p_stop2_resettable;
}

// ---- The way to the robot

Finding monitoring_by_configuration(const CycleRecord& record) {
  if (!record.control.monitoring_only || record.inputs.robot_status.monitoring_mode) return {};
  return because("this bridge is configured to monitor this robot only",
                 "to command it from here, set control: {enabled: true} for this robot and restart the bridge");
}

Finding link(const CycleRecord& record) {
  const std::string detail = record.link_detail.empty() ? "" : ": " + std::string(record.link_detail.view());
  switch (record.link) {
    case transports::LinkState::kUp:
      break;
    case transports::LinkState::kConnecting:
      return because("connecting to the robot" + detail,
                     "wait; when it stays like this, check which fieldbus the robot has switched on, and the cables");
    case transports::LinkState::kDown: {
      // An R3 under E-Stop has no power and says nothing. Which robot it is, is asked anew with every link.
      const std::string e_stop = record.product_type == kProductR4 ? "" : " (E-Stop takes all power of a Meca500 R3)";
      return because(
          "no link to the robot" + detail,
          "check its power" + e_stop +
              ", the cables to it, and its address or position in the configuration; the bridge keeps trying");
    }
  }
  if (record.quality == Quality::kDisconnected) {
    return because("no image from the robot yet", "wait; when it stays like this, check cable and protocol");
  }
  return {};
}

Finding firmware(const CycleRecord& record) {
  if (record.firmware_mismatch) {
    const std::string reported = record.firmware_known ? " reports " + version_text(record.firmware) + " and" : "";
    return because("firmware mismatch: the robot" + reported + " is not what the configuration expects",
                   "correct 'firmware' of this robot in the configuration, or write auto, and restart the bridge");
  }
  if (record.firmware_known && record.quality != Quality::kUnknown) return {};
  return because("the robot's firmware is not known yet, so its image cannot be read with certainty",
                 "wait until the robot has reported it (dynamic data type 1); known are firmware 9, 10 and 11");
}

Finding stale_image(const CycleRecord& record) {
  if (record.quality != Quality::kStale) return {};
  return because("no fresh image from the robot: what is shown is old",
                 "check the cables and the load of network and machine; commands work again with the next image");
}

// ---- Safety

// The motors have no supply until the reset, and come on again by an activation; which a robot in error refuses.
std::string reset_and_activate(const CycleRecord& record, std::string reset) {
  return record.inputs.robot_status.error_code == 0 ? std::move(reset) + ", then 'meca-ctl activate'" : reset;
}
constexpr const char* kPressReset = "press Reset on the power supply";

Finding e_stop(const CycleRecord& record) {
  const image::SafetyStatus& safety = record.inputs.safety_status;
  const image::StopInfo& info = image::stop_info(&image::StopSignals::e_stop);
  const std::string name(info.name), release = std::string(info.remedy) + ", ";
  if (!safety.known) {
    if (!record.inputs.robot_status.e_stop) return {};
    return because(name + " is active",
                   reset_and_activate(record, release + kPressReset + std::string(" if it has that button")));
  }
  if (!safety.stop.e_stop && !record.inputs.robot_status.e_stop) {
    if (!safety.reset_ready || safety.stop.reboot || record.inputs.robot_status.activated) return {};
    return because("the power supply waits for its reset", reset_and_activate(record, kPressReset));
  }
  // Power comes back on an R3 by itself when E-Stop is released; the Reset button is the R4's.
  const std::string reset = record.product_type == kProductR3 ? "switch the power on again" : kPressReset;
  if (safety.resettable.e_stop || safety.reset_ready) {
    return because(name + " is released and waits for its reset", reset_and_activate(record, reset));
  }
  return because(name + " is active", reset_and_activate(record, release + reset));
}

// The stops beside E-Stop that only the Reset button ends. Most do not exist on the Meca500; a bit that is set is said
// all the same.
Finding stops_for_the_reset_button(const CycleRecord& record) {
  const image::SafetyStatus& safety = record.inputs.safety_status;
  if (!safety.known) return {};
  for (const image::StopInfo& stop : image::stop_signals()) {
    if (stop.reset_by != image::ResetBy::kResetButton || !(safety.stop.*stop.bit)) continue;
    const std::string name(stop.name);
    if (safety.resettable.*stop.bit) {
      return because(name + " is over and waits for its reset", reset_and_activate(record, kPressReset));
    }
    return because(name + " is active", reset_and_activate(record, std::string(stop.remedy) + ", then " + kPressReset));
  }
  return {};
}

// The stops that a Resume ends, which only an activated robot takes; nor does it home before. It takes none while the
// cause of any of them is there.
Finding stops_for_resume(const CycleRecord& record) {
  const image::StopInfo *over = nullptr, *present = nullptr;
  bool another = false;
  for (const image::StopInfo& stop : image::stop_signals()) {
    if (!waits_for_resume(record.inputs, stop)) continue;
    if (resettable(record.inputs, stop)) {
      if (over == nullptr) over = &stop;
    } else {
      another = present != nullptr;
      if (present == nullptr) present = &stop;
    }
  }
  if (present != nullptr) {
    return because(std::string(present->name) + " is active",
                   std::string(present->remedy) + (another ? "" : ", then 'meca-ctl resume'"));
  }
  if (over == nullptr) return {};
  const bool pressed = over->bit == &image::StopSignals::p_stop2;
  return because(std::string(over->name) + (pressed ? " is released" : " is over") + " and waits for its reset",
                 "'meca-ctl resume'");
}

// ---- The robot

// Resume only where the robot would take it: what else is in the way shows when the error is gone.
std::string how_to_reset(const CycleRecord& record) {
  const bool resumes = record.inputs.robot_status.activated && !any_waits_for_resume(record.inputs);
  return resumes ? "'meca-ctl reset-error' and 'meca-ctl resume'" : "'meca-ctl reset-error'";
}

Finding robot_error(const CycleRecord& record) {
  const std::uint16_t code = record.inputs.robot_status.error_code;
  if (code == 0) return {};
  const std::string number = "robot error " + std::to_string(code);
  const image::ErrorInfo* known = image::find_error_code(code);
  if (known == nullptr) {
    return because(number + ", which no document names", "read the robot's log, then try " + how_to_reset(record));
  }
  const std::string cause = number + ": " + std::string(known->text) + " (likely: " + std::string(known->cause) + ")";
  const std::string remedy = image::remedy_text(*known, how_to_reset(record));
  return because(cause, known->resettable ? remedy : remedy + "; reset-error does not clear this one");
}

// inferred: that another interface in control shows this bit too.
Finding monitoring_by_robot(const CycleRecord& record) {
  if (!record.inputs.robot_status.monitoring_mode) return {};
  return because("the robot lets this connection only monitor",
                 "end the other control connection, or enable this protocol for control in the robot's portal");
}

Finding activation(const CycleRecord& record) {
  const image::RobotStatus& status = record.inputs.robot_status;
  const image::RobotControl& control = record.outputs.robot_control;
  if (status.busy && control.deactivate)
    return because("the robot is being deactivated", "wait; then 'meca-ctl activate'");
  if (!status.activated) {
    // A robot in a P-Stop can be activated, and then resumed, but not homed before.
    const std::string home = any_waits_for_resume(record.inputs) ? "" : ", then 'meca-ctl home'";
    if (status.busy) return because("the robot is being activated", "wait until it is" + home);
    // An R3 never reports its E-Stop (spec 5.6).
    const std::string e_stop = record.product_type == kProductR3
                                   ? "release E-Stop if it is pressed (a Meca500 R3 does not report it), then "
                                   : "";
    return because("the robot is not activated: its motors are off",
                   e_stop + "'meca-ctl activate'" + home + safety_caveat(record));
  }
  const image::SafetyStatus& safety = record.inputs.safety_status;
  if (safety.known && !safety.vmotor_on && !status.sim_activated) {
    return because("the motors have no power",
                   "check the power supply, then 'meca-ctl deactivate' and 'meca-ctl activate'");
  }
  return {};
}

Finding homing(const CycleRecord& record) {
  const image::RobotStatus& status = record.inputs.robot_status;
  if (status.busy)
    return because(status.homed ? "the robot is busy" : "the robot is being homed", "wait until it is done");
  // Recovery mode exists to move, slowly, without homing.
  if (status.homed || status.recovery_mode) return {};
  return because("the robot is not homed", "keep clear of the arm, then 'meca-ctl home'");
}

// inferred: with the severity "warning" a robot may go on moving with one of these bits set; the bridge says the safer
// thing.
Finding zones(const CycleRecord& record) {
  const image::RobotStatus& status = record.inputs.robot_status;
  if (status.collision_status) {
    return because("the robot sees an imminent collision",
                   "take what is in its way out of it, or plan another path; then 'meca-ctl resume'");
  }
  if (status.work_zone_status) {
    return because("the robot is at the border of its work zone",
                   "plan a path inside the zone; then 'meca-ctl resume'");
  }
  return {};
}

// ---- Motion

std::string_view words(control::ControlState::Loss loss) {
  using Loss = control::ControlState::Loss;
  switch (loss) {
    case Loss::kNone:
      break;
    case Loss::kReleased:
      return "paused it or left it with motion queued, and released control";
    case Loss::kLeaseExpired:
      return "did not renew its lease";
    case Loss::kLinkLost:
      return "was in control when the link was lost";
    case Loss::kShutdown:
      return "was in control when the bridge was stopped";
    case Loss::kTakenOver:
      return "was in control when a client of higher priority took over";
  }
  return {};
}

Finding held_by_bridge(const CycleRecord& record) {
  const image::MotionControl& motion = record.outputs.motion_control;
  if (motion.clear_motion) {
    return because("the bridge is clearing the robot's queue (ClearMotion is set)",
                   "wait until it is done, then 'meca-ctl resume'");
  }
  if (!motion.pause_motion) return {};
  const control::ControlState& control = record.control;
  std::string cause = "the bridge holds the robot (PauseMotion is set)";
  if (!control.owned && control.last_loss != control::ControlState::Loss::kNone) {
    cause += ": '" + std::string(control.last_owner) + "' " + std::string(words(control.last_loss));
  }
  return because(std::move(cause), "'meca-ctl resume'");
}

Finding paused(const CycleRecord& record) {
  const image::MotionStatus& motion = record.inputs.motion_status;
  if (motion.paused) {
    if (motion.excessive_torque) {
      return because("motion is paused: a joint's torque exceeds its limit",
                     "free the arm or lower load and speed, then 'meca-ctl resume'");
    }
    return because(motion.cleared ? "motion is paused and the queue was cleared" : "motion is paused",
                   "'meca-ctl resume'" + safety_caveat(record));
  }
  if (motion.fifo_space == 0) {
    return because("the robot's motion queue is full", "wait until it has worked off some of it, or 'meca-ctl clear'");
  }
  return {};
}

// In the order in which a person has to remove them.
constexpr std::array kChecks{monitoring_by_configuration,
                             link,
                             firmware,
                             stale_image,
                             monitoring_by_robot,
                             e_stop,
                             stops_for_the_reset_button,
                             robot_error,
                             activation,
                             stops_for_resume,
                             homing,
                             zones,
                             held_by_bridge,
                             paused};

// While somebody has control, everybody else's commands are refused.
void name_the_owner(const control::ControlState& control, std::string& remedy) {
  if (!control.owned || remedy.find("'meca-ctl ") == std::string::npos) return;
  remedy += "; '" + std::string(control.owner) + "' has control: command from there, or let it release control first";
}

// Texts are ASCII, but for the name of an owner; a character is not cut in half.
void cut(std::string& text) {
  if (text.size() <= Diagnosis::kMaxText) return;
  std::size_t end = Diagnosis::kMaxText - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  text.replace(end, std::string::npos, "...");
}

}  // namespace

Diagnosis diagnose(const CycleRecord& record) {
  for (const auto check : kChecks) {
    if (Finding found = check(record)) {
      name_the_owner(record.control, found->remedy);
      cut(found->cause);
      cut(found->remedy);
      return *std::move(found);
    }
  }
  return {true, {}, {}};
}

}  // namespace meca::bridge
