// When a topic is published: rates as pure decisions, with the time as an argument.
#include "bridge/track.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;

constexpr TopicConfig kOnChange{.rate = RateKind::kOnChange};
constexpr TopicConfig kEveryCycle{.rate = RateKind::kEveryCycle};
constexpr TopicConfig kOff{.rate = RateKind::kOff};
constexpr TopicConfig kEvery10ms{.rate = RateKind::kPeriod, .period = 10ms};

TEST(OnChange, TheFirstValueIsPublishedEvenIfItIsAllZeros) {
  Track<image::HostTime> track;
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kUnknown, 0ms));
  EXPECT_FALSE(track.offer(kOnChange, {}, Quality::kUnknown, 1ms));
}

TEST(OnChange, AChangeIsPublishedOnceAndSoIsItsWayBack) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(kOnChange, {.busy = true}, Quality::kGood, 1ms));
  EXPECT_FALSE(track.offer(kOnChange, {.busy = true}, Quality::kGood, 2ms));
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kGood, 3ms));
}

TEST(OnChange, AnotherQualityIsAChangeThoughTheValueStays) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kStale, 1ms));
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kDisconnected, 2ms));
  EXPECT_FALSE(track.offer(kOnChange, {}, Quality::kDisconnected, 3ms));
}

// A volatile reader that joined late, the default of every vendor, never saw TargetWrf: it does not change for hours.
TEST(OnChange, AnUnchangedValueIsRepeatedEverySecondForVolatileReadersThatJoinLate) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kGood, 0ms));
  EXPECT_FALSE(track.offer(kOnChange, {}, Quality::kGood, 999ms));
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kGood, 1000ms));
  EXPECT_FALSE(track.offer(kOnChange, {}, Quality::kGood, 1999ms));
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kGood, 2000ms));
}

TEST(OnChange, TheSecondCountsFromTheLastChange) {
  Track<image::RobotStatus> track;
  EXPECT_TRUE(track.offer(kOnChange, {}, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(kOnChange, {.busy = true}, Quality::kGood, 700ms));
  EXPECT_FALSE(track.offer(kOnChange, {.busy = true}, Quality::kGood, 1699ms));
  EXPECT_TRUE(track.offer(kOnChange, {.busy = true}, Quality::kGood, 1700ms));
}

TEST(OnChange, ANanThatStaysIsNoChange) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Track<image::MotionCommand> track;
  const image::MotionCommand command{.command_id = 15, .arguments = {nan}};
  EXPECT_TRUE(track.offer(kOnChange, command, Quality::kGood, 0ms));
  EXPECT_FALSE(track.offer(kOnChange, command, Quality::kGood, 1ms));
  EXPECT_TRUE(track.offer(kOnChange, {.command_id = 15, .arguments = {}}, Quality::kGood, 2ms));
}

TEST(OnChange, EverySectionOfTheImageIsCompared) {
  const image::Inputs zero;
  const auto differs = [&](auto change) {
    image::Inputs inputs;
    change(inputs);
    return !same(inputs, zero);
  };
  EXPECT_TRUE(same(zero, image::Inputs{}));
  EXPECT_TRUE(differs([](auto& i) { i.robot_status.error_code = 1; }));
  EXPECT_TRUE(differs([](auto& i) { i.motion_status.eom = true; }));
  EXPECT_TRUE(differs([](auto& i) { i.target_joint_set.joints[5] = 1; }));
  EXPECT_TRUE(differs([](auto& i) { i.target_end_effector_pose.gamma = 1; }));
  EXPECT_TRUE(differs([](auto& i) { i.target_configuration.turn = 1; }));
  EXPECT_TRUE(differs([](auto& i) { i.target_wrf.x = 1; }));
  EXPECT_TRUE(differs([](auto& i) { i.target_trf.x = 1; }));
  EXPECT_TRUE(differs([](auto& i) { i.robot_timestamp.microseconds = 1; }));
  EXPECT_TRUE(differs([](auto& i) { i.safety_status.stop.p_stop2 = true; }));
  EXPECT_TRUE(differs([](auto& i) { i.dynamic_data[3].values[5] = 1; }));
}

TEST(OnChange, EveryFieldOfTheControlStateIsCompared) {
  using control::ControlState;
  const auto differs = [](auto change) {
    ControlState state;
    change(state);
    return !same(state, ControlState{});
  };
  EXPECT_TRUE(same(ControlState{}, ControlState{}));
  EXPECT_TRUE(differs([](auto& s) { s.owned = true; }));
  EXPECT_TRUE(differs([](auto& s) { s.owner = std::string_view("x"); }));
  EXPECT_TRUE(differs([](auto& s) { s.owner_participant[11] = std::byte{1}; }));
  EXPECT_TRUE(differs([](auto& s) { s.since_unix_ns = 1; }));
  EXPECT_TRUE(differs([](auto& s) { s.lease_ms = 1; }));
  EXPECT_TRUE(differs([](auto& s) { s.on_loss = control::LossPolicy::kFinishMotion; }));
  EXPECT_TRUE(differs([](auto& s) { s.monitoring_only = true; }));
  EXPECT_TRUE(differs([](auto& s) { s.last_refusal.command_id = 1; }));
  EXPECT_TRUE(differs([](auto& s) { s.last_owner = std::string_view("x"); }));
  EXPECT_TRUE(differs([](auto& s) { s.last_loss = ControlState::Loss::kReleased; }));
  EXPECT_FALSE(differs([](auto& s) { s.last_renewal_unix_ns = 1; })) << "or every renewal would be published";
}

TEST(EveryCycle, EveryRecordIsPublished) {
  Track<image::HostTime> track;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(track.offer(kEveryCycle, {}, Quality::kGood, i * 1ms));
}

TEST(Off, NothingIsPublishedNotEvenABadQuality) {
  Track<image::HostTime> track;
  EXPECT_FALSE(track.offer(kOff, {}, Quality::kGood, 0ms));
  EXPECT_FALSE(track.offer(kOff, {}, Quality::kDisconnected, 1ms));
}

int published(Track<image::HostTime>& track, const TopicConfig& config, Time to, Time step) {
  int count = 0;
  for (Time now{}; now < to; now += step) count += track.offer(config, {}, Quality::kGood, now);
  return count;
}

TEST(Period, TenMillisecondsAreAHundredSamplesASecondWhateverTheCycle) {
  for (const Time cycle : {Time(1ms), Time(2ms), Time(10ms)}) {
    Track<image::HostTime> track;
    EXPECT_EQ(published(track, kEvery10ms, 1s, cycle), 100) << cycle.count();
  }
}

TEST(Period, ACycleThatDoesNotDivideThePeriodKeepsTheMeanRate) {
  Track<image::HostTime> track;
  EXPECT_EQ(published(track, kEvery10ms, 1200ms, 4ms), 120);
}

TEST(Period, AfterAGapItDoesNotCatchUp) {
  Track<image::HostTime> track;
  EXPECT_TRUE(track.offer(kEvery10ms, {}, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(kEvery10ms, {}, Quality::kGood, 5s));
  EXPECT_FALSE(track.offer(kEvery10ms, {}, Quality::kGood, 5001ms));
  EXPECT_TRUE(track.offer(kEvery10ms, {}, Quality::kGood, 5010ms));
}

TEST(Period, ALostLinkDoesNotWaitForThePeriod) {
  const TopicConfig slow{.rate = RateKind::kPeriod, .period = 1h};
  Track<image::TargetJointSet> track;
  EXPECT_TRUE(track.offer(slow, {}, Quality::kGood, 0ms));
  EXPECT_FALSE(track.offer(slow, {}, Quality::kGood, 1ms));
  EXPECT_TRUE(track.offer(slow, {}, Quality::kDisconnected, 2ms));
  EXPECT_FALSE(track.offer(slow, {}, Quality::kDisconnected, 3ms));
}

image::DynamicData data(std::uint32_t type, float value = 0) { return {.type_id = type, .values = {value}}; }

TEST(DynamicDataOnChange, EachTypeOfASlotIsComparedWithItsOwnPast) {
  DynamicTrack track;
  EXPECT_TRUE(track.offer(kOnChange, data(1, 11), false, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(kOnChange, data(2, 4), false, Quality::kGood, 1ms));
  EXPECT_FALSE(track.offer(kOnChange, data(1, 11), false, Quality::kGood, 2ms));  // the slot changed, the type did not
  EXPECT_FALSE(track.offer(kOnChange, data(2, 4), false, Quality::kGood, 3ms));
  EXPECT_TRUE(track.offer(kOnChange, data(1, 12), false, Quality::kGood, 4ms));
}

TEST(DynamicDataOnChange, EveryTypeComesAgainAfterASecondThoughNothingChanged) {
  DynamicTrack track;
  EXPECT_TRUE(track.offer(kOnChange, data(1), true, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(kOnChange, data(2), true, Quality::kGood, 500ms));
  EXPECT_FALSE(track.offer(kOnChange, data(1), true, Quality::kGood, 999ms));
  EXPECT_TRUE(track.offer(kOnChange, data(1), true, Quality::kGood, 1000ms));
  EXPECT_FALSE(track.offer(kOnChange, data(2), true, Quality::kGood, 1001ms));
}

TEST(DynamicDataOnChange, AnAutomaticSlotTellsATypeTenTimesASecondAndARequestedOneEveryTime) {
  DynamicTrack automatic, requested;
  int automatic_count = 0, requested_count = 0;
  for (int i = 0; i < 1000; ++i) {  // a noisy value, every millisecond
    automatic_count += automatic.offer(kOnChange, data(40, float(i)), true, Quality::kGood, i * 1ms);
    requested_count += requested.offer(kOnChange, data(40, float(i)), false, Quality::kGood, i * 1ms);
  }
  EXPECT_EQ(automatic_count, 10);
  EXPECT_EQ(requested_count, 1000);
}

TEST(DynamicDataOnChange, ABadQualityIsToldAtOnce) {
  DynamicTrack track;
  EXPECT_TRUE(track.offer(kOnChange, data(40, 1), true, Quality::kGood, 0ms));
  EXPECT_TRUE(track.offer(kOnChange, data(40, 1), true, Quality::kDisconnected, 1ms));
}

TEST(DynamicDataOnChange, MoreTypesThanItRemembersAreStillAllPublished) {
  DynamicTrack track;
  for (std::uint32_t type = 10000; type < 11000; ++type) {
    EXPECT_TRUE(track.offer(kOnChange, data(type), true, Quality::kGood, 0ms)) << type;
  }
}

}  // namespace
}  // namespace meca::bridge
