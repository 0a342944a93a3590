// The watchdog of the process data (ESC data sheet section II, 0400 to 0443): it runs from the first complete write to
// a sync manager with control bit 6 on, and stops with the sync manager. The PDI's own watchdog never runs: the
// simulated application does not hang.
#include "transports/ethercat/esc_state.hpp"

namespace meca::ethercat {

Time EscState::watchdog_time() const noexcept {
  constexpr auto kTick = std::chrono::nanoseconds(40);  // 25 MHz
  return kTick * (u16(reg::kWatchdogDivider) + 2) * u16(reg::kSmWatchdog);
}

void EscState::feed_watchdog(Time now) noexcept { watchdog_fed = now; }

void EscState::check_watchdog(Time now) noexcept {
  const Time most = watchdog_time();
  if (most > Time{} && watchdog_fed && now - *watchdog_fed >= most) {
    watchdog_fed.reset();
    watchdog_expired = true;
    count(reg::kSmWatchdogExpiries);
  }
  set_bits(reg::kSmWatchdogStatus, 1, most == Time{} || watchdog_fed.has_value());
}

bool Esc::take_watchdog_expiry() noexcept { return std::exchange(state_->watchdog_expired, false); }

}  // namespace meca::ethercat
