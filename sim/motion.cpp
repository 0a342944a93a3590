#include "sim/motion.hpp"

#include <algorithm>
#include <limits>

#include "sim/error.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

constexpr int kCommandsPerStep =
    64;  // how many a step may take from the queue; not published, bounds the time of a step

bool is_velocity(std::uint32_t id) noexcept {
  return id == image::kMoveJointsVel || id == image::kMoveLinVelWrf || id == image::kMoveLinVelTrf;
}

bool is_joint_move(std::uint32_t id) noexcept {
  return id == image::kMoveJoints || id == image::kMovePose || id == image::kMoveJointsRel;
}

bool is_move(std::uint32_t id) noexcept;

bool takes_no_time(std::uint32_t id) noexcept {
  // A tool's command is quick for the queue, but not for what its fingers hold.
  return !is_move(id) && !is_velocity(id) && id != image::kDelay && id != image::kStartProgram &&
         !ExternalTool::takes(id);
}

bool is_linear_move(std::uint32_t id) noexcept {
  return id == image::kMoveLin || id == image::kMoveLinRelTrf || id == image::kMoveLinRelWrf;
}

constexpr double kShortestRamp = 0.01;  // s, to come to rest from full pace or to reach it

// From 0 to 1 without a kink at the ends.
double smooth(double x) noexcept { return x * x * (3 - 2 * x); }

bool is_move(std::uint32_t id) noexcept { return is_joint_move(id) || is_linear_move(id); }

// inferred: a program begins from rest.
bool stops_the_arm(std::uint32_t id) noexcept {
  return needs_full_stop(id) || id == image::kDelay || id == image::kStartProgram || is_velocity(id);
}

// The end of a program is the outcome of the StartProgram that began it.
Command as_sent(Command command) noexcept {
  if (command.id == Upcoming::kProgramEnd) command.id = image::kStartProgram;
  return command;
}

}  // namespace

void Motion::repeat_velocity(Time now, const Command& command) noexcept {
  MotionQueue& queue = next_.queue();
  if (active_count_ == 0 && next_.empty()) {
    if (!velocity_.active()) journal_.add({now, command, Outcome::kExecuted, 0});
    velocity_.command(command);
  } else if (!queue.empty() && queue.back().move_id == 0 && is_velocity(queue.back().id)) {
    queue.back() = command;
  } else {
    queue.push(command);
  }
}

void Motion::discard(Time now, const Command& command) noexcept {
  if (command.id == image::kSetCheckpoint) checkpoint_discarded_ = static_cast<std::uint16_t>(command.arguments[0]);
  journal_.add({now, command, Outcome::kDiscarded, 0});
}

void Motion::discard_active(Time now) noexcept {
  if (clearing_) return;  // in the journal already
  for (std::size_t i = 0; i < active_count_; ++i) {
    if (i > 0 || !done_logged_) discard(now, active_[i].command);
  }
}

void Motion::clear(Time now) noexcept {
  discard_active(now);
  // A successor that has hardly begun is left out: the arm comes to rest sooner without it.
  constexpr double kHardly = 1e-4;
  const auto& next = active_[1];
  if (active_count_ == 2 && next.segment.profile().at(next.elapsed).position < kHardly) active_count_ = 1;
  clearing_ = active_count_ > 0;
  for (; !next_.empty(); next_.pop()) discard(now, as_sent(next_.front()));
}

void Motion::halt(Time now) noexcept {
  clear(now);
  active_count_ = 0;
  clearing_ = done_logged_ = false;
  velocity_.halt();
  going_ = 1;
}

bool Motion::moving() const noexcept {
  if (velocity_.moving()) return true;
  if (active_count_ == 0 || going_ <= 0) return false;
  return active_count_ > 1 || active_[0].segment.kind() != Segment::Kind::kDelay;
}

bool Motion::accelerating() const noexcept {
  if (velocity_.active()) return velocity_.accelerating();
  if (!moving()) return false;
  const Active& a = active_[0];
  const bool in_ramp = a.elapsed < a.segment.ramp() || a.elapsed > a.segment.duration() - a.segment.ramp();
  return active_count_ > 1 || in_ramp || going_ < 1;
}

// Seconds from full pace to rest, `ahead` seconds of path time from now: the ramp of the move under way, or as much of
// it as the arm is fast.
double Motion::brake_time(double ahead) const noexcept {
  double ramp = 0, speed = 0;
  for (std::size_t i = 0; i < active_count_; ++i) {
    const Segment& s = active_[i].segment;
    if (s.kind() == Segment::Kind::kDelay) continue;
    ramp = std::max(ramp, s.ramp());
    speed += s.profile().at(active_[i].elapsed + ahead).speed / s.profile().top_speed();
  }
  return std::max(kShortestRamp, ramp * std::min(1.0, speed));
}

void Motion::hold(bool held) noexcept {
  if (held && !held_) brake_ = brake_time(0);
  held_ = held;
}

// How much path time passes in `seconds`: stops and goes on along the path with a smooth change of pace. A pause takes
// effect at once (published: within 5 ms) and needs the ramp of the move under way to come to rest.
double Motion::pace(double seconds) noexcept {
  if (active_count_ == 0 || active_[0].segment.kind() == Segment::Kind::kDelay) {
    going_ = held_ ? 0 : 1;
    return held_ ? 0 : seconds;
  }
  const double ramp = held_ ? brake_ : std::max(active_[0].segment.ramp(), kShortestRamp);
  const double before = going_;
  going_ = std::clamp(going_ + (held_ ? -seconds : seconds) / ramp, 0.0, 1.0);
  return seconds * (smooth(before) + smooth(going_)) / 2;
}

Joints Motion::rest_ahead(Time dt, bool recovery_mode) const noexcept {
  const double seconds = std::chrono::duration<double>(dt).count() * settings_.time_scaling / 100;
  if (velocity_.active()) return velocity_.rest_ahead(seconds, settings_, recovery_mode, joints_);
  if (active_count_ == 0 || active_[0].segment.kind() == Segment::Kind::kDelay) return joints_;
  const double ramp = std::max(active_[0].segment.ramp(), kShortestRamp);
  const double x = held_ ? going_ : std::min(1.0, going_ + seconds / ramp);
  const double next_step = held_ ? 0 : seconds * smooth(x);
  const double brake = held_ ? brake_ : brake_time(next_step);
  const double way = next_step + brake * x * x * x * (1 - x / 2);  // the integral of smooth() down to 0
  const auto where = [way](const Active& a) {
    Segment segment = a.segment;  // following a line changes it
    return segment.at(a.elapsed + way);
  };
  Joints out = where(active_[0]);
  if (active_count_ > 1) {
    const Joints from = active_[1].segment.start(), q = where(active_[1]);
    for (std::size_t i = 0; i < 6; ++i) out[i] += q[i] - from[i];
  }
  return out;
}

// Path time of the older segment from which a successor may run at the same time: at blending 100 %, its whole ramp.
double Motion::blend_start() const noexcept {
  const Segment& s = active_[0].segment;
  return s.duration() - settings_.blending / 100 * s.ramp();
}

// Joint moves blend with joint moves and linear with linear; what stands between them may set things, not stop the arm.
bool Motion::can_blend() const noexcept {
  return !held_ && !clearing_ && active_count_ == 1 && active_[0].elapsed >= blend_start() - 1e-12 &&
         successor_blends();
}

bool Motion::successor_blends() const noexcept {
  if (settings_.blending <= 0) return false;
  const std::uint32_t now = active_[0].command.id;
  constexpr std::size_t kLookAhead = 16;
  for (std::size_t i = 0; i < kLookAhead; ++i) {
    const auto next = next_.id_at(i);
    if (!next) return false;
    if (is_joint_move(*next)) return is_joint_move(now);
    if (is_linear_move(*next)) return is_linear_move(now);
    if (stops_the_arm(*next)) return false;
  }
  return false;
}

bool Motion::tool_is_next() const noexcept { return !next_.empty() && ExternalTool::takes(*next_.id_at(0)); }

// Path time of the older segment from which a tool's command runs beside it: where it blends with its successor, else
// where it slows down (spec 6.3). inferred: gripper settings too, so that they act before the command behind them.
double Motion::tool_start() const noexcept {
  const Segment& s = active_[0].segment;
  return successor_blends() ? blend_start() : s.duration() - s.ramp();
}

bool Motion::can_run_tool() const noexcept {
  return !held_ && !clearing_ && active_count_ == 1 && tool_is_next() && active_[0].elapsed >= tool_start() - 1e-12;
}

// Seconds of path time until the older segment ends, or until a successor may begin.
double Motion::until_event() const noexcept {
  const Active& a = active_[0];
  const double start = (tool_is_next() ? tool_start() : blend_start()) - a.elapsed;
  return active_count_ == 1 && start > 1e-12 ? start : a.segment.duration() - a.elapsed;
}

void Motion::elapse(Time now, double seconds, const JointLimits& limits) noexcept {
  for (std::size_t i = 0; i < active_count_; ++i) active_[i].elapsed += seconds;
  joints_ = active_[0].segment.at(active_[0].elapsed);
  if (active_count_ > 1) {
    const Joints from = active_[1].segment.start();
    const Joints q = active_[1].segment.at(active_[1].elapsed);
    for (std::size_t i = 0; i < 6; ++i) {
      // A corner that turns back at a limit would round a little beyond it.
      joints_[i] = std::clamp(joints_[i] + q[i] - from[i], limits.minimum[i], limits.maximum[i]);
    }
  }
  if (active_[0].elapsed < active_[0].segment.duration() - 1e-12) return;
  if (!done_logged_ && !clearing_) journal_.add({now, active_[0].command, Outcome::kExecuted, 0});
  done_logged_ = false;
  if (--active_count_ > 0) active_[0] = active_[1];
  if (active_count_ == 0) clearing_ = false;
}

std::uint16_t Motion::start_move(Time now, const Command& command, const Joints& from, const JointLimits& limits,
                                 bool recovery_mode) noexcept {
  Active& slot = active_[active_count_];
  const Situation situation{from, limits, recovery_mode};
  const std::uint16_t code = Planner(settings_, situation).plan(command, slot.segment);
  if (code != error::kNone) {
    journal_.add({now, command, Outcome::kRefused, code});
    return code;
  }
  slot.command = command;
  slot.elapsed = 0;
  if (active_count_++ == 0) done_logged_ = false;
  return error::kNone;
}

// Takes the next command. With a move under way, that move counts as done: they blend.
std::uint16_t Motion::start_next(Time now, const JointLimits& limits, bool recovery_mode) noexcept {
  const Command command = next_.front();
  next_.pop();
  if (active_count_ > 0 && !done_logged_) {
    journal_.add({now, active_[0].command, Outcome::kExecuted, 0});
    done_logged_ = true;
  }
  const Joints from = active_count_ > 0 ? active_[0].segment.end() : joints_;
  if (is_move(command.id) || command.id == image::kDelay) {
    return start_move(now, command, from, limits, recovery_mode);
  }
  const std::uint16_t code = execute(command, from);
  if (code != error::kNone) {
    journal_.add({now, command, Outcome::kRefused, code});
  } else if (command.id != image::kStartProgram) {  // that is executed when its program has ended
    journal_.add({now, as_sent(command), Outcome::kExecuted, 0});
  }
  return code;
}

// A command that takes no time in the queue; `from` is where the arm will be.
std::uint16_t Motion::execute(const Command& command, const Joints& from) noexcept {
  if (command.id == Upcoming::kProgramEnd) return error::kNone;
  if (command.id == image::kStartProgram) return next_.start(command);
  if (ExternalTool::takes(command.id)) return tool_.run(command);
  if (is_velocity(command.id)) {
    velocity_.command(command);
  } else if (command.id == image::kSetCheckpoint) {
    checkpoint_reached_ = static_cast<std::uint16_t>(command.arguments[0]);
  } else if (apply(command, from, settings_)) {
    ++settings_version_;
  } else {
    return error::kCommandFailed;
  }
  return error::kNone;
}

void Motion::run_velocity(Time now, double seconds, const JointLimits& limits, bool recovery_mode) noexcept {
  if (!held_ && !next_.empty() && is_velocity(*next_.id_at(0))) {
    start_next(now, limits, recovery_mode);  // goes on with the new velocity without stopping
  } else if (held_ || !next_.empty()) {
    velocity_.cancel();
  }
  velocity_.step(seconds, settings_, limits, recovery_mode, joints_);
}

std::uint16_t Motion::advance(Time now, Time dt, const JointLimits& limits, bool recovery_mode) noexcept {
  double left = std::chrono::duration<double>(dt).count() * settings_.time_scaling / 100;
  if (velocity_.active()) {
    run_velocity(now, left, limits, recovery_mode);
    return error::kNone;
  }
  const bool slowing = held_ && active_count_ > 0;
  left = pace(left);
  if (clearing_ && going_ <= 0) {
    active_count_ = 0;
    clearing_ = done_logged_ = false;
  }
  for (int budget = kCommandsPerStep; budget > 0 && !velocity_.active();) {
    // inferred: a move that reaches its end while the arm slows down for a pause takes along what needs no time behind
    // it.
    const bool ready = !next_.empty() && (!held_ || (slowing && takes_no_time(*next_.id_at(0))));
    const bool may_start = active_count_ == 0 ? ready : can_blend() || can_run_tool();
    if (may_start) {
      --budget;
      if (const auto code = start_next(now, limits, recovery_mode); code != error::kNone) return code;
      continue;
    }
    if (active_count_ == 0 || left <= 0) break;
    const double step = std::min(left, until_event());
    left -= step;
    elapse(now, step, limits);
  }
  return error::kNone;
}

}  // namespace meca::sim
