// Process data of the device: what counts as outputs, what is read back, what happens when a master stops.
#include "tests/unit/ethercat/device_rig.hpp"

namespace meca::ethercat::device_test {
namespace {

// SYNC0 every `hex` ns, from now on.
void start_sync0(DeviceRig& robot, std::string_view cycle) {
  robot.write(reg::kDcSync0Cycle, cycle);
  robot.write(reg::kDcStartTime, "00 00 00 00 00 00 00 00");
  robot.write(reg::kDcActivation, "03");
}

TEST(DeviceProcessData, IsSilentBeforeSafeop) {
  DeviceRig robot;
  robot.to_preop();
  robot.set_up_process_data();
  EXPECT_EQ(robot.cycle(), 0u);
}

TEST(DeviceProcessData, CountsInSafeopAndIsNotActedOn) {
  DeviceRig robot;
  robot.to_safeop();
  EXPECT_EQ(robot.cycle(0x02), 3u);
  EXPECT_FALSE(robot.device.take_fresh());
  EXPECT_EQ(robot.device.output()[0], std::byte{0});
  EXPECT_EQ(robot.device.counters().outputs, 0u);
}

TEST(DeviceProcessData, GoesBothWaysInOp) {
  DeviceRig robot;
  robot.to_op();
  image::InputBytes input{};
  input[251] = std::byte{0xAB};
  robot.device.set_input(input);
  robot.device.take_fresh();
  const auto before = robot.device.counters().outputs;
  EXPECT_EQ(robot.cycle(0x02), 3u);
  EXPECT_TRUE(robot.device.take_fresh());
  EXPECT_FALSE(robot.device.take_fresh());
  EXPECT_EQ(robot.device.output()[0], std::byte{0x02});
  EXPECT_EQ(robot.device.counters().outputs, before + 1);
  EXPECT_EQ(robot.last_cycle.data.back(), std::byte{0xAB});
  EXPECT_EQ(robot.sdo("00 20 40 00 72 02 00 00 00 00"), "00 30 4F 00 72 02 01 00 00 00");
}

TEST(DeviceProcessData, StandsStillOnRequest) {
  DeviceRig robot;
  robot.to_op();
  robot.device.faults().frozen_inputs = true;
  image::InputBytes input{};
  input.fill(std::byte{0x55});
  robot.device.set_input(input);
  EXPECT_EQ(robot.cycle(), 3u);
  EXPECT_EQ(robot.last_cycle.data.back(), std::byte{0});
}

TEST(DeviceWatchdog, DropsToSafeopWhenOutputsStop) {
  DeviceRig robot;
  robot.to_op();
  robot.run(90ms);
  EXPECT_EQ(robot.al(), "OP");
  robot.run(20ms);
  EXPECT_EQ(robot.al(), "SAFEOP+001B");
  EXPECT_EQ(robot.device.counters().watchdog_expiries, 1u);
  EXPECT_EQ(robot.cycle(), 3u) << "inputs still come";
  EXPECT_EQ(robot.al(), "SAFEOP+001B") << "and nothing gets better by itself";
  EXPECT_EQ(robot.ask(0x14), "SAFEOP");
  robot.cycle();
  EXPECT_EQ(robot.ask(0x08), "OP");
}

TEST(DeviceWatchdog, IsTheMastersToSetAndBlamedWhenItIsOff) {
  DeviceRig robot;
  robot.to_safeop();
  robot.write(reg::kSmWatchdog, "00 00");
  robot.cycle();
  EXPECT_EQ(robot.ask(0x08), "OP");
  robot.run(1s);
  EXPECT_EQ(robot.al(), "OP");
  EXPECT_EQ(robot.device.counters().strict, 1u);
}

TEST(DeviceClock, TakesSync0FromSafeopOn) {
  DeviceRig robot;
  robot.to_preop();
  robot.assign();
  robot.set_up_process_data();
  start_sync0(robot, "80 84 1E 00");  // 2 ms
  ASSERT_EQ(robot.ask(0x04), "SAFEOP");
  EXPECT_EQ(robot.sdo("00 20 40 32 1C 02 00 00 00 00"), "00 30 43 32 1C 02 80 84 1E 00");
}

TEST(DeviceClock, RefusesACycleBelowAMillisecond) {
  DeviceRig robot;
  robot.to_preop();
  robot.assign();
  robot.set_up_process_data();
  start_sync0(robot, "20 A1 07 00");  // 500 us
  EXPECT_EQ(robot.ask(0x04), "PREOP+0035");
}

TEST(DeviceClock, WantsSync0WhereItWasChosen) {
  DeviceRig robot;
  robot.to_preop();
  ASSERT_EQ(robot.sdo("00 20 2B 32 1C 01 02 00 00 00"), "00 30 60 32 1C 01 00 00 00 00");
  robot.assign();
  robot.set_up_process_data();
  ASSERT_EQ(robot.ask(0x04), "SAFEOP");
  robot.cycle();
  EXPECT_EQ(robot.ask(0x08), "SAFEOP+002D");
}

// As a real robot of firmware 9 did.
TEST(DeviceClock, IsASyncErrorWhenTheMasterStops) {
  DeviceRig robot;
  robot.to_preop();
  robot.assign();
  robot.set_up_process_data();
  start_sync0(robot, "40 42 0F 00");
  ASSERT_EQ(robot.ask(0x04), "SAFEOP");
  robot.cycle();
  robot.write(reg::kAlControl, "08 00");
  for (int i = 0; i < 100; ++i) robot.cycle();
  ASSERT_EQ(robot.al(), "OP");
  robot.run(3ms);
  EXPECT_EQ(robot.al(), "OP") << "10F1h:02 forgives four cycles";
  robot.run(10ms);
  EXPECT_EQ(robot.al(), "SAFEOP+001A");
  EXPECT_EQ(robot.device.counters().sync_errors, 1u);
  EXPECT_EQ(robot.device.counters().watchdog_expiries, 0u);
  EXPECT_EQ(robot.sdo("00 20 40 32 1C 20 00 00 00 00"), "00 30 4F 32 1C 20 01 00 00 00") << "1C32h:20, sync error";
  EXPECT_EQ(robot.sdo("00 20 40 32 1C 0B 00 00 00 00"), "00 30 4B 32 1C 0B 05 00 00 00") << "1C32h:0B, missed";
}

TEST(DeviceClock, IsASyncErrorWhenSync0IsSwitchedOff) {
  DeviceRig robot;
  robot.to_preop();
  robot.assign();
  robot.set_up_process_data();
  start_sync0(robot, "40 42 0F 00");
  ASSERT_EQ(robot.ask(0x04), "SAFEOP");
  robot.cycle();
  robot.write(reg::kAlControl, "08 00");
  for (int i = 0; i < 10; ++i) robot.cycle();
  ASSERT_EQ(robot.al(), "OP");
  robot.write(reg::kDcActivation, "00");
  robot.cycle();
  EXPECT_EQ(robot.al(), "SAFEOP+001A");
}

TEST(DeviceStrictness, BlamesTwoMappingsOfTheSameData) {
  DeviceRig robot;
  robot.to_safeop();
  robot.write(reg::fmmu(2), fmmu_bytes(0x1000, true));
  robot.cycle();
  EXPECT_EQ(robot.ask(0x08), "OP");
  EXPECT_EQ(robot.device.counters().strict, 1u);
}

TEST(DeviceStrictness, BlamesAnSiiThatIsNotGivenBack) {
  DeviceRig robot;
  robot.set_up_mailbox();
  robot.write(reg::kSiiOwner, "00");
  EXPECT_EQ(robot.ask(0x02), "PREOP");
  EXPECT_EQ(robot.device.counters().strict, 1u);
}

}  // namespace
}  // namespace meca::ethercat::device_test
