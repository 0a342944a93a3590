// Motors and homing: off, activating, on, homing, deactivating; each takes its time.
#pragma once

#include <cstdint>

#include "sim/journal.hpp"

namespace meca::sim {

class Power {
 public:
  enum class State : std::uint8_t { kOff, kActivating, kOn, kHoming, kDeactivating };
  struct Times {
    Time activation, homing, deactivation;
  };

  explicit Power(const Times& times) noexcept : times_(times) {}

  void activate() noexcept { begin(State::kActivating, times_.activation); }
  void home() noexcept { begin(State::kHoming, times_.homing); }
  void deactivate() noexcept { begin(State::kDeactivating, times_.deactivation); }
  // Power is gone: no orderly way down.
  void cut() noexcept { state_ = State::kOff; }
  // The drives will be initialised again at the next activation, which then needs homing (manual, command 1002).
  void forget_homing() noexcept { homed_ = false; }

  // True in the step in which the motors came on.
  bool advance(Time dt) noexcept {
    if (!busy()) return false;
    left_ -= dt;
    if (left_ > Time::zero()) return false;
    const State before = state_;
    state_ = before == State::kDeactivating ? State::kOff : State::kOn;
    if (before == State::kHoming) homed_ = true;
    return before == State::kActivating;
  }

  State state() const noexcept { return state_; }
  bool off() const noexcept { return state_ == State::kOff; }
  bool activated() const noexcept { return state_ == State::kOn || state_ == State::kHoming; }
  bool ready() const noexcept { return state_ == State::kOn; }  // takes commands
  // inferred: homing survives a deactivation, but only an activated robot says Homed ("ready to receive motion
  // commands").
  bool homed() const noexcept { return activated() && homed_; }
  bool busy() const noexcept { return state_ != State::kOff && state_ != State::kOn; }

 private:
  void begin(State state, Time duration) noexcept {
    state_ = state;
    left_ = duration;
  }

  Times times_;
  State state_ = State::kOff;
  Time left_{};
  bool homed_ = false;
};

}  // namespace meca::sim
