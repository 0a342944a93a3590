// Process data: one datagram per robot, as many as fit in a frame, and what is asked of all once a cycle.
#include <algorithm>

#include "transports/ethercat/master_state.hpp"

namespace meca::ethercat {
namespace {

// A count of devices is believed when two cycles say the same; single frames may be cut short by a cable that is
// pulled.
constexpr unsigned kBelieved = 2;
constexpr unsigned kMissesToAsk = 2;
// Nobody puts another device into a place faster than that; one that we do not ask for its state would not show it.
constexpr Time kFastestExchange = std::chrono::milliseconds(100);
constexpr std::uint16_t kReadOnly = 1;  // of a command that reads and writes
constexpr std::uint16_t kTimeSize = 8;

}  // namespace

void MasterState::begin_cycle() noexcept {
  ++cycle;
  ++counters.cycles;
  cyclic_due = any_port();
  chain_state_added = false;
  next_robot = 0;
  phase.next_cycle();
  for (Robot& robot : robots) {
    const bool operational = robot.station.operational();
    if (robot.was_operational && !operational && !closing) ++robot.counters.losses;
    robot.was_operational = operational;
  }
}

Bytes MasterState::cyclic_frame(Time now) noexcept {
  if (!cyclic_due || !in_flight.begin(InFlight::Use::kCyclic, cycle)) {
    cyclic_due = false;
    return {};
  }
  if (!chain_state_added) {
    in_flight.add({Command::kBrd, address_of(0, reg::kAlStatus), 2, {}, {Purpose::Kind::kChainState, 0, 0}});
    if (const auto reference = clocks.reference())
      in_flight.add({Command::kFrmw,
                     address_of(*reference, reg::kDcSystemTime),
                     kTimeSize,
                     {},
                     {Purpose::Kind::kReferenceTime, 0, 0}});
    chain_state_added = true;
  }
  while (next_robot < robots.size() &&
         (!robots[next_robot].station.wants_process_data() || add_process_data(next_robot)))
    ++next_robot;
  cyclic_due = next_robot < robots.size();
  both_ports = true;
  return in_flight.finish(copies(), now);
}

bool MasterState::add_process_data(std::size_t index) noexcept {
  const Robot& robot = robots[index];
  const auto of = static_cast<std::uint16_t>(index);
  const auto logical = static_cast<std::uint32_t>(index * kLogicalSize);
  if (!settings.separate && !robot.cannot_lrw)
    return in_flight.add(
        {Command::kLrw, logical, kLogicalSize, robot.output, {Purpose::Kind::kProcessData, robot.generation, of}});
  if (in_flight.room() < kLogicalSize + kDatagramOverhead) return false;
  return in_flight.add(
             {Command::kLwr, logical, kOutputSize, robot.output, {Purpose::Kind::kOutputs, robot.generation, of}}) &&
         in_flight.add(
             {Command::kLrd, logical + kOutputSize, kInputSize, {}, {Purpose::Kind::kInputs, robot.generation, of}});
}

void MasterState::cyclic_reply(const InFlight::Frame& frame, const Purpose& purpose, std::uint16_t working_counter,
                               Bytes data, Time now) noexcept {
  if (purpose.kind == Purpose::Kind::kChainState) {
    wire::Reader in(data);
    return chain_state(working_counter, in.u16());
  }
  if (purpose.kind == Purpose::Kind::kReferenceTime) {
    if (working_counter > 0) reference_time(data, now);
    return;
  }
  Robot& robot = robots[purpose.of];
  if (purpose.step != robot.generation) return;
  if (purpose.kind != Purpose::Kind::kProcessData)
    return separate_reply(robot, frame, purpose.kind == Purpose::Kind::kInputs, working_counter, data, now);
  if (working_counter != kBothWays) miss(robot, working_counter);
  if (working_counter == kBothWays) take_input(robot, data.subspan(kOutputSize), frame.cycle);
  // A device that does not open its outputs before OP (spec 5.2) counts the inputs only.
  if (working_counter == kBothWays || (!robot.station.operational() && working_counter == kOneWay))
    robot.station.process_data_exchanged(now);
}

void MasterState::separate_reply(Robot& robot, const InFlight::Frame& frame, bool inputs, std::uint16_t working_counter,
                                 Bytes data, Time now) noexcept {
  if (working_counter != kOneWay) return miss(robot, working_counter);
  (inputs ? robot.inputs_cycle : robot.outputs_cycle) = frame.cycle;
  if (!inputs) return;  // outputs stand before inputs in the same frame
  const bool both = robot.outputs_cycle == frame.cycle;
  if (both) take_input(robot, data, frame.cycle);
  if (both || !robot.station.operational()) robot.station.process_data_exchanged(now);
}

void MasterState::take_input(Robot& robot, Bytes input, std::uint64_t of_cycle) noexcept {
  robot.misses = 0;
  if (of_cycle <= robot.input_cycle) return;  // frames overtook each other
  robot.input_cycle = of_cycle;
  std::ranges::copy(input, robot.input.begin());
  robot.fresh = true;
  ++robot.counters.images;
}

void MasterState::miss(Robot& robot, std::uint16_t working_counter) noexcept {
  robot.wrong_counter = working_counter;
  if (!robot.station.operational()) return;
  ++robot.counters.working_counter_misses;
  if (++robot.misses >= kMissesToAsk && robot.misses % kMissesToAsk == 0) robot.al_due = true;
}

// Of the last cycle that missed.
std::string_view MasterState::why_not_counted(const Robot& robot) const noexcept {
  if (robot.wrong_counter == 0)
    return "takes no part in the process data (working counter 0), so its inputs are not taken; restart it if it stays "
           "so";
  if (settings.separate || robot.cannot_lrw || robot.wrong_counter > kBothWays)
    return "is counted more than once in the process data, so its inputs are not taken; another device answers for it";
  if (robot.wrong_counter == kReadOnly)
    return "gives inputs but takes no outputs (working counter 1 where 3 is right), so its inputs are not taken; "
           "restart "
           "it if it stays so";
  return "takes outputs but gives no inputs (working counter 2 where 3 is right); restart it if it stays so";
}

void MasterState::chain_state(std::uint16_t devices, std::uint16_t or_of_states) noexcept {
  if (devices > 0) {
    if (reached && silence() > kFastestExchange) scan_wanted = true;
    heard = cycle;
    reached = true;
    silent = false;
  }
  if (devices != count || or_of_states != states)
    for (Robot& robot : robots) robot.al_due = true;
  count_stands = devices == count ? count_stands + 1 : 1;
  count = devices;
  states = or_of_states;
  // Positions have moved: what is under way by position may reach another one than it should.
  if (scan.running() && scan.by_position() && scanned_count != count) {
    scan.stop();
    scanned_count.reset();
  }
  if (count > 0 && count_stands >= kBelieved && scanned_count != count) scan_wanted = true;
}

void MasterState::reference_time(Bytes data, Time now) noexcept {
  wire::Reader in(data);
  const std::uint64_t time = in.u64();
  phase.seen(time);
  if (!clocks.ready()) return;  // robots start SYNC0 once all clocks are set
  for (Robot& robot : robots)
    if (robot.life != 0) robot.station.dc_ready(time, now);
}

}  // namespace meca::ethercat
