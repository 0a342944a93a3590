// THE field table: where every field of the process image stands, for each firmware layout. No other file knows a byte
// offset. Codec and text rendering are generated from these rows, the compiler checks them (field_table.cpp), and the
// tests walk them against the vendor's files.
//
// Sources: robot manual firmware 11.3, 4.4 and 4.5 (names, types, byte and bit); the vendor's ESI 9.3.3 and 10.2.1
// (CoE objects, older layouts). inferred: what only firmware 11 has keeps its place in the CoE numbering of the manual,
// because no ESI of firmware 11 is public.
// Reserved bits are rows too, so that fields and gaps together must tile the image: written 0, not read.
#pragma once

#include <array>
#include <string_view>

#include "transports/image/field.hpp"

namespace meca::image {
namespace rows {

using enum WireType;
using enum Robots;
using Stop = StopSignals;
using Supply = PowerSupplyInputs;
using Time = RobotTimestamp;

inline constexpr std::string_view kRobotControl = "RobotControl", kMotionControl = "MotionControl",
                                  kMotionCommand = "MotionCommand", kHostTime = "HostTime", kBrakes = "BrakesControl",
                                  kRequested = "DynamicDataConfiguration";
inline constexpr std::string_view kRobotStatus = "RobotStatus", kMotion = "MotionStatus", kJointSet = "TargetJointSet",
                                  kEndEffector = "TargetEndEffectorPose", kConfiguration = "TargetConfiguration",
                                  kWrf = "TargetWrf", kTrf = "TargetTrf", kTimestamp = "RobotTimestamp",
                                  kSafety = "SafetyStatus", kDynamic0 = "DynamicData 0", kDynamic1 = "DynamicData 1",
                                  kDynamic2 = "DynamicData 2", kDynamic3 = "DynamicData 3";

// Places, one short word per section.
template <auto Member>
inline constexpr auto robot_control = at<&Outputs::robot_control, Member>;
template <auto Member>
inline constexpr auto motion_control = at<&Outputs::motion_control, Member>;
inline constexpr auto command_id = at<&Outputs::motion_command, &MotionCommand::command_id>;
template <auto Index>
inline constexpr auto argument = at<&Outputs::motion_command, &MotionCommand::arguments, Index>;
template <auto Member>
inline constexpr auto brakes = at<&Outputs::brakes_control, Member>;
template <auto Slot>
inline constexpr auto requested_type =
    at<&Outputs::dynamic_data_configuration, &DynamicDataConfiguration::type_ids, Slot>;
template <auto Member>
inline constexpr auto robot_status = at<&Inputs::robot_status, Member>;
template <auto Member>
inline constexpr auto motion = at<&Inputs::motion_status, Member>;
template <auto Index>
inline constexpr auto joint = at<&Inputs::target_joint_set, &TargetJointSet::joints, Index>;
template <auto Member>
inline constexpr auto end_effector = at<&Inputs::target_end_effector_pose, Member>;
template <auto Member>
inline constexpr auto configuration = at<&Inputs::target_configuration, Member>;
template <auto Member>
inline constexpr auto wrf = at<&Inputs::target_wrf, Member>;
template <auto Member>
inline constexpr auto trf = at<&Inputs::target_trf, Member>;
template <auto Member>
inline constexpr auto timestamp = at<&Inputs::robot_timestamp, Member>;
template <auto Member>
inline constexpr auto safety = at<&Inputs::safety_status, Member>;
template <auto Member>
inline constexpr auto stop = at<&Inputs::safety_status, &SafetyStatus::stop, Member>;
template <auto Member>
inline constexpr auto resettable = at<&Inputs::safety_status, &SafetyStatus::resettable, Member>;
template <auto Member>
inline constexpr auto supply = at<&Inputs::safety_status, &SafetyStatus::power_supply_inputs, Member>;
template <auto Slot>
inline constexpr auto dynamic_type = at<&Inputs::dynamic_data, Slot, &DynamicData::type_id>;
template <auto Slot, auto Index>
inline constexpr auto dynamic_value = at<&Inputs::dynamic_data, Slot, &DynamicData::values, Index>;

// clang-format off

// ---------------------------------------------------------------- output, host -> robot: 60 bytes

inline constexpr Field<Outputs> kOutput[] = {
    bit(kRobotControl, "Deactivate",      0, 0, {0x7200, 1}, kAll,    robot_control<&RobotControl::deactivate>),
    bit(kRobotControl, "Activate",        0, 1, {0x7200, 2}, kAll,    robot_control<&RobotControl::activate>),
    bit(kRobotControl, "Home",            0, 2, {0x7200, 3}, kAll,    robot_control<&RobotControl::home>),
    bit(kRobotControl, "ResetError",      0, 3, {0x7200, 4}, kAll,    robot_control<&RobotControl::reset_error>),
    bit(kRobotControl, "SimMode",         0, 4, {0x7200, 5}, kAll,    robot_control<&RobotControl::sim_mode>),
    bit(kRobotControl, "RecoveryMode",    0, 5, {0x7200, 6}, kAll,    robot_control<&RobotControl::recovery_mode>),
    bit(kRobotControl, "DisableEtherCAT", 0, 6, {0x7200, 7}, kFrom10, robot_control<&RobotControl::disable_ethercat>),

    number(kMotionControl, "MoveID", kUint16, 4, {0x7310, 1}, kAll, "", motion_control<&MotionControl::move_id>),
    bit(kMotionControl, "SetPoint",     6, 0, {0x7310, 2}, kAll,    motion_control<&MotionControl::set_point>),
    bit(kMotionControl, "PauseMotion",  6, 1, {0x7310, 3}, kAll,    motion_control<&MotionControl::pause_motion>),
    bit(kMotionControl, "ClearMotion",  6, 2, {0x7310, 4}, kAll,    motion_control<&MotionControl::clear_motion>),
    bit(kMotionControl, "ResetPStop2",  6, 3, {0x7310, 5}, kOnly9,  motion_control<&MotionControl::resume_motion>),
    bit(kMotionControl, "ResumeMotion", 6, 3, {0x7310, 5}, kFrom10, motion_control<&MotionControl::resume_motion>),
    bit(kMotionControl, "UseVariables", 6, 4, {0x7310, 6}, kOnly11, motion_control<&MotionControl::use_variables>),

    number(kMotionCommand, "MotionCommandID", kUdint, 8,  {0x7305, 0}, kAll, "", command_id),
    number(kMotionCommand, "Argument 1",      kReal,  12, {0x7306, 1}, kAll, "", argument<0>),
    number(kMotionCommand, "Argument 2",      kReal,  16, {0x7306, 2}, kAll, "", argument<1>),
    number(kMotionCommand, "Argument 3",      kReal,  20, {0x7306, 3}, kAll, "", argument<2>),
    number(kMotionCommand, "Argument 4",      kReal,  24, {0x7306, 4}, kAll, "", argument<3>),
    number(kMotionCommand, "Argument 5",      kReal,  28, {0x7306, 5}, kAll, "", argument<4>),
    number(kMotionCommand, "Argument 6",      kReal,  32, {0x7306, 6}, kAll, "", argument<5>),

    number(kHostTime, "HostTime", kUdint, 36, {0x7400, 0}, kAll, "s", at<&Outputs::host_time, &HostTime::seconds>),

    bit(kBrakes, "BrakesControlAllowed", 40, 0, {0x7410, 1}, kAll, brakes<&BrakesControl::brakes_control_allowed>),
    bit(kBrakes, "BrakesEngaged",        40, 1, {0x7410, 2}, kAll, brakes<&BrakesControl::brakes_engaged>),

    number(kRequested, "DynamicDataTypeID 0", kUdint, 44, {0x7420, 1}, kAll, "", requested_type<0>),
    number(kRequested, "DynamicDataTypeID 1", kUdint, 48, {0x7421, 1}, kAll, "", requested_type<1>),
    number(kRequested, "DynamicDataTypeID 2", kUdint, 52, {0x7422, 1}, kAll, "", requested_type<2>),
    number(kRequested, "DynamicDataTypeID 3", kUdint, 56, {0x7423, 1}, kAll, "", requested_type<3>),
};

inline constexpr ReservedRange kOutputGaps[] = {
    {0, 6, 26, kOnly9},  {0, 7, 25, kFrom10},   // after RobotControl
    {6, 4, 12, kUpTo10}, {6, 5, 11, kOnly11},   // after MotionControl
    {40, 2, 30, kAll},                          // after BrakesControl
};

// ---------------------------------------------------------------- input, robot -> host: 252 bytes

inline constexpr Field<Inputs> kInput[] = {
    bit(kRobotStatus, "Busy",            0, 0, {0x6010, 2},  kAll,    robot_status<&RobotStatus::busy>),
    bit(kRobotStatus, "Activated",       0, 1, {0x6010, 3},  kAll,    robot_status<&RobotStatus::activated>),
    bit(kRobotStatus, "Homed",           0, 2, {0x6010, 4},  kAll,    robot_status<&RobotStatus::homed>),
    bit(kRobotStatus, "SimActivated",    0, 3, {0x6010, 5},  kAll,    robot_status<&RobotStatus::sim_activated>),
    bit(kRobotStatus, "BrakesEngaged",   0, 4, {0x6010, 6},  kAll,    robot_status<&RobotStatus::brakes_engaged>),
    bit(kRobotStatus, "RecoveryMode",    0, 5, {0x6010, 7},  kAll,    robot_status<&RobotStatus::recovery_mode>),
    bit(kRobotStatus, "EStop",           0, 6, {0x6010, 8},  kAll,    robot_status<&RobotStatus::e_stop>),
    bit(kRobotStatus, "CollisionStatus", 0, 7, {0x6010, 9},  kFrom10, robot_status<&RobotStatus::collision_status>),
    bit(kRobotStatus, "WorkZoneStatus",  1, 0, {0x6010, 10}, kFrom10, robot_status<&RobotStatus::work_zone_status>),
    bit(kRobotStatus, "MonitoringMode",  1, 1, {0x6010, 11}, kOnly11, robot_status<&RobotStatus::monitoring_mode>),
    number(kRobotStatus, "ErrorCode", kUint16, 2, {0x6010, 1}, kAll, "", robot_status<&RobotStatus::error_code>),

    number(kMotion, "Checkpoint",          kUdint,  4,  {0x6015, 1}, kUpTo10, "", motion<&MotionStatus::checkpoint_reached>),
    number(kMotion, "Checkpoint",          kUint16, 4,  {0x6015, 1}, kOnly11, "", motion<&MotionStatus::checkpoint_reached>),
    number(kMotion, "CheckpointDiscarded", kUint16, 6,  {0x6015, 2}, kOnly11, "", motion<&MotionStatus::checkpoint_discarded>),
    number(kMotion, "MoveID",              kUint16, 8,  {0x6015, 2}, kAll,    "", motion<&MotionStatus::move_id>),
    number(kMotion, "FIFOSpace",           kUint16, 10, {0x6015, 3}, kAll,    "", motion<&MotionStatus::fifo_space>),
    bit(kMotion, "Paused",           12, 0, {0x6015, 5},  kAll,   motion<&MotionStatus::paused>),
    bit(kMotion, "EOB",              12, 1, {0x6015, 6},  kAll,   motion<&MotionStatus::eob>),
    bit(kMotion, "EOM",              12, 2, {0x6015, 7},  kAll,   motion<&MotionStatus::eom>),
    bit(kMotion, "Cleared",          12, 3, {0x6015, 8},  kAll,   motion<&MotionStatus::cleared>),
    bit(kMotion, "PStop2",           12, 4, {0x6015, 9},  kAll,   motion<&MotionStatus::p_stop2>),
    bit(kMotion, "ExcessiveTorque",  12, 5, {0x6015, 10}, kAll,   motion<&MotionStatus::excessive_torque>),
    bit(kMotion, "PStop2Resettable", 12, 6, {0x6015, 11}, kOnly9, motion<&MotionStatus::p_stop2_resettable>),
    number(kMotion, "OfflineProgramID", kUint16, 14, {0x6015, 4}, kAll, "", motion<&MotionStatus::offline_program_id>),

    number(kJointSet, "J1", kReal, 16, {0x6030, 1}, kAll, "deg", joint<0>),
    number(kJointSet, "J2", kReal, 20, {0x6030, 2}, kAll, "deg", joint<1>),
    number(kJointSet, "J3", kReal, 24, {0x6030, 3}, kAll, "deg", joint<2>),
    number(kJointSet, "J4", kReal, 28, {0x6030, 4}, kAll, "deg", joint<3>),
    number(kJointSet, "J5", kReal, 32, {0x6030, 5}, kAll, "deg", joint<4>),
    number(kJointSet, "J6", kReal, 36, {0x6030, 6}, kAll, "deg", joint<5>),

    number(kEndEffector, "x",     kReal, 40, {0x6031, 1}, kAll, "mm",  end_effector<&Pose::x>),
    number(kEndEffector, "y",     kReal, 44, {0x6031, 2}, kAll, "mm",  end_effector<&Pose::y>),
    number(kEndEffector, "z",     kReal, 48, {0x6031, 3}, kAll, "mm",  end_effector<&Pose::z>),
    number(kEndEffector, "alpha", kReal, 52, {0x6031, 4}, kAll, "deg", end_effector<&Pose::alpha>),
    number(kEndEffector, "beta",  kReal, 56, {0x6031, 5}, kAll, "deg", end_effector<&Pose::beta>),
    number(kEndEffector, "gamma", kReal, 60, {0x6031, 6}, kAll, "deg", end_effector<&Pose::gamma>),

    number(kConfiguration, "Shoulder", kSint, 64, {0x6046, 1}, kAll, "", configuration<&TargetConfiguration::shoulder>),
    number(kConfiguration, "Elbow",    kSint, 65, {0x6046, 2}, kAll, "", configuration<&TargetConfiguration::elbow>),
    number(kConfiguration, "Wrist",    kSint, 66, {0x6046, 3}, kAll, "", configuration<&TargetConfiguration::wrist>),
    number(kConfiguration, "Turn",     kSint, 67, {0x6046, 4}, kAll, "", configuration<&TargetConfiguration::turn>),

    number(kWrf, "x",     kReal, 68, {0x6050, 1}, kAll, "mm",  wrf<&Pose::x>),
    number(kWrf, "y",     kReal, 72, {0x6050, 2}, kAll, "mm",  wrf<&Pose::y>),
    number(kWrf, "z",     kReal, 76, {0x6050, 3}, kAll, "mm",  wrf<&Pose::z>),
    number(kWrf, "alpha", kReal, 80, {0x6050, 4}, kAll, "deg", wrf<&Pose::alpha>),
    number(kWrf, "beta",  kReal, 84, {0x6050, 5}, kAll, "deg", wrf<&Pose::beta>),
    number(kWrf, "gamma", kReal, 88, {0x6050, 6}, kAll, "deg", wrf<&Pose::gamma>),

    number(kTrf, "x",     kReal, 92,  {0x6051, 1}, kAll, "mm",  trf<&Pose::x>),
    number(kTrf, "y",     kReal, 96,  {0x6051, 2}, kAll, "mm",  trf<&Pose::y>),
    number(kTrf, "z",     kReal, 100, {0x6051, 3}, kAll, "mm",  trf<&Pose::z>),
    number(kTrf, "alpha", kReal, 104, {0x6051, 4}, kAll, "deg", trf<&Pose::alpha>),
    number(kTrf, "beta",  kReal, 108, {0x6051, 5}, kAll, "deg", trf<&Pose::beta>),
    number(kTrf, "gamma", kReal, 112, {0x6051, 6}, kAll, "deg", trf<&Pose::gamma>),

    number(kTimestamp, "Seconds",                kUdint, 116, {0x6060, 1}, kAll, "s",  timestamp<&Time::seconds>),
    number(kTimestamp, "Microseconds",           kUdint, 120, {0x6060, 2}, kAll, "us", timestamp<&Time::microseconds>),
    number(kTimestamp, "DynamicDataUpdateCount", kUdint, 124, {0x6060, 3}, kAll, "",   timestamp<&Time::dynamic_data_update_count>),

    // CoE objects of the bits for other robots: ESI of the MCS500, 10.2.1.
    bit(kSafety, "EStop",                  128, 0, {0x6065, 2},  kFrom10, stop<&Stop::e_stop>),
    bit(kSafety, "PStop1",                 128, 1, {0x6065, 3},  kFrom10, stop<&Stop::p_stop1>,                  kOthers),
    bit(kSafety, "PStop2",                 128, 2, {0x6065, 4},  kFrom10, stop<&Stop::p_stop2>),
    bit(kSafety, "OperationModeChange",    128, 4, {0x6065, 5},  kFrom10, stop<&Stop::operation_mode_change>,    kOthers),
    bit(kSafety, "EnablingDeviceReleased", 128, 5, {0x6065, 6},  kFrom10, stop<&Stop::enabling_device_released>, kOthers),
    bit(kSafety, "VoltageFluctuation",     128, 6, {0x6065, 7},  kFrom10, stop<&Stop::voltage_fluctuation>,      kOthers),
    bit(kSafety, "Reboot",                 128, 7, {0x6065, 8},  kFrom10, stop<&Stop::reboot>),
    bit(kSafety, "RedundancyFault",        129, 0, {0x6065, 9},  kFrom10, stop<&Stop::redundancy_fault>,         kOthers),
    bit(kSafety, "StandstillFault",        129, 1, {0x6065, 10}, kFrom10, stop<&Stop::standstill_fault>,         kOthers),
    bit(kSafety, "ConnectionDropped",      129, 2, {0x6065, 11}, kFrom10, stop<&Stop::connection_dropped>),
    bit(kSafety, "MinorError",             129, 3, {0x6065, 12}, kFrom10, stop<&Stop::minor_error>,              kOthers),
    bit(kSafety, "EStopResettable",                  132, 0, {0x6065, 13}, kFrom10, resettable<&Stop::e_stop>),
    bit(kSafety, "PStop1Resettable",                 132, 1, {0x6065, 14}, kFrom10, resettable<&Stop::p_stop1>,                  kOthers),
    bit(kSafety, "PStop2Resettable",                 132, 2, {0x6065, 15}, kFrom10, resettable<&Stop::p_stop2>),
    bit(kSafety, "OperationModeChangeResettable",    132, 4, {0x6065, 16}, kFrom10, resettable<&Stop::operation_mode_change>,    kOthers),
    bit(kSafety, "EnablingDeviceReleasedResettable", 132, 5, {0x6065, 17}, kFrom10, resettable<&Stop::enabling_device_released>, kOthers),
    bit(kSafety, "VoltageFluctuationResettable",     132, 6, {0x6065, 18}, kFrom10, resettable<&Stop::voltage_fluctuation>,      kOthers),
    bit(kSafety, "RebootResettable",                 132, 7, {0x6065, 19}, kFrom10, resettable<&Stop::reboot>),
    bit(kSafety, "RedundancyFaultResettable",        133, 0, {0x6065, 20}, kFrom10, resettable<&Stop::redundancy_fault>,         kOthers),
    bit(kSafety, "StandstillFaultResettable",        133, 1, {0x6065, 21}, kFrom10, resettable<&Stop::standstill_fault>,         kOthers),
    bit(kSafety, "ConnectionDroppedResettable",      133, 2, {0x6065, 22}, kFrom10, resettable<&Stop::connection_dropped>),
    bit(kSafety, "MinorErrorResettable",             133, 3, {0x6065, 23}, kFrom10, resettable<&Stop::minor_error>,              kOthers),
    number(kSafety, "OperationMode", kUsint, 136, {0x6065, 1}, kFrom10, "", safety<&SafetyStatus::operation_mode>, kOthers),
    bit(kSafety, "ResetReady", 137, 0, {0x6065, 24}, kFrom10, safety<&SafetyStatus::reset_ready>),
    bit(kSafety, "VMotorOn",   137, 1, {0x6065, 25}, kFrom10, safety<&SafetyStatus::vmotor_on>),
    bit(kSafety, "PowerSupplyInputEStop",          138, 0, {0x6065, 26}, kFrom10, supply<&Supply::e_stop>,          kOthers),
    bit(kSafety, "PowerSupplyInputPStop1",         138, 1, {0x6065, 27}, kFrom10, supply<&Supply::p_stop1>,         kOthers),
    bit(kSafety, "PowerSupplyInputPStop2",         138, 2, {0x6065, 28}, kFrom10, supply<&Supply::p_stop2>,         kOthers),
    bit(kSafety, "PowerSupplyInputExternalReset",  138, 3, {0x6065, 29}, kFrom10, supply<&Supply::external_reset>,  kOthers),
    bit(kSafety, "PowerSupplyInputKeypadReset",    138, 4, {0x6065, 30}, kFrom10, supply<&Supply::keypad_reset>,    kOthers),
    bit(kSafety, "PowerSupplyInputEnablingDevice", 138, 5, {0x6065, 31}, kFrom10, supply<&Supply::enabling_device>, kOthers),

    // What the values are: dynamic_data_types.hpp.
    number(kDynamic0, "DynamicDataTypeID", kUdint, 140, {0x6070, 1}, kAll, "", dynamic_type<0>),
    number(kDynamic0, "Value 0",           kReal,  144, {0x6070, 2}, kAll, "", dynamic_value<0, 0>),
    number(kDynamic0, "Value 1",           kReal,  148, {0x6070, 3}, kAll, "", dynamic_value<0, 1>),
    number(kDynamic0, "Value 2",           kReal,  152, {0x6070, 4}, kAll, "", dynamic_value<0, 2>),
    number(kDynamic0, "Value 3",           kReal,  156, {0x6070, 5}, kAll, "", dynamic_value<0, 3>),
    number(kDynamic0, "Value 4",           kReal,  160, {0x6070, 6}, kAll, "", dynamic_value<0, 4>),
    number(kDynamic0, "Value 5",           kReal,  164, {0x6070, 7}, kAll, "", dynamic_value<0, 5>),

    number(kDynamic1, "DynamicDataTypeID", kUdint, 168, {0x6071, 1}, kAll, "", dynamic_type<1>),
    number(kDynamic1, "Value 0",           kReal,  172, {0x6071, 2}, kAll, "", dynamic_value<1, 0>),
    number(kDynamic1, "Value 1",           kReal,  176, {0x6071, 3}, kAll, "", dynamic_value<1, 1>),
    number(kDynamic1, "Value 2",           kReal,  180, {0x6071, 4}, kAll, "", dynamic_value<1, 2>),
    number(kDynamic1, "Value 3",           kReal,  184, {0x6071, 5}, kAll, "", dynamic_value<1, 3>),
    number(kDynamic1, "Value 4",           kReal,  188, {0x6071, 6}, kAll, "", dynamic_value<1, 4>),
    number(kDynamic1, "Value 5",           kReal,  192, {0x6071, 7}, kAll, "", dynamic_value<1, 5>),

    number(kDynamic2, "DynamicDataTypeID", kUdint, 196, {0x6072, 1}, kAll, "", dynamic_type<2>),
    number(kDynamic2, "Value 0",           kReal,  200, {0x6072, 2}, kAll, "", dynamic_value<2, 0>),
    number(kDynamic2, "Value 1",           kReal,  204, {0x6072, 3}, kAll, "", dynamic_value<2, 1>),
    number(kDynamic2, "Value 2",           kReal,  208, {0x6072, 4}, kAll, "", dynamic_value<2, 2>),
    number(kDynamic2, "Value 3",           kReal,  212, {0x6072, 5}, kAll, "", dynamic_value<2, 3>),
    number(kDynamic2, "Value 4",           kReal,  216, {0x6072, 6}, kAll, "", dynamic_value<2, 4>),
    number(kDynamic2, "Value 5",           kReal,  220, {0x6072, 7}, kAll, "", dynamic_value<2, 5>),

    number(kDynamic3, "DynamicDataTypeID", kUdint, 224, {0x6073, 1}, kAll, "", dynamic_type<3>),
    number(kDynamic3, "Value 0",           kReal,  228, {0x6073, 2}, kAll, "", dynamic_value<3, 0>),
    number(kDynamic3, "Value 1",           kReal,  232, {0x6073, 3}, kAll, "", dynamic_value<3, 1>),
    number(kDynamic3, "Value 2",           kReal,  236, {0x6073, 4}, kAll, "", dynamic_value<3, 2>),
    number(kDynamic3, "Value 3",           kReal,  240, {0x6073, 5}, kAll, "", dynamic_value<3, 3>),
    number(kDynamic3, "Value 4",           kReal,  244, {0x6073, 6}, kAll, "", dynamic_value<3, 4>),
    number(kDynamic3, "Value 5",           kReal,  248, {0x6073, 7}, kAll, "", dynamic_value<3, 5>),
};

inline constexpr ReservedRange kInputGaps[] = {
    {0, 7, 9, kOnly9},     {1, 1, 7, kOnly10},    {1, 2, 6, kOnly11},                          // in RobotStatus
    {12, 7, 9, kOnly9},    {12, 6, 10, kFrom10},                                               // in MotionStatus
    {128, 0, 96, kOnly9},                                                                      // no SafetyStatus
    {128, 3, 1, kFrom10},  {129, 4, 20, kFrom10}, {132, 3, 1, kFrom10}, {133, 4, 20, kFrom10},  // in SafetyStatus
    {137, 2, 6, kFrom10},  {138, 6, 10, kFrom10},
};

// clang-format on

}  // namespace rows

inline constexpr auto kOutputFields = std::to_array(rows::kOutput);
inline constexpr auto kInputFields = std::to_array(rows::kInput);
inline constexpr auto kOutputReserved = std::to_array(rows::kOutputGaps);
inline constexpr auto kInputReserved = std::to_array(rows::kInputGaps);

// inferred: the second checkpoint of firmware 11 moves the rest of object 6015h up by one; the manual numbers them so.
template <class Image>
constexpr CoeObject coe_object(const Field<Image>& field, Layout layout) noexcept {
  const bool moved = field.coe.index == 0x6015 && field.coe.sub >= 2 && layout == Layout::kFirmware11 &&
                     field.layouts.has(Layout::kFirmware10);
  return {field.coe.index, static_cast<std::uint8_t>(field.coe.sub + (moved ? 1 : 0))};
}

// Whether the image has a safety section at all. Where it has none, nothing is known about stops.
constexpr bool has_safety_section(Layout layout) noexcept {
  for (const auto& field : kInputFields) {
    if (field.section == rows::kSafety && field.layouts.has(layout)) return true;
  }
  return false;
}

}  // namespace meca::image
