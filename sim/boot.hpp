// Whether the robot is there at all: up, going down after RebootRobot, away until it has booted.
#pragma once

#include <cstdint>

#include "sim/journal.hpp"

namespace meca::sim {

class Boot {
 public:
  explicit Boot(Time duration) noexcept : duration_(duration) {}

  // An orderly reboot: the robot is still seen for a moment, so that the command's MoveID reaches the host (inferred).
  void reboot() noexcept {
    state_ = State::kGoingDown;
    left_ = kGoingDownFor;
  }
  // The plug is pulled and put back.
  void cut() noexcept {
    state_ = State::kAway;
    left_ = duration_;
  }

  // True in the step in which the robot is back.
  bool advance(Time dt) noexcept {
    if (state_ == State::kUp) return false;
    left_ -= dt;
    if (left_ > Time::zero()) return false;
    if (state_ == State::kGoingDown) {
      cut();
      return false;
    }
    state_ = State::kUp;
    return true;
  }

  bool up() const noexcept { return state_ == State::kUp; }         // hears its host
  bool present() const noexcept { return state_ != State::kAway; }  // is seen by its host

 private:
  static constexpr Time kGoingDownFor = std::chrono::milliseconds(100);
  enum class State : std::uint8_t { kUp, kGoingDown, kAway };

  Time duration_;
  State state_ = State::kUp;
  Time left_{};
};

}  // namespace meca::sim
