// Outputs as they arrive, and what happens when they stop: the watchdog of sync manager 2, or in DC mode the count of
// SYNC0 cycles without outputs.
#include <algorithm>

#include "transports/ethercat/device_state.hpp"

namespace meca::ethercat {
namespace {

void take_outputs(DeviceState& s) noexcept {
  const auto bytes = s.esc.take_outputs();
  if (!bytes || bytes->size() != kOutputSize) return;
  s.outputs_arrived = true;
  s.outputs_in_cycle = true;
  if (state_of(s) != AlState::kOp) return;  // in SAFEOP outputs count, but nobody acts on them
  std::ranges::copy(*bytes, s.output.begin());
  s.objects.output = s.output;
  s.fresh = true;
  ++s.counters.outputs;
}

void sync_error(DeviceState& s) noexcept {
  ++s.counters.sync_errors;
  s.objects.set_number({0x1C32, 32}, 1);
  al_error(s, AlState::kSafeop, al::kSyncError);
}

// inferred: a cycle without outputs counts one up, one with outputs one down; beyond the limit of 10F1h:02 it is an
// error. At most one cycle each call: a delay of our own is no fault of the master.
void watch_sync0(DeviceState& s, Time now) noexcept {
  if (!s.esc.sync0_active()) return sync_error(s);
  if (s.next_sync == Time{}) s.next_sync = now + s.esc.last_sync0_cycle();
  if (now < s.next_sync) return;
  s.next_sync = std::max(s.next_sync + s.esc.last_sync0_cycle(), now);
  if (s.outputs_in_cycle) {
    s.missed_sync -= s.missed_sync > 0 ? 1 : 0;
  } else {
    ++s.missed_sync;
    s.objects.set_number({0x1C32, 11}, s.objects.number({0x1C32, 11}) + 1);
  }
  s.outputs_in_cycle = false;
  if (s.missed_sync > s.objects.number({0x10F1, 2})) sync_error(s);
}

}  // namespace

void serve_process_data(DeviceState& s, Time now) noexcept {
  take_outputs(s);
  const bool expired = s.esc.take_watchdog_expiry();
  if (expired) s.outputs_arrived = false;
  if (state_of(s) != AlState::kOp) return;
  if (s.distributed_clock) {
    watch_sync0(s, now);  // [ROBOT]: 001Ah when the master stops
    if (expired && state_of(s) == AlState::kOp) sync_error(s);
  } else if (expired) {  // inferred from the trigger in the ESI's control byte
    ++s.counters.watchdog_expiries;
    al_error(s, AlState::kSafeop, al::kWatchdog);
  }
}

bool maps_twice(const Esc& esc) noexcept {
  constexpr std::uint16_t kPhysical = 8, kType = 11, kActive = 12;
  constexpr std::uint8_t kReads = 1, kWrites = 2;
  unsigned writers = 0, readers = 0;
  for (unsigned n = 0; n < Esc::kFmmus; ++n) {
    const std::uint16_t at = reg::fmmu(n);
    if ((esc.peek(at + kActive) & 1) == 0) continue;
    const unsigned physical = esc.peek(at + kPhysical) | esc.peek(at + kPhysical + 1) << 8;
    const std::uint8_t type = esc.peek(at + kType);
    writers += (type & kWrites) != 0 && physical == kSyncManagers[2].start;
    readers += (type & kReads) != 0 && physical == kSyncManagers[3].start;
  }
  return writers > 1 || readers > 1;
}

}  // namespace meca::ethercat
