#include "transports/image/motion_commands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meca::image {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kSmallest = 0.001;  // the manual's smallest percentage, velocity and time

constexpr Argument free(std::string_view name, std::string_view unit) { return {name, unit, -kInf, kInf}; }
constexpr Argument range(std::string_view name, std::string_view unit, double minimum, double maximum) {
  return {name, unit, minimum, maximum};
}
constexpr Argument whole(std::string_view name, double minimum, double maximum) {
  return {name, "", minimum, maximum, true};
}
constexpr Argument one_of(std::string_view name, std::span<const int> choices) {
  return {name, "", static_cast<double>(choices.front()), static_cast<double>(choices.back()), true, choices};
}

// Ascending, so that the first and the last are the range.
constexpr int kOffOn[] = {0, 1};
constexpr int kPosture[] = {-1, 1};
constexpr int kValve[] = {-1, 0, 1};             // unchanged, close, open
constexpr int kWarningSeverity[] = {0, 1, 4};    // silent, warning, error
constexpr int kTorqueSeverity[] = {0, 1, 2, 4};  // silent, status 3028, also pause, also error 3029
constexpr int kTorqueMode[] = {0, 1, 2};         // absolute, absolute without acceleration phases, deviation
constexpr int kWorkZoneMode[] = {1, 2, 3};       // flange centre, tool, tool and links

// The model's joint ranges (manual "technical specifications"); limits set by the user are inside them and live in the
// robot (dynamic data 14 and 15).
constexpr Argument kJoints[] = {range("q1", "deg", -175, 175), range("q2", "deg", -70, 90),
                                range("q3", "deg", -135, 70),  range("q4", "deg", -170, 170),
                                range("q5", "deg", -115, 115), range("q6", "deg", -36000, 36000)};
constexpr Argument kJointSteps[] = {free("dq1", "deg"), free("dq2", "deg"), free("dq3", "deg"),
                                    free("dq4", "deg"), free("dq5", "deg"), free("dq6", "deg")};
constexpr Argument kPose[] = {free("x", "mm"),      free("y", "mm"),     free("z", "mm"),
                              free("alpha", "deg"), free("beta", "deg"), free("gamma", "deg")};
// inferred: no limit; the manual limits what the arm reaches, not what may be asked for.
constexpr Argument kJointVelocities[] = {free("w1", "deg/s"), free("w2", "deg/s"), free("w3", "deg/s"),
                                         free("w4", "deg/s"), free("w5", "deg/s"), free("w6", "deg/s")};
constexpr Argument kCartVelocities[] = {free("vx", "mm/s"),  free("vy", "mm/s"),  free("vz", "mm/s"),
                                        free("wx", "deg/s"), free("wy", "deg/s"), free("wz", "deg/s")};
constexpr Argument kTime[] = {range("t", "s", 0, kInf)};
constexpr Argument kBlending[] = {range("p", "%", 0, 100)};
constexpr Argument kJointVel[] = {range("p", "%", kSmallest, 150)};  // R3: up to 100, the robot itself refuses more
constexpr Argument kJointAcc[] = {range("p", "%", kSmallest, 150)};
constexpr Argument kCartAngVel[] = {range("w", "deg/s", kSmallest, 1000)};
constexpr Argument kCartLinVel[] = {range("v", "mm/s", kSmallest, 5000)};
constexpr Argument kCartAcc[] = {range("p", "%", kSmallest, 600)};
constexpr Argument kConf[] = {one_of("cs", kPosture), one_of("ce", kPosture), one_of("cw", kPosture)};
constexpr Argument kEnable[] = {one_of("e", kOffOn)};
constexpr Argument kCheckpoint[] = {whole("n", 1, 8000)};
constexpr Argument kOpen[] = {one_of("open", kOffOn)};
constexpr Argument kGripperPercent[] = {range("p", "%", 5, 100)};
constexpr Argument kVelTimeout[] = {range("t", "s", kSmallest, 1)};
constexpr Argument kTurn[] = {whole("ct", -100, 100)};
constexpr Argument kTorques[] = {range("t1", "%", kSmallest, 100), range("t2", "%", kSmallest, 100),
                                 range("t3", "%", kSmallest, 100), range("t4", "%", kSmallest, 100),
                                 range("t5", "%", kSmallest, 100), range("t6", "%", kSmallest, 100)};
constexpr Argument kTorqueCfg[] = {one_of("severity", kTorqueSeverity), one_of("mode", kTorqueMode)};
constexpr Argument kValves[] = {one_of("v1", kValve), one_of("v2", kValve)};
constexpr Argument kGripperRange[] = {range("d_closed", "mm", 0, kInf), range("d_open", "mm", 0, kInf)};
constexpr Argument kGripperPosition[] = {range("d", "mm", 0, kInf)};
constexpr Argument kTimeScaling[] = {range("p", "%", kSmallest, 100)};
constexpr Argument kMoveMode[] = {one_of("m", kOffOn)};  // 0 velocity based, 1 time based
constexpr Argument kSeverity[] = {one_of("severity", kWarningSeverity)};
constexpr Argument kPayload[] = {range("m", "kg", 0, kInf), free("cx", "mm"), free("cy", "mm"), free("cz", "mm")};
// inferred: OfflineProgramID has 16 bits, 0 and 65535 mean something else there.
constexpr Argument kProgram[] = {whole("n", 1, 65534)};
// The range of the joint named is the robot's to check; (n, 0, 0) resets joint n.
constexpr Argument kJointLimits[] = {whole("n", 1, 6), range("q_min", "deg", -36000, 36000),
                                     range("q_max", "deg", -36000, 36000)};
constexpr Argument kWorkZoneCfg[] = {one_of("severity", kWarningSeverity), one_of("mode", kWorkZoneMode)};
constexpr Argument kWorkZone[] = {free("x_min", "mm"), free("y_min", "mm"), free("z_min", "mm"),
                                  free("x_max", "mm"), free("y_max", "mm"), free("z_max", "mm")};
constexpr Argument kSphere[] = {free("x", "mm"), free("y", "mm"), free("z", "mm"), range("r", "mm", 0, kInf)};
constexpr Argument kVariable[] = {free("v1", ""), free("v2", ""), free("v3", ""),
                                  free("v4", ""), free("v5", ""), free("v6", "")};
// Commands of other robots: named, so that a refusal can name them; ranges are none of our business.
constexpr Argument kOutputState[] = {free("bank", ""), free("values", ""), free("mask", "")};
constexpr Argument kIoSim[] = {free("bank", ""), free("mode", "")};
constexpr Argument kVacuumThreshold[] = {free("hold", "kPa"), free("release", "kPa")};
constexpr Argument kJumpHeight[] = {free("start", "mm"), free("end", "mm"), free("min", "mm"), free("max", "mm")};
constexpr Argument kJumpApproach[] = {free("start_vel", "mm/s"), free("start_dist", "mm"), free("end_vel", "mm/s"),
                                      free("end_dist", "mm")};

using enum CommandClass;
constexpr Layout k9 = Layout::kFirmware9, k10 = Layout::kFirmware10, k11 = Layout::kFirmware11;

// All arguments are needed: the image always carries six, and one left out would silently be 0.
constexpr MotionCommandInfo row(std::uint32_t id, std::string_view name, CommandClass command_class, Layout since,
                                std::span<const Argument> arguments) {
  return {id, name, command_class, since, arguments, arguments.size()};
}

// Ascending by id.
constexpr MotionCommandInfo kCommands[] = {
    row(0, "NoMove", kImmediate, k9, {}),
    row(kMoveJoints, "MoveJoints", kMotion, k9, kJoints),
    row(kMovePose, "MovePose", kMotion, k9, kPose),
    row(kMoveLin, "MoveLin", kMotion, k9, kPose),
    row(kMoveLinRelTrf, "MoveLinRelTrf", kMotion, k9, kPose),
    row(kMoveLinRelWrf, "MoveLinRelWrf", kMotion, k9, kPose),
    row(kDelay, "Delay", kQueued, k9, kTime),
    row(kSetBlending, "SetBlending", kQueued, k9, kBlending),
    row(kSetJointVel, "SetJointVel", kQueued, k9, kJointVel),
    row(kSetJointAcc, "SetJointAcc", kQueued, k9, kJointAcc),
    row(kSetCartAngVel, "SetCartAngVel", kQueued, k9, kCartAngVel),
    row(kSetCartLinVel, "SetCartLinVel", kQueued, k9, kCartLinVel),
    row(kSetCartAcc, "SetCartAcc", kQueued, k9, kCartAcc),
    row(kSetTrf, "SetTrf", kQueued, k9, kPose),
    row(kSetWrf, "SetWrf", kQueued, k9, kPose),
    row(kSetConf, "SetConf", kQueued, k9, kConf),
    row(kSetAutoConf, "SetAutoConf", kQueued, k9, kEnable),
    row(kSetCheckpoint, "SetCheckpoint", kQueued, k9, kCheckpoint),
    row(kGripper, "Gripper", kQueued, k9, kOpen),  // GripperOpen (1) and GripperClose (0) share the id
    row(kSetGripperVel, "SetGripperVel", kQueued, k9, kGripperPercent),
    row(kSetGripperForce, "SetGripperForce", kQueued, k9, kGripperPercent),
    row(kMoveJointsVel, "MoveJointsVel", kVelocity, k9, kJointVelocities),
    row(kMoveLinVelWrf, "MoveLinVelWrf", kVelocity, k9, kCartVelocities),
    row(kMoveLinVelTrf, "MoveLinVelTrf", kVelocity, k9, kCartVelocities),
    row(kSetVelTimeout, "SetVelTimeout", kQueued, k9, kVelTimeout),
    row(kSetConfTurn, "SetConfTurn", kQueued, k9, kTurn),
    row(kSetAutoConfTurn, "SetAutoConfTurn", kQueued, k9, kEnable),
    row(kSetTorqueLimits, "SetTorqueLimits", kQueued, k9, kTorques),
    row(kSetTorqueLimitsCfg, "SetTorqueLimitsCfg", kQueued, k9, kTorqueCfg),
    row(kMoveJointsRel, "MoveJointsRel", kMotion, k9, kJointSteps),
    row(kSetValveState, "SetValveState", kQueued, k9, kValves),
    row(kSetGripperRange, "SetGripperRange", kQueued, k9, kGripperRange),
    row(kMoveGripper, "MoveGripper", kQueued, k9, kGripperPosition),
    row(kSetJointVelLimit, "SetJointVelLimit", kQueued, k9, kJointVel),
    row(34, "SetOutputState", kOtherRobots, k10, kOutputState),
    row(35, "SetOutputState_Immediate", kOtherRobots, k10, kOutputState),
    row(36, "SetIoSim", kOtherRobots, k10, kIoSim),
    row(37, "VacuumGrip", kOtherRobots, k10, {}),
    row(38, "VacuumGrip_Immediate", kOtherRobots, k10, {}),
    row(39, "VacuumRelease", kOtherRobots, k10, {}),
    row(40, "VacuumRelease_Immediate", kOtherRobots, k10, {}),
    row(41, "SetVacuumThreshold", kOtherRobots, k10, kVacuumThreshold),
    row(42, "SetVacuumThreshold_Immediate", kOtherRobots, k10, kVacuumThreshold),
    row(43, "SetVacuumPurgeDuration", kOtherRobots, k10, kTime),
    row(44, "SetVacuumPurgeDuration_Immediate", kOtherRobots, k10, kTime),
    row(45, "MoveJump", kOtherRobots, k10, kPose),
    row(46, "SetMoveJumpHeight", kOtherRobots, k10, kJumpHeight),
    row(47, "SetMoveJumpApproachVel", kOtherRobots, k10, kJumpApproach),
    // inferred: immediate, as a control command of the TCP/IP interface is; not published for the cyclic one.
    row(kSetTimeScaling, "SetTimeScaling", kImmediate, k10, kTimeScaling),
    row(kSetMoveMode, "SetMoveMode", kQueued, k11, kMoveMode),
    row(kSetMoveDurationCfg, "SetMoveDurationCfg", kQueued, k11, kSeverity),
    row(kSetMoveDuration, "SetMoveDuration", kQueued, k11, kTime),
    row(kSetPayload, "SetPayload", kQueued, k11, kPayload),
    row(kStartProgram, "StartProgram", kMotion, k9, kProgram),  // a program may move the arm
    row(kSetJointLimits, "SetJointLimits", kConfiguration, k11, kJointLimits),
    row(kSetJointLimitsCfg, "SetJointLimitsCfg", kConfiguration, k11, kEnable),
    row(kSetWorkZoneCfg, "SetWorkZoneCfg", kConfiguration, k11, kWorkZoneCfg),
    row(kSetWorkZoneLimits, "SetWorkZoneLimits", kConfiguration, k11, kWorkZone),
    row(kSetCollisionCfg, "SetCollisionCfg", kConfiguration, k11, kSeverity),
    row(kSetToolSphere, "SetToolSphere", kConfiguration, k11, kSphere),
    row(kSetCalibrationCfg, "SetCalibrationCfg", kConfiguration, k11, kEnable),
    row(kRebootRobot, "RebootRobot", kImmediate, k11, {}),
    row(kClearHoming, "ClearHoming", kImmediate, k11, {}),  // inferred: immediate
    // inferred: immediate; one number, or up to six elements of an array.
    {kFirstVariable, "SetVariable", kImmediate, k11, kVariable, 1},
};

static_assert(std::ranges::is_sorted(kCommands, {}, &MotionCommandInfo::id) &&
              std::ranges::adjacent_find(kCommands, {}, &MotionCommandInfo::id) == std::ranges::end(kCommands));

constexpr char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same_word(std::string_view a, std::string_view b) noexcept { return std::ranges::equal(a, b, {}, lower, lower); }

}  // namespace

std::span<const MotionCommandInfo> motion_commands() noexcept { return kCommands; }

const MotionCommandInfo* find_motion_command(std::uint32_t id) noexcept {
  if (id >= kFirstVariable && id <= kLastVariable) id = kFirstVariable;
  const auto found = std::ranges::lower_bound(kCommands, id, {}, &MotionCommandInfo::id);
  return found != std::ranges::end(kCommands) && found->id == id ? found : nullptr;
}

const MotionCommandInfo* find_motion_command(std::string_view name) noexcept {
  const auto found = std::ranges::find_if(
      kCommands, [name](const MotionCommandInfo& command) { return same_word(command.name, name); });
  return found != std::ranges::end(kCommands) ? found : nullptr;
}

bool allows(const Argument& argument, float value) noexcept {
  // Compared as float: 0.1f as a double is above 0.1, and a client that asks for the limit itself means the limit.
  if (!std::isfinite(value)) return false;
  if (value < static_cast<float>(argument.minimum) || value > static_cast<float>(argument.maximum)) return false;
  if (argument.integer && value != std::trunc(value)) return false;
  return argument.choices.empty() ||
         std::ranges::any_of(argument.choices, [value](int choice) { return value == static_cast<float>(choice); });
}

}  // namespace meca::image
