// Every topic of the bridge with its default rate and QoS: the one list that configuration, publisher, meca-ctl and the
// table in idl/README.md follow.
#pragma once

#include <array>
#include <chrono>
#include <string_view>

#include "bridge/config.hpp"

namespace meca::bridge {

enum class Direction : std::uint8_t { kPublished, kSubscribed };

struct TopicInfo {
  std::string_view name;  // topic name behind the prefix, and the IDL struct in module meca500
  Direction direction;    // as the bridge sees it
  TopicConfig defaults;
  bool rate_configurable;  // false for receipts, status and what the bridge subscribes to
  std::string_view about;
};

namespace detail {
using namespace std::chrono_literals;
inline constexpr TopicConfig kOnChange{RateKind::kOnChange, 0ns, true, true, 1};
inline constexpr TopicConfig kEvery10ms{RateKind::kPeriod, 10ms, true, true, 1};
inline constexpr TopicConfig kEvery100ms{RateKind::kPeriod, 100ms, true, true, 1};
inline constexpr TopicConfig kOffByDefault{RateKind::kOff, 0ns, true, true, 1};
inline constexpr TopicConfig kReceipts{RateKind::kOnChange, 0ns, true, true, 256};
inline constexpr TopicConfig kCommands{RateKind::kOnChange, 0ns, true, false, 0};
inline constexpr TopicConfig kStream{RateKind::kOnChange, 0ns, false, false, 1};
}  // namespace detail

inline constexpr std::array kTopics{
    TopicInfo{"RobotStatus", Direction::kPublished, detail::kOnChange, true, "activation, homing, modes, error code"},
    TopicInfo{"MotionStatus", Direction::kPublished, detail::kOnChange, true,
              "queue, checkpoints, pause and end of motion"},
    TopicInfo{"TargetJointSet", Direction::kPublished, detail::kEvery10ms, true, "joint angles, degrees"},
    TopicInfo{"TargetEndEffectorPose", Direction::kPublished, detail::kEvery10ms, true,
              "tool pose in the WRF, mm and degrees"},
    TopicInfo{"TargetConfiguration", Direction::kPublished, detail::kOnChange, true, "shoulder, elbow, wrist, turn"},
    TopicInfo{"TargetWrf", Direction::kPublished, detail::kOnChange, true, "world reference frame in the base frame"},
    TopicInfo{"TargetTrf", Direction::kPublished, detail::kOnChange, true, "tool reference frame in the flange frame"},
    TopicInfo{"RobotTimestamp", Direction::kPublished, detail::kEvery100ms, true, "the robot's monotonic clock"},
    TopicInfo{"SafetyStatus", Direction::kPublished, detail::kOnChange, true,
              "stop signals, reset readiness, motor power"},
    TopicInfo{"DynamicData", Direction::kPublished, detail::kOnChange, true,
              "everything else, as named values with units"},
    TopicInfo{"CyclicState", Direction::kPublished, detail::kOffByDefault, true, "a whole input image in one sample"},
    TopicInfo{"RobotControl", Direction::kPublished, detail::kOnChange, true,
              "what the bridge is sending: activation bits"},
    TopicInfo{"MotionControl", Direction::kPublished, detail::kOnChange, true,
              "what the bridge is sending: MoveID, pause, clear, resume"},
    TopicInfo{"MotionCommand", Direction::kPublished, detail::kOnChange, true,
              "what the bridge is sending: command and arguments"},
    TopicInfo{"HostTime", Direction::kPublished, detail::kOnChange, true, "what the bridge is sending: clock setting"},
    TopicInfo{"BrakesControl", Direction::kPublished, detail::kOnChange, true, "what the bridge is sending: brakes"},
    TopicInfo{"DynamicDataConfiguration", Direction::kPublished, detail::kOnChange, true,
              "what the bridge is sending: dynamic data types asked for"},
    TopicInfo{"BridgeStatus", Direction::kPublished, detail::kEvery100ms, true,
              "link, firmware, timing, and why the robot is not moving"},
    TopicInfo{"ControlStatus", Direction::kPublished, detail::kOnChange, false, "who has control, the last refusal"},
    TopicInfo{"CommandReceipt", Direction::kPublished, detail::kReceipts, false, "what became of each command"},
    TopicInfo{"Command", Direction::kSubscribed, detail::kCommands, false, "actions and queued motion"},
    TopicInfo{"VelocityCommand", Direction::kSubscribed, detail::kStream, false, "velocity stream"},
    TopicInfo{"ControlLease", Direction::kSubscribed, detail::kStream, false, "the owner's sign of life"},
};

}  // namespace meca::bridge
