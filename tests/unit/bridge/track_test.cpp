// When a section is published: rates over cycle records, with time moved by hand.
#include "bridge/track.hpp"

#include <gtest/gtest.h>

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;

constexpr TopicConfig on_change() { return {.rate = RateKind::kOnChange}; }
constexpr TopicConfig every(Time period) { return {.rate = RateKind::kPeriod, .period = period}; }

image::RobotStatus activated() { return {.activated = true}; }

TEST(OnChange, PublishesTheFirstValueAndThenOnlyChanges) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(on_change(), {}, Quality::kGood, 0ms));
  EXPECT_FALSE(track.offer(on_change(), {}, Quality::kGood, 1ms));
  EXPECT_TRUE(track.offer(on_change(), activated(), Quality::kGood, 2ms));
  EXPECT_FALSE(track.offer(on_change(), activated(), Quality::kGood, 3ms));
}

// A volatile reader that joined late, the default of every vendor, never saw TargetWrf: it does not change for hours.
TEST(OnChange, RepeatsAnUnchangedValueEverySecondForVolatileReadersThatJoinLate) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(on_change(), {}, Quality::kGood, 0ms));
  EXPECT_FALSE(track.offer(on_change(), {}, Quality::kGood, 999ms));
  EXPECT_TRUE(track.offer(on_change(), {}, Quality::kGood, 1000ms));
  EXPECT_FALSE(track.offer(on_change(), {}, Quality::kGood, 1999ms));
  EXPECT_TRUE(track.offer(on_change(), {}, Quality::kGood, 2000ms));
}

TEST(OnChange, CountsTheSecondFromTheLastChange) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(on_change(), {}, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(on_change(), activated(), Quality::kGood, 700ms));
  EXPECT_FALSE(track.offer(on_change(), activated(), Quality::kGood, 1699ms));
  EXPECT_TRUE(track.offer(on_change(), activated(), Quality::kGood, 1700ms));
}

TEST(OnChange, TakesALostLinkForAChange) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(on_change(), {}, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(on_change(), {}, Quality::kDisconnected, 1ms));
}

TEST(Period, KeepsItsPhase) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(every(10ms), {}, Quality::kGood, 0ms));
  EXPECT_FALSE(track.offer(every(10ms), {}, Quality::kGood, 9ms));
  EXPECT_TRUE(track.offer(every(10ms), {}, Quality::kGood, 12ms));
  EXPECT_FALSE(track.offer(every(10ms), {}, Quality::kGood, 19ms));
  EXPECT_TRUE(track.offer(every(10ms), {}, Quality::kGood, 20ms));
}

TEST(Period, DoesNotWaitToSayThatAValueIsNoLongerGood) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(every(100ms), {}, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(every(100ms), {}, Quality::kStale, 3ms));
}

TEST(Off, PublishesNothing) {
  Track<image::RobotStatus> track;
  EXPECT_FALSE(track.offer({.rate = RateKind::kOff}, activated(), Quality::kGood, 5s));
}

}  // namespace
}  // namespace meca::bridge
