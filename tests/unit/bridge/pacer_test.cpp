// The rhythm of the loop, with the time moved by hand.
#include "bridge/pacer.hpp"

#include <gtest/gtest.h>

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;

TEST(Pacer, DeadlinesAreAbsoluteSoLatenessDoesNotAddUp) {
  Pacer pacer(1ms, 10ms);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(pacer.deadline(), 10ms + i * 1ms);
    pacer.woke(pacer.deadline() + 300us);
    pacer.done(pacer.deadline() + 400us);
  }
  EXPECT_EQ(pacer.facts().missed_cycles, 0U);
}

TEST(Pacer, WorkThatEndsExactlyAtTheNextDeadlineMissesNothing) {
  Pacer pacer(1ms, 0ms);
  pacer.done(1ms);
  EXPECT_EQ(pacer.deadline(), 1ms);
  EXPECT_EQ(pacer.facts().missed_cycles, 0U);
}

TEST(Pacer, DeadlinesThatAreOverAreCountedSkippedAndThePhaseStays) {
  Pacer pacer(1ms, 0ms);
  pacer.done(3ms + 1us);  // the cycles at 1, 2 and 3 ms can no longer begin in time
  EXPECT_EQ(pacer.facts().missed_cycles, 3U);
  EXPECT_EQ(pacer.deadline(), 4ms);
}

TEST(Pacer, ShiftsMoveTheRhythmForGood) {
  Pacer pacer(1ms, 0ms);
  pacer.done(100us);
  pacer.shift(-10us);
  EXPECT_EQ(pacer.deadline(), 990us);
  pacer.done(1ms);
  EXPECT_EQ(pacer.deadline(), 1990us);
  EXPECT_EQ(pacer.facts().missed_cycles, 0U);
}

TEST(Pacer, LatenessIsThatOfTheLastSecond) {
  Pacer pacer(500ms, 0ms);
  const auto cycle = [&](Time late) {
    const Time now = pacer.deadline() + late;
    pacer.woke(now);
    pacer.done(now);
  };
  cycle(10us);
  cycle(30us);
  EXPECT_EQ(pacer.facts().lateness_max_us, 0U);  // the first second is not over
  cycle(50us);
  EXPECT_EQ(pacer.facts().lateness_max_us, 50U);
  EXPECT_EQ(pacer.facts().lateness_mean_us, 30U);
  for (int i = 0; i < 3; ++i) cycle(7us);
  EXPECT_EQ(pacer.facts().lateness_max_us, 7U);
  EXPECT_EQ(pacer.facts().lateness_mean_us, 7U);
}

}  // namespace
}  // namespace meca::bridge
