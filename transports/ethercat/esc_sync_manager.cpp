// Sync managers: mailboxes (one buffer, full or empty) and process data (three buffers, always the newest whole one),
// which are opened with the first byte and closed with the last (ETG.1000.4, 6.7; ESC data sheet section I).
#include "transports/ethercat/esc_state.hpp"

namespace meca::ethercat {
using namespace esc;

void SyncManagerChannel::choose_buffer_to_write() noexcept {
  for (unsigned buffer = 0; buffer < 3; ++buffer)
    if (newest != buffer && reading != buffer) writing = buffer;
}

void EscState::configure_sync_manager(unsigned n) noexcept {
  SyncManagerChannel& sm = sync_managers[n];
  const std::uint16_t at = reg::sync_manager(n);
  const bool was_enabled = sm.enabled, was_locked = sm.locked;
  const std::uint8_t control = u8(at + kSmControl);
  sm.start = u16(at);
  sm.length = u16(at + 2u);
  sm.mode = (control & 3) == 0   ? SyncManagerChannel::Mode::kBuffered
            : (control & 3) == 2 ? SyncManagerChannel::Mode::kMailbox
                                 : SyncManagerChannel::Mode::kReserved;
  sm.end = sm.start + sm.length * (sm.mode == SyncManagerChannel::Mode::kBuffered ? 3 : 1);
  sm.fits = sm.start >= kRegisters && sm.end <= Esc::kMemory;
  sm.ecat_writes = (control & 0x0C) == 0x04;
  sm.feeds_watchdog = (control & 0x40) != 0;
  sm.enabled = (u8(at + kSmActivate) & kSmEnable) != 0;
  sm.locked = (u8(at + kSmPdiControl) & kSmDeactivate) != 0;
  if (sm.enabled != was_enabled || sm.locked != was_locked) reset_sync_manager(n);
  const bool repeat = (u8(at + kSmActivate) & kSmRepeat) != 0, answered = (u8(at + kSmPdiControl) & kSmRepeat) != 0;
  if (sm.enabled && !was_enabled) set_bits(at + kSmPdiControl, kSmRepeat, repeat);
  if (n == 1) repeat_requested = sm.enabled && was_enabled && repeat != answered;
}

void EscState::reset_sync_manager(unsigned n) noexcept {
  SyncManagerChannel& sm = sync_managers[n];
  sm.open = sm.full = sm.fresh = sm.fetched = false;
  sm.newest.reset();
  sm.reading.reset();
  memory[reg::sync_manager(n) + kSmStatus] = std::byte{0};
  if (!sm.usable() && sm.feeds_watchdog) watchdog_fed.reset();
  show_sync_manager(n);
}

void EscState::show_sync_manager(unsigned n) noexcept {
  const SyncManagerChannel& sm = sync_managers[n];
  const std::uint32_t at = reg::sync_manager(n) + kSmStatus;
  std::uint8_t status = u8(at) & (kSmWasWritten | kSmWasRead);
  if (sm.enabled && sm.mode == SyncManagerChannel::Mode::kMailbox && sm.full) status |= kSmFull;
  if (sm.enabled && sm.mode == SyncManagerChannel::Mode::kBuffered)
    status |= static_cast<std::uint8_t>(sm.newest.value_or(3) << 4);
  memory[at] = std::byte{status};
}

bool EscState::read_guarded(unsigned n, std::uint32_t address, std::span<std::byte> out) noexcept {
  SyncManagerChannel& sm = sync_managers[n];
  const std::uint32_t offset = address - sm.start;
  const bool mailbox = sm.mode == SyncManagerChannel::Mode::kMailbox;
  if (!sm.usable() || sm.ecat_writes || sm.mode == SyncManagerChannel::Mode::kReserved || offset >= sm.length)
    return false;
  if (mailbox ? !sm.full : !sm.newest) return false;
  const std::uint32_t status = reg::sync_manager(n) + kSmStatus;
  if (offset == 0) {
    sm.open = true;
    sm.reading = sm.newest;
    set_bits(status, kSmWasWritten, false);
  }
  if (!sm.open) return false;
  const bool lost = mailbox && n == 1 && faults.lose_mailbox_reads;
  const std::size_t size = std::min<std::size_t>(out.size(), sm.length - offset);
  const std::uint32_t from = address + (mailbox ? 0 : *sm.reading * sm.length);
  if (!lost) std::copy_n(memory.begin() + from, size, out.begin());
  if (offset + size == sm.length) {
    sm.open = sm.full = false;
    sm.fetched = mailbox;
    sm.reading.reset();
    set_bits(status, kSmWasRead, true);
  }
  show_sync_manager(n);
  return !lost;
}

bool EscState::write_guarded(unsigned n, std::uint32_t address, Bytes in, std::byte lanes, Time now) noexcept {
  SyncManagerChannel& sm = sync_managers[n];
  const std::uint32_t offset = address - sm.start;
  const bool mailbox = sm.mode == SyncManagerChannel::Mode::kMailbox;
  if (!sm.usable() || !sm.ecat_writes || sm.mode == SyncManagerChannel::Mode::kReserved || offset >= sm.length)
    return false;
  if (mailbox && sm.full) return false;
  const std::uint32_t status = reg::sync_manager(n) + kSmStatus;
  if (offset == 0) {
    sm.open = true;
    sm.choose_buffer_to_write();
    set_bits(status, kSmWasRead, false);
  }
  if (!sm.open) return false;
  const std::size_t size = std::min<std::size_t>(in.size(), sm.length - offset);
  const std::uint32_t to = address + (mailbox ? 0 : sm.writing * sm.length);
  for (std::size_t i = 0; i < size; ++i) memory[to + i] = (memory[to + i] & ~lanes) | (in[i] & lanes);
  if (offset + size == sm.length) {
    sm.open = false;
    sm.full = mailbox;
    sm.fresh = true;
    if (!mailbox) sm.newest = sm.writing;
    if (sm.feeds_watchdog) feed_watchdog(now);
    set_bits(status, kSmWasWritten, true);
  }
  show_sync_manager(n);
  return true;
}

// ---- The PDI

std::optional<Bytes> Esc::take_mail() noexcept {
  SyncManagerChannel& sm = state_->sync_managers[0];
  if (!sm.usable() || !sm.ecat_writes || !sm.full) return std::nullopt;
  sm.full = false;
  const std::uint32_t status = reg::sync_manager(0) + kSmStatus;
  state_->set_bits(status, kSmWasWritten, false);
  state_->set_bits(status, kSmWasRead, true);
  state_->show_sync_manager(0);
  return Bytes(state_->memory).subspan(sm.start, sm.length);
}

bool Esc::post_mail(Bytes mail) noexcept {
  SyncManagerChannel& sm = state_->sync_managers[1];
  if (!sm.usable() || sm.ecat_writes || sm.mode != SyncManagerChannel::Mode::kMailbox || sm.full ||
      mail.size() > sm.length)
    return false;
  const auto rest = std::ranges::copy(mail, state_->memory.begin() + sm.start).out;
  std::fill_n(rest, sm.length - mail.size(), std::byte{0});
  sm.full = true;
  const std::uint32_t status = reg::sync_manager(1) + kSmStatus;
  state_->set_bits(status, kSmWasRead, false);
  state_->set_bits(status, kSmWasWritten, true);
  state_->show_sync_manager(1);
  return true;
}

bool Esc::mail_fetched() noexcept { return std::exchange(state_->sync_managers[1].fetched, false); }
bool Esc::take_repeat_request() noexcept { return std::exchange(state_->repeat_requested, false); }

void Esc::acknowledge_repeat() noexcept {
  const std::uint16_t at = reg::sync_manager(1);
  state_->set_bits(at + kSmPdiControl, kSmRepeat, (state_->u8(at + kSmActivate) & kSmRepeat) != 0);
}

std::optional<Bytes> Esc::take_outputs() noexcept {
  SyncManagerChannel& sm = state_->sync_managers[2];
  if (!sm.usable() || !sm.ecat_writes || sm.mode != SyncManagerChannel::Mode::kBuffered || !sm.fresh)
    return std::nullopt;
  sm.fresh = false;
  sm.reading = sm.newest;
  const std::uint32_t status = reg::sync_manager(2) + kSmStatus;
  state_->set_bits(status, kSmWasWritten, false);
  state_->set_bits(status, kSmWasRead, true);
  return Bytes(state_->memory).subspan(sm.start + *sm.newest * sm.length, sm.length);
}

void Esc::set_inputs(Bytes bytes) noexcept {
  SyncManagerChannel& sm = state_->sync_managers[3];
  if (!sm.usable() || sm.ecat_writes || sm.mode != SyncManagerChannel::Mode::kBuffered) return;
  sm.choose_buffer_to_write();
  const std::size_t size = std::min<std::size_t>(bytes.size(), sm.length);
  const auto to = state_->memory.begin() + sm.start + sm.writing * sm.length;
  std::fill(std::copy_n(bytes.begin(), size, to), to + sm.length, std::byte{0});
  sm.newest = sm.writing;
  state_->set_bits(reg::sync_manager(3) + kSmStatus, kSmWasWritten, true);
  state_->show_sync_manager(3);
}

Esc::SyncManagerSetting Esc::sync_manager(unsigned n) const noexcept {
  const std::uint16_t at = reg::sync_manager(n);
  return {.start = state_->u16(at),
          .length = state_->u16(at + 2u),
          .control = state_->u8(at + kSmControl),
          .enabled = (state_->u8(at + kSmActivate) & kSmEnable) != 0};
}

void Esc::allow_process_data(bool outputs, bool inputs) noexcept {
  for (const unsigned n : {2u, 3u}) {
    state_->set_bits(reg::sync_manager(n) + kSmPdiControl, kSmDeactivate, !(n == 2 ? outputs : inputs));
    state_->configure_sync_manager(n);
  }
}

}  // namespace meca::ethercat
