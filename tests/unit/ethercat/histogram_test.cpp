// Percentiles of the last second out of buckets.
#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "transports/ethercat/histogram.hpp"

namespace meca::ethercat {
namespace {

using namespace std::chrono_literals;

// Two or more, all in the first window, which the last of them ends.
Histogram::Facts facts_of(const std::vector<std::chrono::nanoseconds>& durations) {
  Histogram histogram;
  std::size_t left = durations.size();
  for (const auto duration : durations) histogram.add(duration, --left == 0 ? 1s : 0s);
  return histogram.facts();
}

TEST(Histogram, KnowsNothingBeforeASecondIsOver) {
  Histogram histogram;
  for (int i = 0; i < 1000; ++i) histogram.add(50us, i * 999us);
  EXPECT_EQ(histogram.facts().p50, 0);
  EXPECT_EQ(histogram.facts().max, 0);
  histogram.add(50us, 1s);
  EXPECT_EQ(histogram.facts().p50, 50);
  EXPECT_EQ(histogram.facts().max, 50);
}

TEST(Histogram, TellsPercentilesOfShortTimesToTheMicrosecond) {
  std::vector<std::chrono::nanoseconds> durations(1000, 10us);
  for (std::size_t i = 0; i < 20; ++i) durations[i] = 12us;
  durations[20] = durations[21] = 14us;
  const auto facts = facts_of(durations);
  EXPECT_EQ(facts.p50, 10);
  EXPECT_EQ(facts.p99, 12);
  EXPECT_EQ(facts.p999, 14);
  EXPECT_EQ(facts.max, 14);
}

TEST(Histogram, RoundsLongTimesUpByNotMoreThanOneSixteenthAndNeverOverTheLongest) {
  for (std::int64_t us = 1; us <= 10'000'000; us = us * 5 / 4 + 1) {
    const std::chrono::microseconds duration(us);
    const auto facts = facts_of({duration, duration, 10s});
    EXPECT_GE(facts.p50, us);
    EXPECT_LE(facts.p50, us + us / 16);
    EXPECT_EQ(facts.max, 10'000'000);
    const auto alone = facts_of({duration, duration});
    EXPECT_EQ(alone.p999, us);
    EXPECT_EQ(alone.max, us);
  }
}

TEST(Histogram, CountsATimeBeforeZeroAsZeroAndAnEndlessOneAsTenSeconds) {
  const auto facts = facts_of({-5us, -5us, 1h});
  EXPECT_EQ(facts.p50, 0);
  EXPECT_EQ(facts.max, 10'000'000);
}

TEST(Histogram, ForgetsASecondWhenTheNextIsOver) {
  Histogram histogram;
  histogram.add(900us, 0s);
  histogram.add(900us, 1s);
  EXPECT_EQ(histogram.facts().max, 900);
  histogram.add(20us, 1500ms);
  EXPECT_EQ(histogram.facts().max, 900) << "until the second window is over";
  histogram.add(20us, 2500ms);
  EXPECT_EQ(histogram.facts().max, 20);
  EXPECT_EQ(histogram.facts().p999, 20);
}

TEST(Histogram, ForgetsWhatIsNotMeasuredAnyMore) {
  Histogram histogram;
  histogram.add(900us, 0s);
  histogram.pass(999ms);
  EXPECT_EQ(histogram.facts().max, 0);
  histogram.pass(1s);
  EXPECT_EQ(histogram.facts().max, 900);
  histogram.pass(1999ms);
  EXPECT_EQ(histogram.facts().max, 900);
  histogram.pass(2s);
  EXPECT_EQ(histogram.facts().max, 0);
}

TEST(Histogram, AWindowBeginsWithItsFirstMeasurement) {
  Histogram histogram;
  histogram.add(5us, 100s);
  histogram.add(7us, 100s + 999ms);
  EXPECT_EQ(histogram.facts().max, 0);
  histogram.add(6us, 101s);
  EXPECT_EQ(histogram.facts().max, 7);
}

}  // namespace
}  // namespace meca::ethercat
