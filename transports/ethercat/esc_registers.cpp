// Registers 0000 to 0FFF: what ECAT may write, and what reading and writing does (ESC data sheet section II;
// spec 5.3, 6.1). Every address of this area answers, also where there is no register: masters write over
// the ends of FMMUs and sync managers that do not exist, and expect a working counter.
#include "transports/ethercat/esc_state.hpp"

namespace meca::ethercat {
using namespace esc;
namespace {

struct WriteMask {
  std::uint16_t from, to;  // both inclusive
  std::uint8_t bits;
};

// Not here: what is written to act only (0040, 0300 to 0313, 0442, 0502, 0900, 0910).
constexpr WriteMask kWriteMasks[] = {
    {0x0010, 0x0011, 0xFF},  // station address; the alias comes from the SII
    {0x0100, 0x0100, 0x03}, {0x0101, 0x0101, 0xFF}, {0x0102, 0x0102, 0x0F}, {0x0103, 0x0103, 0x01},  // DL control
    {0x0120, 0x0120, 0x3F},                                                                          // AL control
    {0x0200, 0x0201, 0xFF},                                                                          // event mask
    {0x0400, 0x0401, 0xFF}, {0x0410, 0x0411, 0xFF}, {0x0420, 0x0421, 0xFF},                          // watchdogs
    {0x0500, 0x0500, 0x03}, {0x0504, 0x050F, 0xFF},                                                  // SII
    {0x0920, 0x092B, 0xFF},                                                  // system time offset and delay
    {0x0930, 0x0930, 0xFF}, {0x0931, 0x0931, 0x7F}, {0x0934, 0x0935, 0x0F},  // control loop
    {0x0980, 0x0980, 0x31}, {0x0981, 0x0981, 0xFF},                          // SYNC unit
    {0x0990, 0x0997, 0xFF}, {0x09A0, 0x09A7, 0xFF}, {0x09A8, 0x09A9, 0x03},  // start, cycles, latches
    {0x0F80, 0x0FFF, 0xFF},                                                  // user RAM
};
// Offsets in one FMMU and one sync manager.
constexpr WriteMask kFmmuMasks[] = {{0x0, 0x5, 0xFF}, {0x6, 0x7, 0x07}, {0x8, 0x9, 0xFF},
                                    {0xA, 0xA, 0x07}, {0xB, 0xB, 0x03}, {0xC, 0xC, 0x01}};
constexpr WriteMask kSyncManagerMasks[] = {
    {0, 3, 0xFF}, {kSmControl, kSmControl, 0x7F}, {kSmActivate, kSmActivate, kSmEnable | kSmRepeat}};

constexpr std::array<std::uint8_t, kRegisters> make_masks() {
  std::array<std::uint8_t, kRegisters> masks{};
  const auto apply = [&masks](std::uint32_t base, const auto& table) {
    for (const WriteMask& m : table)
      for (std::uint32_t a = m.from; a <= m.to; ++a) masks[base + a] = m.bits;
  };
  apply(0, kWriteMasks);
  for (unsigned n = 0; n < Esc::kFmmus; ++n) apply(reg::fmmu(n), kFmmuMasks);
  for (unsigned n = 0; n < Esc::kSyncManagers; ++n) apply(reg::sync_manager(n), kSyncManagerMasks);
  return masks;
}
constexpr auto kMasks = make_masks();

// What 0040 reads as after each letter of "RES".
constexpr std::array<std::uint8_t, 3> kResetLetters = {'R', 'E', 'S'};

// Groups of counters that a write to any of them clears.
struct CounterGroup {
  std::uint16_t from, size;
};
constexpr CounterGroup kCounterGroups[] = {{reg::kRxErrors, 0x0C},  // invalid frames, RX errors, forwarded errors
                                           {reg::kProcessingErrors, 1},
                                           {reg::kPdiErrors, 1},
                                           {reg::kLostLinks, 4},
                                           {reg::kSmWatchdogExpiries, 2}};

// Which of the sync managers or FMMUs, each `each` bytes from `base`, an access touches.
template <class Visit>
void for_each_touched(std::uint32_t address, std::size_t size, std::uint32_t base, std::uint32_t each, unsigned count,
                      Visit visit) {
  if (!touches(address, size, base, std::size_t{each} * count)) return;
  for (unsigned n = 0; n < count; ++n)
    if (touches(address, size, base + n * each, each)) visit(n);
}

}  // namespace

void EscState::count(std::uint16_t address) noexcept {
  if (memory[address] != std::byte{0xFF}) memory[address] = static_cast<std::byte>(u8(address) + 1);
}

// 0210: 2 DL status changed, 3 AL status changed, 4 and up: a sync manager with control bit 4 wants the master.
std::uint16_t EscState::ecat_events() const noexcept {
  unsigned events = (dl_status_event ? 4u : 0u) | (al_status_event ? 8u : 0u);
  for (unsigned n = 0; n < sync_managers.size(); ++n) {
    const std::uint32_t at = reg::sync_manager(n);
    if ((u8(at + kSmControl) & 0x10) == 0) continue;
    const std::uint8_t wanted = sync_managers[n].ecat_writes ? kSmWasRead : kSmWasWritten;
    if ((u8(at + kSmStatus) & wanted) != 0) events |= 0x10u << n;
  }
  return static_cast<std::uint16_t>(events);
}

// 0220: 0 AL control written, 8 and up: a sync manager with control bit 5 wants the application.
std::uint32_t EscState::al_events() const noexcept {
  std::uint32_t events = al_control ? 1u : 0u;
  for (unsigned n = 0; n < sync_managers.size(); ++n) {
    const std::uint32_t at = reg::sync_manager(n);
    if ((u8(at + kSmControl) & 0x20) == 0) continue;
    const std::uint8_t wanted = sync_managers[n].ecat_writes ? kSmWasWritten : kSmWasRead;
    if ((u8(at + kSmStatus) & wanted) != 0) events |= 0x100u << n;
  }
  return events;
}

void EscState::refresh_registers(std::uint32_t address, std::size_t size, Time now) noexcept {
  if (touches(address, size, reg::kEcatEvent, 2)) put(reg::kEcatEvent, 2, ecat_events());
  if (touches(address, size, reg::kAlEvent, 4)) put(reg::kAlEvent, 4, al_events());
  if (touches(address, size, reg::kDcSystemTime, 8)) put(reg::kDcSystemTime, 8, system_time(now));
  if (touches(address, size, reg::kDcStartTime, 8)) advance_sync0(now);
}

void EscState::registers_were_read(std::uint32_t address, std::size_t size) noexcept {
  if (touches(address, size, reg::kDlStatus, 2)) dl_status_event = false;
  if (touches(address, size, reg::kAlStatus, 2)) al_status_event = false;
}

bool EscState::writable(std::uint32_t address) const noexcept {
  if (address >= reg::kSyncManager && address < reg::sync_manager(Esc::kSyncManagers)) {
    // Start, length and control hold still while the sync manager is enabled.
    const std::uint32_t n = (address - reg::kSyncManager) / reg::kSyncManagerSize;
    return (address & 7) > kSmControl || !sync_managers[n].enabled;
  }
  if (address >= reg::kSiiControl && address < reg::kSiiData + 8u) return !sii_busy() && (u8(reg::kSiiOwner) & 1) == 0;
  return true;
}

void EscState::write_registers(std::uint32_t address, Bytes in, std::byte lanes, Time now) noexcept {
  // Byte by byte against the state before the write: a write that disables a sync manager does not move it.
  for (std::size_t i = 0; i < in.size(); ++i) {
    const auto at = static_cast<std::uint32_t>(address + i);
    if (kMasks[at] == 0 || !writable(at)) continue;
    const std::byte mask = std::byte{kMasks[at]} & lanes;
    memory[at] = (memory[at] & ~mask) | (in[i] & mask);
  }
  registers_were_written(address, in, now);
}

void EscState::registers_were_written(std::uint32_t address, Bytes in, Time now) noexcept {
  const std::size_t size = in.size();
  if (touches(address, size, reg::kAlControl, 1)) al_control = u16(reg::kAlControl);
  if (touches(address, size, kSiiCommand, 1) && writable(kSiiCommand)) {
    const bool write_enable = address < kSiiCommand && (in[kSiiCommand - 1 - address] & std::byte{1}) != std::byte{0};
    sii_command(std::to_integer<std::uint8_t>(in[kSiiCommand - address]) & 7, write_enable, now);
  }
  for_each_touched(address, size, reg::kFmmu, reg::kFmmuSize, Esc::kFmmus, [this](unsigned n) { decode_fmmu(n); });
  for_each_touched(address, size, reg::kSyncManager, reg::kSyncManagerSize, Esc::kSyncManagers,
                   [this](unsigned n) { configure_sync_manager(n); });
  if (touches(address, size, reg::kDcReceiveTimes, 4)) latch_receive_times();
  if (covers(address, size, reg::kDcSystemTime, 4)) {
    const std::size_t at = reg::kDcSystemTime - address;
    compare_system_time(in.subspan(at, std::min<std::size_t>(8, size - at)), now);
  }
  if (touches(address, size, reg::kDcSpeedStart, 2)) reset_clock_loop(now);
  if (touches(address, size, reg::kDcFilterDepths, 2)) mean_difference = 0;
  clear_counters(address, size);
  if (touches(address, size, kReset, 1)) reset_letter(in[kReset - address], now);
}

void EscState::clear_counters(std::uint32_t address, std::size_t size) noexcept {
  for (const CounterGroup& group : kCounterGroups)
    if (touches(address, size, group.from, group.size))
      std::fill_n(memory.begin() + group.from, group.size, std::byte{0});
}

// Three writes of one letter each; anything between them starts over.
void EscState::reset_letter(std::byte letter, Time now) noexcept {
  if (letter == std::byte{kResetLetters[reset_progress]}) {
    ++reset_progress;
  } else {
    reset_progress = letter == std::byte{kResetLetters[0]} ? 1 : 0;
  }
  if (reset_progress == kResetLetters.size()) {
    power_on(now, 0);
    reset = true;
  }
  memory[kReset] = std::byte{reset_progress};
}

}  // namespace meca::ethercat
