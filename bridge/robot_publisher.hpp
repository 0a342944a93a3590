// Everything one robot publishes: takes its cycle records one by one and writes what the rate of each topic asks for.
// Lives on the publisher thread.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "bridge/config.hpp"
#include "bridge/cycle.hpp"
#include "bridge/dds.hpp"
#include "bridge/mapping.hpp"
#include "bridge/track.hpp"
#include "idl/types.hpp"

namespace meca::bridge {

// A topic with its writer and rate; the writer is empty when the topic is off.
template <typename Sample>
struct Topic {
  dds::Writer<Sample> writer;
  TopicConfig config;
};

// The writers of all published topics, shared by all robots: a robot is an instance, not a topic.
struct Topics {
  Topics(dds::Participant& participant, const DdsConfig& config);  // throws dds::Error

  Topic<meca500::RobotStatus> robot_status;
  Topic<meca500::MotionStatus> motion_status;
  Topic<meca500::TargetJointSet> target_joint_set;
  Topic<meca500::TargetEndEffectorPose> target_end_effector_pose;
  Topic<meca500::TargetConfiguration> target_configuration;
  Topic<meca500::TargetWrf> target_wrf;
  Topic<meca500::TargetTrf> target_trf;
  Topic<meca500::RobotTimestamp> robot_timestamp;
  Topic<meca500::SafetyStatus> safety_status;
  Topic<meca500::DynamicData> dynamic_data;
  Topic<meca500::CyclicState> cyclic_state;
  Topic<meca500::RobotControl> robot_control;
  Topic<meca500::MotionControl> motion_control;
  Topic<meca500::MotionCommand> motion_command;
  Topic<meca500::HostTime> host_time;
  Topic<meca500::BrakesControl> brakes_control;
  Topic<meca500::DynamicDataConfiguration> dynamic_data_configuration;
  Topic<meca500::BridgeStatus> bridge_status;
  Topic<meca500::ControlStatus> control_status;
  Topic<meca500::CommandReceipt> command_receipt;
};

class RobotPublisher {
 public:
  RobotPublisher(std::string_view robot, Time cycle, Topics& topics);

  void publish(const CycleRecord& record, const StatusFacts& facts);

  std::uint64_t refused_writes() const noexcept { return refused_; }  // by the middleware, since the start

 private:
  template <typename Section, typename Sample>
  struct Stream {
    Track<Section> track;
    Sample sample;
  };

  template <typename Section, typename Sample>
  void publish(Stream<Section, Sample>& stream, Topic<Sample>& topic, const Section& section,
               const CycleRecord& record);
  void publish_inputs(const CycleRecord& record);
  void publish_outputs(const CycleRecord& record);
  void publish_dynamic_data(const CycleRecord& record);
  void publish_status(const CycleRecord& record, const StatusFacts& facts);

  Topics& topics_;
  std::string robot_;
  Time cycle_;
  Time now_{};  // bus time of the record at hand: its cycle number times the cycle
  std::uint64_t refused_ = 0;

  Stream<image::RobotStatus, meca500::RobotStatus> robot_status_;
  Stream<image::MotionStatus, meca500::MotionStatus> motion_status_;
  Stream<image::TargetJointSet, meca500::TargetJointSet> target_joint_set_;
  Stream<image::Pose, meca500::TargetEndEffectorPose> target_end_effector_pose_;
  Stream<image::TargetConfiguration, meca500::TargetConfiguration> target_configuration_;
  Stream<image::Pose, meca500::TargetWrf> target_wrf_;
  Stream<image::Pose, meca500::TargetTrf> target_trf_;
  Stream<image::RobotTimestamp, meca500::RobotTimestamp> robot_timestamp_;
  Stream<image::SafetyStatus, meca500::SafetyStatus> safety_status_;
  Stream<image::RobotControl, meca500::RobotControl> robot_control_;
  Stream<image::MotionControl, meca500::MotionControl> motion_control_;
  Stream<image::MotionCommand, meca500::MotionCommand> motion_command_;
  Stream<image::HostTime, meca500::HostTime> host_time_;
  Stream<image::BrakesControl, meca500::BrakesControl> brakes_control_;
  Stream<image::DynamicDataConfiguration, meca500::DynamicDataConfiguration> dynamic_data_configuration_;
  std::array<DynamicTrack, image::kDynamicSlots> dynamic_tracks_;
  meca500::DynamicData dynamic_sample_;
  Track<image::Inputs> cyclic_state_track_;
  meca500::CyclicState cyclic_state_sample_;
  Track<control::ControlState> control_track_;
  meca500::ControlStatus control_sample_;
  Track<Diagnosis> status_track_;
  meca500::BridgeStatus status_sample_;
};

}  // namespace meca::bridge
