// The AL state machine of the device (ETG.1000.6, 6.4; ETG.1020). Facts of a real robot are marked [ROBOT], what nobody
// has published "inferred".
#include "transports/ethercat/device_state.hpp"
#include "transports/ethercat/pdo_objects.hpp"

namespace meca::ethercat {
namespace {

// inferred: how long the way to OP waits for outputs: the watchdog's default.
constexpr Time kPatience = std::chrono::milliseconds(100);
constexpr std::uint16_t kOk = 0;

constexpr bool is_state(std::uint16_t asked) noexcept {
  return asked == 1 || asked == 2 || asked == 3 || asked == 4 || asked == 8;
}
constexpr bool is_up(AlState from, AlState to) noexcept {
  return static_cast<unsigned>(to) > static_cast<unsigned>(from);
}
constexpr bool is_legal(AlState from, AlState to) noexcept {
  if (!is_up(from, to)) return true;
  return (from == AlState::kInit && to == AlState::kPreop) || (from == AlState::kPreop && to == AlState::kSafeop) ||
         (from == AlState::kSafeop && to == AlState::kOp);
}

bool is_laid_out(const Esc& esc, unsigned n) noexcept {
  const auto setting = esc.sync_manager(n);
  return setting.start == kSyncManagers[n].start && setting.length == kSyncManagers[n].length;
}
// Mode and direction as they have to be. Interrupts are nobody's business, the watchdog trigger is judged elsewhere.
bool is_enabled(const Esc& esc, unsigned n) noexcept {
  const auto setting = esc.sync_manager(n);
  return setting.enabled && (setting.control & 0x0F) == (kSyncManagers[n].control & 0x0F);
}

// inferred: the robot may not look at this; a device that asks for its SII says 0050h.
std::uint16_t check_preop(DeviceState& s) noexcept {
  if (s.settings.wants_sii && !s.esc.sii_belongs_to_pdi()) return al::kNoSiiAccess;
  for (unsigned n = 0; n < 2; ++n) {
    if (!is_laid_out(s.esc, n) || !is_enabled(s.esc, n)) return al::kMailboxConfiguration;
  }
  return kOk;
}

// [ROBOT]: without the assignment 0025h. inferred: the order of the checks, and that another order of the PDOs is
// refused too: they are all fixed in the ESI.
std::uint16_t check_safeop(DeviceState& s) noexcept {
  if (!s.objects.assigned(kRxPdoAssignment, rx_assignment())) return al::kOutputMapping;
  const bool safety = s.settings.layout != image::Layout::kFirmware9;
  if (!s.objects.assigned(kTxPdoAssignment, tx_assignment(safety))) return al::kInputMapping;
  if (!is_laid_out(s.esc, 2)) return al::kOutputConfiguration;
  if (!is_laid_out(s.esc, 3)) return al::kInputConfiguration;
  if (!is_enabled(s.esc, 2) || !is_enabled(s.esc, 3)) return al::kSyncManagerConfiguration;
  if (s.esc.sync0_active() && s.esc.last_sync0_cycle() < std::chrono::milliseconds(1)) return al::kSyncCycle;
  return kOk;
}

std::uint16_t check_op(DeviceState& s) noexcept {
  constexpr std::uint32_t kSync0 = 2;  // of 1C32h:01
  const bool wanted = s.distributed_clock || s.objects.number({0x1C32, 1}) == kSync0;
  if (wanted && !s.esc.sync0_active()) return al::kNoSync;
  return kOk;
}

std::uint16_t check(DeviceState& s, AlState to) noexcept {
  if (s.faults.refuse_state && (to == AlState::kSafeop || to == AlState::kOp)) return *s.faults.refuse_state;
  switch (to) {
    case AlState::kPreop:
      return check_preop(s);
    case AlState::kSafeop:
      return check_safeop(s);
    case AlState::kOp:
      return check_op(s);
    case AlState::kInit:
    case AlState::kBoot:
      break;
  }
  return kOk;
}

void enter(DeviceState& s, AlState to) noexcept {
  const AlState from = state_of(s);
  if (to == AlState::kSafeop && is_up(from, to)) {
    s.outputs_arrived = false;
    s.esc.take_outputs();  // of another time
    s.distributed_clock = s.esc.sync0_active();
    s.objects.set_number({0x1C32, 2},
                         s.distributed_clock ? static_cast<std::uint64_t>(s.esc.last_sync0_cycle().count()) : 0);
  }
  if (to == AlState::kOp) {
    s.missed_sync = 0;
    s.next_sync = {};
    s.objects.set_number({0x1C32, 32}, 0);
  }
  if (to == AlState::kInit) reset_mailbox(s);
  const bool process_data = to == AlState::kSafeop || to == AlState::kOp;
  s.esc.allow_process_data(process_data, process_data);
  s.esc.set_al_status(static_cast<std::uint16_t>(to), kOk);
  if (process_data && !s.faults.frozen_inputs) s.esc.set_inputs(s.objects.input);
}

void refuse(DeviceState& s, AlState stays, std::uint16_t code) noexcept {
  ++s.counters.refused_states;
  al_error(s, stays, code);
}

// What a careful master has done before it asks.
void judge(DeviceState& s, AlState to) noexcept {
  if (to == AlState::kPreop && !s.esc.sii_belongs_to_pdi()) ++s.counters.strict;
  if (to != AlState::kOp) return;
  constexpr std::uint8_t kWatchdogTrigger = 0x40;
  const bool watchdog = (s.esc.sync_manager(2).control & kWatchdogTrigger) != 0 &&
                        (s.esc.peek(reg::kSmWatchdog) != 0 || s.esc.peek(reg::kSmWatchdog + 1) != 0);
  s.counters.strict += !s.outputs_arrived + !watchdog + maps_twice(s.esc);
}

void begin(DeviceState& s, std::uint16_t asked, Time now) noexcept {
  const AlState from = state_of(s);
  if (!is_state(asked)) return refuse(s, from, al::kUnknownState);
  const auto to = static_cast<AlState>(asked);
  if (to == AlState::kBoot) return refuse(s, from, al::kNoBoot);
  if (to == from) {
    s.transition.reset();
    return;
  }
  if (!is_legal(from, to)) {
    ++s.counters.strict;
    return refuse(s, from, al::kInvalidChange);
  }
  if (to == AlState::kInit) {  // at once: what a master does next builds on it
    s.transition.reset();
    return enter(s, to);
  }
  if (s.transition && s.transition->asked == asked) return;  // masters ask again while they wait
  if (is_up(from, to)) judge(s, to);
  const Time done = now + s.settings.transition;
  s.transition = Transition{asked, done, done + kPatience};
}

Emergency emergency_of(AlState state, std::uint16_t code) noexcept {
  // inferred: which emergency goes with which AL error; the codes of ETG.1000.6, 5.6.4 for the ways to SAFEOP and OP.
  constexpr std::uint16_t kToSafeop = 0xA000, kToOp = 0xA001;
  constexpr std::uint8_t kCommunication = 0x10;  // error register
  Emergency emergency{.code = state == AlState::kPreop ? kToSafeop : kToOp, .error_register = kCommunication};
  emergency.data[0] = static_cast<std::byte>(code & 0xFF);
  emergency.data[1] = static_cast<std::byte>(code >> 8);
  return emergency;
}

}  // namespace

AlState state_of(const DeviceState& s) noexcept { return static_cast<AlState>(s.esc.al_status() & kAlStateMask); }
bool has_error(const DeviceState& s) noexcept { return (s.esc.al_status() & kAlError) != 0; }

void al_error(DeviceState& s, AlState state, std::uint16_t code) noexcept {
  s.transition.reset();
  s.esc.set_al_status(static_cast<std::uint16_t>(static_cast<std::uint16_t>(state) | kAlError), code);
  if (state == AlState::kInit) return;  // no mailbox
  s.objects.set_number({0x1001, 0}, 0x10);
  queue_emergency(s, emergency_of(state, code));
}

// As the public slave stack SOES does. inferred: so does the robot.
void watch_configuration(DeviceState& s) noexcept {
  const AlState state = state_of(s);
  const auto stands = [&s](unsigned n) { return is_laid_out(s.esc, n) && is_enabled(s.esc, n); };
  if (state == AlState::kInit) return;
  if (!stands(0) || !stands(1)) {
    enter(s, AlState::kInit);
    return refuse(s, AlState::kInit, al::kMailboxConfiguration);
  }
  if (state == AlState::kPreop || (stands(2) && stands(3))) return;
  const std::uint16_t code = stands(2) ? al::kInputConfiguration : al::kOutputConfiguration;
  enter(s, AlState::kPreop);
  refuse(s, AlState::kPreop, code);
}

void serve_al_control(DeviceState& s, Time now) noexcept {
  while (const auto control = s.esc.take_al_control()) {
    const std::uint16_t asked = *control & kAlStateMask;
    const bool acknowledged = (*control & kAlAcknowledge) != 0;
    if (has_error(s)) {
      if (!acknowledged && asked != static_cast<std::uint16_t>(AlState::kInit)) {
        ++s.counters.strict;
        continue;  // ETG.1000.6, 6.4.1: nothing happens before the error is acknowledged
      }
      s.esc.set_al_status(static_cast<std::uint16_t>(state_of(s)), kOk);
      s.objects.set_number({0x1001, 0}, 0);
    }
    begin(s, asked, now);
  }
}

void advance_transition(DeviceState& s, Time now) noexcept {
  if (!s.transition || now < s.transition->done) return;
  const AlState from = state_of(s);
  const auto to = static_cast<AlState>(s.transition->asked);
  if (is_up(from, to)) {
    if (const std::uint16_t code = check(s, to); code != kOk) return refuse(s, from, code);
    if (to == AlState::kOp && !s.outputs_arrived) {
      if (now < s.transition->give_up) return;
      return refuse(s, from, al::kWatchdog);
    }
  }
  s.transition.reset();
  enter(s, to);
}

}  // namespace meca::ethercat
