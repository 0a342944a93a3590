// Reads words 0 to 1Fh of a device's SII through registers 0500h to 050Fh, with 4 or 8 bytes a read, busy, errors and
// the checksum, and gives the SII back to the device; a machine without I/O in the manner of Station.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "transports/ethercat/sii.hpp"
#include "transports/ethercat/station.hpp"

namespace meca::ethercat {

class SiiReader {
 public:
  // `timeout`: of each read of 4 or 8 bytes.
  explicit SiiReader(Time timeout = std::chrono::milliseconds(500)) noexcept : timeout_(timeout) {}

  void start(Time now) noexcept;
  void tick(Time now) noexcept;
  std::optional<Access> next(Time now) noexcept;  // the same until answered() or lost()
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept;
  void lost(Time now) noexcept;

  // identity() is complete; its checksum may be wrong: it says so.
  bool done() const noexcept { return step_ == Step::kDone; }
  bool failed() const noexcept { return step_ == Step::kFailed; }  // trouble() says why
  const SiiIdentity& identity() const noexcept { return identity_; }
  std::string_view trouble() const noexcept { return trouble_; }  // a sentence without full stop

 private:
  enum class Step : std::uint8_t {
    kIdle,
    kForce,   // the SII away from the device's application
    kOwn,     // and to us
    kWait,    // until it is not busy with what somebody asked before
    kAsk,     // for the words from at_ on
    kPoll,    // until they are there
    kClear,   // an error of the last command
    kReturn,  // to the device's application
    kDone,
    kFailed,
  };
  static constexpr std::uint16_t kStatusSize = 14;  // 0502 to 050F: status, address, data

  void go(Step step, Time due) noexcept {
    step_ = step;
    due_ = due;
  }
  void status_read(Bytes data, Time now) noexcept;
  void take(Bytes words, Time now) noexcept;

  Time timeout_, due_{}, deadline_{};
  Step step_ = Step::kIdle;
  bool refused_ = false, heard_ = false, busy_ = false;
  unsigned uncounted_ = 0;  // answers in a row that nobody counted
  std::uint16_t at_ = 0;    // word
  std::array<std::byte, 2 * SiiIdentity::kWords> words_{};
  std::array<std::byte, 6> out_{};
  SiiIdentity identity_;
  std::string_view trouble_;
};

}  // namespace meca::ethercat
