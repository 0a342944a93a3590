// When the next cycle is due: absolute deadlines that keep their phase, and what the wake-ups were like.
// No clock inside: tests move the time by hand.
#pragma once

#include <algorithm>
#include <cstdint>

#include "transports/transport.hpp"

namespace meca::bridge {

using transports::Time;

// Lateness of the wake-ups of the last full second, and the cycles that could not be run since the start.
struct PaceFacts {
  std::uint64_t missed_cycles = 0;
  std::uint32_t lateness_max_us = 0, lateness_mean_us = 0;
};

class Pacer {
 public:
  Pacer(Time cycle, Time start) : cycle_(cycle), deadline_(start), window_end_(start + kWindow) {}

  Time deadline() const noexcept { return deadline_; }

  // The loop woke up for deadline().
  void woke(Time now) noexcept {
    const Time late = std::max(now - deadline_, Time{});
    max_ = std::max(max_, late);
    sum_ += late;
    ++count_;
    if (now < window_end_) return;
    facts_.lateness_max_us = microseconds(max_);
    facts_.lateness_mean_us = microseconds(sum_ / count_);
    max_ = sum_ = Time{};
    count_ = 0;
    window_end_ = now + kWindow;
  }

  // The cycle is done: moves the deadline to the next one that can still be met. Deadlines that are over when the work
  // ends are missed cycles: they are counted and skipped, and the rhythm stays.
  void done(Time now) noexcept {
    deadline_ += cycle_;
    if (now <= deadline_) return;
    const auto missed = (now - deadline_) / cycle_ + ((now - deadline_) % cycle_ != Time{} ? 1 : 0);
    facts_.missed_cycles += static_cast<std::uint64_t>(missed);
    deadline_ += missed * cycle_;
  }

  // Moves the rhythm: a bus keeps step with a clock of its own.
  void shift(Time by) noexcept { deadline_ += by; }

  const PaceFacts& facts() const noexcept { return facts_; }

 private:
  static constexpr Time kWindow = std::chrono::seconds(1);
  static std::uint32_t microseconds(Time t) noexcept {
    return static_cast<std::uint32_t>(std::min<std::int64_t>(t.count() / 1000, UINT32_MAX));
  }

  Time cycle_;
  Time deadline_;
  Time window_end_;
  Time max_{}, sum_{};
  std::int64_t count_ = 0;
  PaceFacts facts_;
};

}  // namespace meca::bridge
