// How regular packets are, with time moved by hand.
#include "transports/ethernet_ip/period_meter.hpp"

#include <gtest/gtest.h>

namespace meca::ethernet_ip {
namespace {

using namespace std::chrono_literals;

TEST(PeriodMeter, SaysNothingBeforeASecondIsOver) {
  PeriodMeter meter;
  for (auto now = 5s + 0ms; now < 6s; now += 10ms) meter.packet(now);
  EXPECT_EQ(meter.facts().mean_us, 0);
  meter.packet(6s);
  EXPECT_EQ(meter.facts().mean_us, 10'000);
  EXPECT_EQ(meter.facts().max_us, 10'000);
  EXPECT_EQ(meter.facts().deviation_us, 0);
}

TEST(PeriodMeter, GivesMeanMaximumAndStandardDeviationOfTheLastSecond) {
  PeriodMeter meter;
  auto now = 0ms;
  meter.packet(now);
  for (int i = 0; i < 50; ++i) {  // 8, 12, 8, 12 ms
    meter.packet(now += 8ms);
    meter.packet(now += 12ms);
  }
  EXPECT_EQ(meter.facts().mean_us, 10'000);
  EXPECT_EQ(meter.facts().max_us, 12'000);
  EXPECT_EQ(meter.facts().deviation_us, 2'000);
  for (int i = 0; i < 100; ++i) meter.packet(now += 10ms);  // what was before counts no more
  EXPECT_EQ(meter.facts().max_us, 10'000);
  EXPECT_EQ(meter.facts().deviation_us, 0);
}

TEST(PeriodMeter, MeasuresPeriodsThatAreLongerThanItsSecond) {
  PeriodMeter meter;
  meter.packet(1s);
  meter.packet(11s);
  EXPECT_EQ(meter.facts().mean_us, 10'000'000);
}

TEST(PeriodMeter, TakesThePauseBetweenTwoConnectionsForNoPeriod) {
  PeriodMeter meter;
  for (auto now = 0ms; now <= 1s; now += 10ms) meter.packet(now);
  EXPECT_EQ(meter.facts().mean_us, 10'000);
  meter.restart();
  EXPECT_EQ(meter.facts().mean_us, 0);
  for (auto now = 60s + 0ms; now <= 61s; now += 10ms) meter.packet(now);
  EXPECT_EQ(meter.facts().max_us, 10'000);
}

}  // namespace
}  // namespace meca::ethernet_ip
