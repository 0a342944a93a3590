// How regular a stream of packets was over a whole measurement. No clock.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>

namespace meca::bench {

class PeriodStatistics {
 public:
  using Time = std::chrono::nanoseconds;

  void packet(Time at) noexcept {
    if (last_) add(std::chrono::duration<double, std::micro>(at - *last_).count());
    last_ = at;
  }
  // The periods of several streams taken together; what comes after it in either stream begins anew.
  void merge(const PeriodStatistics& other) noexcept {
    last_.reset();
    if (other.count_ == 0) return;
    const auto mine = static_cast<double>(count_), theirs = static_cast<double>(other.count_);
    const double apart = other.mean_ - mean_;
    squares_ += other.squares_ + apart * apart * mine * theirs / (mine + theirs);
    mean_ += apart * theirs / (mine + theirs);
    max_ = std::max(max_, other.max_);
    count_ += other.count_;
  }

  std::int64_t count() const noexcept { return count_; }  // of periods: packets - 1
  double mean_us() const noexcept { return mean_; }
  double max_us() const noexcept { return max_; }
  double deviation_us() const noexcept {  // standard deviation
    return count_ == 0 ? 0 : std::sqrt(squares_ / static_cast<double>(count_));
  }

 private:
  // Welford's way: sums of squares of long periods would lose their last digits.
  void add(double us) noexcept {
    ++count_;
    const double before = us - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (us - mean_);
    max_ = std::max(max_, us);
  }

  std::optional<Time> last_;
  std::int64_t count_ = 0;
  double mean_ = 0, squares_ = 0, max_ = 0;
};

}  // namespace meca::bench
