// Reads words 0 to 1Fh of a device's SII through registers 0500h to 050Fh, with 4 or 8 bytes a read, busy, errors and
// the checksum, and gives the SII back to the device; a machine without I/O in the manner of Station.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "transports/ethercat/sii.hpp"
#include "transports/ethercat/station.hpp"

namespace meca::ethercat {

class SiiReader {
 public:
  explicit SiiReader(Time timeout = std::chrono::milliseconds(500)) noexcept : timeout_(timeout) {}

  void start(Time now) noexcept;
  void tick(Time now) noexcept;
  std::optional<Access> next(Time now) noexcept;  // the same until answered() or lost()
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept;
  void lost(Time now) noexcept;

  bool done() const noexcept;    // identity() is complete (its checksum may be wrong: it says so)
  bool failed() const noexcept;  // trouble() says why
  const SiiIdentity& identity() const noexcept { return identity_; }
  std::string_view trouble() const noexcept { return trouble_; }  // a sentence without full stop

 private:
  // the implementer's
  Time timeout_;
  SiiIdentity identity_;
  std::string_view trouble_;
};

}  // namespace meca::ethercat
