// Everything that moves the arm: the queue, the segments being followed (two while blending), velocity mode, stopping
// and going on along the path. Stepped by time; no allocation after construction.
#pragma once

#include <array>
#include <cstdint>

#include "sim/journal.hpp"
#include "sim/planner.hpp"
#include "sim/programs.hpp"
#include "sim/settings.hpp"
#include "sim/tool.hpp"
#include "sim/velocity_mode.hpp"

namespace meca::sim {

class Motion {
 public:
  Motion(const Settings& defaults, Journal& journal, ExternalTool& tool, const Programs& programs)
      : defaults_(defaults), settings_(defaults), journal_(journal), tool_(tool), next_(programs) {}

  // Queue full: false, and nothing happened.
  bool enqueue(const Command& command) noexcept { return next_.queue().push(command); }
  // Cyclic mode: a velocity command that repeats every cycle. Behind queued commands it waits, but only once.
  void repeat_velocity(Time now, const Command& command) noexcept;

  // Level: while true the arm ramps down along its path and stays; while false it goes on.
  void hold(bool held) noexcept;
  // Empties the queue; a move under way ramps down and is then forgotten (while held).
  void clear(Time now) noexcept;
  // Motors off: no ramp, everything forgotten.
  void halt(Time now) noexcept;
  // After a power loss: as new, but for where the arm is.
  void restart() noexcept {
    restore_defaults();
    checkpoint_reached_ = checkpoint_discarded_ = 0;
  }
  void restore_defaults() noexcept {
    settings_ = defaults_;
    ++settings_version_;
  }

  // Advances by `dt`; returns 0 or the error code of a command whose turn came and failed.
  std::uint16_t advance(Time now, Time dt, const JointLimits& limits, bool recovery_mode) noexcept;

  const Joints& joints() const noexcept { return joints_; }
  // Where the arm comes to rest if it is held after one more step of `dt`.
  Joints rest_ahead(Time dt, bool recovery_mode) const noexcept;
  const Settings& settings() const noexcept { return settings_; }
  Settings& settings() noexcept { return settings_; }
  std::uint32_t settings_version() const noexcept { return settings_version_; }
  std::size_t fifo_space() const noexcept { return next_.queue().space(); }
  std::uint16_t running_program() const noexcept { return next_.running(); }  // 0 none
  bool moving() const noexcept;
  // In an acceleration phase: speeding up, slowing down, or rounding a corner.
  bool accelerating() const noexcept;
  bool nothing_to_do() const noexcept { return active_count_ == 0 && next_.empty() && !velocity_.active(); }
  bool clearing() const noexcept { return clearing_; }
  std::uint16_t checkpoint_reached() const noexcept { return checkpoint_reached_; }
  std::uint16_t checkpoint_discarded() const noexcept { return checkpoint_discarded_; }

 private:
  struct Active {
    Segment segment;
    Command command;
    double elapsed = 0;  // s
  };

  const Settings defaults_;
  Settings settings_;
  std::uint32_t settings_version_ = 0;
  Journal& journal_;
  ExternalTool& tool_;
  Upcoming next_;
  VelocityMode velocity_;
  std::array<Active, 2> active_;  // [0] is the older one
  std::size_t active_count_ = 0;
  bool done_logged_ = false;  // the older one counts as executed already, because its successor is blending with it
  Joints joints_{};
  bool held_ = false, clearing_ = false;
  double going_ = 1;  // 0 stopped .. 1 full pace along the path
  double brake_ = 0;  // s from full pace to rest, while held
  std::uint16_t checkpoint_reached_ = 0, checkpoint_discarded_ = 0;

  std::uint16_t start_next(Time now, const JointLimits& limits, bool recovery_mode) noexcept;
  std::uint16_t start_move(Time now, const Command& command, const Joints& from, const JointLimits& limits,
                           bool recovery_mode) noexcept;
  void run_velocity(Time now, double seconds, const JointLimits& limits, bool recovery_mode) noexcept;
  std::uint16_t execute(const Command& command, const Joints& from) noexcept;
  double pace(double seconds) noexcept;
  double brake_time(double ahead) const noexcept;
  double blend_start() const noexcept;
  bool can_blend() const noexcept;
  bool successor_blends() const noexcept;
  bool tool_is_next() const noexcept;
  double tool_start() const noexcept;
  bool can_run_tool() const noexcept;
  double until_event() const noexcept;
  void elapse(Time now, double seconds, const JointLimits& limits) noexcept;
  void discard(Time now, const Command& command) noexcept;
  void discard_active(Time now) noexcept;
};

}  // namespace meca::sim
