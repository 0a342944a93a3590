// The cyclic process image of the Meca500 as plain structs: what the 60 output bytes and 252 input bytes say.
// No bytes here: positions stand once, in field_table.hpp; codec.hpp turns bytes into these structs and back.
// Section and field names are the robot manual's (fw 11.x, section 4); fields the Meca500 does not use are kept,
// because the bytes exist and other Mecademic robots fill them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace meca::image {

inline constexpr std::size_t kOutputSize = 60;   // bytes, host -> robot (manual 4.4)
inline constexpr std::size_t kInputSize = 252;   // bytes, robot -> host (manual 4.5)
inline constexpr std::size_t kDynamicSlots = 4;  // dynamic data slots per image (manual 4.4.6)

using OutputBytes = std::array<std::byte, kOutputSize>;
using InputBytes = std::array<std::byte, kInputSize>;

// Firmware 9, 10 and 11 share the sizes and differ in meaning. The layout follows from the firmware the robot reports,
// never from a size or an EtherCAT revision (both stay the same).
enum class Layout : std::uint8_t { kFirmware9, kFirmware10, kFirmware11 };

// By the firmware's major version; empty before 9, whose image is another one. inferred: generations after 11 keep its
// layout until a document says otherwise.
constexpr std::optional<Layout> layout_of(unsigned major) noexcept {
  if (major < 9) return std::nullopt;
  return major == 9 ? Layout::kFirmware9 : major == 10 ? Layout::kFirmware10 : Layout::kFirmware11;
}

// "9.x", "10.x", "11.x".
constexpr std::string_view to_string(Layout layout) noexcept {
  switch (layout) {
    case Layout::kFirmware9:
      return "9.x";
    case Layout::kFirmware10:
      return "10.x";
    case Layout::kFirmware11:
      return "11.x";
  }
  return "";
}

// ---------------------------------------------------------------- output, host -> robot

struct RobotControl {       // manual 4.4.1
  bool deactivate{};        // level; wins over activate
  bool activate{};          // level; confirmed by RobotStatus.activated
  bool home{};              // level; confirmed by RobotStatus.homed
  bool reset_error{};       // level; confirmed by error_code == 0
  bool sim_mode{};          // level; only while deactivated
  bool recovery_mode{};     // level
  bool disable_ethercat{};  // firmware >= 10: leaves EtherCAT for TCP/IP
  friend bool operator==(const RobotControl&, const RobotControl&) = default;
};

struct MotionControl {      // manual 4.4.2
  std::uint16_t move_id{};  // a change queues the command; 0 = cyclic mode (velocity)
  bool set_point{};         // must be 1 for commands to be taken
  bool pause_motion{};      // level
  bool clear_motion{};      // level; no command is taken while set
  bool resume_motion{};     // rising edge (firmware 9: ResetPStop2, see field table)
  bool use_variables{};     // firmware 11: arguments are cyclic ids of variables
  friend bool operator==(const MotionControl&, const MotionControl&) = default;
};

struct MotionCommand {  // manual 4.4.3
  std::uint32_t command_id{};
  std::array<float, 6> arguments{};
  friend bool operator==(const MotionCommand&, const MotionCommand&) = default;
};

struct HostTime {           // manual 4.4.4
  std::uint32_t seconds{};  // Unix seconds; 0 = leave the robot's clock alone
  friend bool operator==(const HostTime&, const HostTime&) = default;
};

struct BrakesControl {  // manual 4.4.5
  bool brakes_control_allowed{};
  bool brakes_engaged{};  // with the gate set and the robot deactivated: false lets the arm fall
  friend bool operator==(const BrakesControl&, const BrakesControl&) = default;
};

struct DynamicDataConfiguration {                       // manual 4.4.6
  std::array<std::uint32_t, kDynamicSlots> type_ids{};  // 0 = automatic
  friend bool operator==(const DynamicDataConfiguration&, const DynamicDataConfiguration&) = default;
};

struct Outputs {
  RobotControl robot_control;
  MotionControl motion_control;
  MotionCommand motion_command;
  HostTime host_time;
  BrakesControl brakes_control;
  DynamicDataConfiguration dynamic_data_configuration;
  friend bool operator==(const Outputs&, const Outputs&) = default;
};

// ---------------------------------------------------------------- input, robot -> host

struct RobotStatus {  // manual 4.5.1
  bool busy{};        // activating, homing or deactivating
  bool activated{};
  bool homed{};
  bool sim_activated{};
  bool brakes_engaged{};  // a real 9.x robot showed 1 while activated: not a readiness test
  bool recovery_mode{};
  bool e_stop{};            // deprecated: use SafetyStatus
  bool collision_status{};  // firmware >= 10
  bool work_zone_status{};  // firmware >= 10
  bool monitoring_mode{};   // firmware >= 11: this connection may only monitor
  std::uint16_t error_code{};
  friend bool operator==(const RobotStatus&, const RobotStatus&) = default;
};

struct MotionStatus {                    // manual 4.5.2
  std::uint32_t checkpoint_reached{};    // 16 bits in firmware 11, 32 bits before
  std::uint16_t checkpoint_discarded{};  // firmware 11; 0 before
  std::uint16_t move_id{};               // echo of the last command received
  std::uint16_t fifo_space{};            // free queue entries, at most 13000
  bool paused{};
  bool eob{};
  bool eom{};
  bool cleared{};
  bool p_stop2{};  // deprecated: use SafetyStatus
  bool excessive_torque{};
  bool p_stop2_resettable{};           // firmware 9 only, bit 12:6
  std::uint16_t offline_program_id{};  // 0 none, 65535 a program without cyclic id
  friend bool operator==(const MotionStatus&, const MotionStatus&) = default;
};

struct TargetJointSet {           // manual 4.5.3
  std::array<float, 6> joints{};  // degrees
  friend bool operator==(const TargetJointSet&, const TargetJointSet&) = default;
};

struct Pose {
  float x{}, y{}, z{};             // mm
  float alpha{}, beta{}, gamma{};  // degrees, mobile XYZ Euler angles
  friend bool operator==(const Pose&, const Pose&) = default;
};

struct TargetConfiguration {                 // manual 4.5.5
  std::int8_t shoulder{}, elbow{}, wrist{};  // -1, 1; 0 near the singularity
  std::int8_t turn{};                        // -100..100
  friend bool operator==(const TargetConfiguration&, const TargetConfiguration&) = default;
};

struct RobotTimestamp {          // manual 4.5.8
  std::uint32_t seconds{};       // monotonic, arbitrary reference
  std::uint32_t microseconds{};  // 0..999999
  std::uint32_t dynamic_data_update_count{};
  friend bool operator==(const RobotTimestamp&, const RobotTimestamp&) = default;
};

// The stop signals in the bit order of bytes 128-129 and 132-133, whose bit 3 is reserved (manual 4.5.9).
struct StopSignals {
  bool e_stop{};
  bool p_stop1{};  // not on the Meca500
  bool p_stop2{};
  bool operation_mode_change{};     // not on the Meca500
  bool enabling_device_released{};  // not on the Meca500
  bool voltage_fluctuation{};       // not on the Meca500
  bool reboot{};                    // manual: not on the Meca500; EDS 11.3 and ESI 10.2.1 name it
  bool redundancy_fault{};          // not on the Meca500
  bool standstill_fault{};          // not on the Meca500
  bool connection_dropped{};
  bool minor_error{};  // not on the Meca500
  friend bool operator==(const StopSignals&, const StopSignals&) = default;
};

struct PowerSupplyInputs {  // not on the Meca500
  bool e_stop{}, p_stop1{}, p_stop2{}, external_reset{}, keypad_reset{}, enabling_device{};
  friend bool operator==(const PowerSupplyInputs&, const PowerSupplyInputs&) = default;
};

struct SafetyStatus {  // manual 4.5.9; firmware >= 10
  // False when the image has no safety section (firmware 9): the zeros below then mean nothing, least of all "no stop".
  bool known{};
  StopSignals stop;               // 1 = present or resettable, 0 = reset
  StopSignals resettable;         // 1 = ready to be reset
  std::uint8_t operation_mode{};  // 0 locked, 1 auto, 2 manual; not on the Meca500
  bool reset_ready{};             // R4: Reset button may be pressed
  bool vmotor_on{};               // motors powered
  PowerSupplyInputs power_supply_inputs;
  friend bool operator==(const SafetyStatus&, const SafetyStatus&) = default;
};

struct DynamicData {  // manual 4.5.10, one slot
  std::uint32_t type_id{};
  std::array<float, 6> values{};  // meaning by type: see dynamic_data_types.hpp; NaN is a legal value
  friend bool operator==(const DynamicData&, const DynamicData&) = default;
};

struct Inputs {
  RobotStatus robot_status;
  MotionStatus motion_status;
  TargetJointSet target_joint_set;
  Pose target_end_effector_pose;  // TRF in WRF
  TargetConfiguration target_configuration;
  Pose target_wrf;  // WRF in BRF
  Pose target_trf;  // TRF in FRF
  RobotTimestamp robot_timestamp;
  SafetyStatus safety_status;
  std::array<DynamicData, kDynamicSlots> dynamic_data;
  friend bool operator==(const Inputs&, const Inputs&) = default;
};

}  // namespace meca::image
