#include "cli/json.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/names.hpp"

namespace meca::cli {
namespace {

// Every topic sample begins alike.
template <typename Sample>
Json head(const Sample& sample) {
  Json json;
  json["robot"] = sample.robot().c_str();
  json["header"] = to_json(sample.header());
  return json;
}

template <typename Range>
Json numbers(const Range& range) {
  Json list = Json::array();
  for (const float value : range) list.push_back(number(value));
  return list;
}

Json to_json(const meca500::StopSignals& s) {
  return {{"e_stop", s.e_stop()},
          {"p_stop1", s.p_stop1()},
          {"p_stop2", s.p_stop2()},
          {"operation_mode_change", s.operation_mode_change()},
          {"enabling_device_released", s.enabling_device_released()},
          {"voltage_fluctuation", s.voltage_fluctuation()},
          {"reboot", s.reboot()},
          {"redundancy_fault", s.redundancy_fault()},
          {"standstill_fault", s.standstill_fault()},
          {"connection_dropped", s.connection_dropped()},
          {"minor_error", s.minor_error()}};
}

Json to_json(const meca500::PowerSupplyInputs& p) {
  return {{"e_stop", p.e_stop()},
          {"p_stop1", p.p_stop1()},
          {"p_stop2", p.p_stop2()},
          {"external_reset", p.external_reset()},
          {"keypad_reset", p.keypad_reset()},
          {"enabling_device", p.enabling_device()}};
}

template <typename Sample>
Json or_null(const std::optional<Sample>& sample) {
  return sample ? cli::to_json(*sample) : Json(nullptr);
}

}  // namespace

Json number(float value) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double shortest = value;
  std::from_chars(text.data(), end, shortest);
  return shortest;
}

std::string one_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json to_json(const meca500::Header& header) {
  return {{"cycle", header.cycle()},
          {"robot_time_us", header.robot_time_us()},
          {"receive_time_ns", header.receive_time_ns()},
          {"quality", name(header.quality())}};
}

Json to_json(const meca500::RobotStatus& s) {
  Json json = head(s);
  json["busy"] = s.busy();
  json["activated"] = s.activated();
  json["homed"] = s.homed();
  json["sim_activated"] = s.sim_activated();
  json["brakes_engaged"] = s.brakes_engaged();
  json["recovery_mode"] = s.recovery_mode();
  json["e_stop"] = s.e_stop();
  json["collision_status"] = s.collision_status();
  json["work_zone_status"] = s.work_zone_status();
  json["monitoring_mode"] = s.monitoring_mode();
  json["error_code"] = s.error_code();
  return json;
}

Json to_json(const meca500::MotionStatus& s) {
  Json json = head(s);
  json["checkpoint_reached"] = s.checkpoint_reached();
  json["checkpoint_discarded"] = s.checkpoint_discarded();
  json["move_id"] = s.move_id();
  json["fifo_space"] = s.fifo_space();
  json["paused"] = s.paused();
  json["eob"] = s.eob();
  json["eom"] = s.eom();
  json["cleared"] = s.cleared();
  json["p_stop2"] = s.p_stop2();
  json["excessive_torque"] = s.excessive_torque();
  json["p_stop2_resettable"] = s.p_stop2_resettable();
  json["offline_program_id"] = s.offline_program_id();
  return json;
}

Json to_json(const meca500::TargetJointSet& s) {
  Json json = head(s);
  json["joints"] = numbers(s.joints());
  return json;
}

Json to_json(const meca500::TargetEndEffectorPose& s) {
  Json json = head(s);
  json["x"] = number(s.x());
  json["y"] = number(s.y());
  json["z"] = number(s.z());
  json["alpha"] = number(s.alpha());
  json["beta"] = number(s.beta());
  json["gamma"] = number(s.gamma());
  return json;
}

Json to_json(const meca500::TargetConfiguration& s) {
  Json json = head(s);
  json["shoulder"] = s.shoulder();
  json["elbow"] = s.elbow();
  json["wrist"] = s.wrist();
  json["turn"] = s.turn();
  return json;
}

Json to_json(const meca500::SafetyStatus& s) {
  Json json = head(s);
  json["known"] = s.known();
  json["stop"] = to_json(s.stop());
  json["resettable"] = to_json(s.resettable());
  json["operation_mode"] = s.operation_mode();
  json["reset_ready"] = s.reset_ready();
  json["vmotor_on"] = s.vmotor_on();
  json["power_supply_inputs"] = to_json(s.power_supply_inputs());
  return json;
}

Json to_json(const meca500::DynamicData& s) {
  Json json = head(s);
  json["slot"] = s.slot();
  json["type_id"] = s.type_id();
  json["type_name"] = s.type_name().c_str();
  json["values"] = Json::array();
  for (const auto& value : s.values()) {
    json["values"].push_back(
        {{"name", value.name().c_str()}, {"unit", value.unit().c_str()}, {"value", value.value()}});
  }
  json["raw"] = numbers(s.raw());
  return json;
}

Json to_json(const meca500::BridgeStatus& s) {
  Json counters = Json::object();
  for (const auto& counter : s.transport_counters()) {
    const std::string unit = counter.unit().c_str();
    counters[counter.name().c_str() + (unit.empty() ? "" : "_" + unit)] = counter.value();
  }
  return {{"robot", s.robot().c_str()},
          {"time_ns", s.time_ns()},
          {"bridge_version", s.bridge_version().c_str()},
          {"transport", s.transport().c_str()},
          {"link", name(s.link())},
          {"link_detail", s.link_detail().c_str()},
          {"firmware_known", s.firmware_known()},
          {"firmware", s.firmware().c_str()},
          {"layout", s.layout().c_str()},
          {"product", s.product().c_str()},
          {"serial_number", s.serial_number()},
          {"ready", s.ready()},
          {"cause", s.cause().c_str()},
          {"remedy", s.remedy().c_str()},
          {"cycle_us", s.cycle_us()},
          {"cycles", s.cycles()},
          {"missed_cycles", s.missed_cycles()},
          {"fresh_images", s.fresh_images()},
          {"stale_cycles", s.stale_cycles()},
          {"link_losses", s.link_losses()},
          {"wakeup_lateness_max_us", s.wakeup_lateness_max_us()},
          {"wakeup_lateness_mean_us", s.wakeup_lateness_mean_us()},
          {"records_dropped", s.records_dropped()},
          {"commands_received", s.commands_received()},
          {"commands_rejected", s.commands_rejected()},
          {"transport_counters", std::move(counters)}};
}

Json to_json(const meca500::ControlStatus& s) {
  return {{"robot", s.robot().c_str()},
          {"owned", s.owned()},
          {"owner", s.owner().c_str()},
          {"owner_participant", s.owner_participant().c_str()},
          {"since_ns", s.since_ns()},
          {"priority", s.priority()},
          {"lease_ms", s.lease_ms()},
          {"on_loss", name(s.on_loss())},
          {"contender", s.contender().c_str()},
          {"contender_priority", s.contender_priority()},
          {"contender_takes_over_ns", s.contender_takes_over_ns()},
          {"monitoring_only", s.monitoring_only()},
          {"last_refused", s.last_refused().c_str()},
          {"last_refusal", s.last_refusal().c_str()},
          {"last_owner", s.last_owner().c_str()},
          {"last_loss", s.last_loss().c_str()},
          {"last_renewal_ns", s.last_renewal_ns()}};
}

Json to_json(const meca500::CommandReceipt& s) {
  return {{"robot", s.robot().c_str()},
          {"client", s.client().c_str()},
          {"command_id", s.command_id()},
          {"state", name(s.state())},
          {"reason", name(s.reason())},
          {"text", s.text().c_str()},
          {"robot_error_code", s.robot_error_code()},
          {"cycle", s.cycle()},
          {"time_ns", s.time_ns()}};
}

Json to_json(const std::string& robot, const RobotView& view) {
  Json json;
  json["robot"] = robot;
  json["bridge_status"] = or_null(view.bridge);
  json["control_status"] = or_null(view.control);
  json["robot_status"] = or_null(view.robot_status);
  json["motion_status"] = or_null(view.motion_status);
  json["target_joint_set"] = or_null(view.joints);
  json["target_end_effector_pose"] = or_null(view.pose);
  json["target_configuration"] = or_null(view.configuration);
  json["safety_status"] = or_null(view.safety);
  json["dynamic_data"] = Json::array();
  for (const auto& [type, sample] : view.dynamic_data) json["dynamic_data"].push_back(cli::to_json(sample));
  return json;
}

}  // namespace meca::cli
