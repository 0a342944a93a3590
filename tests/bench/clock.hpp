// Clocks and figures of the bench.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace meca::bench {

inline std::chrono::nanoseconds read_clock(clockid_t id) {
  timespec t{};
  clock_gettime(id, &t);
  return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
}
inline std::chrono::nanoseconds monotonic_now() { return read_clock(CLOCK_MONOTONIC); }
inline std::int64_t unix_now_ns() { return read_clock(CLOCK_REALTIME).count(); }

inline void sleep_until(std::chrono::nanoseconds deadline) {
  const timespec t{deadline.count() / 1'000'000'000, deadline.count() % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
  }
}

// The value below which `share` (0..1) of the samples lie. Sorts. 0 without samples.
inline double percentile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto index = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index), values.end());
  return values[index];
}

}  // namespace meca::bench
