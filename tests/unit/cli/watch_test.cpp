#include "cli/watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/unit/cli/samples.hpp"

namespace meca::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using namespace std::chrono_literals;

constexpr JointRange kRange{-100, 100};

meca500::DynamicData limits(std::uint32_t type, int first_joint, std::array<double, 3> minimum,
                            std::array<double, 3> maximum) {
  auto sample = with_header<meca500::DynamicData>();
  sample.type_id(type);
  std::vector<meca500::NamedValue> values;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string joint = "joint " + std::to_string(first_joint + static_cast<int>(i));
    meca500::NamedValue low, high;
    low.name(joint + " min");
    low.value(minimum[i]);
    high.name(joint + " max");
    high.value(maximum[i]);
    values.push_back(low);
    values.push_back(high);
  }
  sample.values(values);
  return sample;
}

TEST(Bar, PutsTheMarkWhereTheValueIs) {
  EXPECT_EQ(bar(-100, kRange, 11), "[o----------]");
  EXPECT_EQ(bar(0, kRange, 11), "[-----o-----]");
  EXPECT_EQ(bar(100, kRange, 11), "[----------o]");
}

TEST(Bar, ShowsWhatIsOutsideOrNoNumber) {
  EXPECT_EQ(bar(-101, kRange, 11), "[<----------]");
  EXPECT_EQ(bar(1e30, kRange, 11), "[---------->]");
  EXPECT_EQ(bar(std::numeric_limits<double>::quiet_NaN(), kRange, 11), "[-----?-----]");
  EXPECT_EQ(bar(0, {0, 0}, 11), "[-----?-----]");
}

TEST(JointRanges, AreTheModelsUntilTheRobotReportsItsOwn) {
  auto view = standing_robot();
  EXPECT_EQ(joint_ranges(view)[0].minimum, -175);
  EXPECT_EQ(joint_ranges(view)[1].maximum, 90);
  view.dynamic_data[14] = limits(14, 1, {-20, -30, -40}, {20, 30, 40});
  EXPECT_EQ(joint_ranges(view)[0].minimum, -20);
  EXPECT_EQ(joint_ranges(view)[2].maximum, 40);
  EXPECT_EQ(joint_ranges(view)[3].maximum, 170);
  view.dynamic_data[15] = limits(15, 4, {-1, -2, -3}, {1, 2, 3});
  EXPECT_EQ(joint_ranges(view)[5].minimum, -3);
}

TEST(JointRanges, ZeroesOfARobotThatHasNotReportedYetAreNotBelieved) {
  auto view = standing_robot();
  view.dynamic_data[14] = limits(14, 1, {0, 0, 0}, {0, 0, 0});
  EXPECT_EQ(joint_ranges(view)[0].maximum, 175);
}

TEST(Screen, ShowsOneRobotInFull) {
  const auto text = screen_text("arm1", standing_robot(), {1000, 100, 4}, false, false);
  EXPECT_THAT(text, HasSubstr("arm1  standing, nothing queued  (Meca500 R4 11.3.0.1, builtin)\n"));
  EXPECT_THAT(text, HasSubstr("q1    -10.000   -175 [--------------o----------------] 175\n"));
  EXPECT_THAT(text, HasSubstr("images 1000/s, joint samples 100/s, the last 4 ms ago"));
  EXPECT_THAT(text, Not(HasSubstr("\033")));
}

TEST(Screen, ShowsTheTurnsOfJointSixBesideABarOfOneTurn) {
  const auto text = screen_text("arm1", standing_robot(), {}, false, false);
  EXPECT_THAT(text, HasSubstr("q6    720.250   -180 [---------------o---------------] 180  turn 2\n"));
}

TEST(Screen, MarksOldValuesAsOld) {
  auto view = standing_robot();
  view.joints->header().quality(meca500::Quality::STALE);
  EXPECT_THAT(screen_text("arm1", view, {}, false, false), HasSubstr("[STALE: last known values]"));
}

TEST(Screen, HasColorOnlyWhenAsked) {
  EXPECT_THAT(screen_text("arm1", standing_robot(), {}, false, true), HasSubstr("\033[32m"));
}

TEST(Screen, ShowsRobotsInShortWhenTheyWouldNotFit) {
  const Views robots{{"arm1", standing_robot()}, {"arm2", standing_robot()}};
  const auto tall = screen_text(robots, {}, {.rows = 60, .color = false});
  const auto low = screen_text(robots, {}, {.rows = 24, .color = false});
  EXPECT_THAT(tall, HasSubstr("q1 "));
  EXPECT_THAT(low, Not(HasSubstr("q1 ")));
  EXPECT_THAT(low, HasSubstr("arm2  standing"));
  EXPECT_LT(std::ranges::count(low, '\n'), 24);
}

TEST(Screen, OfARobotNothingHasArrivedFromSaysSo) {
  EXPECT_THAT(screen_text("arm1", RobotView{}, {}, false, false), HasSubstr("the last never"));
}

TEST(Line, IsOneLine) {
  const auto text = line_text("arm1", standing_robot(), {1000, 100, 4});
  EXPECT_THAT(text, Not(HasSubstr("\n")));
  EXPECT_THAT(text, HasSubstr("arm1  standing, nothing queued"));
}

TEST(WatchJson, HasRatesBesideTheSamples) {
  const auto json = watch_json("arm1", standing_robot(), {1000, 100, -1});
  EXPECT_EQ(json["rates"]["images_per_second"], 1000);
  EXPECT_TRUE(json["rates"]["age_ms"].is_null());
  EXPECT_EQ(json["doing"], "standing, nothing queued");
}

TEST(RateMeter, MeasuresOverASecond) {
  RateMeter meter;
  Views robots{{"arm1", standing_robot()}};
  auto& view = robots["arm1"];
  const Clock::time_point start{100s};
  view.bridge->fresh_images(5000);
  view.joint_samples = 10;
  view.joints_arrived = start;
  meter.update(robots, start);
  view.bridge->fresh_images(7000);
  view.joint_samples = 210;
  EXPECT_EQ(meter.update(robots, start + 500ms).at("arm1").images, 0) << "a window is a second";
  const auto rates = meter.update(robots, start + 2s).at("arm1");
  EXPECT_DOUBLE_EQ(rates.images, 1000);
  EXPECT_DOUBLE_EQ(rates.samples, 100);
  EXPECT_DOUBLE_EQ(rates.age_ms, 2000);
}

TEST(RateMeter, ARestartedBridgeDoesNotGiveAnAbsurdRate) {
  RateMeter meter;
  Views robots{{"arm1", standing_robot()}};
  robots["arm1"].bridge->fresh_images(1'000'000);
  meter.update(robots, Clock::time_point{100s});
  robots["arm1"].bridge->fresh_images(5);
  EXPECT_EQ(meter.update(robots, Clock::time_point{101s}).at("arm1").images, 0);
}

}  // namespace
}  // namespace meca::cli
