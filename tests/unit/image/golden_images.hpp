// Golden images in hex, for each layout and byte order. Written from the offsets in the robot manual (firmware 11.3,
// 4.4 and 4.5) and its firmware 9 and 10 differences, not with the codec. REALs are IEEE 754: 1.5 = 3FC00000.
#pragma once

#include <string_view>

namespace meca::image::golden {

// clang-format off

inline constexpr std::string_view kOutputs9Little =
    "2A 00 00 00 "                                  // Activate, ResetError, RecoveryMode
    "34 12 "                                        // MoveID 4660
    "0D 00 "                                        // SetPoint, ClearMotion, ResetPStop2
    "1F 4E 00 00 "                                  // MotionCommandID 19999
    "00 00 C0 3F 00 00 10 C0 00 00 40 40 "          // arguments 1.5, -2.25, 3,
    "00 00 80 C0 00 00 B0 40 00 00 C0 C0 "          // -4, 5.5, -6
    "00 F1 53 65 "                                  // HostTime 1700000000 s
    "03 00 00 00 "                                  // BrakesControlAllowed, BrakesEngaged
    "00 00 00 00 28 00 00 00 2E 00 00 00 10 27 00 00 ";  // dynamic data types 0, 40, 46, 10000

inline constexpr std::string_view kOutputs10Little =
    "6A 00 00 00 "                                  // Activate, ResetError, RecoveryMode, DisableEtherCAT
    "34 12 "                                        // MoveID 4660
    "0D 00 "                                        // SetPoint, ClearMotion, ResumeMotion
    "1F 4E 00 00 "                                  // MotionCommandID 19999
    "00 00 C0 3F 00 00 10 C0 00 00 40 40 "          // arguments 1.5, -2.25, 3,
    "00 00 80 C0 00 00 B0 40 00 00 C0 C0 "          // -4, 5.5, -6
    "00 F1 53 65 "                                  // HostTime 1700000000 s
    "03 00 00 00 "                                  // BrakesControlAllowed, BrakesEngaged
    "00 00 00 00 28 00 00 00 2E 00 00 00 10 27 00 00 ";  // dynamic data types 0, 40, 46, 10000

inline constexpr std::string_view kOutputs11Little =
    "6A 00 00 00 "                                  // Activate, ResetError, RecoveryMode, DisableEtherCAT
    "34 12 "                                        // MoveID 4660
    "1D 00 "                                        // SetPoint, ClearMotion, ResumeMotion, UseVariables
    "1F 4E 00 00 "                                  // MotionCommandID 19999
    "00 00 C0 3F 00 00 10 C0 00 00 40 40 "          // arguments 1.5, -2.25, 3,
    "00 00 80 C0 00 00 B0 40 00 00 C0 C0 "          // -4, 5.5, -6
    "00 F1 53 65 "                                  // HostTime 1700000000 s
    "03 00 00 00 "                                  // BrakesControlAllowed, BrakesEngaged
    "00 00 00 00 28 00 00 00 2E 00 00 00 10 27 00 00 ";  // dynamic data types 0, 40, 46, 10000

inline constexpr std::string_view kOutputs9Big =
    "2A 00 00 00 "                                  // Activate, ResetError, RecoveryMode
    "12 34 "                                        // MoveID 4660
    "0D 00 "                                        // SetPoint, ClearMotion, ResetPStop2
    "00 00 4E 1F "                                  // MotionCommandID 19999
    "3F C0 00 00 C0 10 00 00 40 40 00 00 "          // arguments 1.5, -2.25, 3,
    "C0 80 00 00 40 B0 00 00 C0 C0 00 00 "          // -4, 5.5, -6
    "65 53 F1 00 "                                  // HostTime 1700000000 s
    "03 00 00 00 "                                  // BrakesControlAllowed, BrakesEngaged
    "00 00 00 00 00 00 00 28 00 00 00 2E 00 00 27 10 ";  // dynamic data types 0, 40, 46, 10000

inline constexpr std::string_view kOutputs10Big =
    "6A 00 00 00 "                                  // Activate, ResetError, RecoveryMode, DisableEtherCAT
    "12 34 "                                        // MoveID 4660
    "0D 00 "                                        // SetPoint, ClearMotion, ResumeMotion
    "00 00 4E 1F "                                  // MotionCommandID 19999
    "3F C0 00 00 C0 10 00 00 40 40 00 00 "          // arguments 1.5, -2.25, 3,
    "C0 80 00 00 40 B0 00 00 C0 C0 00 00 "          // -4, 5.5, -6
    "65 53 F1 00 "                                  // HostTime 1700000000 s
    "03 00 00 00 "                                  // BrakesControlAllowed, BrakesEngaged
    "00 00 00 00 00 00 00 28 00 00 00 2E 00 00 27 10 ";  // dynamic data types 0, 40, 46, 10000

inline constexpr std::string_view kOutputs11Big =
    "6A 00 00 00 "                                  // Activate, ResetError, RecoveryMode, DisableEtherCAT
    "12 34 "                                        // MoveID 4660
    "1D 00 "                                        // SetPoint, ClearMotion, ResumeMotion, UseVariables
    "00 00 4E 1F "                                  // MotionCommandID 19999
    "3F C0 00 00 C0 10 00 00 40 40 00 00 "          // arguments 1.5, -2.25, 3,
    "C0 80 00 00 40 B0 00 00 C0 C0 00 00 "          // -4, 5.5, -6
    "65 53 F1 00 "                                  // HostTime 1700000000 s
    "03 00 00 00 "                                  // BrakesControlAllowed, BrakesEngaged
    "00 00 00 00 00 00 00 28 00 00 00 2E 00 00 27 10 ";  // dynamic data types 0, 40, 46, 10000

inline constexpr std::string_view kInputs9Little =
    "16 00 "                                        // RobotStatus: Activated, Homed, BrakesEngaged
    "E1 0B "                                        // ErrorCode 3041
    "45 23 01 00 "                                  // Checkpoint 74565 (32 bits in this firmware)
    "34 12 C8 32 "                                  // MoveID 4660, FIFOSpace 13000
    "69 00 "                                        // Paused, Cleared, ExcessiveTorque, PStop2Resettable
    "FF FF "                                        // OfflineProgramID 65535
    "00 00 C0 3F 00 00 10 C0 00 00 40 40 "          // TargetJointSet 1.5, -2.25, 3,
    "00 00 80 C0 00 00 B0 40 00 00 C0 C0 "          // -4, 5.5, -6 deg
    "00 00 3E 43 00 00 00 BF 00 00 9A 43 "          // TargetEndEffectorPose 190, -0.5, 308 mm,
    "00 00 00 00 00 00 B4 42 00 00 34 C3 "          // 0, 90, -180 deg
    "FF 01 00 9C "                                  // Shoulder -1, Elbow 1, Wrist 0, Turn -100
    "00 00 80 3F 00 00 00 40 00 00 40 40 "          // TargetWrf 1, 2, 3 mm,
    "00 00 20 41 00 00 A0 41 00 00 F0 41 "          // 10, 20, 30 deg
    "00 00 80 BF 00 00 00 C0 00 00 40 C0 "          // TargetTrf -1, -2, -3 mm,
    "00 00 20 C1 00 00 A0 C1 00 00 F0 C1 "          // -10, -20, -30 deg
    "78 56 34 12 3F 42 0F 00 07 00 00 00 "          // RobotTimestamp 305419896 s, 999999 us, DynamicDataUpdateCount 7
    "00 00 00 00 00 00 00 00 00 00 00 00 "          // no SafetyStatus: twelve reserved bytes
    "28 00 00 00 "                                  // slot 0: 40, joint position (actual)
    "00 00 80 3F 00 00 00 40 00 00 40 40 "
    "00 00 80 40 00 00 A0 40 00 00 C0 40 "
    "01 00 00 00 "                                  // slot 1: 1, firmware version
    "00 00 30 41 00 00 40 40 00 00 40 40 "
    "00 74 45 46 00 00 00 00 00 00 00 00 "
    "14 00 00 00 "                                  // slot 2: 20, configuration, NaN = automatic
    "00 00 C0 7F 00 00 C0 7F 00 00 C0 7F "
    "00 00 C0 7F 00 00 00 00 00 00 00 00 "
    "10 27 00 00 "                                  // slot 3: 10000, a variable
    "00 00 00 3F 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 ";

inline constexpr std::string_view kInputs10Little =
    "86 01 "                                        // RobotStatus: Activated, Homed, CollisionStatus, WorkZoneStatus
    "E1 0B "                                        // ErrorCode 3041
    "45 23 01 00 "                                  // Checkpoint 74565 (32 bits in this firmware)
    "34 12 C8 32 "                                  // MoveID 4660, FIFOSpace 13000
    "29 00 "                                        // Paused, Cleared, ExcessiveTorque
    "FF FF "                                        // OfflineProgramID 65535
    "00 00 C0 3F 00 00 10 C0 00 00 40 40 "          // TargetJointSet 1.5, -2.25, 3,
    "00 00 80 C0 00 00 B0 40 00 00 C0 C0 "          // -4, 5.5, -6 deg
    "00 00 3E 43 00 00 00 BF 00 00 9A 43 "          // TargetEndEffectorPose 190, -0.5, 308 mm,
    "00 00 00 00 00 00 B4 42 00 00 34 C3 "          // 0, 90, -180 deg
    "FF 01 00 9C "                                  // Shoulder -1, Elbow 1, Wrist 0, Turn -100
    "00 00 80 3F 00 00 00 40 00 00 40 40 "          // TargetWrf 1, 2, 3 mm,
    "00 00 20 41 00 00 A0 41 00 00 F0 41 "          // 10, 20, 30 deg
    "00 00 80 BF 00 00 00 C0 00 00 40 C0 "          // TargetTrf -1, -2, -3 mm,
    "00 00 20 C1 00 00 A0 C1 00 00 F0 C1 "          // -10, -20, -30 deg
    "78 56 34 12 3F 42 0F 00 07 00 00 00 "          // RobotTimestamp 305419896 s, 999999 us, DynamicDataUpdateCount 7
    "85 04 00 00 "                                  // stop: EStop, PStop2, Reboot, ConnectionDropped
    "04 08 00 00 "                                  // resettable: PStop2, MinorError
    "01 02 22 00 "                                  // OperationMode 1, VMotorOn, PowerSupplyInput PStop1 and EnablingDevice
    "28 00 00 00 "                                  // slot 0: 40, joint position (actual)
    "00 00 80 3F 00 00 00 40 00 00 40 40 "
    "00 00 80 40 00 00 A0 40 00 00 C0 40 "
    "01 00 00 00 "                                  // slot 1: 1, firmware version
    "00 00 30 41 00 00 40 40 00 00 40 40 "
    "00 74 45 46 00 00 00 00 00 00 00 00 "
    "14 00 00 00 "                                  // slot 2: 20, configuration, NaN = automatic
    "00 00 C0 7F 00 00 C0 7F 00 00 C0 7F "
    "00 00 C0 7F 00 00 00 00 00 00 00 00 "
    "10 27 00 00 "                                  // slot 3: 10000, a variable
    "00 00 00 3F 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 ";

inline constexpr std::string_view kInputs11Little =
    "86 03 "                                        // RobotStatus: Activated, Homed, CollisionStatus, WorkZoneStatus, MonitoringMode
    "E1 0B "                                        // ErrorCode 3041
    "40 1F 3F 1F "                                  // Checkpoint 8000, CheckpointDiscarded 7999
    "34 12 C8 32 "                                  // MoveID 4660, FIFOSpace 13000
    "29 00 "                                        // Paused, Cleared, ExcessiveTorque
    "FF FF "                                        // OfflineProgramID 65535
    "00 00 C0 3F 00 00 10 C0 00 00 40 40 "          // TargetJointSet 1.5, -2.25, 3,
    "00 00 80 C0 00 00 B0 40 00 00 C0 C0 "          // -4, 5.5, -6 deg
    "00 00 3E 43 00 00 00 BF 00 00 9A 43 "          // TargetEndEffectorPose 190, -0.5, 308 mm,
    "00 00 00 00 00 00 B4 42 00 00 34 C3 "          // 0, 90, -180 deg
    "FF 01 00 9C "                                  // Shoulder -1, Elbow 1, Wrist 0, Turn -100
    "00 00 80 3F 00 00 00 40 00 00 40 40 "          // TargetWrf 1, 2, 3 mm,
    "00 00 20 41 00 00 A0 41 00 00 F0 41 "          // 10, 20, 30 deg
    "00 00 80 BF 00 00 00 C0 00 00 40 C0 "          // TargetTrf -1, -2, -3 mm,
    "00 00 20 C1 00 00 A0 C1 00 00 F0 C1 "          // -10, -20, -30 deg
    "78 56 34 12 3F 42 0F 00 07 00 00 00 "          // RobotTimestamp 305419896 s, 999999 us, DynamicDataUpdateCount 7
    "85 04 00 00 "                                  // stop: EStop, PStop2, Reboot, ConnectionDropped
    "04 08 00 00 "                                  // resettable: PStop2, MinorError
    "01 02 22 00 "                                  // OperationMode 1, VMotorOn, PowerSupplyInput PStop1 and EnablingDevice
    "28 00 00 00 "                                  // slot 0: 40, joint position (actual)
    "00 00 80 3F 00 00 00 40 00 00 40 40 "
    "00 00 80 40 00 00 A0 40 00 00 C0 40 "
    "01 00 00 00 "                                  // slot 1: 1, firmware version
    "00 00 30 41 00 00 40 40 00 00 40 40 "
    "00 74 45 46 00 00 00 00 00 00 00 00 "
    "14 00 00 00 "                                  // slot 2: 20, configuration, NaN = automatic
    "00 00 C0 7F 00 00 C0 7F 00 00 C0 7F "
    "00 00 C0 7F 00 00 00 00 00 00 00 00 "
    "10 27 00 00 "                                  // slot 3: 10000, a variable
    "00 00 00 3F 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 ";

inline constexpr std::string_view kInputs9Big =
    "16 00 "                                        // RobotStatus: Activated, Homed, BrakesEngaged
    "0B E1 "                                        // ErrorCode 3041
    "00 01 23 45 "                                  // Checkpoint 74565 (32 bits in this firmware)
    "12 34 32 C8 "                                  // MoveID 4660, FIFOSpace 13000
    "69 00 "                                        // Paused, Cleared, ExcessiveTorque, PStop2Resettable
    "FF FF "                                        // OfflineProgramID 65535
    "3F C0 00 00 C0 10 00 00 40 40 00 00 "          // TargetJointSet 1.5, -2.25, 3,
    "C0 80 00 00 40 B0 00 00 C0 C0 00 00 "          // -4, 5.5, -6 deg
    "43 3E 00 00 BF 00 00 00 43 9A 00 00 "          // TargetEndEffectorPose 190, -0.5, 308 mm,
    "00 00 00 00 42 B4 00 00 C3 34 00 00 "          // 0, 90, -180 deg
    "FF 01 00 9C "                                  // Shoulder -1, Elbow 1, Wrist 0, Turn -100
    "3F 80 00 00 40 00 00 00 40 40 00 00 "          // TargetWrf 1, 2, 3 mm,
    "41 20 00 00 41 A0 00 00 41 F0 00 00 "          // 10, 20, 30 deg
    "BF 80 00 00 C0 00 00 00 C0 40 00 00 "          // TargetTrf -1, -2, -3 mm,
    "C1 20 00 00 C1 A0 00 00 C1 F0 00 00 "          // -10, -20, -30 deg
    "12 34 56 78 00 0F 42 3F 00 00 00 07 "          // RobotTimestamp 305419896 s, 999999 us, DynamicDataUpdateCount 7
    "00 00 00 00 00 00 00 00 00 00 00 00 "          // no SafetyStatus: twelve reserved bytes
    "00 00 00 28 "                                  // slot 0: 40, joint position (actual)
    "3F 80 00 00 40 00 00 00 40 40 00 00 "
    "40 80 00 00 40 A0 00 00 40 C0 00 00 "
    "00 00 00 01 "                                  // slot 1: 1, firmware version
    "41 30 00 00 40 40 00 00 40 40 00 00 "
    "46 45 74 00 00 00 00 00 00 00 00 00 "
    "00 00 00 14 "                                  // slot 2: 20, configuration, NaN = automatic
    "7F C0 00 00 7F C0 00 00 7F C0 00 00 "
    "7F C0 00 00 00 00 00 00 00 00 00 00 "
    "00 00 27 10 "                                  // slot 3: 10000, a variable
    "3F 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 ";

inline constexpr std::string_view kInputs10Big =
    "86 01 "                                        // RobotStatus: Activated, Homed, CollisionStatus, WorkZoneStatus
    "0B E1 "                                        // ErrorCode 3041
    "00 01 23 45 "                                  // Checkpoint 74565 (32 bits in this firmware)
    "12 34 32 C8 "                                  // MoveID 4660, FIFOSpace 13000
    "29 00 "                                        // Paused, Cleared, ExcessiveTorque
    "FF FF "                                        // OfflineProgramID 65535
    "3F C0 00 00 C0 10 00 00 40 40 00 00 "          // TargetJointSet 1.5, -2.25, 3,
    "C0 80 00 00 40 B0 00 00 C0 C0 00 00 "          // -4, 5.5, -6 deg
    "43 3E 00 00 BF 00 00 00 43 9A 00 00 "          // TargetEndEffectorPose 190, -0.5, 308 mm,
    "00 00 00 00 42 B4 00 00 C3 34 00 00 "          // 0, 90, -180 deg
    "FF 01 00 9C "                                  // Shoulder -1, Elbow 1, Wrist 0, Turn -100
    "3F 80 00 00 40 00 00 00 40 40 00 00 "          // TargetWrf 1, 2, 3 mm,
    "41 20 00 00 41 A0 00 00 41 F0 00 00 "          // 10, 20, 30 deg
    "BF 80 00 00 C0 00 00 00 C0 40 00 00 "          // TargetTrf -1, -2, -3 mm,
    "C1 20 00 00 C1 A0 00 00 C1 F0 00 00 "          // -10, -20, -30 deg
    "12 34 56 78 00 0F 42 3F 00 00 00 07 "          // RobotTimestamp 305419896 s, 999999 us, DynamicDataUpdateCount 7
    "85 04 00 00 "                                  // stop: EStop, PStop2, Reboot, ConnectionDropped
    "04 08 00 00 "                                  // resettable: PStop2, MinorError
    "01 02 22 00 "                                  // OperationMode 1, VMotorOn, PowerSupplyInput PStop1 and EnablingDevice
    "00 00 00 28 "                                  // slot 0: 40, joint position (actual)
    "3F 80 00 00 40 00 00 00 40 40 00 00 "
    "40 80 00 00 40 A0 00 00 40 C0 00 00 "
    "00 00 00 01 "                                  // slot 1: 1, firmware version
    "41 30 00 00 40 40 00 00 40 40 00 00 "
    "46 45 74 00 00 00 00 00 00 00 00 00 "
    "00 00 00 14 "                                  // slot 2: 20, configuration, NaN = automatic
    "7F C0 00 00 7F C0 00 00 7F C0 00 00 "
    "7F C0 00 00 00 00 00 00 00 00 00 00 "
    "00 00 27 10 "                                  // slot 3: 10000, a variable
    "3F 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 ";

inline constexpr std::string_view kInputs11Big =
    "86 03 "                                        // RobotStatus: Activated, Homed, CollisionStatus, WorkZoneStatus, MonitoringMode
    "0B E1 "                                        // ErrorCode 3041
    "1F 40 1F 3F "                                  // Checkpoint 8000, CheckpointDiscarded 7999
    "12 34 32 C8 "                                  // MoveID 4660, FIFOSpace 13000
    "29 00 "                                        // Paused, Cleared, ExcessiveTorque
    "FF FF "                                        // OfflineProgramID 65535
    "3F C0 00 00 C0 10 00 00 40 40 00 00 "          // TargetJointSet 1.5, -2.25, 3,
    "C0 80 00 00 40 B0 00 00 C0 C0 00 00 "          // -4, 5.5, -6 deg
    "43 3E 00 00 BF 00 00 00 43 9A 00 00 "          // TargetEndEffectorPose 190, -0.5, 308 mm,
    "00 00 00 00 42 B4 00 00 C3 34 00 00 "          // 0, 90, -180 deg
    "FF 01 00 9C "                                  // Shoulder -1, Elbow 1, Wrist 0, Turn -100
    "3F 80 00 00 40 00 00 00 40 40 00 00 "          // TargetWrf 1, 2, 3 mm,
    "41 20 00 00 41 A0 00 00 41 F0 00 00 "          // 10, 20, 30 deg
    "BF 80 00 00 C0 00 00 00 C0 40 00 00 "          // TargetTrf -1, -2, -3 mm,
    "C1 20 00 00 C1 A0 00 00 C1 F0 00 00 "          // -10, -20, -30 deg
    "12 34 56 78 00 0F 42 3F 00 00 00 07 "          // RobotTimestamp 305419896 s, 999999 us, DynamicDataUpdateCount 7
    "85 04 00 00 "                                  // stop: EStop, PStop2, Reboot, ConnectionDropped
    "04 08 00 00 "                                  // resettable: PStop2, MinorError
    "01 02 22 00 "                                  // OperationMode 1, VMotorOn, PowerSupplyInput PStop1 and EnablingDevice
    "00 00 00 28 "                                  // slot 0: 40, joint position (actual)
    "3F 80 00 00 40 00 00 00 40 40 00 00 "
    "40 80 00 00 40 A0 00 00 40 C0 00 00 "
    "00 00 00 01 "                                  // slot 1: 1, firmware version
    "41 30 00 00 40 40 00 00 40 40 00 00 "
    "46 45 74 00 00 00 00 00 00 00 00 00 "
    "00 00 00 14 "                                  // slot 2: 20, configuration, NaN = automatic
    "7F C0 00 00 7F C0 00 00 7F C0 00 00 "
    "7F C0 00 00 00 00 00 00 00 00 00 00 "
    "00 00 27 10 "                                  // slot 3: 10000, a variable
    "3F 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 ";

// clang-format on

}  // namespace meca::image::golden
