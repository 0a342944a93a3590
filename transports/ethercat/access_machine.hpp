// A part of the conversation with one device: it wants one access after the other and ends well or with a reason. What
// the station does is put together from these. No allocation, no clock.
#pragma once

#include <cstdint>
#include <optional>

#include "transports/ethercat/station.hpp"
#include "transports/text.hpp"

namespace meca::ethercat {

// What the device does not do, to be read after "the robot at position 0"; without full stop.
using Predicate = FixedText<220>;

class AccessMachine {
 public:
  enum class Outcome : std::uint8_t { kRunning, kDone, kFailed };

  virtual ~AccessMachine() = default;

  virtual void tick(Time now) noexcept = 0;  // time-outs
  // What it wants accessed now, once; then nothing until answered() or lost() is called.
  virtual std::optional<Access> next(Time now) noexcept = 0;
  // `data` may be shorter than what was asked for; that is as good as lost.
  virtual void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept = 0;
  virtual void lost(Time now) noexcept = 0;
  virtual Time next_event() const noexcept = 0;  // when next() or tick() has something to do

  Outcome outcome() const noexcept { return outcome_; }
  bool running() const noexcept { return outcome_ == Outcome::kRunning; }
  const Predicate& trouble() const noexcept { return trouble_; }

 protected:
  AccessMachine() = default;
  AccessMachine(const AccessMachine&) = default;
  AccessMachine& operator=(const AccessMachine&) = default;

  void begin() noexcept {
    outcome_ = Outcome::kRunning;
    trouble_ = {};
  }
  void done() noexcept { outcome_ = Outcome::kDone; }
  void fail(const Predicate& trouble) noexcept {
    outcome_ = Outcome::kFailed;
    trouble_ = trouble;
  }

 private:
  Outcome outcome_ = Outcome::kDone;
  Predicate trouble_;
};

// One more look at something that a device does not have yet.
inline constexpr Time kPollPeriod = std::chrono::microseconds(500);

inline std::uint8_t u8_at(Bytes data, std::size_t at) noexcept { return std::to_integer<std::uint8_t>(data[at]); }
inline std::uint16_t u16_at(Bytes data, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(u8_at(data, at) | u8_at(data, at + 1) << 8);
}

}  // namespace meca::ethercat
