// Who stands in a chain: looks at every device once, for people (`meca-ctl scan ethercat`); a machine without I/O.
// Reads only: no station address, no state and no owner of an SII is another one afterwards, so it may be used beside a
// running master. Not for the cycle thread: it allocates.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transports/ethercat/frame.hpp"
#include "transports/ethercat/registers.hpp"
#include "transports/ethercat/sii.hpp"
#include "transports/ethercat/sii_reader.hpp"
#include "transports/text.hpp"

namespace meca::ethercat {

// Port of an ESC: register 0110 (DL status) and the counters from 0300 on, which stop at 255.
struct ScannedPort {
  bool exists = false;  // by the port descriptor, 0007
  bool link = false, loop_closed = false, communication = false;
  std::uint8_t invalid_frames = 0, rx_errors = 0, forwarded_errors = 0, lost_links = 0;
};

enum class DcSupport : std::uint8_t { kNone, k32Bit, k64Bit };

struct ScannedDevice {
  std::uint16_t position = 0;  // in the chain, 0 = first
  bool answered = false;       // false: it counted in the broadcast and did not answer alone; nothing else is known
  std::uint16_t station_address = 0;  // 0: no master has given it one
  std::uint16_t alias = 0;            // of its register (0012); power-on copies it from the SII
  std::uint16_t al_status = 0, al_code = 0;
  std::array<ScannedPort, 4> ports{};
  std::uint8_t processing_errors = 0, pdi_errors = 0;
  DcSupport dc = DcSupport::kNone;
  bool sii_with_device = false;          // its SII belongs to the device's side (PDI)
  bool process_data_of_meca500 = false;  // sync managers 2 and 3 are set up as a master does for a Meca500
  std::optional<SiiIdentity> identity;   // nothing: identity_trouble says why
  FixedText<160> identity_trouble;       // a sentence without full stop
};

bool is_meca500(const SiiIdentity& identity) noexcept;  // by vendor and product
// SAFEOP and OP need a master that sends process data all the time.
bool runs_under_a_master(const ScannedDevice& device) noexcept;

struct ScanSettings {
  // No master's, so that replies to both are told apart.
  MacAddress source{std::byte{0x10}, std::byte{'S'}, std::byte{'C'}, std::byte{'A'}, std::byte{'N'}, std::byte{0x10}};
  Time frame_timeout = std::chrono::milliseconds(100);
  Time patience = std::chrono::seconds(1);  // until anybody answers at all
};

class Scan {
 public:
  static constexpr unsigned kTries = 3;  // of a frame to a device that was there

  explicit Scan(const ScanSettings& settings = {}, Time now = {});

  void tick(Time now);  // time-outs
  // A frame to send, or nothing; valid until the next call.
  Bytes next_frame(Time now);
  Time next_event() const noexcept;  // when tick() has something to do; Time::max(): done
  // Any EtherCAT frame that came in. True: it was the answer that was waited for.
  bool received(Bytes frame, Time now);

  bool done() const noexcept { return step_ == Step::kDone; }
  std::span<const ScannedDevice> devices() const noexcept { return devices_; }  // position order
  // Our own frames that came back as they were sent: no device, but a loop (or a ring's other end) is on the cable.
  std::uint64_t echoes() const noexcept { return echoes_; }
  // Frames that are not ours: a master works on this cable, or on this machine.
  std::uint64_t frames_of_others() const noexcept { return frames_of_others_; }

 private:
  enum class Step : std::uint8_t { kCounting, kRegisters, kIdentity, kGivingBack, kDone };

  bool is_answer(Bytes frame) const;
  void take(Bytes frame, Time now);
  void take_registers(Bytes frame, Time now);
  void begin_identity(Time now);
  std::optional<Access> next_access(Time now);
  void follow_reader();
  void next_device();
  void give_up_frame(Time now);

  ScanSettings settings_;
  Step step_ = Step::kCounting;
  Time patience_ends_;
  std::vector<ScannedDevice> devices_;
  std::size_t current_ = 0;
  unsigned lost_ = 0;  // of the same frame
  std::optional<SiiReader> reader_;
  std::array<std::byte, kLongestFrame> buffer_{};
  Bytes in_flight_;
  Time flight_ends_{};
  std::uint8_t index_ = 0;
  std::uint64_t echoes_ = 0, frames_of_others_ = 0;
};

}  // namespace meca::ethercat
