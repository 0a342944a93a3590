#include "sim/profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace meca::sim {
namespace {

TEST(Profile, StartsAtRestEndsAtRestAndNeverGoesBack) {
  for (const double cruise : {0.05, 0.2, 0.8}) {
    const Profile p(cruise, 0.2);
    EXPECT_EQ(p.at(0).position, 0);
    EXPECT_EQ(p.at(p.duration()).position, 1);
    double before = 0;
    for (double t = 0; t <= p.duration(); t += 1e-3) {
      const auto point = p.at(t);
      EXPECT_GE(point.position, before - 1e-12);
      EXPECT_GE(point.speed, 0);
      EXPECT_LE(point.speed, p.top_speed() * (1 + 1e-9));
      before = point.position;
    }
  }
}

TEST(Profile, SpeedIsTheDerivativeOfPosition) {
  const Profile p(0.8, 0.2);
  for (double t = 0.001; t < p.duration() - 0.001; t += 0.00037) {
    const double slope = (p.at(t + 1e-6).position - p.at(t - 1e-6).position) / 2e-6;
    ASSERT_NEAR(slope, p.at(t).speed, 1e-3) << t;
  }
}

TEST(Profile, AccelerationHasNoJumps) {
  const Profile p(0.8, 0.2);
  const auto acceleration = [&](double t) { return (p.at(t + 1e-5).speed - p.at(t - 1e-5).speed) / 2e-5; };
  double before = 0;
  // The steepest change allowed: from 0 to the peak over the jerk share of the ramp.
  const double steepest = p.top_speed() / 0.2 / (1 - Profile::kJerkShare) / (0.2 * Profile::kJerkShare);
  for (double t = 1e-4; t < p.duration(); t += 1e-4) {
    const double a = acceleration(t);
    ASSERT_LT(std::abs(a - before), steepest * 1.2e-4) << t;
    before = a;
  }
}

TEST(Profile, TheRampOfTheR4LogHasAnAverageOf375AndAPeakOf478) {
  // 60 degrees with a plateau of 75 deg/s: spec 6.2, public 1 kHz log of an R4.
  const Profile p(60.0 / 75, 0.2);
  double peak = 0;
  for (double t = 1e-4; t < 0.2; t += 1e-4) peak = std::max(peak, (p.at(t + 1e-5).speed - p.at(t - 1e-5).speed) / 2e-5);
  EXPECT_NEAR(60 * peak, 478, 1);
  EXPECT_NEAR(60 * p.at(0.2).speed, 75, 1e-9);
}

TEST(Profile, AShortRunTurnsAroundBeforeFullSpeed) {
  const Profile full(0.8, 0.2), quarter(0.05, 0.2);
  EXPECT_NEAR(full.duration(), 1.0, 1e-12);
  EXPECT_NEAR(quarter.duration(), 0.2, 1e-12);  // 2 sqrt(0.05 * 0.2)
  EXPECT_NEAR(quarter.ramp(), 0.1, 1e-12);
}

TEST(Profile, ARunOfNoLengthIsOverAtOnce) {
  const Profile p(0, 0.2);
  EXPECT_LT(p.duration(), 0.01);
  EXPECT_EQ(p.at(0.01).position, 1);
}

}  // namespace
}  // namespace meca::sim
