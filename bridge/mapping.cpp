#include "bridge/mapping.hpp"

#include <algorithm>
#include <cstdio>

#include "bridge/control/receipt_text.hpp"
#include "transports/image/dynamic_data_types.hpp"

namespace meca::bridge {
namespace {

template <typename Sample>
void fill_pose(const image::Pose& pose, Sample& sample) {
  sample.x(pose.x);
  sample.y(pose.y);
  sample.z(pose.z);
  sample.alpha(pose.alpha);
  sample.beta(pose.beta);
  sample.gamma(pose.gamma);
}

void fill_stops(const image::StopSignals& stops, meca500::StopSignals& sample) {
  sample.e_stop(stops.e_stop);
  sample.p_stop1(stops.p_stop1);
  sample.p_stop2(stops.p_stop2);
  sample.operation_mode_change(stops.operation_mode_change);
  sample.enabling_device_released(stops.enabling_device_released);
  sample.voltage_fluctuation(stops.voltage_fluctuation);
  sample.reboot(stops.reboot);
  sample.redundancy_fault(stops.redundancy_fault);
  sample.standstill_fault(stops.standstill_fault);
  sample.connection_dropped(stops.connection_dropped);
  sample.minor_error(stops.minor_error);
}

template <typename Sample>
void set_common(Sample& sample, std::string_view robot, const meca500::Header& header) {
  set_text(sample.robot(), robot);
  sample.header(header);
}

// Product types of dynamic data type 2.
std::string product_name(std::uint32_t type) {
  switch (type) {
    case 0:
      return "";
    case 3:
      return "Meca500 R3";
    case 4:
      return "Meca500 R4";
    default:
      return "product type " + std::to_string(type);
  }
}

std::string_view loss_name(control::ControlState::Loss loss) {
  using Loss = control::ControlState::Loss;
  switch (loss) {
    case Loss::kNone:
      return "";
    case Loss::kReleased:
      return "released";
    case Loss::kLeaseExpired:
      return "lease expired";
    case Loss::kLinkLost:
      return "link lost";
    case Loss::kShutdown:
      return "the bridge is stopping";
    case Loss::kTakenOver:
      return "taken over";
  }
  return "";
}

meca500::LossPolicy to_idl(control::LossPolicy policy) {
  return policy == control::LossPolicy::kFinishMotion ? meca500::LossPolicy::FINISH_MOTION
                                                      : meca500::LossPolicy::STOP_MOTION;
}

}  // namespace

meca500::Quality to_idl(Quality quality) noexcept {
  switch (quality) {
    case Quality::kUnknown:
      return meca500::Quality::UNKNOWN;
    case Quality::kGood:
      return meca500::Quality::GOOD;
    case Quality::kStale:
      return meca500::Quality::STALE;
    case Quality::kDisconnected:
      return meca500::Quality::DISCONNECTED;
  }
  return meca500::Quality::UNKNOWN;
}

meca500::LinkState to_idl(transports::LinkState link) noexcept {
  switch (link) {
    case transports::LinkState::kDown:
      return meca500::LinkState::LINK_DOWN;
    case transports::LinkState::kConnecting:
      return meca500::LinkState::LINK_CONNECTING;
    case transports::LinkState::kUp:
      return meca500::LinkState::LINK_UP;
  }
  return meca500::LinkState::LINK_DOWN;
}

void fill_header(const CycleRecord& record, meca500::Header& header) {
  const auto& time = record.inputs.robot_timestamp;
  header.cycle(record.cycle);
  header.robot_time_us(std::uint64_t{time.seconds} * 1'000'000 + time.microseconds);
  header.receive_time_ns(record.receive_unix_ns);
  header.quality(to_idl(record.quality));
}

void fill(const image::RobotStatus& section, meca500::RobotStatus& sample) {
  sample.busy(section.busy);
  sample.activated(section.activated);
  sample.homed(section.homed);
  sample.sim_activated(section.sim_activated);
  sample.brakes_engaged(section.brakes_engaged);
  sample.recovery_mode(section.recovery_mode);
  sample.e_stop(section.e_stop);
  sample.collision_status(section.collision_status);
  sample.work_zone_status(section.work_zone_status);
  sample.monitoring_mode(section.monitoring_mode);
  sample.error_code(section.error_code);
}

void fill(const image::MotionStatus& section, meca500::MotionStatus& sample) {
  sample.checkpoint_reached(section.checkpoint_reached);
  sample.checkpoint_discarded(section.checkpoint_discarded);
  sample.move_id(section.move_id);
  sample.fifo_space(section.fifo_space);
  sample.paused(section.paused);
  sample.eob(section.eob);
  sample.eom(section.eom);
  sample.cleared(section.cleared);
  sample.p_stop2(section.p_stop2);
  sample.excessive_torque(section.excessive_torque);
  sample.p_stop2_resettable(section.p_stop2_resettable);
  sample.offline_program_id(section.offline_program_id);
}

void fill(const image::TargetJointSet& section, meca500::TargetJointSet& sample) { sample.joints(section.joints); }

void fill(const image::Pose& section, meca500::TargetEndEffectorPose& sample) { fill_pose(section, sample); }
void fill(const image::Pose& section, meca500::TargetWrf& sample) { fill_pose(section, sample); }
void fill(const image::Pose& section, meca500::TargetTrf& sample) { fill_pose(section, sample); }

void fill(const image::TargetConfiguration& section, meca500::TargetConfiguration& sample) {
  sample.shoulder(section.shoulder);
  sample.elbow(section.elbow);
  sample.wrist(section.wrist);
  sample.turn(section.turn);
}

void fill(const image::RobotTimestamp& section, meca500::RobotTimestamp& sample) {
  sample.seconds(section.seconds);
  sample.microseconds(section.microseconds);
  sample.dynamic_data_update_count(section.dynamic_data_update_count);
}

void fill(const image::SafetyStatus& section, meca500::SafetyStatus& sample) {
  sample.known(section.known);
  fill_stops(section.stop, sample.stop());
  fill_stops(section.resettable, sample.resettable());
  sample.operation_mode(section.operation_mode);
  sample.reset_ready(section.reset_ready);
  sample.vmotor_on(section.vmotor_on);
  auto& inputs = sample.power_supply_inputs();
  inputs.e_stop(section.power_supply_inputs.e_stop);
  inputs.p_stop1(section.power_supply_inputs.p_stop1);
  inputs.p_stop2(section.power_supply_inputs.p_stop2);
  inputs.external_reset(section.power_supply_inputs.external_reset);
  inputs.keypad_reset(section.power_supply_inputs.keypad_reset);
  inputs.enabling_device(section.power_supply_inputs.enabling_device);
}

void fill(const image::RobotControl& section, meca500::RobotControl& sample) {
  sample.deactivate(section.deactivate);
  sample.activate(section.activate);
  sample.home_robot(section.home);
  sample.reset_error(section.reset_error);
  sample.sim_mode(section.sim_mode);
  sample.recovery_mode(section.recovery_mode);
  sample.disable_ethercat(section.disable_ethercat);
}

void fill(const image::MotionControl& section, meca500::MotionControl& sample) {
  sample.move_id(section.move_id);
  sample.set_point(section.set_point);
  sample.pause_motion(section.pause_motion);
  sample.clear_motion(section.clear_motion);
  sample.resume_motion(section.resume_motion);
  sample.use_variables(section.use_variables);
}

void fill(const image::MotionCommand& section, meca500::MotionCommand& sample) {
  sample.motion_command_id(section.command_id);
  sample.arguments(section.arguments);
}

void fill(const image::HostTime& section, meca500::HostTime& sample) { sample.seconds(section.seconds); }

void fill(const image::BrakesControl& section, meca500::BrakesControl& sample) {
  sample.brakes_control_allowed(section.brakes_control_allowed);
  sample.brakes_engaged(section.brakes_engaged);
}

void fill(const image::DynamicDataConfiguration& section, meca500::DynamicDataConfiguration& sample) {
  sample.type_ids(section.type_ids);
}

void fill(const image::DynamicData& data, std::uint8_t slot, image::Layout layout, meca500::DynamicData& sample) {
  sample.slot(slot);
  sample.type_id(data.type_id);
  sample.raw(data.values);
  const auto* info = image::find_dynamic_data_type(data.type_id, layout);
  set_text(sample.type_name(), info != nullptr ? info->name : std::string_view{});
  auto& values = sample.values();
  values.resize(info != nullptr ? std::min(info->values.size(), data.values.size()) : 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    set_text(values[i].name(), info->values[i].name);
    set_text(values[i].unit(), info->values[i].unit);
    values[i].value(image::dynamic_value(info->values[i], data.values[i]));
  }
}

void fill(std::string_view robot, const CycleRecord& record, meca500::CyclicState& sample) {
  const auto& inputs = record.inputs;
  set_text(sample.robot(), robot);
  fill_header(record, sample.header());
  const auto section = [&](const auto& from, auto& to) {
    set_common(to, robot, sample.header());
    fill(from, to);
  };
  section(inputs.robot_status, sample.robot_status());
  section(inputs.motion_status, sample.motion_status());
  section(inputs.target_joint_set, sample.target_joint_set());
  section(inputs.target_end_effector_pose, sample.target_end_effector_pose());
  section(inputs.target_configuration, sample.target_configuration());
  section(inputs.target_wrf, sample.target_wrf());
  section(inputs.target_trf, sample.target_trf());
  section(inputs.robot_timestamp, sample.robot_timestamp());
  section(inputs.safety_status, sample.safety_status());
  for (std::uint8_t slot = 0; slot < image::kDynamicSlots; ++slot) {
    auto& to = sample.dynamic_data()[slot];
    set_common(to, robot, sample.header());
    fill(inputs.dynamic_data[slot], slot, record.layout, to);
  }
}

void fill(const control::ControlState& state, meca500::ControlStatus& sample) {
  sample.owned(state.owned);
  set_text(sample.owner(), state.owner);
  set_text(sample.owner_participant(), state.owned ? to_string(state.owner_participant) : std::string{});
  sample.since_ns(state.since_unix_ns);
  sample.priority(state.priority);
  sample.lease_ms(state.lease_ms);
  sample.on_loss(to_idl(state.on_loss));
  set_text(sample.contender(), state.contender);
  sample.contender_priority(state.contender_priority);
  sample.contender_takes_over_ns(state.contender_takes_over_unix_ns);
  sample.monitoring_only(state.monitoring_only);
  const bool refused = !state.last_refusal.client.empty();
  set_text(sample.last_refused(), state.last_refusal.client);
  set_text(sample.last_refusal(), refused ? control::describe(state.last_refusal) : std::string{});
  set_text(sample.last_owner(), state.last_owner);
  set_text(sample.last_loss(), loss_name(state.last_loss));
  sample.last_renewal_ns(state.last_renewal_unix_ns);
}

void fill(const CycleRecord& record, const Diagnosis& diagnosis, const StatusFacts& facts,
          meca500::BridgeStatus& sample) {
  sample.time_ns(facts.unix_ns);
  set_text(sample.bridge_version(), MECA_VERSION);
  set_text(sample.transport(), facts.transport);
  sample.link(to_idl(record.link));
  set_text(sample.link_detail(), record.link_detail);
  sample.firmware_known(record.firmware_known);
  set_text(sample.firmware(), record.firmware_known ? to_string(record.firmware) : std::string{});
  set_text(sample.layout(), record.firmware_known ? image::to_string(record.layout) : std::string_view{});
  set_text(sample.product(), product_name(record.product_type));
  sample.serial_number(record.serial_number);
  sample.ready(diagnosis.ready);
  set_text(sample.cause(), diagnosis.cause);
  set_text(sample.remedy(), diagnosis.remedy);
  sample.cycle_us(static_cast<std::uint32_t>(facts.cycle.count() / 1000));
  sample.cycles(record.cycle);
  sample.missed_cycles(facts.missed_cycles);
  sample.fresh_images(record.counters.fresh_images);
  sample.stale_cycles(record.counters.stale_cycles);
  sample.link_losses(record.counters.link_losses);
  sample.wakeup_lateness_max_us(facts.wakeup_lateness_max_us);
  sample.wakeup_lateness_mean_us(facts.wakeup_lateness_mean_us);
  sample.records_dropped(facts.records_dropped);
  sample.commands_received(record.counters.commands_received);
  sample.commands_rejected(record.counters.commands_rejected);
  sample.transport_counters().resize(facts.counters.size());
  for (std::size_t i = 0; i < facts.counters.size(); ++i) {
    meca500::TransportCounter& counter = sample.transport_counters()[i];
    set_text(counter.name(), facts.counters[i].name);
    set_text(counter.unit(), facts.counters[i].unit);
    counter.value(record.transport_counters[i]);
  }
}

std::string to_string(const control::ParticipantId& id) {
  std::string text;
  for (const std::byte b : id) {
    char hex[4];
    std::snprintf(hex, sizeof hex, "%02x", std::to_integer<unsigned>(b));
    text += (text.empty() ? "" : ".") + std::string(hex);
  }
  return text;
}

std::string to_string(const transports::FirmwareVersion& version) {
  return std::to_string(version.major) + "." + std::to_string(version.minor) + "." + std::to_string(version.patch) +
         "." + std::to_string(version.build);
}

bool is_presentable(std::string_view name) noexcept {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f;
  });
}

}  // namespace meca::bridge
