// What is behind a Station (station.hpp): where it is on its way, and the machine that talks to the device at the
// moment.
#pragma once

#include <cstdint>
#include <optional>

#include "transports/ethercat/access_machine.hpp"
#include "transports/ethercat/al_request.hpp"
#include "transports/ethercat/coe_configuration.hpp"
#include "transports/ethercat/mailbox_client.hpp"
#include "transports/ethercat/register_writes.hpp"
#include "transports/ethercat/station.hpp"

namespace meca::ethercat {

struct StationState {
  enum class Step : std::uint8_t {
    kNothing,
    kToInit,
    kMailboxRegisters,
    kToPreop,
    kCoe,
    kWaitForClock,
    kClockRegisters,
    kProcessDataRegisters,
    kToSafeop,
    kCyclesBeforeOp,
    kToOp,
    kAcknowledge,  // of an error in SAFEOP or OP
    kMailRound,    // in OP: emergencies
    kToClosed,
  };
  using Phase = Station::Phase;
  using Text = transports::LinkDetail;

  explicit StationState(const StationSettings& settings);

  // ---- The way up, one step after the other
  void climb(Time now) noexcept;
  void begin(Step step, Time now) noexcept;
  void run(AccessMachine& machine) noexcept { active = &machine; }
  void proceed(Time now) noexcept;  // `active` may have come to its end
  void step_done(Time now) noexcept;
  void reached_op(Time now) noexcept;
  void write_mailbox_registers(Time now) noexcept;
  void write_clock_registers(Time now) noexcept;
  void write_process_data_registers(Time now) noexcept;

  // ---- What goes wrong
  void fail(const Predicate& why, Time now) noexcept;  // pauses, then climbs from the beginning
  void stop() noexcept;                                // nothing is talked about any more
  void abandon(Time now) noexcept;
  void check_state(Time now) noexcept;  // `status` is what the master has seen
  void left_operation(Time now) noexcept;
  void say(const Predicate& what) noexcept;
  bool stable(Time now) const noexcept { return now - operational_since >= settings.longest_backoff; }

  StationSettings settings;
  StationCounters counters;
  Phase phase = Phase::kAbsent;
  Step step = Step::kNothing;
  std::uint16_t address = 0, status = 0, code = 0;
  std::optional<SiiIdentity> identity;
  Text trouble{"was not found yet"};

  AlRequest al;
  RegisterWrites writes;
  MailboxClient mailbox;
  CoeConfiguration coe;
  AccessMachine* active = nullptr;

  std::optional<Access> pending;  // with the master
  bool abandoned = false;         // nobody waits for its answer any more
  Time abandoned_until{};

  Time backoff{}, pause_until{}, deadline{}, operational_since{}, next_mail_round{};
  int cycles = 0, recoveries = 0;
  std::optional<std::uint64_t> clock;  // system time of the chain at clock_at
  Time clock_at{};
};

}  // namespace meca::ethercat
