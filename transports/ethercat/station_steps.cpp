// The way of a station: from INIT to OP, and back there after a fault.
#include <algorithm>
#include <array>

#include "transports/ethercat/al_status.hpp"
#include "transports/ethercat/station_state.hpp"

namespace meca::ethercat {
namespace {

using Phase = Station::Phase;
using Step = StationState::Step;

// Longer than any frame takes: an answer that nobody waits for has come by then or never will.
constexpr Time kAnswerForgotten = std::chrono::milliseconds(100);
// So often in a row an error is acknowledged at once; then it takes the long way, with pauses.
constexpr int kFastRecoveries = 3;
constexpr Time kMailRound = std::chrono::milliseconds(500);
constexpr Time kSync0Lead = std::chrono::milliseconds(100);  // from now to the first SYNC0

int length(std::string_view s) noexcept { return static_cast<int>(s.size()); }

template <class Number>
std::array<std::byte, sizeof(Number)> bytes_of(Number value) noexcept {
  std::array<std::byte, sizeof(Number)> out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::byte>(value >> 8 * i & 0xFF);
  return out;
}

}  // namespace

StationState::StationState(const StationSettings& given)
    : settings(given),
      al(counters),
      writes(given.preop_timeout, counters),
      mailbox({given.mailbox_request_timeout, given.mailbox_response_timeout}, counters),
      coe(mailbox, given.dc, counters),
      backoff(given.shortest_backoff) {}

void StationState::climb(Time now) noexcept {
  phase = Phase::kInit;
  begin(Step::kToInit, now);
}

void StationState::begin(Step next, Time now) noexcept {
  step = next;
  active = nullptr;
  switch (step) {
    case Step::kNothing:
    case Step::kWaitForClock:
      break;
    case Step::kToInit:
    case Step::kToClosed:
      al.start(AlState::kInit, settings.init_timeout, now);
      return run(al);
    case Step::kMailboxRegisters:
      return write_mailbox_registers(now);
    case Step::kToPreop:
      phase = Phase::kPreop;
      al.start(AlState::kPreop, settings.preop_timeout, now);
      return run(al);
    case Step::kCoe:
      phase = Phase::kConfiguring;
      coe.start(now);
      return run(coe);
    case Step::kClockRegisters:
      return write_clock_registers(now);
    case Step::kProcessDataRegisters:
      return write_process_data_registers(now);
    case Step::kToSafeop:
      phase = Phase::kSafeop;
      al.start(AlState::kSafeop, settings.op_timeout, now);
      return run(al);
    case Step::kCyclesBeforeOp:
      if (phase != Phase::kRecovering) phase = Phase::kStarting;
      cycles = 0;
      deadline = now + settings.op_timeout;
      break;
    case Step::kToOp:
      al.start(AlState::kOp, settings.op_timeout, now);
      return run(al);
    case Step::kAcknowledge:
      phase = Phase::kRecovering;
      al.start(AlState::kSafeop, settings.op_timeout, now);
      return run(al);
    case Step::kMailRound:
      mailbox.drain(now);
      return run(mailbox);
  }
}

void StationState::proceed(Time now) noexcept {
  while (active != nullptr && !active->running()) {
    const bool failed = active->outcome() == AccessMachine::Outcome::kFailed;
    if (failed && step != Step::kToClosed && step != Step::kMailRound) return fail(active->trouble(), now);
    if (failed) abandon(now);
    step_done(now);
  }
}

void StationState::step_done(Time now) noexcept {
  switch (step) {
    case Step::kNothing:
    case Step::kCyclesBeforeOp:
    case Step::kWaitForClock:
      return;
    case Step::kToInit:
      return begin(Step::kMailboxRegisters, now);
    case Step::kMailboxRegisters:
      return begin(Step::kToPreop, now);
    case Step::kToPreop:
      return begin(Step::kCoe, now);
    case Step::kCoe:
      if (!settings.dc) return begin(Step::kProcessDataRegisters, now);
      return begin(clock ? Step::kClockRegisters : Step::kWaitForClock, now);
    case Step::kClockRegisters:
      return begin(Step::kProcessDataRegisters, now);
    case Step::kProcessDataRegisters:
      return begin(Step::kToSafeop, now);
    case Step::kToSafeop:
    case Step::kAcknowledge:
      return begin(Step::kCyclesBeforeOp, now);
    case Step::kToOp:
      return reached_op(now);
    case Step::kMailRound:
      next_mail_round = now + kMailRound;
      return begin(Step::kNothing, now);
    case Step::kToClosed:
      phase = Phase::kClosed;
      return begin(Step::kNothing, now);
  }
}

void StationState::reached_op(Time now) noexcept {
  begin(Step::kNothing, now);
  phase = Phase::kOperational;
  ++counters.operational;
  operational_since = now;
  next_mail_round = now + kMailRound;
  trouble = {};
}

// ---- Registers

// What another master left is cleared first: its FMMUs would answer in our process data, its SYNC0 would go on.
void StationState::write_mailbox_registers(Time now) noexcept {
  constexpr std::size_t kFmmus = 8, kManagers = kSyncManagers.size();
  writes.clear();
  writes.add_zeros(reg::kFmmu, kFmmus * reg::kFmmuSize);
  writes.add_zeros(reg::kSyncManager, kManagers * reg::kSyncManagerSize);
  writes.add_u16(reg::kDcCyclicUnit, 0, RegisterWrites::Need::kMay);
  const std::array to_pdi{std::byte{1}};
  writes.add(reg::kSiiOwner, to_pdi, RegisterWrites::Need::kMay);
  for (unsigned n = 0; n < 2; ++n) writes.add(reg::sync_manager(n), sync_manager_bytes(n, true));
  writes.start(now);
  run(writes);
}

// SYNC0 at multiples of the cycle of the system time, which is the same in all devices (spec 5.9.7).
void StationState::write_clock_registers(Time now) noexcept {
  const auto cycle = static_cast<std::uint64_t>(std::max<Time::rep>(settings.sync0_cycle.count(), 1));
  const std::uint64_t earliest = *clock + static_cast<std::uint64_t>((now - clock_at + kSync0Lead).count());
  const std::uint64_t start =
      (earliest + cycle - 1) / cycle * cycle + static_cast<std::uint64_t>(settings.shift.count());
  const std::array activation{std::byte{0x03}};  // cyclic operation, SYNC0
  writes.clear();
  writes.add_u16(reg::kDcCyclicUnit, 0);
  writes.add(reg::kDcStartTime, bytes_of(start));
  writes.add(reg::kDcSync0Cycle, bytes_of(static_cast<std::uint32_t>(cycle)));
  writes.add(reg::kDcSync1Cycle, bytes_of(std::uint32_t{0}));
  writes.add(reg::kDcActivation, activation);
  writes.start(now);
  run(writes);
}

void StationState::write_process_data_registers(Time now) noexcept {
  constexpr std::uint16_t kDivider = 2498;  // (2498 + 2) x 40 ns = 100 us
  constexpr Time kTick = std::chrono::microseconds(100);
  writes.clear();
  if (settings.watchdog > Time{}) {
    writes.add_u16(reg::kWatchdogDivider, kDivider);
    writes.add_u16(reg::kSmWatchdog,
                   static_cast<std::uint16_t>(std::clamp<Time::rep>(settings.watchdog / kTick, 1, 0xFFFF)));
  }
  for (unsigned n = 2; n < 4; ++n) writes.add(reg::sync_manager(n), sync_manager_bytes(n, true));
  writes.add(reg::fmmu(0), fmmu_bytes(settings.logical_output, true));
  writes.add(reg::fmmu(1), fmmu_bytes(settings.logical_input, false));
  writes.start(now);
  run(writes);
}

// ---- What goes wrong

void StationState::say(const Predicate& what) noexcept {
  trouble = Text::format("the robot %s %u %.*s", settings.alias ? "with alias" : "at position",
                         unsigned{settings.alias.value_or(settings.position)}, length(what.view()), what.view().data());
}

void StationState::fail(const Predicate& why, Time now) noexcept {
  say(why);
  stop();
  abandon(now);
  phase = Phase::kPausing;
  pause_until = now + backoff;
  backoff = std::min(backoff * 2, settings.longest_backoff);
}

void StationState::stop() noexcept {
  step = Step::kNothing;
  active = nullptr;
}

void StationState::abandon(Time now) noexcept {
  if (!pending || abandoned) return;
  abandoned = true;
  abandoned_until = now + kAnswerForgotten;
}

// Steps that ask the device for a state look for themselves.
void StationState::check_state(Time now) noexcept {
  const std::uint16_t state = status & kAlStateMask;
  const bool error = (status & kAlError) != 0;
  const std::string_view name = al_state_name(status), text = al_code_text(code);
  if (phase == Phase::kOperational) {
    if (error || state != static_cast<std::uint16_t>(AlState::kOp)) left_operation(now);
  } else if (step == Step::kCyclesBeforeOp) {
    if (error || state < static_cast<std::uint16_t>(AlState::kSafeop)) left_operation(now);
  } else if (phase == Phase::kConfiguring && (error || state != static_cast<std::uint16_t>(AlState::kPreop))) {
    fail(Predicate::format("left PREOP by itself and is in %.*s: AL status code 0x%04X, %.*s", length(name),
                           name.data(), unsigned{code}, length(text), text.data()),
         now);
  }
}

void StationState::left_operation(Time now) noexcept {
  const std::uint16_t state = status & kAlStateMask;
  const std::string_view name = al_state_name(status), text = al_code_text(code);
  const bool configured =
      state == static_cast<std::uint16_t>(AlState::kSafeop) || state == static_cast<std::uint16_t>(AlState::kOp);
  const bool was_stable = phase == Phase::kOperational && stable(now);
  if ((status & kAlError) != 0) ++counters.al_errors;
  const auto why = (status & kAlError) != 0
                       ? Predicate::format("went to %.*s with an error: AL status code 0x%04X, %.*s", length(name),
                                           name.data(), unsigned{code}, length(text), text.data())
                       : Predicate::format("went to %.*s by itself: it was restarted, or another master is at work",
                                           length(name), name.data());
  if (configured && recoveries < kFastRecoveries) {
    ++recoveries;
    say(why);
    abandon(now);
    return begin(Step::kAcknowledge, now);
  }
  if (configured || !was_stable) return fail(why, now);
  say(why);
  abandon(now);
  climb(now);
}

}  // namespace meca::ethercat
