// Table 8 of the robot manual as data: the motion-related commands with their arguments, units and ranges (fw 11.3).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "transports/image/image.hpp"

namespace meca::image {

enum class CommandClass : std::uint8_t {
  kMotion,         // moves the arm through the queue
  kVelocity,       // 21, 22, 23: moves the arm while it is repeated
  kQueued,         // goes through the queue, does not move the arm
  kConfiguration,  // 150-156: robot must be deactivated
  kImmediate,      // acts on reception
  kOtherRobots,    // exists in the protocol, refused by the Meca500
};

struct Argument {
  std::string_view name;  // the manual's: "q1", "x", "alpha", "p"
  std::string_view unit;  // "deg", "mm", "%", "s", "deg/s", "mm/s", "kg"; empty where it has none
  double minimum;         // inclusive; -infinity where the manual gives no limit
  double maximum;         // inclusive
  bool integer = false;
  std::span<const int> choices = {};  // the only legal values, where the manual lists them one by one; else empty
};

struct MotionCommandInfo {
  std::uint32_t id;
  std::string_view name;  // TCP/IP name: "MoveJoints"
  CommandClass command_class;
  Layout since;                         // first firmware generation that has it
  std::span<const Argument> arguments;  // in order; fewer may be allowed, see minimum_arguments
  std::size_t minimum_arguments;
};

std::span<const MotionCommandInfo> motion_commands() noexcept;

// nullptr when the id is in no table. Ids 10000..19999 all give the entry "SetVariable" (its id is 10000).
const MotionCommandInfo* find_motion_command(std::uint32_t id) noexcept;
// By TCP/IP name, without regard to case. nullptr when unknown.
const MotionCommandInfo* find_motion_command(std::string_view name) noexcept;

// Whether a plain value is legal: finite, in the range, whole where it must be, one of the choices where there are any.
// Not for use_variables, where each argument is the cyclic id of a variable instead.
bool allows(const Argument& argument, float value) noexcept;

inline constexpr std::uint32_t kFirstVariable = 10000, kLastVariable = 19999;
inline constexpr std::uint32_t kMoveJoints = 1, kMovePose = 2, kMoveLin = 3, kMoveLinRelTrf = 4, kMoveLinRelWrf = 5,
                               kDelay = 6, kSetBlending = 7, kSetJointVel = 8, kSetJointAcc = 9, kSetCartAngVel = 10,
                               kSetCartLinVel = 11, kSetCartAcc = 12, kSetTrf = 13, kSetWrf = 14, kSetConf = 15,
                               kSetAutoConf = 16, kSetCheckpoint = 17, kGripper = 18, kSetGripperVel = 19,
                               kSetGripperForce = 20, kMoveJointsVel = 21, kMoveLinVelWrf = 22, kMoveLinVelTrf = 23,
                               kSetVelTimeout = 24, kSetConfTurn = 25, kSetAutoConfTurn = 26, kSetTorqueLimits = 27,
                               kSetTorqueLimitsCfg = 28, kMoveJointsRel = 29, kSetValveState = 30,
                               kSetGripperRange = 31, kMoveGripper = 32, kSetJointVelLimit = 33, kSetTimeScaling = 48,
                               kSetMoveMode = 49, kSetMoveDurationCfg = 50, kSetMoveDuration = 51, kSetPayload = 60,
                               kStartProgram = 100, kSetJointLimits = 150, kSetJointLimitsCfg = 151,
                               kSetWorkZoneCfg = 152, kSetWorkZoneLimits = 153, kSetCollisionCfg = 154,
                               kSetToolSphere = 155, kSetCalibrationCfg = 156, kRebootRobot = 200, kClearHoming = 1002;

}  // namespace meca::image
