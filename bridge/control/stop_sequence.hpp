// The stop after a loss of control or a safety stop: Pause at once (the level itself is held by Actions until somebody
// resumes), and from the next cycle on Clear, until the robot says that its queue is gone.
#pragma once

#include "bridge/control/messages.hpp"
#include "bridge/control/view.hpp"

namespace meca::control {

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
    reason_ = reason;
    started_ = now;
  }
  void cancel() noexcept { active_ = clear_ = false; }

  Progress advance(const View& view) noexcept {
    if (!active_) return Progress::kNone;
    // Not in the cycle that notices: the stop image itself is Pause and SetPoint 0, nothing else.
    if (view.now > started_) {
      if (clear_ && view.fresh) ++images_;
      clear_ = true;
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
  Reason reason_ = Reason::kNone;
  Time started_{};
};

}  // namespace meca::control
