#include "cli/format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "cli/bus_text.hpp"
#include "cli/names.hpp"
#include "transports/image/error_codes.hpp"

namespace meca::cli {
namespace {

constexpr int kQueueSize = 13000;  // manual: places in the motion queue

template <typename Text>
std::string str(const Text& text) {
  return text.c_str();
}

std::string joined(const std::vector<std::string>& words, const std::string& when_none) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? when_none : text;
}

std::string link_text(const meca500::BridgeStatus& s) {
  switch (s.link()) {
    case meca500::LinkState::LINK_UP:
      return "up";
    case meca500::LinkState::LINK_CONNECTING:
      return "connecting";
    case meca500::LinkState::LINK_DOWN:
      return "down";
  }
  return "?";
}

std::string with_detail(std::string text, const std::string& detail) {
  return detail.empty() ? text : text + ": " + detail;
}

void add_signals(const meca500::StopSignals& s, std::vector<std::string>& names) {
  if (s.e_stop()) names.emplace_back("E-Stop");
  if (s.p_stop1()) names.emplace_back("P-Stop 1");
  if (s.p_stop2()) names.emplace_back("P-Stop 2");
  if (s.operation_mode_change()) names.emplace_back("operation mode change");
  if (s.enabling_device_released()) names.emplace_back("enabling device released");
  if (s.voltage_fluctuation()) names.emplace_back("voltage fluctuation");
  if (s.reboot()) names.emplace_back("reboot");
  if (s.redundancy_fault()) names.emplace_back("redundancy fault");
  if (s.standstill_fault()) names.emplace_back("standstill fault");
  if (s.connection_dropped()) names.emplace_back("connection dropped");
  if (s.minor_error()) names.emplace_back("minor error");
}

std::string busy_text(const meca500::RobotStatus& s) {
  if (!s.activated()) return "being activated or deactivated";
  return s.homed() ? "busy" : "being homed or activated";
}

std::string motion_text(const RobotView& view) {
  if (!view.motion_status) return "activated and homed";
  const auto& motion = *view.motion_status;
  if (motion.paused()) return motion.eom() ? "paused" : "coming to a pause";
  if (!motion.eom()) return "moving";
  return motion.eob() ? "standing, nothing queued" : "standing, commands are queued";
}

meca500::Quality quality_of(const RobotView& view) {
  return view.robot_status ? view.robot_status->header().quality() : meca500::Quality::UNKNOWN;
}

std::string identity_text(const meca500::BridgeStatus& s) {
  std::string text = s.product().size() == 0 ? "product not known yet" : str(s.product());
  if (s.serial_number() != 0) text += ", serial " + std::to_string(s.serial_number());
  text += s.firmware_known() ? ", firmware " + str(s.firmware()) + " (layout " + str(s.layout()) + ")"
                             : ", firmware not known yet";
  return text + ", over " + str(s.transport());
}

std::string counters_text(const meca500::BridgeStatus& s) {
  std::ostringstream out;
  out << "cycle " << s.cycle_us() << " us; " << s.cycles() << " cycles, " << s.missed_cycles() << " missed, "
      << s.stale_cycles() << " stale, " << s.link_losses() << " link losses";
  return out.str();
}

}  // namespace

std::string fixed(double value, int width, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%*.*f", width, decimals, value);
  return text.data();
}

std::string seconds_text(std::chrono::nanoseconds time) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g s", std::chrono::duration<double>(time).count());
  return text.data();
}

std::string error_text(std::uint16_t code) {
  if (code == 0) return "none";
  const auto* info = image::find_error_code(code);
  if (info == nullptr) return std::to_string(code) + ", a code that no document names";
  const std::string number = std::to_string(code);
  return number + " " + std::string(info->name) + ": " + std::string(info->text) + "; 'meca-ctl errors " + number +
         "' explains it";
}

std::string activity(const RobotView& view) {
  if (view.bridge && view.bridge->link() != meca500::LinkState::LINK_UP) {
    const bool connecting = view.bridge->link() == meca500::LinkState::LINK_CONNECTING;
    return with_detail(connecting ? "connecting" : "not connected", str(view.bridge->link_detail()));
  }
  if (!view.robot_status) return "not known: no RobotStatus yet";
  const auto& robot = *view.robot_status;
  const auto quality = quality_of(view);
  if (quality == meca500::Quality::DISCONNECTED) return "not connected";
  if (quality == meca500::Quality::UNKNOWN) return "not known: the firmware is being asked for";
  const std::string old = quality == meca500::Quality::STALE ? " (stale: no fresh image)" : "";
  if (robot.error_code() != 0) return "in error " + std::to_string(robot.error_code()) + old;
  if (robot.busy()) return busy_text(robot) + old;
  if (!robot.activated()) return "deactivated, motors off" + old;
  if (!robot.homed() && !robot.recovery_mode()) return "activated, not homed" + old;
  return motion_text(view) + old;
}

std::string readiness(const RobotView& view, std::string_view reader) {
  if (!view.bridge) return "not known: no BridgeStatus yet";
  if (view.bridge->ready()) return "yes";
  std::string text = view.bridge->cause().size() == 0 ? "no" : "no: " + str(view.bridge->cause());
  if (view.bridge->remedy().size() != 0) text += "; " + str(view.bridge->remedy());
  const auto note = reader.empty() ? std::string::npos : text.find("; '" + std::string(reader) + "' has control");
  return text.substr(0, note);
}

std::string safety(const RobotView& view) {
  if (!view.safety) return "not known: no SafetyStatus yet";
  const auto& s = *view.safety;
  const auto quality = s.header().quality();
  if (!s.known() || quality == meca500::Quality::UNKNOWN) return "not known: the robot does not report stops";
  std::vector<std::string> raised, resettable;
  add_signals(s.stop(), raised);
  add_signals(s.resettable(), resettable);
  std::string text = joined(raised, "no stop signal");
  if (!resettable.empty()) text += "; may be reset: " + joined(resettable, "");
  text += s.vmotor_on() ? "; motor supply on" : "; motor supply off";
  if (s.reset_ready()) text += "; Reset button may be pressed";
  if (quality != meca500::Quality::GOOD) text += " (" + std::string(name(quality)) + ": last known)";
  return text;
}

namespace {
std::string with_priority(const std::string& client, std::uint32_t priority) {
  return priority == 0 ? client : client + " (priority " + std::to_string(priority) + ")";
}
}  // namespace

std::string control_text(const meca500::ControlStatus& s, std::int64_t now_ns) {
  std::string text;
  if (s.monitoring_only()) {
    text = "monitoring only";
  } else if (!s.owned()) {
    text = "free";
    if (s.last_owner().size() != 0) text += "; last " + str(s.last_owner()) + " (" + str(s.last_loss()) + ")";
  } else {
    const double seconds = std::max(0.0, static_cast<double>(now_ns - s.since_ns()) * 1e-9);
    text = with_priority(str(s.owner()), s.priority()) + " for " + fixed(seconds, 0, 0) + " s, lease " +
           std::to_string(s.lease_ms()) + " ms";
    if (s.contender().size() != 0) {
      const double left = std::max(0.0, static_cast<double>(s.contender_takes_over_ns() - now_ns) * 1e-9);
      text += "; " + with_priority(str(s.contender()), s.contender_priority()) + " takes over in " + fixed(left, 0, 1) +
              " s";
    }
  }
  if (s.last_refused().size() != 0) text += "; refused " + str(s.last_refused()) + ": " + str(s.last_refusal());
  return text;
}

std::string joints_text(const meca500::TargetJointSet& sample) {
  std::string text;
  for (const float joint : sample.joints()) text += fixed(joint, 10, 3);
  return text + "  deg";
}

std::string pose_text(const meca500::TargetEndEffectorPose& s) {
  return fixed(s.x(), 10, 3) + fixed(s.y(), 10, 3) + fixed(s.z(), 10, 3) + "  mm " + fixed(s.alpha(), 9, 3) +
         fixed(s.beta(), 10, 3) + fixed(s.gamma(), 10, 3) + "  deg";
}

std::string flags_text(const RobotView& view) {
  std::vector<std::string> flags;
  if (view.robot_status) {
    const auto& s = *view.robot_status;
    flags.emplace_back(s.activated() ? "activated" : "not activated");
    flags.emplace_back(s.homed() ? "homed" : "not homed");
    if (s.busy()) flags.emplace_back("busy");
    if (s.sim_activated()) flags.emplace_back("simulation");
    if (s.recovery_mode()) flags.emplace_back("recovery mode");
    if (s.brakes_engaged()) flags.emplace_back("brakes engaged");
    if (s.collision_status()) flags.emplace_back("collision imminent");
    if (s.work_zone_status()) flags.emplace_back("outside work zone");
    if (s.monitoring_mode()) flags.emplace_back("monitoring only");
  }
  if (view.motion_status) {
    const auto& m = *view.motion_status;
    if (m.paused()) flags.emplace_back("paused");
    if (m.cleared()) flags.emplace_back("queue cleared");
    if (m.excessive_torque()) flags.emplace_back("excessive torque");
  }
  return joined(flags, "not known");
}

std::string status_text(const std::string& robot, const RobotView& view, std::int64_t now_ns) {
  std::ostringstream out;
  out << robot;
  if (view.bridge) out << "  " << identity_text(*view.bridge);
  out << "\n  Doing    " << activity(view) << "\n  Ready    " << readiness(view) << '\n';
  if (view.bridge) {
    out << "  Link     " << with_detail(link_text(*view.bridge), str(view.bridge->link_detail())) << "; "
        << counters_text(*view.bridge) << '\n';
    const std::string bus = bus_counts_text(*view.bridge), timing = bus_timing_text(*view.bridge);
    if (!bus.empty()) out << "  Bus      " << bus << '\n';
    if (!timing.empty()) out << "  Timing   " << timing << '\n';
  }
  if (view.control) out << "  Control  " << control_text(*view.control, now_ns) << '\n';
  out << "  State    " << flags_text(view) << '\n';
  if (view.robot_status) out << "  Error    " << error_text(view.robot_status->error_code()) << '\n';
  if (view.motion_status) {
    const int waiting = std::max(0, kQueueSize - static_cast<int>(view.motion_status->fifo_space()));
    out << "  Queue    " << waiting << " waiting, " << view.motion_status->fifo_space() << " places free\n";
  }
  out << "  Safety   " << safety(view) << '\n';
  const auto quality = quality_of(view);
  if (quality != meca500::Quality::GOOD) out << "  Values   " << name(quality) << ": the last known ones\n";
  if (view.joints) out << "  Joints " << joints_text(*view.joints) << '\n';
  if (view.pose) out << "  Pose   " << pose_text(*view.pose) << '\n';
  if (view.configuration) {
    const auto& c = *view.configuration;
    out << "  Posture  shoulder " << c.shoulder() << ", elbow " << c.elbow() << ", wrist " << c.wrist() << ", turn "
        << c.turn() << '\n';
  }
  return out.str();
}

std::string receipt_text(const meca500::CommandReceipt& receipt, std::string_view title) {
  std::string state(name(receipt.state()));
  std::ranges::transform(state, state.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string text = str(receipt.robot()) + ": " + std::string(title) + ": " + state;
  if (receipt.reason() != meca500::ReceiptReason::REASON_NONE) {
    text += " (" + std::string(name(receipt.reason())) + ")";
  }
  if (receipt.text().size() != 0 && is_terminal(receipt.state())) text += ": " + str(receipt.text());
  return text;
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    if (widths.size() < row.size()) widths.resize(row.size());
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += row[i];
      if (i + 1 < row.size()) text.append(widths[i] - row[i].size() + 2, ' ');
    }
    text += '\n';
  }
  return text;
}

}  // namespace meca::cli
