#include "transports/ethercat/station.hpp"

#include <algorithm>
#include <utility>

#include "transports/ethercat/station_state.hpp"

namespace meca::ethercat {

using Phase = Station::Phase;
using Step = StationState::Step;

namespace {

std::string_view progress(Step step) noexcept {
  switch (step) {
    case Step::kNothing:
    case Step::kMailRound:
      return {};
    case Step::kToInit:
    case Step::kMailboxRegisters:
      return "is being brought to INIT";
    case Step::kToPreop:
      return "is being brought to PREOP";
    case Step::kCoe:
      return "is in PREOP and being configured over its mailbox";
    case Step::kWaitForClock:
      return "is in PREOP until the clocks of the chain run together";
    case Step::kClockRegisters:
    case Step::kProcessDataRegisters:
      return "is in PREOP and being given its process data";
    case Step::kToSafeop:
      return "is being brought to SAFEOP";
    case Step::kCyclesBeforeOp:
      return "is in SAFEOP until process data has come back complete";
    case Step::kToOp:
      return "is being brought to OP";
    case Step::kAcknowledge:
      return "is being brought back to OP";
    case Step::kToClosed:
      return "is being brought to INIT to say good-bye";
  }
  return {};
}

}  // namespace

Station::Station(const StationSettings& settings) : state_(std::make_unique<StationState>(settings)) {}
Station::~Station() = default;
Station::Station(Station&&) noexcept = default;
Station& Station::operator=(Station&&) noexcept = default;

// ---- What the master knows

void Station::found(std::uint16_t station_address, const SiiIdentity& identity, Time now) noexcept {
  StationState& s = *state_;
  if (s.phase == Phase::kClosing || s.phase == Phase::kClosed) return;
  const bool same = s.address == station_address && s.identity == identity;
  if (same && s.phase != Phase::kAbsent) return;
  s.stop();
  s.abandon(now);
  s.address = station_address;
  s.identity = identity;
  s.backoff = s.settings.shortest_backoff;
  s.trouble = {};
  s.coe.forget();
  s.climb(now);
}

void Station::absent(std::string_view why, Time now) noexcept {
  StationState& s = *state_;
  if (s.phase == Phase::kClosed) return;
  s.stop();
  s.abandon(now);
  s.phase = s.phase == Phase::kClosing ? Phase::kClosed : Phase::kAbsent;
  s.status = s.code = 0;
  s.clock.reset();
  s.coe.forget();
  s.trouble = why;
}

void Station::al_status(std::uint16_t status, std::uint16_t code, Time now) noexcept {
  StationState& s = *state_;
  if ((status & kAlStateMask) == 0) return;
  s.status = status;
  s.code = code;
  s.check_state(now);
}

void Station::process_data_exchanged(Time now) noexcept {
  StationState& s = *state_;
  if (s.step == Step::kCyclesBeforeOp && ++s.cycles >= kCyclesBeforeOp) s.begin(Step::kToOp, now);
}

void Station::dc_ready(std::uint64_t system_time, Time now) noexcept {
  StationState& s = *state_;
  s.clock = system_time;
  s.clock_at = now;
  if (s.step == Step::kWaitForClock) s.begin(Step::kClockRegisters, now);
}

void Station::close(Time now) noexcept {
  StationState& s = *state_;
  if (s.phase == Phase::kClosing || s.phase == Phase::kClosed) return;
  const bool there = s.phase != Phase::kAbsent;
  s.stop();
  s.abandon(now);
  s.trouble = {};
  s.phase = there ? Phase::kClosing : Phase::kClosed;
  if (there) s.begin(Step::kToClosed, now);
}

// ---- Conversation

void Station::tick(Time now) noexcept {
  StationState& s = *state_;
  if (s.phase == Phase::kPausing && now >= s.pause_until) s.climb(now);
  if (s.step == Step::kCyclesBeforeOp && now >= s.deadline) {
    s.fail("gets no process data back complete; check the working counter and the cables behind it", now);
  }
  if (operational() && s.stable(now)) {
    s.backoff = s.settings.shortest_backoff;
    s.recoveries = 0;
  }
  if (operational() && s.active == nullptr && now >= s.next_mail_round) s.begin(Step::kMailRound, now);
  if (s.active == nullptr) return;
  s.active->tick(now);
  s.proceed(now);
}

std::optional<Access> Station::next(Time now) noexcept {
  StationState& s = *state_;
  if (s.pending && !s.abandoned) return s.pending;
  if (s.pending && now < s.abandoned_until) return std::nullopt;
  s.pending.reset();
  s.abandoned = false;
  if (s.active != nullptr) s.pending = s.active->next(now);
  return s.pending;
}

Time Station::next_event() const noexcept {
  const StationState& s = *state_;
  if (s.phase == Phase::kPausing) return s.pause_until;
  if (s.step == Step::kCyclesBeforeOp) return s.deadline;
  if (s.active != nullptr)
    return s.abandoned ? std::max(s.abandoned_until, s.active->next_event()) : s.active->next_event();
  return operational() ? s.next_mail_round : Time::max();
}

void Station::answered(std::uint16_t working_counter, Bytes data, Time now) noexcept {
  StationState& s = *state_;
  if (!s.pending) return;
  s.pending.reset();
  if (std::exchange(s.abandoned, false) || s.active == nullptr) return;
  s.active->answered(working_counter, data, now);
  if (s.active == &s.al && s.al.status() != 0) {
    s.status = s.al.status();
    s.code = s.al.code();
  }
  s.proceed(now);
}

void Station::lost(Time now) noexcept {
  StationState& s = *state_;
  if (!s.pending) return;
  s.pending.reset();
  if (std::exchange(s.abandoned, false) || s.active == nullptr) return;
  s.active->lost(now);
}

// ---- Facts

Phase Station::phase() const noexcept { return state_->phase; }

bool Station::wants_process_data() const noexcept {
  const Phase phase = state_->phase;
  return phase == Phase::kStarting || phase == Phase::kOperational || phase == Phase::kRecovering;
}

std::uint16_t Station::station_address() const noexcept { return state_->address; }
std::uint16_t Station::last_al_status() const noexcept { return state_->status; }
std::uint16_t Station::last_al_code() const noexcept { return state_->code; }
const std::optional<SiiIdentity>& Station::identity() const noexcept { return state_->identity; }
std::string_view Station::device_name() const noexcept { return state_->coe.name(); }
transports::FirmwareVersion Station::firmware() const noexcept { return state_->coe.firmware(); }
const std::optional<Emergency>& Station::last_emergency() const noexcept { return state_->mailbox.last_emergency(); }
std::string_view Station::trouble() const noexcept {
  return state_->trouble.empty() ? progress(state_->step) : state_->trouble.view();
}
const StationCounters& Station::counters() const noexcept { return state_->counters; }

}  // namespace meca::ethercat
