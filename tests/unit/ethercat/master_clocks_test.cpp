// Distributed clocks: of the whole chain, and the parts that compute.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/unit/ethercat/master_segment.hpp"
#include "transports/ethercat/clocks.hpp"

namespace meca::ethercat::test {
namespace {

constexpr std::uint64_t kEpoch = 800'000'000'000'000'000;  // ns since 2000-01-01: May 2025

MasterSettings with_clocks(std::size_t robots) {
  MasterSettings out = settings_for(robots);
  out.dc = true;
  out.dc_epoch = kEpoch;
  return out;
}

std::vector<DeviceSettings> drifting(std::size_t count, std::int32_t ppm) {
  std::vector<DeviceSettings> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i].esc.clock_ppm = i % 2 == 0 ? ppm : -ppm;
    out[i].esc.clock_start = 1'000'000'000 * (i + 1);
  }
  return out;
}

std::int64_t apart(Segment& segment, std::size_t a, std::size_t b) {
  return std::llabs(static_cast<std::int64_t>(segment.device(a).esc().system_time(segment.now()) -
                                              segment.device(b).esc().system_time(segment.now())));
}

TEST(MasterClocks, RobotsBecomeOperationalSynchronousToSync0) {
  Segment segment(with_clocks(3), drifting(3, 0));
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  segment.run(1s);
  EXPECT_TRUE(segment.all_operational());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(segment.device(i).esc().sync0_active());
    EXPECT_EQ(segment.device(i).esc().last_sync0_cycle(), Time(1ms));
    EXPECT_EQ(segment.device(i).counters().sync_errors, 0u);
  }
}

TEST(MasterClocks, TheReferenceClockSaysTheMastersTime) {
  Segment segment(with_clocks(1), drifting(1, 0));
  ASSERT_TRUE(segment.start());
  const auto time = static_cast<std::int64_t>(segment.device(0).esc().system_time(segment.now()) - kEpoch);
  EXPECT_LT(std::llabs(time - segment.now().count()), 1'000'000);
}

TEST(MasterClocks, FramesAreLedToHalfACycleBeforeSync0) {
  for (const auto& [shift, step] : {std::pair{0us, 1000}, {200us, 3000}, {700us, -2000}}) {
    MasterSettings settings = with_clocks(1);
    settings.dc_epoch = kEpoch + 400'000;  // so far behind the multiples of the cycle do frames pass
    settings.dc_shift = shift;
    Segment segment(settings, drifting(1, 0));
    ASSERT_TRUE(segment.start());
    EXPECT_NEAR(static_cast<double>(segment.master().dc_phase_correction().count()), step, 50) << shift.count();
  }
}

TEST(MasterClocks, ClocksThatDriftStayTogether) {
  Segment segment(with_clocks(3), drifting(3, 20));
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  segment.run(5s);
  EXPECT_TRUE(segment.all_operational());
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_LT(apart(segment, 0, i), 5'000) << i;
    EXPECT_LT(std::llabs(segment.master().counters(i).dc_difference_ns), 5'000) << i;
  }
}

// Faster and slower than the clock's own loop can correct.
TEST(MasterClocks, ADifferenceThatStaysIsShownWithItsSign) {
  std::vector<DeviceSettings> devices(3);
  devices[1].esc.clock_ppm = 1000;
  devices[2].esc.clock_ppm = -1000;
  Segment segment(with_clocks(3), devices);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  segment.run(1s);
  EXPECT_EQ(segment.master().counters(0).dc_difference_ns, 0) << "of the reference";
  EXPECT_GT(segment.master().counters(1).dc_difference_ns, 100);
  EXPECT_LT(segment.master().counters(2).dc_difference_ns, -100);
}

TEST(MasterClocks, ARobotThatComesBackIsSetToTheTimeOfTheOthers) {
  Segment segment(with_clocks(3), drifting(3, 5));
  ASSERT_TRUE(segment.start());
  segment.run(100ms);
  segment.device(1).power_cycle(segment.now());
  segment.run(50ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
  segment.run(1s);
  EXPECT_LT(apart(segment, 0, 1), 5'000);
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
  EXPECT_EQ(segment.master().counters(2).losses, 0u);
}

TEST(MasterClocks, OnlyTheClockOfTheRobotThatComesBackIsSet) {
  Segment segment(with_clocks(3), drifting(3, 5));
  ASSERT_TRUE(segment.start());
  segment.device(1).power_cycle(segment.now());
  int set = 0;
  segment.sent = [&](Bytes frame, Chain::Side) {
    DatagramWalk<const std::byte> walk(frame);
    while (const auto datagram = walk.next())
      set += datagram->command() == Command::kFpwr &&
             (datagram->ado() == reg::kDcOffset || datagram->ado() == reg::kDcSpeedStart);
  };
  segment.run(50ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
  EXPECT_EQ(set, 2) << "offset and speed of one";
}

TEST(MasterClocks, WhenTheReferenceIsPowerCycledTheOthersKeepTheTime) {
  Segment segment(with_clocks(3), drifting(3, 0));
  ASSERT_TRUE(segment.start());
  segment.run(100ms);
  segment.device(0).power_cycle(segment.now());
  segment.run(50ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  segment.run(1s);
  EXPECT_LT(apart(segment, 0, 1), 5'000);
  EXPECT_EQ(segment.master().counters(1).losses, 0u);
}

TEST(MasterClocks, ARobotWithoutAClockIsToldSo) {
  std::vector<DeviceSettings> devices(1);
  devices[0].esc.features = 0x01C0;
  Segment segment(with_clocks(1), devices);
  segment.run(2s);
  EXPECT_EQ(segment.master().trouble(0), "position 0 has no distributed clock; set dc: false");
}

TEST(MasterClocks, AreSetUpWhicheverReplyIsLost) {
  std::size_t replies = 0;
  {
    Segment segment(with_clocks(1), drifting(1, 0));
    segment.fate = [&](std::size_t n) {
      replies = n + 1;
      return Fate{};
    };
    ASSERT_TRUE(segment.start());
  }
  for (std::size_t lost = 0; lost < replies; ++lost) {
    Segment segment(with_clocks(1), drifting(1, 0));
    segment.fate = [&](std::size_t n) { return Fate{.lost = n == lost}; };
    ASSERT_TRUE(segment.start()) << "reply " << lost << " of " << replies << ": " << segment.master().trouble(0);
  }
}

TEST(MasterClocks, TheOwnerIsToldHowToMoveItsCycleUntilItStandsHalfACycleBeforeSync0) {
  Time cycle = 1ms;
  PhaseControl phase(cycle, cycle / 2);
  // The reference runs 10 ppm fast; the master's deadlines begin 300 us off.
  double reference = 800'000, deadline = 0;
  for (int i = 0; i < 60'000; ++i) {
    phase.seen(static_cast<std::uint64_t>(reference));
    EXPECT_LE(std::abs(phase.correction().count()), 10'000);
    const double step = 1e6 + static_cast<double>(phase.correction().count());
    deadline += step;
    reference += step * 1.00001;
  }
  EXPECT_LT(std::abs(std::fmod(reference, 1e6) - 500'000), 2'000);
}

TEST(MasterClocks, WithoutTheReferenceTheOwnerIsToldTheDifferenceInSpeedOnly) {
  PhaseControl phase(1ms, 500us);
  for (int i = 0; i < 2'000; ++i) {  // 300 us late, for so long that the clocks seem to run apart
    phase.next_cycle();
    phase.seen(800'000);
  }
  phase.next_cycle();
  EXPECT_EQ(phase.correction(), -3'000ns - 100ns) << "a hundredth of the way, a twentieth of a nanosecond a cycle";
  for (int i = 0; i < 10; ++i) {
    phase.next_cycle();
    EXPECT_EQ(phase.correction(), -100ns);
  }
}

// It once stood still then: the same step in each of some hundred cycles.
TEST(MasterClocks, TheOwnersCycleIsLedWhileTheClockOfARobotThatComesBackIsSet) {
  Segment segment(with_clocks(3), drifting(3, 50));
  ASSERT_TRUE(segment.start());
  segment.device(1).power_cycle(segment.now());
  Time last{};
  int same = 0, longest = 0;
  segment.every_cycle = [&](Segment& of) {
    same = of.master().dc_phase_correction() == last ? same + 1 : 0;
    last = of.master().dc_phase_correction();
    longest = std::max(longest, same);
  };
  segment.run(50ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
  EXPECT_LT(longest, 50);
}

// The cables of the simulated chain take 1 us each.
TEST(MasterClocks, EveryRobotIsToldHowMuchLaterItHearsTheReference) {
  Segment segment(with_clocks(4), drifting(4, 0));
  ASSERT_TRUE(segment.start());
  const auto delay = [&](std::size_t robot) {
    unsigned value = 0;
    for (unsigned i = 4; i-- > 0;)
      value = value << 8 | segment.device(robot).esc().peek(static_cast<std::uint16_t>(reg::kDcDelay + i));
    return value;
  };
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(delay(i), 1000u * i) << i;
}

TEST(MasterClocks, TheDifferenceRegisterIsSignAndMagnitude) {
  EXPECT_EQ(clock_difference(0x8000'0005), 5);
  EXPECT_EQ(clock_difference(5), -5);
  EXPECT_EQ(clock_difference(0), 0);
}

}  // namespace
}  // namespace meca::ethercat::test
