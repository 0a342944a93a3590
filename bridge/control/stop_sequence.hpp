// The stop after a loss of control or a safety stop: Pause at once (the level itself is held by Actions until somebody
// resumes), then Clear, until the robot says that its queue is gone. While it is not known what of the queue was
// executed, Clear waits until the paused arm is at rest, because only then the robot's state tells.
#pragma once

#include "bridge/control/messages.hpp"
#include "bridge/control/view.hpp"

namespace meca::control {

// Waits until a paused arm stands and its state has settled, or there is no point in waiting.
class Rest {
 public:
  void restart(Time now) noexcept {
    since_ = now;
    images_ = 0;
  }
  bool reached(const View& view) noexcept {
    // Longer than any ramp of an arm of this size. inferred; if it is not, the open command ends DISCARDED.
    constexpr Time kPatience = std::chrono::milliseconds(500);
    const image::MotionStatus& m = view.in.motion_status;
    if (view.fresh) images_ = m.paused && m.eom ? images_ + 1 : 0;
    const bool robot_has_ended_it = view.in.robot_status.error_code != 0 || !view.in.robot_status.activated;
    return robot_has_ended_it || images_ > kRestImages || view.now - since_ > kPatience;
  }

 private:
  Time since_{};
  int images_ = 0;
};

class StopSequence {
 public:
  enum class Progress : std::uint8_t { kNone, kCleared, kTimedOut };

  explicit StopSequence(Time timeout) noexcept : timeout_(timeout) {}

  // While one is under way the first cause stands.
  void start(Reason reason, Time now) noexcept {
    if (active_) return;
    active_ = true;
    clear_ = false;
    images_ = 0;
    rest_.restart(now);
    reason_ = reason;
    started_ = now;
  }
  void cancel() noexcept { active_ = clear_ = false; }

  Progress advance(const View& view, bool unproved) noexcept {
    if (!active_) return Progress::kNone;
    if (clear_) {
      if (view.fresh) ++images_;
    } else if (view.now > started_) {
      // Not in the cycle that notices: the stop image itself is Pause and SetPoint 0, nothing else.
      clear_ = !unproved || rest_.reached(view);
    }
    if (view.fresh && images_ >= kSettleImages && view.in.motion_status.cleared) {
      cancel();
      return Progress::kCleared;
    }
    if (view.now - started_ > timeout_) {
      cancel();
      return Progress::kTimedOut;
    }
    return Progress::kNone;
  }

  bool active() const noexcept { return active_; }
  bool clear() const noexcept { return clear_; }
  Reason reason() const noexcept { return reason_; }

 private:
  Time timeout_;
  bool active_ = false;
  bool clear_ = false;
  int images_ = 0;
  Rest rest_;
  Reason reason_ = Reason::kNone;
  Time started_{};
};

}  // namespace meca::control
