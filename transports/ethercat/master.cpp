// The front of the master: frames out and in, links, the good-bye.
#include "transports/ethercat/master.hpp"

#include <algorithm>
#include <utility>

#include "transports/ethercat/master_state.hpp"

namespace meca::ethercat {
namespace {

using Phase = Station::Phase;
constexpr std::string_view kLookedThrough = "the chain is being looked through";
constexpr std::string_view kNotLookedThrough =
    "the ring is open before the first device, and robots are looked for from there; check the cable there";
constexpr Time kLeastSilence = std::chrono::milliseconds(100);
constexpr unsigned kMissesToSay = 10, kUnevenFrames = 4;

StationSettings station_settings(const MasterSettings& settings, std::size_t robot) {
  StationSettings out = settings.station;
  out.position = settings.robots[robot].position;
  out.alias = settings.robots[robot].alias;
  out.logical_output = static_cast<std::uint32_t>(robot * kLogicalSize);
  out.logical_input = out.logical_output + kOutputSize;
  out.watchdog = settings.watchdog;
  out.dc = settings.dc;
  out.sync0_cycle = settings.cycle;
  out.shift = settings.dc_shift;
  return out;
}

MasterSettings without_clocks_in_a_ring(MasterSettings settings) {
  settings.dc = settings.dc && !settings.redundant;
  return settings;
}

}  // namespace

MasterState::MasterState(const MasterSettings& from)
    : settings(without_clocks_in_a_ring(from)),
      ports{true, from.redundant},
      in_flight(from.source),
      scan(from.station.sii_timeout),
      clocks(from.dc_epoch),
      phase(from.cycle, from.dc_shift + from.cycle / 2) {
  robots.reserve(settings.robots.size());
  for (std::size_t i = 0; i < settings.robots.size(); ++i) {
    robots.emplace_back(settings.robots[i], station_settings(settings, i));
    robots.back().trouble = kLookedThrough;
  }
}

void MasterState::give_up_overdue(Time now) noexcept {
  while (InFlight::Frame* const frame = in_flight.overdue(timeouts(), now)) {
    ++counters.lost_frames;
    // Of a ring one copy may have come: then that is what there is to know.
    if (frame->arrived > 0 && frame->use == InFlight::Use::kCyclic) missed_a_copy(*frame);
    if (frame->arrived > 0)
      dispatch(*frame, Bytes(frame->merged).first(frame->size), now);
    else
      lost(*frame, now);
    uneven_frames = kUnevenFrames;
    if (frame->use == InFlight::Use::kService) next_service = now + unequal_pause();
    in_flight.release(*frame);
  }
  if (any_port() && !silent && silence() > std::max(settings.watchdog, kLeastSilence)) {
    silent = true;
    out_of_reach("no device answers; check the cable to the first robot and its power", now);
  }
}

// In cycles, not in time: while we stood still ourselves nobody could answer.
Time MasterState::silence() const noexcept { return settings.cycle * static_cast<Time::rep>(cycle - heard); }

void MasterState::missed_a_copy(const InFlight::Frame& frame) noexcept {
  talking_port = frame.seen[0] ? 0 : 1;
  if (++single_copies == kMissedCopies) ring_is(true, talking_port == 0 ? count : 0);
}

void MasterState::ring_is(bool open, std::size_t reached_from_primary) noexcept {
  ring_open = open;
  ring_open_at_first = open && reached_from_primary == 0;
  if (!open) return;
  constexpr const char* kMeaning = "the next cut takes robots away; check the cable there";
  if (reached_from_primary == 0) {
    ring_trouble = transports::LinkDetail::format("the ring is open before the first device; %s", kMeaning);
  } else {
    ring_trouble =
        transports::LinkDetail::format("the ring is open behind position %zu; %s", reached_from_primary - 1, kMeaning);
  }
}

void MasterState::out_of_reach(std::string_view why, Time now) noexcept {
  reached = false;
  count = states = 0;
  count_stands = 0;
  scanned_count.reset();
  scan.stop();
  clocks.forget();
  phase.reset();
  for (Robot& robot : robots) {
    robot.trouble = why;
    if (robot.life == 0) continue;
    robot.station.absent(why, now);
    robot.life = 0;
    ++robot.generation;
  }
}

void MasterState::dispatch(const InFlight::Frame& frame, Bytes reply, Time now) noexcept {
  DatagramWalk<const std::byte> walk(reply);
  // One copy of two: what nobody counted there may have been counted in the other, which is lost.
  const bool half = frame.arrived < frame.awaited;
  if (frame.use == InFlight::Use::kService) service_in_flight = false;
  for (std::size_t i = 0; i < frame.count; ++i) {
    const auto datagram = walk.next();
    if (!datagram) return;
    const Purpose& purpose = frame.datagrams[i].purpose;
    if (half && (datagram->working_counter() == 0 || purpose.kind == Purpose::Kind::kChainState)) {
      if (frame.use == InFlight::Use::kService) service_lost(purpose, now);
      continue;
    }
    if (frame.use == InFlight::Use::kCyclic)
      cyclic_reply(frame, purpose, datagram->working_counter(), datagram->data(), now);
    else
      service_reply(purpose, datagram->working_counter(), datagram->data(), now);
  }
}

void MasterState::lost(const InFlight::Frame& frame, Time now) noexcept {
  if (frame.use == InFlight::Use::kCyclic) return;
  service_in_flight = false;
  for (std::size_t i = 0; i < frame.count; ++i) service_lost(frame.datagrams[i].purpose, now);
}

// What is lost at a regular beat must not be met by it again and again: from a lost answer of a mailbox to its
// repetition it is five more frames, and any regular distance can bring that one into the beat too. So after a loss no
// distance tells the next one (a linear congruential generator, Numerical Recipes 7.1), and they reach over two cycles,
// for the frames of the cycles count in the beat.
Time MasterState::unequal_pause() noexcept {
  constexpr unsigned kMultiplier = 1'664'525, kIncrement = 1'013'904'223, kGoodBits = 16;
  constexpr Time::rep kLeastChoice = 4;
  const Time::rep choice = std::max(kLeastChoice, 2 * (settings.cycle / settings.service_period));
  dice = dice * kMultiplier + kIncrement;
  return settings.service_period * (static_cast<Time::rep>(dice >> kGoodBits) % choice);
}

Master::Master(const MasterSettings& settings) : state_(std::make_unique<MasterState>(settings)) {}
Master::~Master() = default;
Master::Master(Master&&) noexcept = default;
Master& Master::operator=(Master&&) noexcept = default;

void Master::begin_cycle(Time now) noexcept {
  state_->give_up_overdue(now);
  state_->round_trip.pass(now);
  state_->begin_cycle();
}

Bytes Master::next_frame(Time now) noexcept {
  state_->give_up_overdue(now);
  if (!state_->any_port()) return {};
  Bytes frame = state_->cyclic_frame(now);
  if (frame.empty()) frame = state_->service_frame(now);
  if (!frame.empty()) ++state_->counters.sent_frames;
  return frame;
}

Time Master::next_event() const noexcept {
  if (state_->cyclic_due) return Time::min();
  Time out = state_->next_service_event();
  if (const auto overdue = state_->in_flight.next_overdue(state_->timeouts())) out = std::min(out, *overdue);
  return out;
}

bool Master::on_both_ports() const noexcept { return state_->both_ports; }

void Master::received(Port port, Bytes frame, Time now) noexcept {
  MasterState& state = *state_;
  const auto arrival = state.in_flight.received(static_cast<std::size_t>(port), frame);
  if (arrival.verdict == InFlight::Verdict::kMalformed) ++state.counters.malformed_frames;
  if (arrival.verdict == InFlight::Verdict::kUnexpected) ++state.counters.unexpected_frames;
  if (arrival.verdict == InFlight::Verdict::kOtherEnd) state.single_copies = 0;
  if (arrival.frame == nullptr || arrival.verdict == InFlight::Verdict::kUnexpected) return;
  ++state.counters.received_frames;
  const bool cyclic = arrival.frame->use == InFlight::Use::kCyclic;
  const bool counts_all = cyclic && arrival.frame->datagrams[0].purpose.kind == Purpose::Kind::kChainState;
  if (state.settings.redundant && counts_all && port == Port::kPrimary && arrival.frame->awaited > 1) {
    // Of a whole ring the frame of the primary port comes back at the other one; what comes back here passed nobody.
    DatagramWalk<const std::byte> walk(frame);
    const std::uint16_t reached = walk.next()->working_counter();
    if (state.ring_open && reached == 0) state.scan_wanted = true;  // who came new behind the break can be found now
    state.ring_is(reached > 0, reached);
  }
  if (arrival.verdict != InFlight::Verdict::kComplete) return;
  if (cyclic) {
    if (arrival.frame->awaited > 1) state.single_copies = 0;
    state.round_trip.add(now - arrival.frame->sent, now);
    if (arrival.frame->cycle != state.cycle) ++state.counters.late_frames;
  }
  state.dispatch(*arrival.frame, arrival.reply, now);
  state.in_flight.release(*arrival.frame);
}

void Master::link_changed(Port port, bool up, Time now) noexcept {
  MasterState& state = *state_;
  const bool had_port = state.any_port();
  state.ports[static_cast<std::size_t>(port)] = up && (port == Port::kPrimary || state.settings.redundant);
  state.single_copies = 0;
  if (state.settings.redundant && !state.both_ends()) {
    state.ring_is(true, state.ports[0] ? state.scan.devices().size() : 0);
    state.in_flight.await_one_copy();
  }
  if (!state.ports[0] && state.scan.running()) {
    state.scan.stop();
    state.scan_wanted = true;
  }
  if (state.any_port()) {
    if (!state.reached) state.heard = state.cycle;  // time to answer
    if (!had_port) {
      for (Robot& robot : state.robots) robot.trouble = kLookedThrough;
    }
    return;
  }
  state.cyclic_due = state.silent = false;
  state.out_of_reach("no carrier", now);
}

void Master::close(Time now) noexcept {
  state_->closing = true;
  state_->scan.stop();
  for (Robot& robot : state_->robots) robot.station.close(now);
}

bool Master::closed() const noexcept {
  const auto is_closed = [](const Robot& robot) {
    return robot.life == 0 || robot.station.phase() == Phase::kClosed || robot.station.phase() == Phase::kAbsent;
  };
  return state_->closing && (!state_->any_port() || std::ranges::all_of(state_->robots, is_closed));
}

void Master::set_output(std::size_t robot, const image::OutputBytes& output) noexcept {
  state_->robots[robot].output = output;
}

bool Master::take_fresh(std::size_t robot) noexcept { return std::exchange(state_->robots[robot].fresh, false); }
const image::InputBytes& Master::input(std::size_t robot) const noexcept { return state_->robots[robot].input; }
const Station& Master::station(std::size_t robot) const noexcept { return state_->robots[robot].station; }

std::string_view Master::trouble(std::size_t index) const noexcept {
  const Robot& robot = state_->robots[index];
  if (state_->ring_open_at_first && robot.trouble.view() == kLookedThrough) return kNotLookedThrough;
  if (!robot.trouble.empty()) return robot.trouble;
  if (!robot.station.operational()) return robot.station.trouble();
  if (robot.misses >= kMissesToSay) return state_->why_not_counted(robot);
  return state_->ring_open ? state_->ring_trouble.view() : robot.station.trouble();
}

const RobotCounters& Master::counters(std::size_t robot) const noexcept { return state_->robots[robot].counters; }
const MasterCounters& Master::counters() const noexcept { return state_->counters; }
const Histogram& Master::round_trip() const noexcept { return state_->round_trip; }
bool Master::ring_open() const noexcept { return state_->settings.redundant && state_->ring_open; }
Time Master::dc_phase_correction() const noexcept { return state_->phase.correction(); }

}  // namespace meca::ethercat
