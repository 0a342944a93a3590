#include "tests/bench/period_statistics.hpp"

#include <gtest/gtest.h>

namespace meca::bench {
namespace {

using namespace std::chrono_literals;

PeriodStatistics arrivals(std::initializer_list<std::chrono::nanoseconds> times) {
  PeriodStatistics out;
  for (const auto at : times) out.packet(at);
  return out;
}

TEST(PeriodStatisticsOf, AnEvenStreamHasNoDeviation) {
  const auto stream = arrivals({5s, 5s + 10ms, 5s + 20ms, 5s + 30ms});
  EXPECT_EQ(stream.count(), 3);
  EXPECT_DOUBLE_EQ(stream.mean_us(), 10'000);
  EXPECT_DOUBLE_EQ(stream.max_us(), 10'000);
  EXPECT_DOUBLE_EQ(stream.deviation_us(), 0);
}

TEST(PeriodStatisticsOf, OnePacketIsNoPeriod) {
  EXPECT_EQ(arrivals({}).deviation_us(), 0);
  EXPECT_EQ(arrivals({1s}).count(), 0);
  EXPECT_EQ(arrivals({1s}).deviation_us(), 0);
}

TEST(PeriodStatisticsOf, APacketThatComesLateCountsTwice) {
  const auto stream = arrivals({0ms, 10ms, 24ms, 30ms});  // periods of 10, 14 and 6 ms
  EXPECT_DOUBLE_EQ(stream.mean_us(), 10'000);
  EXPECT_DOUBLE_EQ(stream.max_us(), 14'000);
  EXPECT_NEAR(stream.deviation_us(), 3265.986, 0.001);  // sqrt(32/3) ms
}

TEST(PeriodStatisticsOf, StreamsTakenTogetherAreTheSumOfTheirPeriods) {
  auto both = arrivals({0ms, 10ms});
  both.merge(arrivals({}));
  both.merge(arrivals({1s, 1s + 14ms, 1s + 20ms}));
  EXPECT_EQ(both.count(), 3);
  EXPECT_DOUBLE_EQ(both.mean_us(), 10'000);
  EXPECT_DOUBLE_EQ(both.max_us(), 14'000);
  EXPECT_NEAR(both.deviation_us(), 3265.986, 0.001);
}

TEST(PeriodStatisticsOf, NothingLiesBetweenTwoStreams) {
  PeriodStatistics both;
  both.merge(arrivals({0ms, 10ms}));
  both.packet(9s);
  EXPECT_EQ(both.count(), 1);
}

}  // namespace
}  // namespace meca::bench
