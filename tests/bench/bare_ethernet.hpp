// The yardstick of EtherCAT: a loop that sleeps until its time, sends, and waits for what comes back. Nothing else.
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "transports/ethercat/histogram.hpp"

namespace meca::bench {

// IEEE 802: for local experiments.
inline constexpr std::uint16_t kBareEtherType = 0x88B5;
// Where a frame has its number within the cycle, and that of the cycle (32 bits, this machine's byte order).
inline constexpr std::size_t kBareNumber = 14, kBareCycle = 16;

// The seconds of a measurement, each with its percentiles as BridgeStatus has them.
class RoundTrips {
 public:
  void second(const ethercat::Histogram::Facts& facts);
  double p50_us() const { return mean(p50_); }  // of the seconds
  double p99_us() const { return mean(p99_); }
  double max_us() const { return static_cast<double>(max_); }

 private:
  double mean(std::int64_t sum) const { return seconds_ > 0 ? static_cast<double>(sum) / seconds_ : 0; }
  std::int64_t p50_ = 0, p99_ = 0, max_ = 0;
  int seconds_ = 0;
};

// The cycle thread of the bridge, the bare loop and the robots' end all ask for this SCHED_FIFO priority.
inline constexpr int kPriority = 48;
// For the calling thread, not for those that it starts. False where it is refused.
bool make_real_time();

struct BareLoopOptions {
  std::vector<std::size_t> frames;   // bytes of each frame of a cycle
  std::chrono::nanoseconds begin{};  // CLOCK_MONOTONIC: of the first cycle, which decides the phase of all
  std::chrono::seconds start_up{2};  // not measured
  std::chrono::seconds duration{10};
};

// One cycle is 1 ms. Throws std::runtime_error.
nlohmann::ordered_json run_bare_ethernet(const BareLoopOptions& options);

}  // namespace meca::bench
