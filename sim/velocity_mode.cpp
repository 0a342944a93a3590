#include "sim/velocity_mode.hpp"

#include <algorithm>
#include <cmath>

#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

constexpr double kMargin = 0.05;  // degrees kept from a joint limit; not published, inferred from "slightly before"

void scale(Joints& v, double k) noexcept {
  for (double& x : v) x *= k;
}

// All joints slow down together, so the direction stays.
void limit_speed(Joints& v, const Joints& limit) noexcept {
  double over = 1;
  for (std::size_t i = 0; i < 6; ++i) over = std::max(over, std::abs(v[i]) / limit[i]);
  scale(v, 1 / over);
}

// Speed from which each joint can still stop before its limit at half the available deceleration.
void brake_before_limits(Joints& v, const Joints& q, const JointLimits& limits, const Joints& slope,
                         double seconds) noexcept {
  double k = 1;
  for (std::size_t i = 0; i < 6; ++i) {
    const double room = (v[i] > 0 ? limits.maximum[i] - q[i] : q[i] - limits.minimum[i]) - kMargin;
    if (v[i] == 0) continue;
    const double allowed = room <= 0 ? 0 : std::min(std::sqrt(slope[i] * room), room / seconds);
    k = std::min(k, allowed / std::abs(v[i]));
  }
  scale(v, k);
}

// The stretched (or folded) elbow is a singularity that a line cannot cross: it would have to come back from there.
bool would_stretch(const Joints& q, const Joints& v, double seconds) noexcept {
  const Joints next{q[0], q[1], q[2] + v[2] * seconds, q[3], q[4], q[5]};
  const int now = posture(q).elbow;
  return now != 0 && posture(next).elbow != now;
}

}  // namespace

void VelocityMode::command(const Command& command) noexcept {
  command_ = command;
  active_ = true;
  cancelled_ = false;
  age_ = 0;
}

void VelocityMode::halt() noexcept {
  active_ = cancelled_ = moving_ = accelerating_ = false;
  velocity_ = change_ = {};
}

Joints VelocityMode::wanted(const Settings& settings, const Dynamics& d, const Joints& q) const noexcept {
  Joints out{};
  if (cancelled_) return out;
  if (command_.id == image::kMoveJointsVel) {
    std::copy(command_.arguments.begin(), command_.arguments.end(), out.begin());
    limit_speed(out, d.speed_limit);
    return out;
  }
  const Mat3 axes =
      command_.id == image::kMoveLinVelTrf ? forward(q).r * settings.trf_transform.r : settings.wrf_transform.r;
  // Arguments have no limit; far above what any arm can do, only the direction matters (and squares would overflow).
  constexpr double kEnough = 1e4;
  double largest = kEnough;
  for (const float v : command_.arguments) largest = std::max(largest, std::abs(static_cast<double>(v)));
  Twist a{};
  for (std::size_t i = 0; i < 6; ++i) a[i] = command_.arguments[i] * (kEnough / largest);
  Vec3 linear = axes * Vec3{a[0], a[1], a[2]}, angular = axes * Vec3{a[3], a[4], a[5]};
  const double over = std::max({1.0, norm(linear) / d.linear_limit, norm(angular) / d.angular_limit});
  linear = (1 / over) * linear;
  angular = (1 / over) * angular;
  const Twist twist{linear[0], linear[1], linear[2], angular[0], angular[1], angular[2]};
  if (!solve(jacobian(q, settings.trf_transform.p), twist, out)) return {};
  limit_speed(out, d.speed_limit);
  return out;
}

// deg/s^2: full speed in one ramp.
Joints VelocityMode::slope(const Dynamics& d) const noexcept {
  const double ramp = command_.id == image::kMoveJointsVel ? d.joint_ramp : d.cartesian_ramp;
  Joints out;
  for (std::size_t i = 0; i < 6; ++i) out[i] = kTopSpeed[i] / ramp;
  return out;
}

Joints VelocityMode::rest_ahead(double seconds, const Settings& settings, bool recovery_mode,
                                const Joints& joints) const noexcept {
  const Joints slope = this->slope(dynamics(settings, recovery_mode));
  double to_rest = 0;
  Joints next;  // as if it went on to change as it did
  for (std::size_t i = 0; i < 6; ++i) {
    next[i] = velocity_[i] + change_[i];
    to_rest = std::max(to_rest, std::abs(next[i]) / slope[i]);
  }
  Joints out;
  for (std::size_t i = 0; i < 6; ++i) out[i] = joints[i] + next[i] * (seconds + to_rest / 2);
  return out;
}

void VelocityMode::step(double seconds, const Settings& settings, const JointLimits& limits, bool recovery_mode,
                        Joints& joints) noexcept {
  if (!active_ || seconds <= 0) return;
  age_ += seconds;
  if (age_ > settings.velocity_timeout + 1e-9) cancelled_ = true;
  const Dynamics d = dynamics(settings, recovery_mode);
  const Joints slope = this->slope(d);
  const Joints before = velocity_;
  const Joints target = wanted(settings, d, joints);
  double k = 1;
  for (std::size_t i = 0; i < 6; ++i) {
    const double change = std::abs(target[i] - velocity_[i]);
    if (change > slope[i] * seconds) k = std::min(k, slope[i] * seconds / change);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    change_[i] = k * (target[i] - velocity_[i]);
    velocity_[i] += change_[i];
  }
  brake_before_limits(velocity_, joints, limits, slope, seconds);

  if (command_.id != image::kMoveJointsVel && would_stretch(joints, velocity_, seconds)) velocity_ = {};

  accelerating_ = velocity_ != before;
  moving_ = false;
  for (std::size_t i = 0; i < 6; ++i) {
    joints[i] += velocity_[i] * seconds;
    if (std::abs(velocity_[i]) > 1e-6) moving_ = true;
  }
  if (cancelled_ && !moving_) halt();
}

}  // namespace meca::sim
