// Each bit by name, and each value of the dynamic data by number: a swap of two neighbours in the table shows here.
// Positions: robot manual firmware 11.3, 4.4 and 4.5.
#include <gtest/gtest.h>

#include "tests/unit/image/support.hpp"

namespace meca::image {
namespace {

constexpr Format kFormat{Layout::kFirmware11};

template <class Image>
struct NamedBit {
  std::size_t byte, bit;
  bool& (*member)(Image&);
};

// clang-format off
constexpr NamedBit<Outputs> kOutputBits[] = {
    {0, 0, [](Outputs& o) -> bool& { return o.robot_control.deactivate; }},
    {0, 1, [](Outputs& o) -> bool& { return o.robot_control.activate; }},
    {0, 2, [](Outputs& o) -> bool& { return o.robot_control.home; }},
    {0, 3, [](Outputs& o) -> bool& { return o.robot_control.reset_error; }},
    {0, 4, [](Outputs& o) -> bool& { return o.robot_control.sim_mode; }},
    {0, 5, [](Outputs& o) -> bool& { return o.robot_control.recovery_mode; }},
    {0, 6, [](Outputs& o) -> bool& { return o.robot_control.disable_ethercat; }},
    {6, 0, [](Outputs& o) -> bool& { return o.motion_control.set_point; }},
    {6, 1, [](Outputs& o) -> bool& { return o.motion_control.pause_motion; }},
    {6, 2, [](Outputs& o) -> bool& { return o.motion_control.clear_motion; }},
    {6, 3, [](Outputs& o) -> bool& { return o.motion_control.resume_motion; }},
    {6, 4, [](Outputs& o) -> bool& { return o.motion_control.use_variables; }},
    {40, 0, [](Outputs& o) -> bool& { return o.brakes_control.brakes_control_allowed; }},
    {40, 1, [](Outputs& o) -> bool& { return o.brakes_control.brakes_engaged; }},
};

constexpr NamedBit<Inputs> kInputBits[] = {
    {0, 0, [](Inputs& i) -> bool& { return i.robot_status.busy; }},
    {0, 1, [](Inputs& i) -> bool& { return i.robot_status.activated; }},
    {0, 2, [](Inputs& i) -> bool& { return i.robot_status.homed; }},
    {0, 3, [](Inputs& i) -> bool& { return i.robot_status.sim_activated; }},
    {0, 4, [](Inputs& i) -> bool& { return i.robot_status.brakes_engaged; }},
    {0, 5, [](Inputs& i) -> bool& { return i.robot_status.recovery_mode; }},
    {0, 6, [](Inputs& i) -> bool& { return i.robot_status.e_stop; }},
    {0, 7, [](Inputs& i) -> bool& { return i.robot_status.collision_status; }},
    {1, 0, [](Inputs& i) -> bool& { return i.robot_status.work_zone_status; }},
    {1, 1, [](Inputs& i) -> bool& { return i.robot_status.monitoring_mode; }},
    {12, 0, [](Inputs& i) -> bool& { return i.motion_status.paused; }},
    {12, 1, [](Inputs& i) -> bool& { return i.motion_status.eob; }},
    {12, 2, [](Inputs& i) -> bool& { return i.motion_status.eom; }},
    {12, 3, [](Inputs& i) -> bool& { return i.motion_status.cleared; }},
    {12, 4, [](Inputs& i) -> bool& { return i.motion_status.p_stop2; }},
    {12, 5, [](Inputs& i) -> bool& { return i.motion_status.excessive_torque; }},
    {128, 0, [](Inputs& i) -> bool& { return i.safety_status.stop.e_stop; }},
    {128, 1, [](Inputs& i) -> bool& { return i.safety_status.stop.p_stop1; }},
    {128, 2, [](Inputs& i) -> bool& { return i.safety_status.stop.p_stop2; }},
    {128, 4, [](Inputs& i) -> bool& { return i.safety_status.stop.operation_mode_change; }},
    {128, 5, [](Inputs& i) -> bool& { return i.safety_status.stop.enabling_device_released; }},
    {128, 6, [](Inputs& i) -> bool& { return i.safety_status.stop.voltage_fluctuation; }},
    {128, 7, [](Inputs& i) -> bool& { return i.safety_status.stop.reboot; }},
    {129, 0, [](Inputs& i) -> bool& { return i.safety_status.stop.redundancy_fault; }},
    {129, 1, [](Inputs& i) -> bool& { return i.safety_status.stop.standstill_fault; }},
    {129, 2, [](Inputs& i) -> bool& { return i.safety_status.stop.connection_dropped; }},
    {129, 3, [](Inputs& i) -> bool& { return i.safety_status.stop.minor_error; }},
    {132, 0, [](Inputs& i) -> bool& { return i.safety_status.resettable.e_stop; }},
    {132, 1, [](Inputs& i) -> bool& { return i.safety_status.resettable.p_stop1; }},
    {132, 2, [](Inputs& i) -> bool& { return i.safety_status.resettable.p_stop2; }},
    {132, 4, [](Inputs& i) -> bool& { return i.safety_status.resettable.operation_mode_change; }},
    {132, 5, [](Inputs& i) -> bool& { return i.safety_status.resettable.enabling_device_released; }},
    {132, 6, [](Inputs& i) -> bool& { return i.safety_status.resettable.voltage_fluctuation; }},
    {132, 7, [](Inputs& i) -> bool& { return i.safety_status.resettable.reboot; }},
    {133, 0, [](Inputs& i) -> bool& { return i.safety_status.resettable.redundancy_fault; }},
    {133, 1, [](Inputs& i) -> bool& { return i.safety_status.resettable.standstill_fault; }},
    {133, 2, [](Inputs& i) -> bool& { return i.safety_status.resettable.connection_dropped; }},
    {133, 3, [](Inputs& i) -> bool& { return i.safety_status.resettable.minor_error; }},
    {137, 0, [](Inputs& i) -> bool& { return i.safety_status.reset_ready; }},
    {137, 1, [](Inputs& i) -> bool& { return i.safety_status.vmotor_on; }},
    {138, 0, [](Inputs& i) -> bool& { return i.safety_status.power_supply_inputs.e_stop; }},
    {138, 1, [](Inputs& i) -> bool& { return i.safety_status.power_supply_inputs.p_stop1; }},
    {138, 2, [](Inputs& i) -> bool& { return i.safety_status.power_supply_inputs.p_stop2; }},
    {138, 3, [](Inputs& i) -> bool& { return i.safety_status.power_supply_inputs.external_reset; }},
    {138, 4, [](Inputs& i) -> bool& { return i.safety_status.power_supply_inputs.keypad_reset; }},
    {138, 5, [](Inputs& i) -> bool& { return i.safety_status.power_supply_inputs.enabling_device; }},
};
// clang-format on

TEST(NamedBits, OfTheOutputsStandWhereTheManualHasThem) {
  for (const auto& [byte, bit, member] : kOutputBits) {
    OutputBytes bytes{};
    bytes[byte] = std::byte{1} << bit;
    Outputs expected;
    member(expected) = true;
    EXPECT_EQ(decode_outputs(bytes, kFormat), expected) << "byte " << byte << ", bit " << bit;
  }
}

TEST(NamedBits, OfTheInputsStandWhereTheManualHasThem) {
  for (const auto& [byte, bit, member] : kInputBits) {
    InputBytes bytes{};
    bytes[byte] = std::byte{1} << bit;
    Inputs expected;
    expected.safety_status.known = true;
    member(expected) = true;
    EXPECT_EQ(decode_inputs(bytes, kFormat), expected) << "byte " << byte << ", bit " << bit;
  }
}

TEST(NamedBits, OfFirmware9AreResetPStop2AndPStop2Resettable) {  // ESI 9.3.3: 7310:5 and 6015:11
  OutputBytes outputs{};
  outputs[6] = std::byte{0x08};
  EXPECT_TRUE(decode_outputs(outputs, {Layout::kFirmware9}).motion_control.resume_motion);
  InputBytes inputs{};
  inputs[12] = std::byte{0x40};
  EXPECT_TRUE(decode_inputs(inputs, {Layout::kFirmware9}).motion_status.p_stop2_resettable);
}

TEST(DynamicDataSlots, HoldATypeAndSixValuesEach) {
  // 28 bytes a slot from byte 140: type, then six REALs; their lowest bytes number the words.
  InputBytes bytes{};
  for (std::size_t word = 0; word < 28; ++word) bytes[140 + 4 * word] = static_cast<std::byte>(word + 1);
  const auto slots = decode_inputs(bytes, kFormat).dynamic_data;
  for (std::size_t slot = 0; slot < kDynamicSlots; ++slot) {
    EXPECT_EQ(slots[slot].type_id, 7 * slot + 1);
    for (std::size_t value = 0; value < 6; ++value) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(slots[slot].values[value]), 7 * slot + 2 + value);
    }
  }
}

}  // namespace
}  // namespace meca::image
