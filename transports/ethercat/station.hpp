// One robot in the chain as our end sees it: from "found at a position" to OP and back after a fault, as a machine
// without I/O. It wants one register access at a time; the master (master.hpp) puts it into a frame and brings the
// answer. No allocation after construction, no clock.
//
// The way up (identity and station address are the master's work): INIT, mailbox sync managers, PREOP, mailbox emptied,
// device name and firmware (1008h, 100Ah), PDO assignment written and read back bit by bit, sync type, DC where wanted,
// sync managers 2 and 3, FMMUs, watchdog, SAFEOP -> (process data runs) -> OP. SAFEOP with an error in between is
// acknowledged and climbed again; anything worse begins again from INIT, after a pause that grows.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "transports/ethercat/frame.hpp"
#include "transports/ethercat/mailbox.hpp"
#include "transports/ethercat/registers.hpp"
#include "transports/ethercat/sii.hpp"
#include "transports/text.hpp"
#include "transports/transport.hpp"

namespace meca::ethercat {

struct StationSettings {
  std::uint16_t position = 0;                           // in the chain, for the sentences ..
  std::optional<std::uint16_t> alias;                   // .. or what it is known by, wherever it stands
  std::uint32_t logical_output = 0, logical_input = 0;  // where its process data stands in the logical address space
  Time watchdog = std::chrono::milliseconds(100);       // of sync manager 2, 0: as the device has it; 100 us steps
  bool dc = false;                                      // DC synchronous mode, else SM-synchronous
  Time sync0_cycle{};                                   // with dc
  Time shift{};                                         // of SYNC0 against the multiples of the cycle
  // As the ESI of the robot asks for.
  Time preop_timeout = std::chrono::seconds(2), op_timeout = std::chrono::seconds(9),
       init_timeout = std::chrono::seconds(5);
  Time mailbox_request_timeout = std::chrono::milliseconds(100), mailbox_response_timeout = std::chrono::seconds(2);
  Time sii_timeout = std::chrono::milliseconds(500);  // of one read
  Time shortest_backoff = std::chrono::milliseconds(200), longest_backoff = std::chrono::seconds(5);
};

// One access to the registers or the memory of this device, by its station address: FPRD or FPWR.
struct Access {
  static constexpr std::size_t kMost = kMailboxSize;
  std::uint16_t address = 0;  // ADO
  std::uint16_t size = 0;     // at most kMost
  bool write = false;
  Bytes data;  // what is written, `size` bytes, until the next call; else empty
};

struct StationCounters {
  std::uint64_t lost_accesses = 0;    // no reply, or nobody counted
  std::uint64_t mailbox_repeats = 0;  // a mail was lost on its way to us and asked for again
  std::uint64_t emergencies = 0;
  std::uint64_t sdo_aborts = 0;
  std::uint64_t al_errors = 0;    // times that the device left OP or SAFEOP with an error
  std::uint64_t operational = 0;  // times that OP was reached
};

struct StationState;

class Station {
 public:
  enum class Phase : std::uint8_t {
    kAbsent,       // the master does not see it
    kPausing,      // after a fault, until the back-off is over
    kInit,         // to INIT
    kPreop,        // to PREOP
    kConfiguring,  // CoE, DC, FMMU
    kSafeop,       // to SAFEOP
    kStarting,     // process data runs, to OP
    kOperational,
    kRecovering,  // SAFEOP + error: acknowledge and climb
    kClosing,     // to INIT
    kClosed,      // in INIT, after close(): for ever
  };

  explicit Station(const StationSettings& settings);
  ~Station();
  Station(Station&&) noexcept;
  Station& operator=(Station&&) noexcept;

  // ---- What the master knows
  // It was found in the chain, is a Meca500 by its SII, and has this station address. Found again where nothing was
  // wrong: it goes on where it was, unless its AL state (al_status()) says that it was power-cycled.
  void found(std::uint16_t station_address, const SiiIdentity& identity, Time now) noexcept;
  // "not in the chain: 1 of 3 devices answer"; or another device than it should be: "position 1 is vendor 0x...,
  // product 0x...: not a Meca500, it is left alone".
  void absent(std::string_view why, Time now) noexcept;

  // AL status seen by the master on its rounds (register 0130, 6 bytes: status, -, code).
  void al_status(std::uint16_t status, std::uint16_t code, Time now) noexcept;
  // A frame with process data of this robot came back complete: needed `kCyclesBeforeOp` times before OP is requested.
  void process_data_exchanged(Time now) noexcept;
  // The chain's clocks are set up: time of the reference clock (ns since 2000-01-01). DC goes no further before.
  void dc_ready(std::uint64_t system_time, Time now) noexcept;
  void close(Time now) noexcept;  // to INIT

  // ---- Conversation; tick first
  void tick(Time now) noexcept;  // time-outs, back-off
  // What it wants accessed now; nothing: it waits. The same until answered() or lost() is called; but nothing when it
  // has come to want something else meanwhile (a time-out, close()), whose turn is after the answer to the first.
  std::optional<Access> next(Time now) noexcept;
  // When tick() or next() has something new to do, not later than now: at once; Time::max(): never by itself. What
  // next() gave already is not new.
  Time next_event() const noexcept;
  // The reply to what next() gave. `data`: what was read, `size` bytes.
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept;
  void lost(Time now) noexcept;

  // ---- Facts
  Phase phase() const noexcept;
  bool wants_process_data() const noexcept;  // from SAFEOP on: its part of the logical address space is mapped
  bool operational() const noexcept { return phase() == Phase::kOperational; }
  std::uint16_t station_address() const noexcept;
  std::uint16_t last_al_status() const noexcept;  // 0: not known
  std::uint16_t last_al_code() const noexcept;
  const std::optional<SiiIdentity>& identity() const noexcept;  // as long as it is the same device
  std::string_view device_name() const noexcept;                // 1008h; empty: not read, or it has none
  transports::FirmwareVersion firmware() const noexcept;        // of 100Ah, where it can be read as one; else unknown
  // That it sent by CoE; in OP its mailbox is looked into twice a second.
  const std::optional<Emergency>& last_emergency() const noexcept;
  // Why it is not operational, or what it does in another way than asked; a sentence without full stop.
  std::string_view trouble() const noexcept;
  const StationCounters& counters() const noexcept;

 private:
  std::unique_ptr<StationState> state_;
};

inline constexpr int kCyclesBeforeOp = 5;

}  // namespace meca::ethercat
