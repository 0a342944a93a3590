// The judge of a death must be able to condemn: each promise is broken once by one image.
#include "tests/bench/death_judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "transports/image/motion_commands.hpp"

namespace meca::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint64_t kRenewed = 1000;  // the cycle that took the last sign of life
constexpr DeathLimits kLimits;            // 1 ms, lease 100 ms, velocity lease 50 ms

std::int64_t stamp(std::uint64_t cycle) {
  return 1'800'000'000'000'000'000 + static_cast<std::int64_t>(cycle) * 1'000'000;
}

// Queued motion until the cycle before `stop`, then the stop image.
WireImages images(std::uint64_t stop) {
  WireImages all;
  for (std::uint64_t cycle = kRenewed - 10; cycle < kRenewed + 300; ++cycle) {
    WireImage& image = all[cycle];
    image.time_ns = stamp(cycle);
    image.has_control = image.has_command = true;
    image.set_point = cycle < stop;
    image.pause = cycle >= stop;
    image.move_id = 7;
    image.command = image::kMoveJoints;
  }
  return all;
}

// A velocity stream that falls silent: zero from `zero` on, stop from `stop` on.
WireImages velocity(std::uint64_t zero, std::uint64_t stop) {
  WireImages all = images(stop);
  for (auto& [cycle, image] : all) {
    image.command = image::kMoveJointsVel;
    image.arguments[0] = cycle < zero ? 8.F : 0.F;
    image.set_point = cycle < zero;
  }
  return all;
}

std::vector<std::string> stop_broken(const WireImages& all, bool is_velocity = false) {
  const auto facts = judge_stop(all, stamp(kRenewed), is_velocity, kLimits);
  return facts ? facts->broken : std::vector<std::string>{"not measured"};
}

TEST(DeathJudge, CountsFromTheCycleThatTookTheSignOfLifeToTheCycleThatSendsTheStop) {
  const auto facts = judge_stop(images(kRenewed + 101), stamp(kRenewed), false, kLimits);
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->stop_cycle, kRenewed + 101);
  EXPECT_EQ(facts->cycles, 102);
  EXPECT_EQ(facts->on_wire_ns, stamp(kRenewed + 102));
  EXPECT_THAT(facts->broken, IsEmpty());
}

TEST(DeathJudge, CondemnsAStopOneCycleTooLate) {
  EXPECT_THAT(stop_broken(images(kRenewed + 102)), ElementsAre(HasSubstr("after 103 cycles, promised 102")));
}

TEST(DeathJudge, CondemnsAStopBeforeTheLeaseIsOver) {
  EXPECT_THAT(stop_broken(images(kRenewed + 98)), ElementsAre(HasSubstr("before the lease was over")));
}

TEST(DeathJudge, CondemnsALateStopThatMissedCyclesMakeLookEarly) {
  WireImages all = images(kRenewed + 60);
  for (auto& [cycle, image] : all) {
    if (cycle >= kRenewed + 50) image.time_ns = stamp(cycle + 60);  // 60 cycles could not be run, 10 more were
  }
  EXPECT_THAT(stop_broken(all), ElementsAre(HasSubstr("did not stop")));
}

TEST(DeathJudge, TakesAPauseThatLeavesTheVelocityForNoStop) {
  WireImages all = velocity(kRenewed + 120, kRenewed + 101);
  for (auto& [cycle, image] : all) image.set_point = image.set_point && cycle < kRenewed + 101;
  EXPECT_THAT(stop_broken(all), testing::Not(IsEmpty()));
}

TEST(DeathJudge, CondemnsAVelocityThatOutlivesItsOwnLease) {
  EXPECT_THAT(stop_broken(velocity(kRenewed + 51, kRenewed + 101), true), IsEmpty());
  EXPECT_THAT(stop_broken(velocity(kRenewed + 52, kRenewed + 101), true), ElementsAre(HasSubstr("promised 52")));
}

TEST(DeathJudge, MeasuresNothingAcrossAHole) {
  WireImages all = images(kRenewed + 101);
  all.erase(kRenewed + 40);
  EXPECT_FALSE(judge_stop(all, stamp(kRenewed), false, kLimits));
  EXPECT_FALSE(judge_stop(images(kRenewed + 101), stamp(kRenewed) + 1, false, kLimits)) << "no cycle has that stamp";
}

TEST(DeathJudge, WantsQuietUntilTheNextOwnerIsLet) {
  const std::uint64_t stop = kRenewed + 101, resumed = stop + 50, commanded = stop + 70;
  const auto broken = [&](std::uint64_t cycle, auto change) {
    WireImages all = images(stop);
    for (auto& [at, image] : all) image.pause = at >= stop && at < resumed;
    change(all[cycle]);
    return judge_quiet(all, stop, resumed, commanded).value_or(std::vector<std::string>{"not measured"});
  };
  const auto nothing = [](WireImage&) {};
  const auto set_point = [](WireImage& i) { i.set_point = true; };
  const auto unpause = [](WireImage& i) { i.pause = false; };
  const auto resume = [](WireImage& i) { i.resume = true; };
  EXPECT_THAT(broken(stop, nothing), IsEmpty());
  EXPECT_THAT(broken(commanded, set_point), IsEmpty());
  EXPECT_THAT(broken(commanded - 1, set_point), ElementsAre(HasSubstr("SetPoint")));
  EXPECT_THAT(broken(resumed, resume), IsEmpty());
  EXPECT_THAT(broken(resumed - 1, resume), ElementsAre(HasSubstr("Resume")));
  EXPECT_THAT(broken(resumed - 1, unpause), ElementsAre(HasSubstr("Pause")));
  EXPECT_THAT(broken(resumed - 1, [](WireImage& i) { i.has_command = false; }), ElementsAre("not measured"));
}

}  // namespace
}  // namespace meca::bench
