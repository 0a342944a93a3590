// How regular packets are: mean, maximum and standard deviation of the time between two of them, over the last second.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>

namespace meca::ethernet_ip {

class PeriodMeter {
 public:
  using Time = std::chrono::nanoseconds;

  struct Facts {  // microseconds; 0 while nothing was measured
    std::int64_t mean_us = 0, max_us = 0, deviation_us = 0;
  };

  void packet(Time now) noexcept {
    if (!last_) {
      window_end_ = now + kWindow;
    } else {
      add(now - *last_);
      if (now >= window_end_) end_window(now);
    }
    last_ = now;
  }
  // The stream ends here: the pause until the next one is no period.
  void restart() noexcept { *this = {}; }

  const Facts& facts() const noexcept { return facts_; }

 private:
  static constexpr Time kWindow = std::chrono::seconds(1);

  // Welford's way: sums of squares of long periods would lose their last digits.
  void add(Time period) noexcept {
    const double us = std::chrono::duration<double, std::micro>(period).count();
    ++count_;
    const double before = us - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (us - mean_);
    max_ = std::max(max_, us);
  }
  void end_window(Time now) noexcept {
    facts_ = {std::llround(mean_), std::llround(max_), std::llround(std::sqrt(squares_ / static_cast<double>(count_)))};
    count_ = 0;
    mean_ = squares_ = max_ = 0;
    window_end_ = now + kWindow;
  }

  std::optional<Time> last_;
  Time window_end_{};
  std::int64_t count_ = 0;
  double mean_ = 0, squares_ = 0, max_ = 0;
  Facts facts_;
};

}  // namespace meca::ethernet_ip
