// Distributed clocks of the ESC (ETG.1000.4, 6.8; spec 5.9).
#include "tests/unit/ethercat/esc_wire.hpp"

namespace meca::ethercat {
namespace {

using test::Reply;
using namespace std::chrono_literals;

class EscClock : public test::EscWire {
 protected:
  void begin_with(std::int32_t ppm, std::uint64_t start) {
    EscSettings s = test::meca500_settings();
    s.clock_ppm = ppm;
    s.clock_start = start;
    esc = Esc(s);
  }
  // 092C: positive while its clock is ahead.
  std::int64_t difference() {
    const auto v = static_cast<std::int64_t>(read(reg::kDcDifference, 4).value());
    return (v & 0x80000000) != 0 ? v & 0x7FFFFFFF : -v;
  }
  // What a follower gets: the reference's time, with FRMW to a station that it is not.
  unsigned reference(std::uint64_t time, unsigned size = 8) {
    return send(Command::kFrmw, address_of(0x4711, reg::kDcSystemTime), test::little_endian(time, size)).wkc;
  }
};

TEST_F(EscClock, LocalTimeBeginsWhereTheSettingsSayAndRunsAsFast) {
  begin_with(0, 1'000'000'007);
  EXPECT_EQ(read(reg::kDcSystemTime, 8).value(), 1'000'000'007u);
  now = 3s;
  EXPECT_EQ(read(reg::kDcSystemTime, 8).value(), 4'000'000'007u);
  EXPECT_EQ(read(reg::kDcSystemTime, 4).value(), 4'000'000'007u);
}

TEST_F(EscClock, RunsFasterByItsPpm) {
  begin_with(50, 0);
  now = 1000s;
  EXPECT_EQ(esc.system_time(now), 1'000'050'000'000u);
  begin_with(-50, 0);
  EXPECT_EQ(esc.system_time(now), 999'950'000'000u);
}

TEST_F(EscClock, OffsetMakesSystemTimeOfLocalTime) {
  begin_with(0, 100);
  EXPECT_EQ(write(reg::kDcOffset, test::little_endian(0x0123456789ABCDEF, 8)), 1u);
  EXPECT_EQ(read(reg::kDcSystemTime, 8).value(), 0x0123456789ABCDEF + 100);
  EXPECT_EQ(read(reg::kDcOffset, 8).value(), 0x0123456789ABCDEF);
}

// IgH writes offset and delay as one.
TEST_F(EscClock, OffsetAndDelayCanBeWrittenAsOne) {
  EXPECT_EQ(write(reg::kDcOffset, "01 00 00 00 00 00 00 00 22 01 00 00"), 1u);
  EXPECT_EQ(read(reg::kDcDelay, 4).value(), 0x122u);
}

TEST_F(EscClock, AWriteTo0900LatchesTheLocalTimesOfTheFrameAtItsPorts) {
  begin_with(0, 5000);
  now = 1ms;
  esc.frame_begins(now, now + 4us);
  EXPECT_EQ(send(Command::kBwr, address_of(0, reg::kDcReceiveTimes), test::hex("00 00 00 00")).wkc, 1u);
  now = 2ms;
  esc.frame_begins(now, now + 4us);
  EXPECT_EQ(read(reg::kDcReceiveTimes, 4).value(), 1'005'000u);
  EXPECT_EQ(read(reg::kDcReceiveTimes + 4, 4).value(), 1'009'000u);
  EXPECT_EQ(read(reg::kDcReceiveTimes + 8, 8).value(), 0u);
  EXPECT_EQ(read(reg::kDcReceiveTimePu, 8).value(), 1'005'000u);
}

TEST_F(EscClock, OneByteTo0900LatchesToo) {
  now = 1ms;
  esc.frame_begins(now, std::nullopt);
  write(reg::kDcReceiveTimes, "00");
  EXPECT_EQ(read(reg::kDcReceiveTimes, 8).value(), 1'000'000u);  // nothing came back to port 1
}

TEST_F(EscClock, AsReferenceItIsReadByFrmwAndArmw) {
  write(reg::kStationAddress, "01 10");
  now = 1ms;
  const Reply fp = send(Command::kFrmw, address_of(0x1001, reg::kDcSystemTime), std::vector<std::byte>(8));
  EXPECT_EQ(fp.value(), 1'000'000u);
  EXPECT_EQ(fp.wkc, 1u);
  const Reply ap = send(Command::kArmw, address_of(0, reg::kDcSystemTime), std::vector<std::byte>(8));
  EXPECT_EQ(ap.value(), 1'000'000u);
  EXPECT_EQ(difference(), 0);
}

TEST_F(EscClock, AsFollowerItShowsHowFarItIsAheadWithTheDelayTakenIntoAccount) {
  write(reg::kDcFilterDepths, "00 0C");
  write(reg::kDcDelay, test::little_endian(300, 4));
  now = 1ms;
  EXPECT_EQ(reference(1'000'000 - 300 - 77), 1u);
  EXPECT_EQ(read(reg::kDcDifference, 4).value(), 0x80000000u + 77);
}

TEST_F(EscClock, BehindItHasNoSignBit) {
  write(reg::kDcFilterDepths, "00 0C");
  now = 1ms;
  EXPECT_EQ(reference(1'000'077, 4), 1u);
  EXPECT_EQ(read(reg::kDcDifference, 4).value(), 77u);
}

TEST_F(EscClock, TheFilterShowsAMeanAndIsResetByAWrite) {
  write(reg::kDcFilterDepths, "04 0C");
  now = 1ms;
  reference(1'000'000 - 1600);
  EXPECT_EQ(difference(), 100);
  write(reg::kDcFilterDepths, "00 0C");
  reference(1'000'000 - 1600);
  EXPECT_EQ(difference(), 1600);
}

TEST_F(EscClock, FollowsAReferenceThatIsFasterOrSlower) {
  for (const int ppm : {-100, -3, 0, 3, 100}) {
    begin_with(ppm, 123'456);
    now = 0s;
    write(reg::kDcSpeedStart, "00 10");
    write(reg::kDcFilterDepths, "00 0C");
    for (int i = 0; i < 1000; ++i) {
      now += 1ms;
      reference(static_cast<std::uint64_t>(now.count()));
    }
    EXPECT_LE(std::abs(difference()), 10) << ppm << " ppm";
    now += 1s;  // alone, its speed is right too
    const auto ahead = static_cast<std::int64_t>(esc.system_time(now)) - now.count();
    EXPECT_LE(std::abs(ahead), 5000) << ppm << " ppm";
  }
}

TEST_F(EscClock, ResettingTheLoopGivesItsOwnSpeedBack) {
  begin_with(100, 0);
  for (int i = 0; i < 1000; ++i) {
    now += 1ms;
    reference(static_cast<std::uint64_t>(now.count()));
  }
  write(reg::kDcSpeedStart, "00 10");
  const auto before = esc.system_time(now);
  EXPECT_EQ(esc.system_time(now + 1s) - before, 1'000'100'000u);
}

// From now on: what a change of speed made of the time before would be a jump.
TEST_F(EscClock, ADriftChangesItsSpeedAndNotItsTime) {
  begin_with(10, 0);
  now = 100s;
  EXPECT_EQ(read(reg::kDcSystemTime, 8).value(), 100'001'000'000u);
  esc.faults().clock_drift = 90;
  EXPECT_EQ(read(reg::kDcSystemTime, 8).value(), 100'001'000'000u);
  now = 200s;
  EXPECT_EQ(read(reg::kDcSystemTime, 8).value(), 200'011'000'000u);
  esc.faults().clock_drift = 0;
  EXPECT_EQ(read(reg::kDcSystemTime, 8).value(), 200'011'000'000u);
  now = 300s;
  EXPECT_EQ(read(reg::kDcSystemTime, 8).value(), 300'012'000'000u);
}

// What the loop can take up (500 ppm) leaves no difference behind.
TEST_F(EscClock, ADriftThatItsLoopTakesUpIsSeenForAMomentOneThatIsTooMuchAsLongAsItLasts) {
  begin_with(0, 0);
  write(reg::kDcFilterDepths, "00 0C");
  const auto follow = [&](int milliseconds) {
    std::int64_t most = 0;
    for (int i = 0; i < milliseconds; ++i) {
      now += 1ms;
      reference(static_cast<std::uint64_t>(now.count()));
      most = std::max(most, std::abs(difference()));
    }
    return most;
  };
  follow(1000);
  esc.faults().clock_drift = 400;
  EXPECT_GE(follow(1000), 400) << "what 400 ppm are in a cycle, before the loop knows of it";
  EXPECT_LE(follow(1000), 10);
  esc.faults().clock_drift = 1000;
  follow(1000);
  EXPECT_NEAR(static_cast<double>(difference()), 1000, 100) << "half of it is taken off a cycle: what 500 ppm make";
  esc.faults().clock_drift = 0;
  follow(1000);
  EXPECT_LE(follow(1000), 10);
}

TEST_F(EscClock, SystemTimeThatIsNotWholeIsNotCompared) {
  write(reg::kDcFilterDepths, "00 0C");
  now = 1ms;
  EXPECT_EQ(reference(0, 2), 1u);
  EXPECT_EQ(read(reg::kDcDifference, 4).value(), 0u);
}

TEST_F(EscClock, APowerCycleStartsItAtZero) {
  begin_with(0, 777);
  now = 10s;
  esc.power_cycle(now);
  EXPECT_EQ(esc.system_time(now + 5us), 5000u);
}

// ---- SYNC0

TEST_F(EscClock, Sync0RunsOnceCyclicOperationAndSync0AreActivated) {
  EXPECT_FALSE(esc.sync0_active());
  write(reg::kDcStartTime, test::little_endian(100'000'000, 8));
  write(reg::kDcSync0Cycle, test::little_endian(1'000'000, 4));
  write(reg::kDcActivation, "01");
  EXPECT_FALSE(esc.sync0_active());
  write(reg::kDcActivation, "03");
  EXPECT_TRUE(esc.sync0_active());
  EXPECT_EQ(esc.last_sync0_cycle(), 1ms);
  write(reg::kDcActivation, "00");
  EXPECT_FALSE(esc.sync0_active());
}

TEST_F(EscClock, StartTimeShowsTheNextPulseOnceItRuns) {
  write(reg::kDcStartTime, test::little_endian(100'000'250, 8));
  write(reg::kDcSync0Cycle, test::little_endian(1'000'000, 4));
  now = 1s;
  EXPECT_EQ(read(reg::kDcStartTime, 8).value(), 100'000'250u);
  write(reg::kDcActivation, "03");
  EXPECT_EQ(read(reg::kDcStartTime, 8).value(), 1'000'000'250u);
  now = 1'000'000'250ns;
  EXPECT_EQ(read(reg::kDcStartTime, 8).value(), 1'001'000'250u);
}

TEST_F(EscClock, AStartTimeAheadIsKeptUntilThen) {
  write(reg::kDcStartTime, test::little_endian(100'000'000, 8));
  write(reg::kDcSync0Cycle, test::little_endian(1'000'000, 4));
  write(reg::kDcActivation, "03");
  now = 50ms;
  EXPECT_EQ(read(reg::kDcStartTime, 8).value(), 100'000'000u);
}

}  // namespace
}  // namespace meca::ethercat
