#include "sim/profile.hpp"

#include <algorithm>
#include <cmath>

namespace meca::sim {
namespace {

struct Ramp {
  double speed;     // 0..1 of full speed
  double distance;  // in (full speed x ramp time); 0.5 at the end
};

// `u` 0..1 of the ramp. Acceleration: up over x, constant, down over x, with area 1.
Ramp ramp_at(double u) noexcept {
  constexpr double x = Profile::kJerkShare;
  constexpr double peak = 1 / (1 - x);
  const auto first_half = [&](double v) -> Ramp {
    if (v < x) return {peak * v * v / (2 * x), peak * v * v * v / (6 * x)};
    const double d = v - x;
    return {peak * (x / 2 + d), peak * (x * x / 6 + x / 2 * d + d * d / 2)};
  };
  if (u <= 0.5) return first_half(u);
  const Ramp mirror = first_half(1 - u);  // speed is point symmetric around the middle
  return {1 - mirror.speed, u - 0.5 + mirror.distance};
}

}  // namespace

Profile::Profile(double cruise, double ramp) noexcept {
  cruise = std::max(cruise, 1e-6);
  ramp = std::max(ramp, 1e-6);
  if (cruise >= ramp) {
    speed_ = 1 / cruise;
    ramp_ = ramp;
    duration_ = cruise + ramp;
  } else {
    ramp_ = std::sqrt(cruise * ramp);  // same slope 1 / (cruise ramp), distance 1 in two ramps
    speed_ = 1 / ramp_;
    duration_ = 2 * ramp_;
  }
}

Profile Profile::lasting(double seconds) const noexcept {
  if (seconds >= 2 * ramp_) return {seconds - ramp_, ramp_};
  return {seconds / 2, seconds / 2};
}

Profile::Point Profile::at(double seconds) const noexcept {
  if (seconds <= 0) return {0, 0};
  if (seconds >= duration_) return {1, 0};
  if (seconds < ramp_) {
    const Ramp r = ramp_at(seconds / ramp_);
    return {r.distance * ramp_ * speed_, r.speed * speed_};
  }
  const double left = duration_ - seconds;
  if (left < ramp_) {
    const Ramp r = ramp_at(left / ramp_);
    return {1 - r.distance * ramp_ * speed_, r.speed * speed_};
  }
  return {(seconds - ramp_ / 2) * speed_, speed_};
}

}  // namespace meca::sim
