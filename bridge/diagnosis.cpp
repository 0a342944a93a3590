#include "bridge/diagnosis.hpp"

#include <array>
#include <optional>

#include "transports/image/error_codes.hpp"

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

// ---- The way to the robot

Finding monitoring_by_configuration(const CycleRecord& record) {
  if (!record.control.monitoring_only || record.inputs.robot_status.monitoring_mode) return {};
  return because("this bridge is configured to monitor this robot only",
                 "to command it from here, set control: {enabled: true} for this robot and restart the bridge");
}

Finding link(const CycleRecord& record) {
  const std::string detail = record.link_detail.empty() ? "" : ": " + std::string(record.link_detail);
  switch (record.link) {
    case transports::LinkState::kUp:
      break;
    case transports::LinkState::kConnecting:
      return because("connecting to the robot" + detail, "wait; when it stays like this, check address and protocol");
    case transports::LinkState::kDown: {
      // An R3 under E-Stop has no power and says nothing; with the product unknown that is possible too.
      const std::string e_stop =
          record.product_type == kProductR4 ? "" : "; a Meca500 R3 in E-Stop has no power at all";
      return because("no link to the robot" + detail,
                     "check its power, the cable and the address; the bridge keeps trying" + e_stop);
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
                 "check cable and network load; commands work again with the next image");
}

// ---- Safety

Finding e_stop(const CycleRecord& record) {
  const image::SafetyStatus& safety = record.inputs.safety_status;
  const std::string activate = ", then 'meca-ctl activate'";
  if (!safety.known) {
    if (!record.inputs.robot_status.e_stop) return {};
    return because("E-Stop is active", "release it, press Reset on the power supply if it has that button" + activate);
  }
  if (!safety.stop.e_stop && !record.inputs.robot_status.e_stop) {
    if (!safety.reset_ready || record.inputs.robot_status.activated) return {};
    return because("the power supply waits for its reset", "press Reset on the power supply" + activate);
  }
  // Power comes back on an R3 by itself when E-Stop is released; the Reset button is the R4's.
  const std::string reset =
      record.product_type == kProductR3 ? "switch the power on again" : "press Reset on the power supply";
  if (safety.resettable.e_stop || safety.reset_ready) {
    return because("E-Stop is released and waits for its reset", reset + activate);
  }
  return because("E-Stop is active", "release it, " + reset + activate);
}

// The stops beside E-Stop and P-Stop 2. Most do not exist on the Meca500; a bit that is set is said all the same.
// inferred: the remedies, from the names; the manual describes none of these stops for the Meca500.
struct OtherStop {
  bool image::StopSignals::*bit;
  std::string_view name;
  std::string_view while_present;
  std::string_view when_resettable;
};
constexpr std::string_view kReset = "press Reset on the power supply, then 'meca-ctl activate'";
constexpr std::string_view kResume = "'meca-ctl resume'";
constexpr std::array kOtherStops{
    OtherStop{&image::StopSignals::p_stop1, "P-Stop 1", "release it, then reset", kReset},
    OtherStop{&image::StopSignals::voltage_fluctuation, "a voltage fluctuation stop", "check the mains supply", kReset},
    OtherStop{&image::StopSignals::redundancy_fault, "a redundancy fault of the safety inputs",
              "check the wiring of both safety channels", kReset},
    OtherStop{&image::StopSignals::standstill_fault, "a standstill fault", "find what moved the arm", kReset},
    OtherStop{&image::StopSignals::reboot, "the stop after a reboot", "wait until the robot has started", kReset},
    OtherStop{&image::StopSignals::operation_mode_change, "the stop after a change of operation mode",
              "finish changing the mode", kReset},
    OtherStop{&image::StopSignals::enabling_device_released, "the enabling device (released)",
              "hold it in its middle position", kResume},
    OtherStop{&image::StopSignals::connection_dropped, "a stop because the robot lost a control connection",
              "restore that connection or let its program end", kResume},
    OtherStop{&image::StopSignals::minor_error, "a minor error of the power supply", "read the robot's log", kReset},
};

Finding other_stops(const CycleRecord& record) {
  const image::SafetyStatus& safety = record.inputs.safety_status;
  if (!safety.known) return {};
  for (const OtherStop& stop : kOtherStops) {
    if (!(safety.stop.*stop.bit)) continue;
    const std::string name(stop.name);
    if (safety.resettable.*stop.bit)
      return because(name + " is over and waits for its reset", std::string(stop.when_resettable));
    return because(name + " is active",
                   std::string(stop.while_present) + ", then " + std::string(stop.when_resettable));
  }
  return {};
}

Finding p_stop2(const CycleRecord& record) {
  const image::SafetyStatus& safety = record.inputs.safety_status;
  const image::MotionStatus& motion = record.inputs.motion_status;
  const bool stopped = safety.known ? safety.stop.p_stop2 || motion.p_stop2 : motion.p_stop2;
  const bool resettable = safety.known ? safety.resettable.p_stop2 : motion.p_stop2_resettable;
  if (!stopped) return {};
  if (resettable) return because("P-Stop 2 is released and waits for its reset", "'meca-ctl resume'");
  return because("P-Stop 2 is active", "release it, then 'meca-ctl resume'");
}

// ---- The robot

Finding robot_error(const CycleRecord& record) {
  const std::uint16_t code = record.inputs.robot_status.error_code;
  if (code == 0) return {};
  const std::string number = "robot error " + std::to_string(code);
  const image::ErrorInfo* known = image::find_error_code(code);
  if (known == nullptr) {
    return because(number + ", which no document names", "read the robot's log, then try 'meca-ctl reset-error'");
  }
  const std::string remedy(known->remedy);
  return because(number + ": " + std::string(known->text) + " (likely: " + std::string(known->cause) + ")",
                 known->resettable ? remedy + "; then 'meca-ctl reset-error' and 'meca-ctl resume'"
                                   : remedy + "; reset-error does not clear this one");
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
    if (status.busy) return because("the robot is being activated", "wait until it is, then 'meca-ctl home'");
    return because("the robot is not activated: its motors are off",
                   "'meca-ctl activate', then 'meca-ctl home'" + safety_caveat(record));
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
constexpr std::array<Finding (*)(const CycleRecord&), 14> kChecks{
    monitoring_by_configuration, link,       firmware, stale_image, e_stop, other_stops,    robot_error,
    monitoring_by_robot,         activation, homing,   p_stop2,     zones,  held_by_bridge, paused};

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
      cut(found->cause);
      cut(found->remedy);
      return *std::move(found);
    }
  }
  return {true, {}, {}};
}

}  // namespace meca::bridge
