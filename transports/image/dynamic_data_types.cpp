#include "transports/image/dynamic_data_types.hpp"

#include <algorithm>
#include <bit>

#include "transports/image/motion_commands.hpp"

namespace meca::image {
namespace {

constexpr ValueInfo kVersion[] = {{"major version", ""}, {"minor version", ""}, {"patch", ""}, {"build", ""}};
constexpr ValueInfo kProduct[] = {{"product type", ""}};  // 3 Meca500 R3, 4 Meca500 R4, 20 MCS500 R1
// A REAL holds 24 bits, so the serial number comes twice: rounded, and exactly as the bits of a UINT32.
constexpr ValueInfo kSerial[] = {{"serial number (rounded)", ""}, {"serial number", "", true}};
constexpr ValueInfo kEnabled[] = {{"enabled", ""}};
constexpr ValueInfo kLimits123[] = {{"joint 1 min", "deg"}, {"joint 2 min", "deg"}, {"joint 3 min", "deg"},
                                    {"joint 1 max", "deg"}, {"joint 2 max", "deg"}, {"joint 3 max", "deg"}};
constexpr ValueInfo kLimits456[] = {{"joint 4 min", "deg"}, {"joint 5 min", "deg"}, {"joint 6 min", "deg"},
                                    {"joint 4 max", "deg"}, {"joint 5 max", "deg"}, {"joint 6 max", "deg"}};
constexpr ValueInfo kWorkZoneCfg[] = {{"severity", ""}, {"mode", ""}};
constexpr ValueInfo kWorkZone[] = {{"x min", "mm"}, {"y min", "mm"}, {"z min", "mm"},
                                   {"x max", "mm"}, {"y max", "mm"}, {"z max", "mm"}};
constexpr ValueInfo kSphere[] = {{"x", "mm"}, {"y", "mm"}, {"z", "mm"}, {"radius", "mm"}};
constexpr ValueInfo kConf[] = {{"shoulder", ""}, {"elbow", ""}, {"wrist", ""}, {"turn", ""}};  // NaN = automatic
constexpr ValueInfo kParameters[] = {{"blending", "%"}, {"velocity timeout", "s"}};
// inferred: the manual says percent for all six; two of them can only be mm/s and deg/s.
constexpr ValueInfo kVelocitySettings[] = {{"joint velocity", "%"},         {"joint acceleration", "%"},
                                           {"linear velocity", "mm/s"},     {"angular velocity", "deg/s"},
                                           {"cartesian acceleration", "%"}, {"joint velocity limit", "%"}};
constexpr ValueInfo kGripperCfg[] = {
    {"gripper force", "%"}, {"gripper velocity", "%"}, {"closed position", "mm"}, {"open position", "mm"}};
constexpr ValueInfo kTorqueCfg[] = {{"severity", ""}, {"mode", ""}};
constexpr ValueInfo kTorques[] = {{"joint 1", "%"}, {"joint 2", "%"}, {"joint 3", "%"},
                                  {"joint 4", "%"}, {"joint 5", "%"}, {"joint 6", "%"}};
constexpr ValueInfo kVacuumCfg[] = {{"hold threshold", "kPa"}, {"release threshold", "kPa"}, {"purge duration", "s"}};
constexpr ValueInfo kDuration[] = {{"move mode", ""}, {"severity", ""}, {"duration", "s"}};
constexpr ValueInfo kCalibration[] = {{"enabled", ""}, {"calibrated", ""}};
constexpr ValueInfo kPayload[] = {{"mass", "kg"}, {"centre x", "mm"}, {"centre y", "mm"}, {"centre z", "mm"}};
constexpr ValueInfo kJointVelocities[] = {{"joint 1", "deg/s"}, {"joint 2", "deg/s"}, {"joint 3", "deg/s"},
                                          {"joint 4", "deg/s"}, {"joint 5", "deg/s"}, {"joint 6", "deg/s"}};
constexpr ValueInfo kCartVelocities[] = {{"vx", "mm/s"},  {"vy", "mm/s"},  {"vz", "mm/s"},
                                         {"wx", "deg/s"}, {"wy", "deg/s"}, {"wz", "deg/s"}};
constexpr ValueInfo kSeverity[] = {{"severity", ""}};
// Groups: 0 robot, 1 flange, 2 tool, 3 environment, 4 work zone. Parts of the robot: 0 base, 1..6 links.
constexpr ValueInfo kCollision[] = {
    {"collision", ""}, {"first group", ""}, {"first part", ""}, {"second group", ""}, {"second part", ""}};
constexpr ValueInfo kWorkZoneStatus[] = {{"breach", ""}, {"group", ""}, {"part", ""}};
constexpr ValueInfo kJoints[] = {{"joint 1", "deg"}, {"joint 2", "deg"}, {"joint 3", "deg"},
                                 {"joint 4", "deg"}, {"joint 5", "deg"}, {"joint 6", "deg"}};
constexpr ValueInfo kPose[] = {{"x", "mm"},      {"y", "mm"},     {"z", "mm"},
                               {"alpha", "deg"}, {"beta", "deg"}, {"gamma", "deg"}};
constexpr ValueInfo kAcceleration[] = {{"ax", "g/16000"}, {"ay", "g/16000"}, {"az", "g/16000"}};
// Tool types: 0 none, 10 MEGP25E, 11 MEGP25LS, 20 MPM500.
constexpr ValueInfo kTool[] = {{"tool type", ""}, {"homing done", ""}, {"error", ""}, {"overheated", ""}};
// A gripper's reading; with a pneumatic module the first two values are the valves, which the slot does not tell.
constexpr ValueInfo kGripper[] = {{"holding part, or valve 1", ""},
                                  {"target reached, or valve 2", ""},
                                  {"closed", ""},
                                  {"open", ""},
                                  {"force", "%"},
                                  {"position", "mm"}};
constexpr ValueInfo kTimeScaling[] = {{"time scaling", "%"}};
constexpr ValueInfo kVariable[] = {{"value 1", ""}, {"value 2", ""}, {"value 3", ""},
                                   {"value 4", ""}, {"value 5", ""}, {"value 6", ""}};

// Firmware 10 and 11, ascending by id. An entry without values is named in a document that does not say what it holds.
constexpr DynamicDataInfo kTypes[] = {
    {kDynAutomatic, "automatic", {}, true},
    {kDynFirmwareVersion, "firmware version", kVersion, true},
    {kDynProductType, "product type", kProduct, true},
    {kDynSerialNumber, "serial number", kSerial, true},
    {4, "reserved", {}, true},
    {5, "reserved", {}, true},
    {6, "reserved", {}, true},
    {7, "reserved", {}, true},
    {8, "reserved", {}, true},
    {9, "reserved", {}, true},
    {10, "reserved", {}, true},
    {11, "joint limits enabled", kEnabled, true},
    {12, "joint limits 1-3 (model)", kLimits123, true},
    {13, "joint limits 4-6 (model)", kLimits456, true},
    {14, "joint limits 1-3 (effective)", kLimits123, true},
    {15, "joint limits 4-6 (effective)", kLimits456, true},
    {16, "external tool firmware version", {}, true},
    {17, "work zone configuration", kWorkZoneCfg, true},
    {18, "work zone limits", kWorkZone, true},
    {19, "tool sphere", kSphere, true},
    {20, "configuration (requested)", kConf, true},
    {21, "blending and velocity timeout", kParameters, true},
    {22, "velocities and accelerations", kVelocitySettings, true},
    {23, "gripper settings", kGripperCfg, true},
    {24, "torque limits configuration", kTorqueCfg, true},
    {25, "torque limits", kTorques, true},
    {26, "vacuum settings", kVacuumCfg, false},
    {27, "jump height", {}, false},
    {28, "jump approach velocity", {}, false},
    {29, "move mode and duration", kDuration, true},
    {30, "calibration", kCalibration, true},
    {31, "payload", kPayload, true},
    {32, "joint velocity (target)", kJointVelocities, true},
    {33, "joint torque (target)", kTorques, true},
    {34, "cartesian velocity (target)", kCartVelocities, true},
    {36, "collision configuration", kSeverity, true},
    {37, "collision status", kCollision, true},
    {38, "work zone status", kWorkZoneStatus, true},
    {40, "joint position (actual)", kJoints, true},
    {41, "cartesian position (actual)", kPose, true},
    {42, "joint velocity (actual)", kJointVelocities, true},
    {43, "joint torque (actual)", kTorques, true},
    {44, "cartesian velocity (actual)", kCartVelocities, true},
    {45, "configuration (actual)", kConf, true},
    {46, "accelerometer", kAcceleration, true},
    {52, "external tool status", kTool, true},
    {53, "gripper or valve state", kGripper, true},
    {54, "time scaling", kTimeScaling, true},
    {55, "temperature", {}, false},
    {56, "motor load (I2t)", {}, false},
    {61, "joint limits 1-3 (configured)", kLimits123, true},
    {62, "joint limits 4-6 (configured)", kLimits456, true},
    {72, "I/O module state", {}, false},
    {73, "vacuum gripper state", {}, false},
    {74, "gripper module I/O state", {}, false},
    {77, "MVK01 adapter I/O state", {}, false},
    {78, "signal generator I/O state", {}, false},
    {79, "power supply adapter I/O state", {}, false},
    {kFirstVariable, "variable", kVariable, true},
};

// Where firmware 9 says something else. not published for firmware 10: taken to be as 11.
constexpr ValueInfo kPairs123[] = {{"joint 1 min", "deg"}, {"joint 1 max", "deg"}, {"joint 2 min", "deg"},
                                   {"joint 2 max", "deg"}, {"joint 3 min", "deg"}, {"joint 3 max", "deg"}};
constexpr ValueInfo kPairs456[] = {{"joint 4 min", "deg"}, {"joint 4 max", "deg"}, {"joint 5 min", "deg"},
                                   {"joint 5 max", "deg"}, {"joint 6 min", "deg"}, {"joint 6 max", "deg"}};
constexpr std::span kFiveVelocitySettings = std::span(kVelocitySettings).first<5>();

constexpr DynamicDataInfo kTypes9[] = {
    {4, "joint mastering offsets", kJoints, true},
    {5, "DH parameters of joint 1", {}, true},  // not published: which value is which
    {6, "DH parameters of joint 2", {}, true},
    {7, "DH parameters of joint 3", {}, true},
    {8, "DH parameters of joint 4", {}, true},
    {9, "DH parameters of joint 5", {}, true},
    {10, "DH parameters of joint 6", {}, true},
    {14, "joint limits 1-3 (effective)", kPairs123, true},
    {15, "joint limits 4-6 (effective)", kPairs456, true},
    {22, "velocities and accelerations", kFiveVelocitySettings, true},
};

constexpr bool ascending(std::span<const DynamicDataInfo> types) {
  return std::ranges::adjacent_find(types, std::ranges::greater_equal{}, &DynamicDataInfo::id) == types.end();
}
static_assert(ascending(kTypes) && ascending(kTypes9));

const DynamicDataInfo* find_in(std::span<const DynamicDataInfo> types, std::uint32_t id) noexcept {
  const auto found = std::ranges::lower_bound(types, id, {}, &DynamicDataInfo::id);
  return found != types.end() && found->id == id ? &*found : nullptr;
}

}  // namespace

std::span<const DynamicDataInfo> dynamic_data_types() noexcept { return kTypes; }

const DynamicDataInfo* find_dynamic_data_type(std::uint32_t id, Layout layout) noexcept {
  if (id >= kFirstVariable && id <= kLastVariable) id = kFirstVariable;
  if (layout == Layout::kFirmware9) {
    if (const auto* found = find_in(kTypes9, id)) return found;
  }
  return find_in(kTypes, id);
}

double dynamic_value(const ValueInfo& info, float raw) noexcept {
  return info.bit_pattern ? static_cast<double>(std::bit_cast<std::uint32_t>(raw)) : static_cast<double>(raw);
}

}  // namespace meca::image
