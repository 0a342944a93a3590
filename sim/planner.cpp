#include "sim/planner.hpp"

#include <algorithm>
#include <cmath>

#include "sim/error.hpp"
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

// A line that leaves a singularity, or goes exactly through it, continues in the posture that moves the joints least.
bool follow(const Transform& flange, const Joints& previous, Posture& posture, Joints& out) noexcept {
  if (!inverse(flange, posture, previous, out)) return false;
  out[5] = with_nearest_turn(out[5], previous[5], kModelLimits.minimum[5], kModelLimits.maximum[5]);
  double best = largest_change(out, previous);
  if (best < 5) return true;
  for (const Posture other : {Posture{posture.shoulder, posture.elbow, -posture.wrist},
                              Posture{-posture.shoulder, posture.elbow, posture.wrist},
                              Posture{-posture.shoulder, posture.elbow, -posture.wrist}}) {
    Joints q;
    if (!inverse(flange, other, previous, q)) continue;
    q[5] = with_nearest_turn(q[5], previous[5], kModelLimits.minimum[5], kModelLimits.maximum[5]);
    const double change = largest_change(q, previous);
    if (change < best) {
      best = change;
      posture = other;
      out = q;
    }
  }
  return true;
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
  if (Joints q; follow(flange_at(s), last_, posture_, q)) last_ = q;
  return last_;
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

std::uint16_t Planner::plan_joints(const Joints& target, Segment& segment) const noexcept {
  if (!situation_.limits.contains(target)) return error::kJointOverLimit;
  segment.kind_ = Segment::Kind::kJoints;
  segment.end_ = target;
  segment.profile_ = Profile(joint_time(target), dynamics_.joint_ramp);
  return error::kNone;
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

std::uint16_t Planner::walk(Segment& segment, double& cruise, int samples) const noexcept {
  const Posture first = settings_.auto_conf ? without_zero(posture(situation_.start)) : settings_.conf;
  Posture now = first;
  Joints previous = situation_.start;
  for (int i = 1; i <= samples; ++i) {
    Joints q;
    if (!follow(segment.flange_at(static_cast<double>(i) / samples), previous, now, q)) return error::kOutOfReach;
    // A line past a singularity would need joints to jump; one exactly through it needs another posture behind it.
    if (largest_change(q, previous) > 20) return error::kSingularity;
    if (!settings_.auto_conf && now != first) return error::kSingularity;
    if (!situation_.limits.contains(q)) return error::kJointOverLimit;
    for (std::size_t j = 0; j < 6; ++j) {
      cruise = std::max(cruise, std::abs(q[j] - previous[j]) * samples / dynamics_.speed_limit[j]);
    }
    previous = q;
  }
  segment.end_ = previous;
  return error::kNone;
}

std::uint16_t Planner::plan_linear(const Transform& tool_target, Segment& segment) const noexcept {
  if (!start_is_in_conf()) return error::kStartConfMismatch;
  segment.kind_ = Segment::Kind::kLinear;
  segment.tool_inverse_ = inverse(settings_.trf_transform);
  segment.tool_start_ = forward(situation_.start) * settings_.trf_transform;
  segment.travel_ = tool_target.p - segment.tool_start_.p;
  segment.turn_ = axis_angle(tool_target.r * transpose(segment.tool_start_.r));
  segment.last_ = situation_.start;
  segment.posture_ = settings_.auto_conf ? without_zero(posture(situation_.start)) : settings_.conf;

  const double distance = norm(segment.travel_);
  const double angle = std::abs(segment.turn_.degrees);
  double cruise = std::max(distance / dynamics_.linear_speed, angle / dynamics_.angular_speed);
  const double wanted_samples = std::clamp(std::max(distance / 2, angle), 16.0, 400.0);
  if (const auto code = walk(segment, cruise, static_cast<int>(wanted_samples)); code != error::kNone) return code;
  segment.profile_ = Profile(cruise, dynamics_.cartesian_ramp);
  return error::kNone;
}

}  // namespace meca::sim
