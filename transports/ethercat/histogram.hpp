// How long something takes: p50, p99, p99.9 and max of the last second, from buckets of fixed memory.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdint>

namespace meca::ethercat {

class Histogram {
 public:
  using Time = std::chrono::nanoseconds;

  struct Facts {  // microseconds, upper bound of the bucket (6 % wide) for the percentiles; 0 while nothing was
                  // measured
    std::int64_t p50 = 0, p99 = 0, p999 = 0, max = 0;
  };

  void add(Time took, Time now) noexcept {
    if (count_ == 0) window_end_ = now + kWindow;
    const auto us = static_cast<std::uint64_t>(std::clamp<std::int64_t>(took.count() / 1000, 0, 10'000'000));
    ++buckets_[bucket(us)];
    ++count_;
    max_ = std::max(max_, us);
    if (now >= window_end_) end_window();
  }
  // For what may cease to be measured, to be called all the time: facts do not outlive their second by more than one.
  void pass(Time now) noexcept {
    if (count_ > 0 && now >= window_end_) end_window();
    if (count_ == 0 && now >= window_end_ + kWindow) facts_ = {};
  }
  const Facts& facts() const noexcept { return facts_; }

 private:
  static constexpr Time kWindow = std::chrono::seconds(1);
  static constexpr unsigned kSteps = 16;  // per power of two

  static unsigned bucket(std::uint64_t us) noexcept {
    if (us < kSteps) return static_cast<unsigned>(us);
    const unsigned power = static_cast<unsigned>(std::bit_width(us)) - 1;  // 4 or more
    return (power - 3) * kSteps + static_cast<unsigned>(us >> (power - 4)) - kSteps;
  }
  static std::uint64_t upper(unsigned bucket) noexcept {
    if (bucket < kSteps) return bucket;
    const unsigned power = bucket / kSteps + 3;
    return ((std::uint64_t{bucket % kSteps} + kSteps + 1) << (power - 4)) - 1;
  }
  std::int64_t percentile(double part) const noexcept {
    const auto wanted = static_cast<std::uint64_t>(part * static_cast<double>(count_));
    std::uint64_t seen = 0;
    for (unsigned i = 0; i < buckets_.size(); ++i) {
      seen += buckets_[i];
      if (seen > wanted) return static_cast<std::int64_t>(std::min(upper(i), max_));
    }
    return static_cast<std::int64_t>(max_);
  }
  void end_window() noexcept {
    facts_ = {percentile(0.5), percentile(0.99), percentile(0.999), static_cast<std::int64_t>(max_)};
    buckets_ = {};
    count_ = max_ = 0;
  }

  std::array<std::uint32_t, 24 * kSteps> buckets_{};
  std::uint64_t count_ = 0, max_ = 0;
  Time window_end_{};
  Facts facts_;
};

}  // namespace meca::ethercat
