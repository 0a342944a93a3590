// The way up: what is written where, and that a lost frame anywhere does no harm.
#include <gmock/gmock.h>

#include "tests/unit/ethercat/station_rig.hpp"
#include "tests/unit/ethercat/wire_golden.hpp"

namespace meca::ethercat::station_test {
namespace {

using golden::from_hex;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(StationClimb, ReachesOpAndSaysNothingMore) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.trouble(), "");
  EXPECT_EQ(rig.device.status(), 8);
  EXPECT_EQ(rig.station.counters().operational, 1u);
  EXPECT_EQ(rig.station.counters().lost_accesses, 0u);
  EXPECT_EQ(rig.station.device_name(), "Meca500");
  EXPECT_EQ(rig.station.firmware(), (transports::FirmwareVersion{11, 3, 3, 12637}));
}

TEST(StationClimb, GoesThroughTheStatesOneByOne) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  EXPECT_THAT(rig.device.al_requests, ElementsAre(0x11, 0x02, 0x04, 0x08));
}

// The bytes that five public masters write (spec 5.6).
TEST(StationClimb, WritesSyncManagersAndFmmusAsEveryMasterDoes) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.device.memory(0x0800, 5), from_hex("00 10 80 00 26"));
  EXPECT_EQ(rig.device.memory(0x0810, 8), from_hex("00 11 3C 00 64 00 01 00"));
  EXPECT_EQ(rig.device.memory(0x0818, 8), from_hex("00 14 FC 00 20 00 01 00"));
  EXPECT_EQ(rig.device.memory(0x0600, 16), from_hex("00 00 01 00 3C 00 00 07 00 11 00 02 01 00 00 00"));
  EXPECT_EQ(rig.device.memory(0x0610, 16), from_hex("00 00 02 00 FC 00 00 07 00 14 00 01 01 00 00 00"));
}

TEST(StationClimb, SetsTheWatchdogOfTheOutputs) {
  auto settings = usual_settings();
  settings.watchdog = 20ms;
  StationRig rig(settings);
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.device.memory(0x0400, 2), from_hex("C2 09"));  // 2498: 100 us
  EXPECT_EQ(rig.device.memory(0x0420, 2), from_hex("C8 00"));
}

TEST(StationClimb, LeavesTheWatchdogAsItIsWhenNoneIsAskedFor) {
  auto settings = usual_settings();
  settings.watchdog = Time{};
  StationRig rig(settings);
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.device.memory(0x0420, 2), from_hex("00 00"));
}

TEST(StationClimb, ForgetsWhatAnotherMasterLeftInTheFmmus) {
  StationRig rig;
  const ByteVector left(16, std::byte{0x55});
  rig.device.access({reg::fmmu(5), 16, true, left});
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.device.memory(reg::fmmu(5), 16), ByteVector(16));
}

TEST(StationClimb, GivesTheSiiToTheRobotBeforePreop) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.device.memory(reg::kSiiOwner, 1), from_hex("01"));
}

TEST(StationClimb, ThrowsAwayWhatLiesInTheMailboxFromBefore) {
  StationRig rig;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPreop));
  SdoMessage old;
  old.kind = SdoMessage::Kind::kUploadResponse;
  old.address = {0x1008, 0};  // what is asked for first
  const ByteVector name = text("SomebodyElse");
  old.data = name;
  old.size = static_cast<std::uint32_t>(name.size());
  rig.device.post_sdo(old);
  ASSERT_TRUE(rig.run_until(Phase::kOperational)) << rig.trouble();
  EXPECT_EQ(rig.station.device_name(), "Meca500");
}

TEST(StationClimb, DoesWithoutClocksWhereADeviceHasNone) {
  StationRig rig;
  rig.device.missing = {reg::kDcCyclicUnit};
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.station.counters().lost_accesses, 0u);
}

TEST(StationClimb, AcknowledgesAnErrorThatStandsBeforeItAsks) {
  StationRig rig;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kConfiguring));
  rig.rounds = false;
  rig.run(5ms);
  rig.device.set_status(0x12, 0x001D);
  ASSERT_TRUE(rig.run_until(Phase::kOperational)) << rig.trouble();
  EXPECT_THAT(rig.device.al_requests, ElementsAre(0x11, 0x02, 0x12, 0x04, 0x08));
}

TEST(StationClimb, WaitsForProcessDataBeforeItAsksForOp) {
  StationRig rig;
  rig.process_data = false;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kStarting));
  rig.run(1s);
  EXPECT_EQ(rig.device.status(), 4);
  EXPECT_THAT(rig.trouble(), HasSubstr("SAFEOP until process data"));
  for (int i = 0; i < kCyclesBeforeOp; ++i) {
    EXPECT_EQ(rig.station.phase(), Phase::kStarting);
    rig.station.process_data_exchanged(rig.now);
    rig.step();
  }
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
}

class StationLayouts : public testing::TestWithParam<image::Layout> {};

TEST_P(StationLayouts, AreConfiguredAlike) {
  StationRig rig(usual_settings(), GetParam());
  const bool safety = GetParam() != image::Layout::kFirmware9;
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.device.dictionary.number(0x1C12, 0), 9u);
  EXPECT_EQ(rig.device.dictionary.number(0x1C12, 1), 0x1600u);
  EXPECT_EQ(rig.device.dictionary.number(0x1C13, 0), safety ? 13u : 12u);
  EXPECT_EQ(rig.device.dictionary.number(0x1C13, 9), safety ? 0x1A11u : 0x1A20u);
  EXPECT_EQ(rig.station.firmware().major, safety ? 11 : 9);
  EXPECT_EQ(rig.station.counters().sdo_aborts, safety ? 0u : 1u);
}

TEST_P(StationLayouts, AreReadEntryByEntryWithoutCompleteAccess) {
  StationRig rig(usual_settings(), GetParam());
  rig.device.dictionary.complete_access = false;
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.device.status(), 8);
}

INSTANTIATE_TEST_SUITE_P(All, StationLayouts,
                         testing::Values(image::Layout::kFirmware9, image::Layout::kFirmware10,
                                         image::Layout::kFirmware11));

TEST(StationClimb, WritesTheAssignmentAsTheStandardSaysAndThenTheSyncTypes) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  const auto& written = rig.device.dictionary.written;
  ASSERT_EQ(written.size(), 2u + 9 + 2 + 13 + 2);
  EXPECT_EQ(written[0], Dictionary::key(0x1C12, 0));
  EXPECT_EQ(written[1], Dictionary::key(0x1C12, 1));
  EXPECT_EQ(written[10], Dictionary::key(0x1C12, 0));
  EXPECT_EQ(written[11], Dictionary::key(0x1C13, 0));
  EXPECT_EQ(written[26], Dictionary::key(0x1C32, 1));
  EXPECT_EQ(rig.device.dictionary.number(0x1C32, 1), 1u);
  EXPECT_EQ(rig.device.dictionary.number(0x1C33, 1), 0x22u);
}

TEST(StationClimb, GoesOnWhenTheRobotLetsNobodyChooseTheSyncType) {
  StationRig rig;
  rig.device.dictionary.refuse_write[Dictionary::key(0x1C32, 1)] = 0x06010002;
  rig.device.dictionary.refuse_write[Dictionary::key(0x1C33, 1)] = 0x06010002;
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.station.counters().sdo_aborts, 2u);
}

// ---- Distributed clocks

StationSettings dc_settings() {
  auto settings = usual_settings();
  settings.dc = true;
  settings.sync0_cycle = 2ms;
  settings.shift = 300us;
  return settings;
}

TEST(StationClock, WaitsInPreopUntilTheClocksRunTogether) {
  StationRig rig(dc_settings());
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kConfiguring));
  rig.run(5s);
  EXPECT_EQ(rig.station.phase(), Phase::kConfiguring);
  EXPECT_THAT(rig.trouble(), HasSubstr("clocks of the chain"));
  rig.station.dc_ready(1'000'000'123, rig.now);
  ASSERT_TRUE(rig.run_until(Phase::kOperational)) << rig.trouble();
}

TEST(StationClock, StartsSync0AtAMultipleOfTheCycleAndShiftsIt) {
  StationRig rig(dc_settings());
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kConfiguring));
  rig.run(1s);
  rig.station.dc_ready(1'000'000'123, rig.now);
  ASSERT_TRUE(rig.run_until(Phase::kOperational)) << rig.trouble();
  EXPECT_EQ(rig.device.memory(0x0990, 8), le(1'102'000'000 + 300'000, 8));  // 100 ms later, rounded up
  EXPECT_EQ(rig.device.memory(0x09A0, 4), le(2'000'000, 4));
  EXPECT_EQ(rig.device.memory(0x0980, 2), from_hex("00 03"));
  EXPECT_EQ(rig.device.dictionary.number(0x1C32, 1), 2u);
  EXPECT_EQ(rig.device.dictionary.number(0x1C33, 1), 2u);
}

TEST(StationClock, GoesOnWithClocksThatWereReadyBefore) {
  StationRig rig(dc_settings());
  rig.station.dc_ready(5'000'000'000, rig.now);
  ASSERT_TRUE(rig.climbs());
  EXPECT_GT(rig.device.memory(0x0990, 8), ByteVector(8));
}

TEST(StationClock, IsWaitedForAgainWhenTheRobotWasGone) {
  StationRig rig(dc_settings());
  rig.station.dc_ready(5'000'000'000, rig.now);
  ASSERT_TRUE(rig.climbs());
  rig.station.absent("not in the chain", rig.now);
  rig.find();
  rig.run(5s);
  EXPECT_THAT(rig.trouble(), HasSubstr("clocks of the chain"));
}

TEST(StationClock, IsSwitchedOffWithoutDc) {
  StationRig rig;
  const auto left = from_hex("00 03");
  rig.device.access({reg::kDcCyclicUnit, 2, true, left});
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.device.memory(reg::kDcCyclicUnit, 2), ByteVector(2));
}

// ---- Losses

std::size_t accesses_of_a_climb(StationSettings settings) {
  StationRig rig(settings);
  rig.station.dc_ready(5'000'000'000, rig.now);
  rig.find();
  rig.run_until(Phase::kOperational);
  return rig.wire.count;
}

class StationLosses : public testing::TestWithParam<Wire::Loss> {};

TEST_P(StationLosses, OfAnySingleFrameDoNotKeepItFromOp) {
  const auto settings = dc_settings();
  const std::size_t all = accesses_of_a_climb(settings);
  ASSERT_GT(all, 100u);
  for (std::size_t k = 0; k < all; ++k) {
    StationRig rig(settings);
    rig.wire.loses = [k](std::size_t n, const Access&) { return n == k ? GetParam() : Wire::Loss::kNothing; };
    rig.station.dc_ready(5'000'000'000, rig.now);
    ASSERT_TRUE(rig.climbs()) << "access " << k;
    ASSERT_EQ(rig.station.counters().lost_accesses, 1u) << "access " << k;
    ASSERT_THAT(rig.device.al_requests, testing::Contains(0x08).Times(testing::Ge(1))) << "access " << k;
    ASSERT_EQ(rig.device.dictionary.number(0x1C13, 0), 13u);
  }
}

TEST_P(StationLosses, OfEveryThirdFrameOnlyMakeItSlow) {
  StationRig rig;
  rig.wire.loses = [](std::size_t n, const Access&) { return n % 3 == 2 ? GetParam() : Wire::Loss::kNothing; };
  ASSERT_TRUE(rig.climbs());
  EXPECT_GT(rig.station.counters().lost_accesses, 50u);
}

INSTANTIATE_TEST_SUITE_P(BothWays, StationLosses, testing::Values(Wire::Loss::kRequest, Wire::Loss::kReply));

}  // namespace
}  // namespace meca::ethercat::station_test
