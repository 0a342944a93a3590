#include "transports/ethercat/bus_counters.hpp"

#include <algorithm>
#include <array>

namespace meca::ethercat {
namespace {

constexpr std::array<transports::CounterInfo, 30> kInfo{{
    {"al_state", ""},
    {"al_status_code", ""},
    {"images", ""},
    {"working_counter_misses", ""},
    {"losses", ""},
    {"emergencies", ""},
    {"emergency_code", ""},
    {"sdo_aborts", ""},
    {"mailbox_repeats", ""},
    {"lost_frames", ""},
    {"late_frames", ""},
    {"unexpected_frames", ""},
    {"malformed_frames", ""},
    {"failed_sends", ""},
    {"round_trip_p50", "us"},
    {"round_trip_p99", "us"},
    {"round_trip_p999", "us"},
    {"round_trip_max", "us"},
    {"wake_up_p50", "us"},
    {"wake_up_p99", "us"},
    {"wake_up_p999", "us"},
    {"wake_up_max", "us"},
    {"dc_difference", "ns"},
    {"port0_invalid_frames", ""},
    {"port1_invalid_frames", ""},
    {"port0_rx_errors", ""},
    {"port1_rx_errors", ""},
    {"port0_lost_links", ""},
    {"port1_lost_links", ""},
    {"ring_open", ""},
}};
static_assert(kInfo.size() <= transports::kMostCounters);

constexpr std::int64_t number(std::uint64_t value) noexcept { return static_cast<std::int64_t>(value); }

}  // namespace

std::span<const transports::CounterInfo> bus_counters() noexcept { return kInfo; }

void count(const Master& master, std::size_t robot, const BusFacts& facts, std::span<std::int64_t> out) noexcept {
  const Station& station = master.station(robot);
  const StationCounters& s = station.counters();
  const RobotCounters& r = master.counters(robot);
  const MasterCounters& m = master.counters();
  const Histogram::Facts &trip = master.round_trip().facts(), &late = facts.wake_up.facts();
  const auto values = std::to_array<std::int64_t>({
      station.last_al_status(),
      station.last_al_code(),
      number(r.images),
      number(r.working_counter_misses),
      number(r.losses),
      number(s.emergencies),
      station.last_emergency() ? station.last_emergency()->code : 0,
      number(s.sdo_aborts),
      number(s.mailbox_repeats),
      number(m.lost_frames),
      number(m.late_frames),
      number(m.unexpected_frames),
      number(m.malformed_frames),
      number(facts.failed_sends),
      trip.p50,
      trip.p99,
      trip.p999,
      trip.max,
      late.p50,
      late.p99,
      late.p999,
      late.max,
      r.dc_difference_ns,
      r.invalid_frames[0],
      r.invalid_frames[1],
      r.rx_errors[0],
      r.rx_errors[1],
      r.lost_links[0],
      r.lost_links[1],
      master.ring_open() ? 1 : 0,
  });
  static_assert(values.size() == kInfo.size());
  std::ranges::copy(values, out.begin());
}

}  // namespace meca::ethercat
