#include "sim/planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/error.hpp"
#include "sim/severity.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

double largest_change(const Joints& a, const Joints& b) noexcept {
  double out = 0;
  for (std::size_t i = 0; i < 6; ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

Posture without_zero(Posture p) noexcept {
  const auto fill = [](int v) { return v == 0 ? 1 : v; };
  return {fill(p.shoulder), fill(p.elbow), fill(p.wrist)};
}

Joints joints_of(const Command& c) noexcept {
  Joints out;
  std::copy(c.arguments.begin(), c.arguments.end(), out.begin());
  return out;
}

}  // namespace

Transform Segment::flange_at(double position) const noexcept {
  const Transform tool{rotation(turn_.axis, turn_.degrees * position) * tool_start_.r,
                       tool_start_.p + position * travel_};
  return tool * tool_inverse_;
}

Joints Segment::at(double seconds) noexcept {
  if (kind_ == Kind::kDelay) return end_;
  if (seconds >= profile_.duration()) return end_;
  const double s = profile_.at(seconds).position;
  if (kind_ == Kind::kJoints) {
    Joints out;
    for (std::size_t i = 0; i < 6; ++i) out[i] = start_[i] + s * (end_[i] - start_[i]);
    return out;
  }
  std::size_t i = stretch_count_ - 1;
  while (i > 0 && s < stretches_[i].from) --i;
  if (Joints q; joints_at(s, stretches_[i].posture, last_, q)) last_ = q;
  return last_;
}

bool Segment::joints_at(double position, const Posture& posture, const Joints& previous, Joints& out) const noexcept {
  if (!inverse(flange_at(position), posture, previous, out)) return false;
  out[5] = with_nearest_turn(out[5], previous[5], kModelLimits.minimum[5], kModelLimits.maximum[5]);
  return true;
}

// The posture that moves the joints least; the elbow cannot turn over on a line.
Posture Segment::nearest_posture(double position, const Posture& now, const Joints& previous) const noexcept {
  Posture best = now;
  double least = std::numeric_limits<double>::infinity();
  for (const Posture p :
       {now, Posture{now.shoulder, now.elbow, -now.wrist}, Posture{-now.shoulder, now.elbow, now.wrist},
        Posture{-now.shoulder, now.elbow, -now.wrist}}) {
    Joints q;
    if (!joints_at(position, p, previous, q)) continue;
    if (const double change = largest_change(q, previous); change < least) {
      least = change;
      best = p;
    }
  }
  return best;
}

// Finds where between the two positions `next` takes over, so that following the line in time, with other steps than
// the planning's, changes posture at the same place. False: more often than a line can.
bool Segment::change_posture(double before, double after, const Posture& now, const Posture& next,
                             const Joints& previous) noexcept {
  if (stretch_count_ == stretches_.size()) return false;
  for (int i = 0; i < 40; ++i) {
    const double middle = (before + after) / 2;
    (nearest_posture(middle, now, previous) == now ? before : after) = middle;
  }
  stretches_[stretch_count_++] = {after, next};
  return true;
}

std::uint16_t Planner::plan(const Command& command, Segment& segment) const noexcept {
  const Joints a = joints_of(command);
  const Transform pose = to_transform(a);
  const Transform tool = forward(situation_.start) * settings_.trf_transform;  // in the base frame
  segment.start_ = situation_.start;
  switch (command.id) {
    case image::kDelay:
      segment.kind_ = Segment::Kind::kDelay;
      segment.end_ = situation_.start;
      segment.delay_ = a[0];
      return error::kNone;
    case image::kMoveJoints:
      return plan_joints(a, segment);
    case image::kMoveJointsRel: {
      Joints target = situation_.start;
      for (std::size_t i = 0; i < 6; ++i) target[i] += a[i];
      return plan_joints(target, segment);
    }
    case image::kMovePose: {
      Joints target;
      const Transform flange = settings_.wrf_transform * pose * inverse(settings_.trf_transform);
      if (const auto code = choose_joints(flange, target); code != error::kNone) return code;
      return plan_joints(target, segment);
    }
    case image::kMoveLin:
      return plan_linear(settings_.wrf_transform * pose, segment);
    case image::kMoveLinRelTrf:
      return plan_linear(tool * pose, segment);
    case image::kMoveLinRelWrf: {
      // Axes of the WRF, around the tool's own point.
      const Mat3& w = settings_.wrf_transform.r;
      return plan_linear({w * pose.r * transpose(w) * tool.r, tool.p + w * pose.p}, segment);
    }
    default:
      return error::kCommandFailed;
  }
}

double Planner::joint_time(const Joints& target) const noexcept {
  double out = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    out = std::max(out, std::abs(target[i] - situation_.start[i]) / dynamics_.joint_speed[i]);
  }
  return out;
}

std::uint16_t Planner::give_time(double cruise, double ramp, Segment& segment) const noexcept {
  segment.profile_ = Profile(cruise, ramp);
  if (settings_.move_mode == 0) return error::kNone;
  const bool too_short = settings_.move_duration < segment.profile_.duration();
  if (!too_short) segment.profile_ = segment.profile_.lasting(settings_.move_duration);
  return too_short && settings_.move_duration_severity == severity::kError ? error::kDurationTooShort : error::kNone;
}

std::uint16_t Planner::plan_joints(const Joints& target, Segment& segment) const noexcept {
  if (!situation_.limits.contains(target)) return error::kJointOverLimit;
  segment.kind_ = Segment::Kind::kJoints;
  segment.end_ = target;
  return give_time(joint_time(target), dynamics_.joint_ramp, segment);
}

std::uint16_t Planner::choose_joints(const Transform& flange, Joints& out) const noexcept {
  const JointLimits& limits = situation_.limits;
  const Solutions solutions = inverse_all(flange, situation_.start);
  std::uint16_t why = error::kOutOfReach;
  double best = 0;
  for (std::size_t i = 0; i < solutions.count; ++i) {
    if (!settings_.auto_conf && solutions.all[i].posture != settings_.conf) continue;
    Joints q = solutions.all[i].joints;
    q[5] = settings_.auto_conf_turn ? with_nearest_turn(q[5], situation_.start[5], limits.minimum[5], limits.maximum[5])
                                    : with_turn(q[5], settings_.conf_turn);
    if (!limits.contains(q)) {
      if (why == error::kOutOfReach) why = error::kJointOverLimit;
      continue;
    }
    const double time = joint_time(q);
    if (why == error::kNone && time >= best) continue;
    best = time;
    out = q;
    why = error::kNone;
  }
  return why;
}

bool Planner::start_is_in_conf() const noexcept {
  const auto fits = [](int is, int wanted) { return is == 0 || is == wanted; };
  if (!settings_.auto_conf) {
    const Posture is = posture(situation_.start);
    const Posture& wanted = settings_.conf;
    if (!fits(is.shoulder, wanted.shoulder) || !fits(is.elbow, wanted.elbow) || !fits(is.wrist, wanted.wrist)) {
      return false;
    }
  }
  return settings_.auto_conf_turn || turn(situation_.start[5]) == settings_.conf_turn;
}

// Steps over a piece of line where joints turn fast; fewer than the first walk ever takes, so that it tells them apart.
constexpr int kFiner = 32, kFewestSamples = 40, kMostSamples = 400;

std::uint16_t Planner::walk_to(Segment& segment, double before, double after, int steps, Joints& previous,
                               double& cruise) const noexcept {
  constexpr double kSmooth = 5;  // degrees a joint may turn in one step without a closer look
  constexpr double kJump = 20;   // and with one
  for (int i = 1; i <= steps; ++i) {
    const double a = before + (after - before) * (i - 1) / steps, b = before + (after - before) * i / steps;
    const Posture now = segment.stretches_[segment.stretch_count_ - 1].posture;
    Joints q;
    if (!segment.joints_at(b, now, previous, q)) return error::kOutOfReach;
    if (largest_change(q, previous) > kSmooth) {
      // A line past a singularity would need joints to jump; one exactly through it needs another posture behind it.
      const Posture next = segment.nearest_posture(b, now, previous);
      segment.joints_at(b, next, previous, q);
      if (largest_change(q, previous) > (steps == kFiner ? kSmooth : kJump)) return error::kSingularity;
      if (steps != kFiner) {
        if (const auto code = walk_to(segment, a, b, kFiner, previous, cruise); code != error::kNone) return code;
        continue;
      }
      if (next == now || !settings_.auto_conf) return error::kSingularity;
      if (!segment.change_posture(a, b, now, next, previous)) return error::kSingularity;
    }
    if (!situation_.limits.contains(q)) return error::kJointOverLimit;
    for (std::size_t j = 0; j < 6; ++j) {
      cruise = std::max(cruise, std::abs(q[j] - previous[j]) / (b - a) / dynamics_.speed_limit[j]);
    }
    previous = q;
  }
  return error::kNone;
}

std::uint16_t Planner::walk(Segment& segment, double& cruise, int samples) const noexcept {
  segment.stretches_[0] = {0, settings_.auto_conf ? without_zero(posture(situation_.start)) : settings_.conf};
  segment.stretch_count_ = 1;
  segment.end_ = situation_.start;
  return walk_to(segment, 0, 1, samples, segment.end_, cruise);
}

std::uint16_t Planner::plan_linear(const Transform& tool_target, Segment& segment) const noexcept {
  if (!start_is_in_conf()) return error::kStartConfMismatch;
  segment.kind_ = Segment::Kind::kLinear;
  segment.tool_inverse_ = inverse(settings_.trf_transform);
  segment.tool_start_ = forward(situation_.start) * settings_.trf_transform;
  segment.travel_ = tool_target.p - segment.tool_start_.p;
  segment.turn_ = axis_angle(tool_target.r * transpose(segment.tool_start_.r));
  segment.last_ = situation_.start;

  const double distance = norm(segment.travel_);
  const double angle = std::abs(segment.turn_.degrees);
  double cruise = std::max(distance / dynamics_.linear_speed, angle / dynamics_.angular_speed);
  const double wanted_samples = std::clamp<double>(std::max(distance / 2, angle), kFewestSamples, kMostSamples);
  if (const auto code = walk(segment, cruise, static_cast<int>(wanted_samples)); code != error::kNone) return code;
  return give_time(cruise, dynamics_.cartesian_ramp, segment);
}

}  // namespace meca::sim
