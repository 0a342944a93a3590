// A smooth run from 0 to 1: speed rises over a ramp, stays, and falls over a ramp; acceleration is a trapezoid, so
// there is no jerk step at its corners that a drive could not follow.
#pragma once

namespace meca::sim {

class Profile {
 public:
  Profile() = default;
  // `cruise` > 0: seconds the run would take at full speed all the way. `ramp` > 0: seconds from rest to full speed.
  // A run too short for full speed keeps the slope of that ramp and turns around earlier.
  Profile(double cruise, double ramp) noexcept;

  // The same ramps, slowed down to take `seconds` (not shorter than it takes now).
  Profile lasting(double seconds) const noexcept;

  struct Point {
    double position;  // 0..1
    double speed;     // per second
  };
  Point at(double seconds) const noexcept;

  double duration() const noexcept { return duration_; }  // seconds
  double ramp() const noexcept { return ramp_; }          // seconds, after shortening
  double top_speed() const noexcept { return speed_; }    // per second

  // Part of a ramp in which acceleration rises (and again falls). Calibrated: a published 1 kHz log of an R4 has a peak
  // of 478 deg/s^2 where the average of the ramp is 375, so 1 / (1 - x) = 478 / 375.
  static constexpr double kJerkShare = 1.0 - 375.0 / 478.0;

 private:
  double ramp_ = 0, speed_ = 0, duration_ = 0;
};

}  // namespace meca::sim
