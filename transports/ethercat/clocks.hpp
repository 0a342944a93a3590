// Distributed clocks of the chain (spec 5.9; ETG.1000.4, clause 6 "distributed clock"): propagation delays
// from the times at which a frame passes the ports, offsets to the master's time, and the drift towards the reference,
// which is the first device that has a clock. A machine without I/O that wants datagrams and takes answers; no
// allocation after construction. Clocks that run already are not set again: only their delays are, when the chain
// changes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transports/ethercat/chain_scan.hpp"

namespace meca::ethercat {

// How far the master's cycle is away from where the devices want it, and by how much its next deadline is to move.
class PhaseControl {
 public:
  // Cycles begin `target` after the multiples of the cycle on the reference clock.
  PhaseControl(Time cycle, Time target) noexcept : cycle_(cycle), target_(target) {}
  // The reference clock's time (ns since 2000-01-01) as this cycle's frame passed it.
  void seen(std::uint64_t reference) noexcept;
  // To be called once a cycle. Where nothing was seen since the last one only the difference in speed is corrected: the
  // way to the target is not known then, and the same step again and again would lead past it.
  void next_cycle() noexcept;
  Time correction() const noexcept { return correction_; }
  void reset() noexcept { integral_ = correction_ = {}; }

 private:
  void correct(Time late) noexcept;

  Time cycle_, target_, integral_{}, correction_{};
  bool seen_ = false;
};

class Clocks {
 public:
  // Time 0 of `now` in ns since 2000-01-01.
  explicit Clocks(std::uint64_t epoch);

  void start(std::span<const ChainScan::Device> devices) noexcept;
  void forget() noexcept { clocks_.clear(), step_ = Step::kIdle; }  // the chain was out of reach: set all again
  bool running() const noexcept { return step_ != Step::kIdle && step_ != Step::kReady; }
  bool ready() const noexcept { return step_ == Step::kReady; }
  bool add_to(InFlight& frame, Time now) noexcept;
  void answered(const Purpose& purpose, std::uint16_t working_counter, Bytes data) noexcept;
  void lost(const Purpose& purpose) noexcept;

  // Station address of the device whose clock all follow; empty before it is set, or when there is none.
  std::optional<std::uint16_t> reference() const noexcept;

 private:
  enum class Step : std::uint8_t {
    kIdle,
    kLatch,
    kReadPorts,
    kReadLocal,
    kDelay,
    kOffset,
    kSpeed,
    kFilter,
    kDrift,
    kReady
  };
  struct Clock {
    std::uint32_t life = 0;
    std::uint16_t address = 0, dl_status = 0;
    bool running = false;  // it was set, and follows the reference
    std::uint64_t local = 0, offset = 0;
    std::uint32_t delay = 0;
    std::array<std::uint32_t, 4> ports{};
    bool answered = false, asked = false;
  };

  void begin(Step step) noexcept;
  void next_step() noexcept;
  void restart() noexcept;
  void compute_delays() noexcept;
  void compute_offsets() noexcept;
  bool add_one(InFlight& frame, std::size_t item) noexcept;
  bool add_drift(InFlight& frame) noexcept;

  std::uint64_t epoch_;
  Step step_ = Step::kIdle;
  std::uint8_t generation_ = 0;
  std::vector<Clock> clocks_, before_;
  Time latched_{};
  unsigned failures_ = 0, drifts_ = 0;  // drifts: those that came back
};

// Register 092Ch: magnitude in bits 0 to 30, bit 31: the local copy of the time is not less than what was received.
std::int64_t clock_difference(std::uint32_t register_value) noexcept;

}  // namespace meca::ethercat
