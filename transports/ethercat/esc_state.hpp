// The inside of an ESC, for its own files (esc*.cpp) only: what it remembers, and which file does what.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "transports/ethercat/esc.hpp"

namespace meca::ethercat {

// FMMU registers, decoded: a run of bits of the logical address space onto a run of bits of the memory.
struct Fmmu {
  bool active = false, reads = false, writes = false;
  std::uint32_t logical = 0, length = 0;  // length: bytes touched
  std::uint32_t first_bit = 0, last_bit = 7;
  std::uint32_t physical = 0, physical_bit = 0;

  bool whole_bytes() const noexcept { return first_bit == 0 && last_bit == 7 && physical_bit == 0; }
};

// What a sync manager guards, and how far the two sides are with it.
struct SyncManagerChannel {
  enum class Mode : std::uint8_t { kBuffered, kMailbox, kReserved };

  std::uint32_t start = 0, length = 0;
  std::uint32_t end = 0;  // of what it guards: three buffers where it is buffered
  Mode mode = Mode::kBuffered;
  bool ecat_writes = false;     // direction; the PDI writes otherwise
  bool feeds_watchdog = false;  // control bit 6
  bool enabled = false;         // by the master
  bool locked = false;          // by the PDI: deactivated
  bool fits = false;            // inside of the process RAM
  // Mailbox: one buffer, full or not. `open` (both modes): the first byte was accessed, the last one was not yet.
  bool open = false, full = false;
  // Three buffers: the newest whole one, the one that the reader has, the one that the writer fills.
  std::optional<unsigned> newest, reading;
  unsigned writing = 0;
  bool fresh = false;    // the PDI has not taken `newest` yet
  bool fetched = false;  // ECAT has read the mailbox since the PDI asked last

  bool guards() const noexcept { return length > 0 && (enabled || locked); }
  bool usable() const noexcept { return enabled && !locked && fits; }
  void choose_buffer_to_write() noexcept;
};

struct EscState {
  explicit EscState(const EscSettings& s);

  // ---- esc.cpp
  void power_on(Time now, std::uint64_t local_time) noexcept;
  void catch_up(Time now) noexcept;  // what passed by itself until now: SII access, watchdog
  void show_ports() noexcept;

  // ---- esc_datagram.cpp: commands, addresses, working counter
  void process(MutableDatagram& datagram, Time now) noexcept;
  unsigned serve(MutableDatagram& datagram, Time now) noexcept;
  unsigned exchange(std::uint16_t address, std::span<std::byte> data, bool reads, bool writes, bool or_in,
                    Time now) noexcept;

  // ---- esc_fmmu.cpp
  void decode_fmmu(unsigned n) noexcept;
  unsigned exchange_logical(std::uint32_t address, std::span<std::byte> data, bool reads, bool writes,
                            Time now) noexcept;

  // ---- esc_memory.cpp: all of it, by ECAT. True: at least one byte was accessed.
  bool read(std::uint32_t address, std::span<std::byte> out, Time now) noexcept;
  // Only the bits of `lanes` in every byte.
  bool write(std::uint32_t address, Bytes in, std::byte lanes, Time now) noexcept;

  // ---- esc_registers.cpp: 0000h to 0FFFh
  void refresh_registers(std::uint32_t address, std::size_t size, Time now) noexcept;
  void registers_were_read(std::uint32_t address, std::size_t size) noexcept;
  void write_registers(std::uint32_t address, Bytes in, std::byte lanes, Time now) noexcept;
  bool writable(std::uint32_t address) const noexcept;
  void registers_were_written(std::uint32_t address, Bytes in, Time now) noexcept;
  void clear_counters(std::uint32_t address, std::size_t size) noexcept;
  void count(std::uint16_t address) noexcept;  // an error counter; it stops at FFh
  std::uint16_t ecat_events() const noexcept;
  std::uint32_t al_events() const noexcept;
  void reset_letter(std::byte letter, Time now) noexcept;

  // ---- esc_sync_manager.cpp
  void configure_sync_manager(unsigned n) noexcept;
  void reset_sync_manager(unsigned n) noexcept;
  void show_sync_manager(unsigned n) noexcept;  // its status byte
  bool read_guarded(unsigned n, std::uint32_t address, std::span<std::byte> out) noexcept;
  bool write_guarded(unsigned n, std::uint32_t address, Bytes in, std::byte lanes, Time now) noexcept;

  // ---- esc_sii.cpp
  void sii_command(std::uint8_t command, bool write_enable, Time now) noexcept;
  void sii_finish() noexcept;
  void sii_load(bool with_alias) noexcept;
  void show_sii() noexcept;
  bool sii_busy() const noexcept { return sii_command_running != 0; }

  // ---- esc_clock.cpp
  std::uint64_t local_time(Time now) const noexcept;
  std::uint64_t system_time(Time now) const noexcept;
  void anchor_clock(Time now) noexcept;
  void follow_drift(Time now) noexcept;
  void latch_receive_times() noexcept;
  void compare_system_time(Bytes received, Time now) noexcept;
  void reset_clock_loop(Time now) noexcept;
  void advance_sync0(Time now) noexcept;

  // ---- esc_watchdog.cpp
  Time watchdog_time() const noexcept;  // 0: off
  void feed_watchdog(Time now) noexcept;
  void check_watchdog(Time now) noexcept;

  // ---- Memory in little endian
  std::uint8_t u8(std::uint32_t address) const noexcept { return std::to_integer<std::uint8_t>(memory[address]); }
  std::uint16_t u16(std::uint32_t address) const noexcept { return static_cast<std::uint16_t>(number(address, 2)); }
  std::uint32_t u32(std::uint32_t address) const noexcept { return static_cast<std::uint32_t>(number(address, 4)); }
  std::uint64_t u64(std::uint32_t address) const noexcept { return number(address, 8); }
  std::uint64_t number(std::uint32_t address, unsigned size) const noexcept {
    std::uint64_t value = 0;
    for (unsigned i = size; i-- > 0;) value = value << 8 | u8(address + i);
    return value;
  }
  void put(std::uint32_t address, unsigned size, std::uint64_t value) noexcept {
    for (unsigned i = 0; i < size; ++i) memory[address + i] = static_cast<std::byte>(value >> 8 * i & 0xFF);
  }
  void set_bits(std::uint32_t address, std::uint8_t mask, bool on) noexcept {
    memory[address] = on ? memory[address] | std::byte{mask} : memory[address] & ~std::byte{mask};
  }

  EscSettings settings;
  EscFaults faults;
  std::array<std::byte, Esc::kMemory> memory{};
  std::array<Fmmu, Esc::kFmmus> fmmus;
  std::array<SyncManagerChannel, Esc::kSyncManagers> sync_managers;

  EscPorts ports{{true, false, false, false}};
  bool dl_status_event = false, al_status_event = false;
  std::optional<std::uint16_t> al_control;  // written, not taken by the PDI yet
  std::uint8_t reset_progress = 0;          // letters of "RES"
  bool reset = false;                       // since the PDI asked last

  bool repeat_requested = false;

  std::uint8_t sii_command_running = 0;  // 0: not busy
  Time sii_ready{};
  std::uint16_t sii_errors = 0;  // bits 11 to 14 of 0502

  // The local clock: this was its time then, and it runs so much faster than `now`.
  Time clock_anchor{};
  std::uint64_t clock_anchor_local = 0;
  std::int32_t clock_drift = 0;     // as last seen in the faults, ppm
  std::int64_t clock_loop_ppb = 0;  // what the control loop adds to settings.clock_ppm and the drift
  std::optional<Time> last_comparison;
  std::int64_t mean_difference = 0;
  std::uint64_t received_at_port0 = 0;
  std::optional<std::uint64_t> received_at_port1;

  std::optional<Time> watchdog_fed;  // runs since then
  bool watchdog_expired = false;     // since the PDI asked last
};

namespace esc {

// Does [address, address + size) touch the register(s) at `where`?
constexpr bool touches(std::uint32_t address, std::size_t size, std::uint32_t where, std::size_t length) noexcept {
  return address < where + length && where < address + size;
}
constexpr bool covers(std::uint32_t address, std::size_t size, std::uint32_t where, std::size_t length) noexcept {
  return address <= where && where + length <= address + size;
}

inline constexpr std::uint32_t kRegisters = 0x1000;  // from here on: process RAM
inline constexpr std::uint32_t kReset = 0x0040, kSiiCommand = reg::kSiiControl + 1u;

// Bits of 0502, SII control and status.
inline constexpr std::uint16_t kSiiWriteEnable = 0x0001, kSii8Bytes = 0x0040, kSiiChecksumError = 0x0800,
                               kSiiNotLoaded = 0x1000, kSiiCommandError = 0x2000, kSiiWriteEnableError = 0x4000,
                               kSiiBusy = 0x8000;

// Of a sync manager, relative to its first register.
inline constexpr std::uint32_t kSmControl = 4, kSmStatus = 5, kSmActivate = 6, kSmPdiControl = 7;
inline constexpr std::uint8_t kSmEnable = 0x01, kSmRepeat = 0x02, kSmDeactivate = 0x01;
inline constexpr std::uint8_t kSmWasWritten = 0x01, kSmWasRead = 0x02, kSmFull = 0x08;

}  // namespace esc
}  // namespace meca::ethercat
