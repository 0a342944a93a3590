// What is known about the robots on the bus: the last sample of every state topic, per robot.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "bridge/dds.hpp"
#include "idl/types.hpp"

namespace meca::cli {

using Clock = std::chrono::steady_clock;

struct RobotView {
  std::optional<meca500::BridgeStatus> bridge;
  std::optional<meca500::ControlStatus> control;
  std::optional<meca500::RobotStatus> robot_status;
  std::optional<meca500::MotionStatus> motion_status;
  std::optional<meca500::TargetJointSet> joints;
  std::optional<meca500::TargetEndEffectorPose> pose;
  std::optional<meca500::TargetConfiguration> configuration;
  std::optional<meca500::SafetyStatus> safety;
  std::map<std::uint32_t, meca500::DynamicData> dynamic_data;  // by type id, whatever slot it came in

  Clock::time_point joints_arrived{};  // of the last TargetJointSet
  std::uint64_t joint_samples = 0;     // received so far
  std::uint64_t bridge_samples = 0;
  dds::ParticipantId bridge_writer{};  // of the last BridgeStatus: a bridge that was started again is another one
};

using Views = std::map<std::string, RobotView>;  // by robot name

}  // namespace meca::cli
