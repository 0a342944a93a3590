#include "bridge/robot_publisher.hpp"

#include "bridge/diagnosis.hpp"
#include "bridge/topics.hpp"

namespace meca::bridge {
namespace {

// A receipt is for the client that waits for it now; kept for ever, those of clients long gone would fill the memory.
constexpr auto kReceiptLifespan = std::chrono::minutes(10);

TopicConfig config_of(const DdsConfig& config, std::string_view name) {
  if (const auto found = config.topics.find(std::string(name)); found != config.topics.end()) return found->second;
  for (const auto& topic : kTopics) {
    if (topic.name == name) return topic.defaults;
  }
  return {};
}

dds::Qos qos_of(const TopicConfig& config) {
  return {.reliability = config.reliable ? dds::Reliability::kReliable : dds::Reliability::kBestEffort,
          .durability = config.transient_local ? dds::Durability::kTransientLocal : dds::Durability::kVolatile,
          .depth = config.depth};
}

template <typename Sample>
void open(dds::Participant& participant, const DdsConfig& config, std::string_view name, Topic<Sample>& topic,
          std::chrono::nanoseconds lifespan = {}) {
  topic.config = config_of(config, name);
  if (topic.config.rate == RateKind::kOff) return;
  dds::Qos qos = qos_of(topic.config);
  qos.lifespan = lifespan;
  topic.writer = participant.create_writer<Sample>(config.topic_prefix + std::string(name), qos);
}

}  // namespace

Topics::Topics(dds::Participant& p, const DdsConfig& c) {
  open(p, c, "RobotStatus", robot_status);
  open(p, c, "MotionStatus", motion_status);
  open(p, c, "TargetJointSet", target_joint_set);
  open(p, c, "TargetEndEffectorPose", target_end_effector_pose);
  open(p, c, "TargetConfiguration", target_configuration);
  open(p, c, "TargetWrf", target_wrf);
  open(p, c, "TargetTrf", target_trf);
  open(p, c, "RobotTimestamp", robot_timestamp);
  open(p, c, "SafetyStatus", safety_status);
  open(p, c, "DynamicData", dynamic_data);
  open(p, c, "CyclicState", cyclic_state);
  open(p, c, "RobotControl", robot_control);
  open(p, c, "MotionControl", motion_control);
  open(p, c, "MotionCommand", motion_command);
  open(p, c, "HostTime", host_time);
  open(p, c, "BrakesControl", brakes_control);
  open(p, c, "DynamicDataConfiguration", dynamic_data_configuration);
  open(p, c, "BridgeStatus", bridge_status);
  open(p, c, "ControlStatus", control_status);
  open(p, c, "CommandReceipt", command_receipt, kReceiptLifespan);
}

RobotPublisher::RobotPublisher(std::string_view robot, Time cycle, Topics& topics)
    : topics_(topics), robot_(robot), cycle_(cycle) {
  const auto name = [&](auto&... samples) { (set_text(samples.robot(), robot), ...); };
  name(robot_status_.sample, motion_status_.sample, target_joint_set_.sample, target_end_effector_pose_.sample,
       target_configuration_.sample, target_wrf_.sample, target_trf_.sample, robot_timestamp_.sample,
       safety_status_.sample, robot_control_.sample, motion_control_.sample, motion_command_.sample, host_time_.sample,
       brakes_control_.sample, dynamic_data_configuration_.sample, dynamic_sample_, cyclic_state_sample_,
       control_sample_, status_sample_);
  dynamic_sample_.values().reserve(6);
}

template <typename Section, typename Sample>
void RobotPublisher::publish(Stream<Section, Sample>& stream, Topic<Sample>& topic, const Section& section,
                             const CycleRecord& record) {
  if (!topic.writer || !stream.track.offer(topic.config, section, record.quality, now_)) return;
  fill_header(record, stream.sample.header());
  fill(section, stream.sample);
  refused_ += !topic.writer.write(stream.sample);
}

void RobotPublisher::publish(const CycleRecord& record, const StatusFacts& facts) {
  now_ = cycle_ * static_cast<Time::rep>(record.cycle);
  publish_inputs(record);
  publish_dynamic_data(record);
  publish_outputs(record);
  publish_status(record, facts);
}

void RobotPublisher::publish_inputs(const CycleRecord& record) {
  const auto& inputs = record.inputs;
  publish(robot_status_, topics_.robot_status, inputs.robot_status, record);
  publish(motion_status_, topics_.motion_status, inputs.motion_status, record);
  publish(target_joint_set_, topics_.target_joint_set, inputs.target_joint_set, record);
  publish(target_end_effector_pose_, topics_.target_end_effector_pose, inputs.target_end_effector_pose, record);
  publish(target_configuration_, topics_.target_configuration, inputs.target_configuration, record);
  publish(target_wrf_, topics_.target_wrf, inputs.target_wrf, record);
  publish(target_trf_, topics_.target_trf, inputs.target_trf, record);
  publish(robot_timestamp_, topics_.robot_timestamp, inputs.robot_timestamp, record);
  publish(safety_status_, topics_.safety_status, inputs.safety_status, record);

  auto& whole = topics_.cyclic_state;
  if (whole.writer && cyclic_state_track_.offer(whole.config, inputs, record.quality, now_)) {
    fill(robot_, record, cyclic_state_sample_);
    refused_ += !whole.writer.write(cyclic_state_sample_);
  }
}

void RobotPublisher::publish_outputs(const CycleRecord& record) {
  const auto& outputs = record.outputs;
  publish(robot_control_, topics_.robot_control, outputs.robot_control, record);
  publish(motion_control_, topics_.motion_control, outputs.motion_control, record);
  publish(motion_command_, topics_.motion_command, outputs.motion_command, record);
  publish(host_time_, topics_.host_time, outputs.host_time, record);
  publish(brakes_control_, topics_.brakes_control, outputs.brakes_control, record);
  publish(dynamic_data_configuration_, topics_.dynamic_data_configuration, outputs.dynamic_data_configuration, record);
}

void RobotPublisher::publish_dynamic_data(const CycleRecord& record) {
  auto& topic = topics_.dynamic_data;
  if (!topic.writer) return;
  for (std::uint8_t slot = 0; slot < image::kDynamicSlots; ++slot) {
    const auto& data = record.inputs.dynamic_data[slot];
    const bool automatic = record.outputs.dynamic_data_configuration.type_ids[slot] == 0U;
    if (!dynamic_tracks_[slot].offer(topic.config, data, automatic, record.quality, now_)) continue;
    fill_header(record, dynamic_sample_.header());
    fill(data, slot, record.layout, dynamic_sample_);
    refused_ += !topic.writer.write(dynamic_sample_);
  }
}

void RobotPublisher::publish_status(const CycleRecord& record, const StatusFacts& facts) {
  auto& control = topics_.control_status;
  // Its quality would be that of the robot's data; who owns the robot is always known.
  if (control.writer && control_track_.offer(control.config, record.control, Quality::kGood, now_)) {
    fill(record.control, control_sample_);
    refused_ += !control.writer.write(control_sample_);
  }
  auto& status = topics_.bridge_status;
  if (!status.writer) return;
  // The sentences cost some microseconds: only a topic that is published on change has to make them every cycle.
  Diagnosis diagnosis;
  const bool on_change = status.config.rate == RateKind::kOnChange;
  if (on_change) diagnosis = diagnose(record);
  if (!status_track_.offer(status.config, diagnosis, record.quality, now_)) return;
  if (!on_change) diagnosis = diagnose(record);
  fill(record, diagnosis, facts, status_sample_);
  refused_ += !status.writer.write(status_sample_);
}

}  // namespace meca::bridge
