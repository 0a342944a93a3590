// Image sections to IDL samples: one row per field. A row sets exactly its own field in the image, and exactly its own
// getter of the sample may show it: a field that lands in its neighbour's place fails two rows.
#include "bridge/mapping.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <utility>
#include <vector>

namespace meca::bridge {
namespace {

template <typename Section, typename Sample>
struct Field {
  const char* name;
  std::function<void(Section&)> set;
  std::function<double(const Sample&)> get;
  double expected = 1;
};

template <typename Section, typename Sample>
void expect_each_field_in_its_place(const std::vector<Field<Section, Sample>>& fields) {
  for (const auto& field : fields) {
    Section section{};
    field.set(section);
    Sample sample;
    fill(section, sample);
    for (const auto& other : fields) {
      EXPECT_EQ(other.get(sample), &other == &field ? field.expected : 0)
          << other.name << " after setting " << field.name;
    }
  }
}

#define FLAG(name)                                                                        \
  {                                                                                       \
#name, [](auto& s) { s.name = true; }, [](const auto& s) { return double(s.name()); } \
  }
#define NUMBER(name, value)                                                                               \
  {                                                                                                       \
#name, [](auto& s) { s.name = value; }, [](const auto& s) { return double(s.name()); }, double(value) \
  }

TEST(Mapping, EveryFieldOfRobotStatusHasItsPlace) {
  expect_each_field_in_its_place<image::RobotStatus, meca500::RobotStatus>(
      {FLAG(busy), FLAG(activated), FLAG(homed), FLAG(sim_activated), FLAG(brakes_engaged), FLAG(recovery_mode),
       FLAG(e_stop), FLAG(collision_status), FLAG(work_zone_status), FLAG(monitoring_mode), NUMBER(error_code, 65535)});
}

TEST(Mapping, EveryFieldOfMotionStatusHasItsPlace) {
  expect_each_field_in_its_place<image::MotionStatus, meca500::MotionStatus>(
      {NUMBER(checkpoint_reached, 4294967295U), NUMBER(checkpoint_discarded, 65535), NUMBER(move_id, 65534),
       NUMBER(fifo_space, 13000), FLAG(paused), FLAG(eob), FLAG(eom), FLAG(cleared), FLAG(p_stop2),
       FLAG(excessive_torque), FLAG(p_stop2_resettable), NUMBER(offline_program_id, 65533)});
}

TEST(Mapping, EveryJointHasItsPlace) {
  std::vector<Field<image::TargetJointSet, meca500::TargetJointSet>> fields;
  for (std::size_t i = 0; i < 6; ++i) {
    fields.push_back(
        {"joint", [i](auto& s) { s.joints[i] = -1.5F; }, [i](const auto& s) { return double(s.joints()[i]); }, -1.5});
  }
  expect_each_field_in_its_place(fields);
}

template <typename Sample>
void expect_pose_in_place() {
  expect_each_field_in_its_place<image::Pose, Sample>({NUMBER(x, 0.5F), NUMBER(y, 1.5F), NUMBER(z, 2.5F),
                                                       NUMBER(alpha, 3.5F), NUMBER(beta, 4.5F), NUMBER(gamma, 5.5F)});
}

TEST(Mapping, EveryCoordinateOfTheThreePosesHasItsPlace) {
  expect_pose_in_place<meca500::TargetEndEffectorPose>();
  expect_pose_in_place<meca500::TargetWrf>();
  expect_pose_in_place<meca500::TargetTrf>();
}

TEST(Mapping, EveryFieldOfTheConfigurationHasItsPlaceAndItsSign) {
  expect_each_field_in_its_place<image::TargetConfiguration, meca500::TargetConfiguration>(
      {NUMBER(shoulder, -1), NUMBER(elbow, -1), NUMBER(wrist, -1), NUMBER(turn, -100)});
}

TEST(Mapping, EveryFieldOfTheTimestampHasItsPlace) {
  expect_each_field_in_its_place<image::RobotTimestamp, meca500::RobotTimestamp>(
      {NUMBER(seconds, 4294967295U), NUMBER(microseconds, 999999), NUMBER(dynamic_data_update_count, 4294967294U)});
}

#define STOP(list, name)                                                                                        \
  {                                                                                                             \
#list "." #name, [](auto& s) { s.list.name = true; }, [](const auto& s) { return double(s.list().name()); } \
  }
#define STOPS(list)                                                                                \
  STOP(list, e_stop), STOP(list, p_stop1), STOP(list, p_stop2), STOP(list, operation_mode_change), \
      STOP(list, enabling_device_released), STOP(list, voltage_fluctuation), STOP(list, reboot),   \
      STOP(list, redundancy_fault), STOP(list, standstill_fault), STOP(list, connection_dropped),  \
      STOP(list, minor_error)

TEST(Mapping, EveryFieldOfSafetyStatusHasItsPlace) {
  expect_each_field_in_its_place<image::SafetyStatus, meca500::SafetyStatus>(
      {FLAG(known), STOPS(stop), STOPS(resettable), NUMBER(operation_mode, 2), FLAG(reset_ready), FLAG(vmotor_on),
       STOP(power_supply_inputs, e_stop), STOP(power_supply_inputs, p_stop1), STOP(power_supply_inputs, p_stop2),
       STOP(power_supply_inputs, external_reset), STOP(power_supply_inputs, keypad_reset),
       STOP(power_supply_inputs, enabling_device)});
}

TEST(Mapping, EveryFieldOfTheOutputsHasItsPlace) {
  expect_each_field_in_its_place<image::RobotControl, meca500::RobotControl>(
      {FLAG(deactivate),
       FLAG(activate),
       {"home", [](auto& s) { s.home = true; }, [](const auto& s) { return double(s.home_robot()); }},
       FLAG(reset_error),
       FLAG(sim_mode),
       FLAG(recovery_mode),
       FLAG(disable_ethercat)});
  expect_each_field_in_its_place<image::MotionControl, meca500::MotionControl>(
      {NUMBER(move_id, 65535), FLAG(set_point), FLAG(pause_motion), FLAG(clear_motion), FLAG(resume_motion),
       FLAG(use_variables)});
  expect_each_field_in_its_place<image::HostTime, meca500::HostTime>({NUMBER(seconds, 4294967295U)});
  expect_each_field_in_its_place<image::BrakesControl, meca500::BrakesControl>(
      {FLAG(brakes_control_allowed), FLAG(brakes_engaged)});
}

TEST(Mapping, EveryElementOfTheOutputArraysHasItsPlace) {
  std::vector<Field<image::MotionCommand, meca500::MotionCommand>> command{
      {"id", [](auto& s) { s.command_id = 19999; }, [](const auto& s) { return double(s.motion_command_id()); },
       19999}};
  std::vector<Field<image::DynamicDataConfiguration, meca500::DynamicDataConfiguration>> types;
  for (std::size_t i = 0; i < 6; ++i) {
    command.push_back({"argument", [i](auto& s) { s.arguments[i] = 2.5F; },
                       [i](const auto& s) { return double(s.arguments()[i]); }, 2.5});
  }
  for (std::size_t i = 0; i < image::kDynamicSlots; ++i) {
    types.push_back(
        {"type", [i](auto& s) { s.type_ids[i] = 40; }, [i](const auto& s) { return double(s.type_ids()[i]); }, 40});
  }
  expect_each_field_in_its_place(command);
  expect_each_field_in_its_place(types);
}

TEST(Mapping, TheHeaderCarriesCycleTimesAndQuality) {
  CycleRecord record;
  record.cycle = 7;
  record.receive_unix_ns = 1'700'000'000'000'000'001;
  record.inputs.robot_timestamp = {.seconds = 4294967295U, .microseconds = 999999};
  const std::vector<std::pair<Quality, meca500::Quality>> qualities{
      {Quality::kUnknown, meca500::Quality::UNKNOWN},
      {Quality::kGood, meca500::Quality::GOOD},
      {Quality::kStale, meca500::Quality::STALE},
      {Quality::kDisconnected, meca500::Quality::DISCONNECTED}};
  for (const auto& [ours, theirs] : qualities) {
    record.quality = ours;
    meca500::Header header;
    fill_header(record, header);
    EXPECT_EQ(header.cycle(), 7U);
    EXPECT_EQ(header.robot_time_us(), 4294967295999999U);  // wider than 32 bits
    EXPECT_EQ(header.receive_time_ns(), 1'700'000'000'000'000'001);
    EXPECT_EQ(header.quality(), theirs);
  }
}

TEST(Mapping, DynamicDataHasNamesAndUnitsAndKeepsTheRawNumbers) {
  const image::DynamicData data{.type_id = 40, .values = {1, 2, 3, 4, 5, 6}};  // manual Table 12: 40 = joint positions
  meca500::DynamicData sample;
  fill(data, 3, image::Layout::kFirmware11, sample);
  EXPECT_EQ(sample.slot(), 3);
  EXPECT_EQ(sample.type_id(), 40U);
  EXPECT_THAT(sample.type_name().to_string(), testing::HasSubstr("joint position"));
  ASSERT_EQ(sample.values().size(), 6U);
  EXPECT_EQ(sample.values()[5].name().to_string(), "joint 6");
  EXPECT_EQ(sample.values()[5].unit().to_string(), "deg");
  EXPECT_EQ(sample.values()[5].value(), 6);
  EXPECT_EQ(sample.raw()[5], 6);
}

TEST(Mapping, AnUndocumentedDynamicDataTypeStaysRawAndForgetsTheNamesBefore) {
  meca500::DynamicData sample;
  fill({.type_id = 40, .values = {}}, 0, image::Layout::kFirmware11, sample);
  fill({.type_id = 9999, .values = {1.5F}}, 0, image::Layout::kFirmware11, sample);
  EXPECT_EQ(sample.type_name().to_string(), "");
  EXPECT_TRUE(sample.values().empty());
  EXPECT_EQ(sample.raw()[0], 1.5F);
}

TEST(Mapping, TheSerialNumberIsABitPatternAndComesOutExact) {
  // Type 3: the second value is the bits of a UINT32 in a REAL slot. 16777217 is the first integer no float can hold.
  const image::DynamicData data{.type_id = 3, .values = {16777216.0F, std::bit_cast<float>(16777217U)}};
  meca500::DynamicData sample;
  fill(data, 0, image::Layout::kFirmware11, sample);
  ASSERT_EQ(sample.values().size(), 2U);
  EXPECT_EQ(sample.values()[1].value(), 16777217.0);
}

TEST(Mapping, CyclicStateHoldsEverySectionUnderTheSameHeaderAndKey) {
  CycleRecord record;
  record.cycle = 9;
  record.quality = Quality::kGood;
  record.inputs.robot_status.homed = true;
  record.inputs.motion_status.move_id = 1;
  record.inputs.target_joint_set.joints[1] = 2;
  record.inputs.target_end_effector_pose.x = 3;
  record.inputs.target_configuration.turn = 4;
  record.inputs.target_wrf.x = 5;
  record.inputs.target_trf.x = 6;
  record.inputs.robot_timestamp.seconds = 7;
  record.inputs.safety_status.known = true;
  record.inputs.dynamic_data[3].type_id = 42;
  meca500::CyclicState sample;
  fill("arm1", record, sample);
  EXPECT_TRUE(sample.robot_status().homed());
  EXPECT_EQ(sample.motion_status().move_id(), 1);
  EXPECT_EQ(sample.target_joint_set().joints()[1], 2);
  EXPECT_EQ(sample.target_end_effector_pose().x(), 3);
  EXPECT_EQ(sample.target_configuration().turn(), 4);
  EXPECT_EQ(sample.target_wrf().x(), 5);
  EXPECT_EQ(sample.target_trf().x(), 6);
  EXPECT_EQ(sample.robot_timestamp().seconds(), 7U);
  EXPECT_TRUE(sample.safety_status().known());
  EXPECT_EQ(sample.dynamic_data()[3].type_id(), 42U);
  EXPECT_EQ(sample.dynamic_data()[3].slot(), 3);
  for (const auto* header : {&sample.header(), &sample.robot_status().header(), &sample.safety_status().header(),
                             &sample.dynamic_data()[3].header()}) {
    EXPECT_EQ(header->cycle(), 9U);
    EXPECT_EQ(header->quality(), meca500::Quality::GOOD);
  }
  EXPECT_EQ(sample.robot().to_string(), "arm1");
  EXPECT_EQ(sample.target_wrf().robot().to_string(), "arm1");
}

TEST(Mapping, ControlStatusSaysWhoHasControlAndWhoWasRefused) {
  control::ControlState state;
  state.owned = true;
  state.owner = std::string_view("plc");
  state.owner_participant = {std::byte{0x01}, std::byte{0x0f}, std::byte{0xa2}};
  state.since_unix_ns = 5;
  state.priority = 3;
  state.lease_ms = 100;
  state.on_loss = control::LossPolicy::kFinishMotion;
  state.monitoring_only = true;
  state.last_refusal.client = std::string_view("other");
  state.last_refusal.state = control::ReceiptState::kRejected;
  state.last_refusal.reason = control::Reason::kNotOwner;
  state.last_refusal.other = std::string_view("plc");
  state.last_owner = std::string_view("before");
  state.last_loss = control::ControlState::Loss::kLeaseExpired;
  state.contender = std::string_view("supervisor");
  state.contender_priority = 10;
  state.last_renewal_unix_ns = 88;
  state.contender_takes_over_unix_ns = 77;
  meca500::ControlStatus sample;
  fill(state, sample);
  EXPECT_TRUE(sample.owned());
  EXPECT_EQ(sample.owner().to_string(), "plc");
  EXPECT_EQ(sample.owner_participant().to_string(), "01.0f.a2.00.00.00.00.00.00.00.00.00");
  EXPECT_EQ(sample.since_ns(), 5);
  EXPECT_EQ(sample.lease_ms(), 100U);
  EXPECT_EQ(sample.on_loss(), meca500::LossPolicy::FINISH_MOTION);
  EXPECT_TRUE(sample.monitoring_only());
  EXPECT_EQ(sample.last_refused().to_string(), "other");
  EXPECT_THAT(sample.last_refusal().to_string(), testing::HasSubstr("plc"));
  EXPECT_EQ(sample.last_owner().to_string(), "before");
  EXPECT_EQ(sample.last_loss().to_string(), "lease expired");
  EXPECT_EQ(sample.priority(), 3U);
  EXPECT_EQ(sample.contender().to_string(), "supervisor");
  EXPECT_EQ(sample.contender_priority(), 10U);
  EXPECT_EQ(sample.contender_takes_over_ns(), 77);
  EXPECT_EQ(sample.last_renewal_ns(), 88);

  fill(control::ControlState{}, sample);  // a sample used again forgets
  EXPECT_EQ(sample.owner().to_string(), "");
  EXPECT_EQ(sample.owner_participant().to_string(), "");
  EXPECT_EQ(sample.last_refusal().to_string(), "");
  EXPECT_EQ(sample.contender().to_string(), "");
}

TEST(Mapping, BridgeStatusCarriesEveryCounterInItsPlace) {
  CycleRecord record;
  record.cycle = 1;
  record.link = transports::LinkState::kUp;
  record.firmware_known = true;
  record.firmware = {11, 3, 3, 12637};
  record.product_type = 4;
  record.serial_number = 2;
  record.counters = {
      .fresh_images = 3, .stale_cycles = 4, .link_losses = 5, .commands_received = 6, .commands_rejected = 7};
  const StatusFacts facts{.transport = "builtin",
                          .cycle = std::chrono::microseconds(8),
                          .missed_cycles = 9,
                          .records_dropped = 10,
                          .wakeup_lateness_max_us = 11,
                          .wakeup_lateness_mean_us = 12,
                          .unix_ns = 13};
  meca500::BridgeStatus sample;
  fill(record, {.ready = false, .cause = "P-Stop 2 is active", .remedy = "release it"}, facts, sample);
  EXPECT_EQ(sample.link(), meca500::LinkState::LINK_UP);
  EXPECT_EQ(sample.transport().to_string(), "builtin");
  EXPECT_EQ(sample.firmware().to_string(), "11.3.3.12637");
  EXPECT_EQ(sample.layout().to_string(), "11.x");
  EXPECT_EQ(sample.product().to_string(), "Meca500 R4");
  EXPECT_FALSE(sample.ready());
  EXPECT_EQ(sample.cause().to_string(), "P-Stop 2 is active");
  EXPECT_EQ(sample.remedy().to_string(), "release it");
  const std::vector<std::uint64_t> numbers{sample.cycles(),
                                           sample.serial_number(),
                                           sample.fresh_images(),
                                           sample.stale_cycles(),
                                           sample.link_losses(),
                                           sample.commands_received(),
                                           sample.commands_rejected(),
                                           sample.cycle_us(),
                                           sample.missed_cycles(),
                                           sample.records_dropped(),
                                           sample.wakeup_lateness_max_us(),
                                           sample.wakeup_lateness_mean_us(),
                                           static_cast<std::uint64_t>(sample.time_ns())};
  EXPECT_THAT(numbers, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13));
}

TEST(Mapping, BridgeStatusNamesWhatTheFieldbusCountsAndLeavesNothingOfALongerListBehind) {
  constexpr std::array<transports::CounterInfo, 2> kNames{{{"lost_packets", ""}, {"period_mean", "us"}}};
  CycleRecord record;
  record.transport_counters = {3, -4, 5};
  meca500::BridgeStatus sample;
  sample.transport_counters().resize(4);
  fill(record, {}, {.transport = "ethernet_ip", .counters = kNames}, sample);
  ASSERT_EQ(sample.transport_counters().size(), 2U);
  EXPECT_EQ(sample.transport_counters()[0].name().to_string(), "lost_packets");
  EXPECT_EQ(sample.transport_counters()[0].unit().to_string(), "");
  EXPECT_EQ(sample.transport_counters()[0].value(), 3);
  EXPECT_EQ(sample.transport_counters()[1].unit().to_string(), "us");
  EXPECT_EQ(sample.transport_counters()[1].value(), -4);
}

TEST(Mapping, UnknownFirmwareIsEmptyAndNotNought) {
  meca500::BridgeStatus sample;
  fill(CycleRecord{}, {}, {}, sample);
  EXPECT_FALSE(sample.firmware_known());
  EXPECT_EQ(sample.firmware().to_string(), "");
  EXPECT_EQ(sample.layout().to_string(), "");
  EXPECT_EQ(sample.product().to_string(), "");
}

TEST(Mapping, AShorterTextAfterALongerOneLeavesNothingBehind) {
  meca500::CommandReceipt sample;
  fill("a-long-robot-name", {}, "a long sentence", 0, 0, sample);
  fill("arm1", {}, "short", 0, 0, sample);
  EXPECT_STREQ(sample.text().c_str(), "short");  // what goes over the wire ends at the zero
  EXPECT_STREQ(sample.robot().c_str(), "arm1");
}

TEST(Mapping, AnEndlessTextIsCutAtWhatTheFieldHolds) {
  meca500::CommandReceipt sample;
  fill("arm1", {}, std::string(1000, 'x'), 0, 0, sample);
  EXPECT_EQ(sample.text().to_string(), std::string(255, 'x'));
}

}  // namespace
}  // namespace meca::bridge
