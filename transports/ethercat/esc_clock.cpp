// Distributed clocks: receive times, system time, its control loop, SYNC0 (ETG.1000.4, 6.8; ESC data sheet section I).
// The loop of a real ESC is hardware that nobody has published; this one is inferred: it converges as fast, no more.
#include <limits>

#include "transports/ethercat/esc_state.hpp"

namespace meca::ethercat {
using namespace esc;
namespace {

constexpr std::int64_t kBillion = 1'000'000'000;
constexpr std::int64_t kMostLoopPpb = 500'000;
constexpr std::int64_t kMostInterval = 10'000'000;  // between comparisons, as far as the loop cares, ns

constexpr std::uint64_t plus(std::uint64_t time, std::int64_t ns) noexcept {
  return time + static_cast<std::uint64_t>(ns);
}

}  // namespace

std::uint64_t EscState::local_time(Time now) const noexcept {
  const std::int64_t passed = (now - clock_anchor).count();
  const std::int64_t ppb = (std::int64_t{settings.clock_ppm} + clock_drift) * 1000 + clock_loop_ppb;
  // Whole seconds apart, so that nothing overflows.
  const std::int64_t gained = passed / kBillion * ppb + passed % kBillion * ppb / kBillion;
  return plus(plus(clock_anchor_local, passed), gained);
}

std::uint64_t EscState::system_time(Time now) const noexcept { return local_time(now) + u64(reg::kDcOffset); }

// From where the clock is now, or a change of its speed would count backwards.
void EscState::anchor_clock(Time now) noexcept {
  clock_anchor_local = local_time(now);
  clock_anchor = now;
}

void EscState::follow_drift(Time now) noexcept {
  if (clock_drift == faults.clock_drift) return;
  anchor_clock(now);
  clock_drift = faults.clock_drift;
}

void EscState::latch_receive_times() noexcept {
  put(reg::kDcReceiveTimes, 4, received_at_port0);
  if (received_at_port1) put(reg::kDcReceiveTimes + 4u, 4, *received_at_port1);
  put(reg::kDcReceiveTimePu, 8, received_at_port0);
}

// A system time arrives: 4 bytes of it or all 8. The difference is shown, and the clock moves towards it: phase by a
// half, speed by an eighth of what it says, so that constant drift leaves no difference behind.
void EscState::compare_system_time(Bytes received, Time now) noexcept {
  std::uint64_t other = 0;
  for (std::size_t i = received.size(); i-- > 0;) other = other << 8 | std::to_integer<std::uint64_t>(received[i]);
  other += u32(reg::kDcDelay);
  const std::uint64_t difference = system_time(now) - other;
  const std::int64_t ahead =
      received.size() == 8 ? static_cast<std::int64_t>(difference) : static_cast<std::int32_t>(difference & 0xFFFFFFFF);
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  const std::int64_t bounded = std::clamp(ahead, -kMost, kMost);
  mean_difference += (bounded - mean_difference) / (std::int64_t{1} << (u8(reg::kDcFilterDepths) & 0x0F));
  // Sign and magnitude; the sign: our time is the later one, or the same.
  const auto magnitude = static_cast<std::uint32_t>(mean_difference < 0 ? -mean_difference : mean_difference);
  put(reg::kDcDifference, 4, magnitude | (mean_difference >= 0 ? 0x80000000u : 0u));

  const std::int64_t interval =
      last_comparison ? std::min<std::int64_t>((now - *last_comparison).count(), kMostInterval) : 0;
  last_comparison = now;
  if (interval <= 0) return;
  const std::int64_t step = std::clamp(bounded / 2, -interval / 10, interval / 10);
  clock_anchor_local = plus(local_time(now), -step);
  clock_anchor = now;
  const std::int64_t drift = bounded * kBillion / interval / 8;
  clock_loop_ppb = std::clamp(clock_loop_ppb - drift, -kMostLoopPpb, kMostLoopPpb);
}

void EscState::reset_clock_loop(Time now) noexcept {
  anchor_clock(now);
  clock_loop_ppb = 0;
  mean_difference = 0;
  last_comparison.reset();
}

// The start time register shows the next pulse once SYNC0 runs. A start that has passed is no harm: the pulses stand on
// its grid.
void EscState::advance_sync0(Time now) noexcept {
  constexpr std::uint8_t kRuns = 0x03;
  const std::uint64_t cycle = u32(reg::kDcSync0Cycle), start = u64(reg::kDcStartTime), time = system_time(now);
  if ((u8(reg::kDcActivation) & kRuns) != kRuns || cycle == 0 || start > time) return;
  put(reg::kDcStartTime, 8, start + ((time - start) / cycle + 1) * cycle);
}

void Esc::frame_begins(Time now, std::optional<Time> returned) noexcept {
  state_->received_at_port0 = state_->local_time(now);
  state_->received_at_port1.reset();
  if (returned) state_->received_at_port1 = state_->local_time(*returned);
}

bool Esc::sync0_active() const noexcept { return (state_->u8(reg::kDcActivation) & 3) == 3; }
Time Esc::last_sync0_cycle() const noexcept { return Time{state_->u32(reg::kDcSync0Cycle)}; }
std::uint64_t Esc::system_time(Time now) const noexcept { return state_->system_time(now); }

}  // namespace meca::ethercat
