// Everything that is not process data: one small frame at a time, in which each who wants something has a datagram.
#include <algorithm>

#include "transports/ethercat/master_state.hpp"

namespace meca::ethercat {
namespace {

constexpr Time kAlStatusPeriod = std::chrono::milliseconds(100), kErrorsPeriod = std::chrono::seconds(1),
               kDifferencePeriod = std::chrono::milliseconds(100), kScanPause = std::chrono::milliseconds(100),
               kLongestScanPause = std::chrono::seconds(1);
constexpr std::uint16_t kAlStatusSize = 6;  // status, reserved, code
// A service frame does not grow beyond it, however many want something: 700 bytes are 56 us of a 100 Mbit/s line.
constexpr std::size_t kMostServiceBytes = 560;
constexpr unsigned kSilentToScan = 3;
// The device's counters stop at 255.
constexpr std::uint8_t kClearFrom = 128;

}  // namespace

Bytes MasterState::service_frame(Time now) noexcept {
  if (service_in_flight || now < next_service) return {};
  next_service = now + settings.service_period;
  if (uneven_frames > 0) {
    --uneven_frames;
    next_service += unequal_pause();
  }
  look_after_scan(now);
  for (Robot& robot : robots) robot.station.tick(now);
  if (!in_flight.begin(InFlight::Use::kService, cycle)) return {};
  // Every other frame only: the scan may ask in vain for long, and the robots are not to wait for it.
  const bool alone = settings.redundant && scan.by_position();
  const bool by_position = alone && both_ports_in_service;
  both_ports_in_service = !by_position;
  if (by_position || !alone) scan.add_to(in_flight, now);
  if (!by_position) {
    clocks.add_to(in_flight, now);
    add_robots(now);
  }
  both_ports = !by_position;
  const Bytes frame = in_flight.finish(by_position ? InFlight::Copies{} : copies(), now);
  service_in_flight = !frame.empty();
  return frame;
}

void MasterState::look_after_scan(Time now) noexcept {
  if (closing) return;
  // Of a ring without the primary port positions count from the other end: what is known is kept as it is.
  if (scan_wanted && !scan.running() && reached && ports[0] && now >= next_scan) {
    scan_wanted = false;
    scanned_count = count;
    ++counters.scans;
    scan.start();
  }
  scan.tick(now);
  if (!scan.take_end()) return;
  bind(now);
  // Who could not be read is asked again, less and less often as long as it is the same one: it may only have been
  // switched off and on meanwhile, and then it comes as another.
  const auto unreadable = std::ranges::find(scan.devices(), false, &ChainScan::Device::identified);
  const bool all_read = unreadable == scan.devices().end();
  const std::uint32_t life = all_read ? 0 : unreadable->life;
  scan_pause = life != 0 && life == unreadable_life ? std::min(2 * scan_pause, kLongestScanPause) : kScanPause;
  unreadable_life = life;
  next_scan = now + scan_pause;
  scan_wanted = scan_wanted || !all_read;
}

void MasterState::add_robots(Time now) noexcept {
  const std::size_t all = robots.size(), room = in_flight.room();
  for (std::size_t k = 0; k < all; ++k) {
    const std::size_t index = (first_robot + k) % all;
    if (room - std::min(room, in_flight.room()) > kMostServiceBytes) {
      first_robot = index;
      return;
    }
    if (robots[index].life != 0) add_robot(index, now);
  }
}

void MasterState::add_robot(std::size_t index, Time now) noexcept {
  Robot& robot = robots[index];
  const std::uint16_t address = robot.station.station_address();
  const auto purpose = [&](Purpose::Kind kind) {
    return Purpose{kind, robot.generation, static_cast<std::uint16_t>(index)};
  };
  const auto read = [&](std::uint16_t ado, std::uint16_t size, Purpose::Kind kind) {
    return in_flight.add({Command::kFprd, address_of(address, ado), size, {}, purpose(kind)});
  };
  if (robot.al_due || now >= robot.next_al) {
    robot.al_due = !read(reg::kAlStatus, kAlStatusSize, Purpose::Kind::kAlStatus);
    if (!robot.al_due) robot.next_al = now + kAlStatusPeriod;
  }
  if (const auto access = robot.station.next(now))
    in_flight.add({access->write ? Command::kFpwr : Command::kFprd, address_of(address, access->address), access->size,
                   access->data, purpose(Purpose::Kind::kStation)});
  if (robot.errors.clear)
    robot.errors.clear = !in_flight.add({Command::kFpwr,
                                         address_of(address, reg::kRxErrors),
                                         reg::kErrorCountersSize,
                                         {},
                                         purpose(Purpose::Kind::kClearErrorCounters)});
  else if (now >= robot.next_errors && read(reg::kRxErrors, reg::kErrorCountersSize, Purpose::Kind::kErrorCounters))
    robot.next_errors = now + kErrorsPeriod;
  if (clocks.ready() && now >= robot.next_difference && read(reg::kDcDifference, 4, Purpose::Kind::kClockDifference))
    robot.next_difference = now + kDifferencePeriod;
}

void MasterState::service_reply(const Purpose& purpose, std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (purpose.kind == Purpose::Kind::kScan) return scan.answered(purpose, working_counter, data, now);
  if (purpose.kind == Purpose::Kind::kClocks) return clocks.answered(purpose, working_counter, data);
  Robot& robot = robots[purpose.of];
  if (purpose.step != robot.generation || robot.life == 0) return;
  if (purpose.kind == Purpose::Kind::kAlStatus) return al_status_reply(robot, working_counter, data, now);
  if (purpose.kind == Purpose::Kind::kStation) return robot.station.answered(working_counter, data, now);
  if (working_counter != kOneWay) return;
  if (purpose.kind == Purpose::Kind::kErrorCounters) return error_counters_reply(robot, data);
  wire::Reader in(data);
  if (purpose.kind == Purpose::Kind::kClockDifference) robot.counters.dc_difference_ns = clock_difference(in.u32());
  if (purpose.kind == Purpose::Kind::kClearErrorCounters) robot.errors.last = {};
}

void MasterState::service_lost(const Purpose& purpose, Time now) noexcept {
  if (purpose.kind == Purpose::Kind::kScan) return scan.lost(purpose, now);
  if (purpose.kind == Purpose::Kind::kClocks) return clocks.lost(purpose);
  Robot& robot = robots[purpose.of];
  if (purpose.step != robot.generation || robot.life == 0) return;
  if (purpose.kind == Purpose::Kind::kStation) robot.station.lost(now);
  if (purpose.kind == Purpose::Kind::kAlStatus) robot.al_due = true;
}

void MasterState::al_status_reply(Robot& robot, std::uint16_t working_counter, Bytes data, Time now) noexcept {
  if (working_counter != kOneWay) {
    robot.al_due = true;
    if (++robot.silent % kSilentToScan == 0) scan_wanted = true;
    return;
  }
  robot.silent = 0;
  wire::Reader in(data);
  const std::uint16_t status = in.u16();
  in.skip(2);
  robot.station.al_status(status, in.u16(), now);
}

void MasterState::error_counters_reply(Robot& robot, Bytes data) noexcept {
  // Of ports 0 and 1: invalid frames, receive errors; lost links.
  constexpr std::size_t kLinks = reg::kLostLinks - reg::kRxErrors;
  constexpr std::array<std::size_t, 6> kAt{0, 2, 1, 3, kLinks, kLinks + 1};
  const std::array<std::uint32_t*, 6> sums{&robot.counters.invalid_frames[0], &robot.counters.invalid_frames[1],
                                           &robot.counters.rx_errors[0],      &robot.counters.rx_errors[1],
                                           &robot.counters.lost_links[0],     &robot.counters.lost_links[1]};
  ErrorCounterReading& reading = robot.errors;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto value = std::to_integer<std::uint8_t>(data[kAt[i]]);
    // What stood there before us is not ours; fewer than before: somebody cleared them.
    const std::uint8_t more = value >= reading.last[i] ? static_cast<std::uint8_t>(value - reading.last[i]) : value;
    if (reading.known) *sums[i] += more;
    reading.last[i] = value;
    reading.clear = reading.clear || value >= kClearFrom;
  }
  reading.known = true;
}

Time MasterState::next_service_event() const noexcept {
  if (service_in_flight || !any_port()) return Time::max();  // its time-out comes from what is in flight
  Time wanted = Time::max();
  if (scan.running() || clocks.running()) wanted = next_service;
  if (scan_wanted && reached && ports[0] && !closing) wanted = std::min(wanted, next_scan);
  for (const Robot& robot : robots) {
    wanted = std::min(wanted, robot.station.next_event());
    if (robot.life == 0) continue;
    wanted = std::min({wanted, robot.al_due ? next_service : robot.next_al, robot.next_errors});
    if (clocks.ready()) wanted = std::min(wanted, robot.next_difference);
  }
  return std::max(wanted, next_service);
}

}  // namespace meca::ethercat
