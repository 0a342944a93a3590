#include "tests/bench/ethercat_scenarios.hpp"

#include <stdlib.h>

#include <algorithm>
#include <future>
#include <sstream>
#include <string>

#include "tests/bench/bare_ethernet.hpp"
#include "tests/bench/bridge_process.hpp"
#include "tests/bench/clock.hpp"
#include "tests/bench/ethercat_cable.hpp"
#include "tests/bench/ethercat_cell.hpp"
#include "tests/bench/process.hpp"
#include "tests/bench/status_watch.hpp"

namespace meca::bench {
namespace {

using json = nlohmann::ordered_json;
using namespace std::chrono_literals;
using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr seconds kStartUp = 3s;  // and discovery: not measured

std::string configuration(const Setting& setting, int robots, bool whole_image = false) {
  std::ostringstream out;
  out << "dds:\n  domain: " << setting.domain << "\n";
  if (whole_image) out << "  topics:\n    CyclicState: {rate: every_cycle}\n";
  out << "realtime: {priority: " << kPriority << "}\n";
  // The machine may be busy: robots that leave OP would hide what is measured.
  out << "log: {level: error}\nethercat:\n  segments:\n    - {interface: " << kMasterInterface
      << ", watchdog: 500ms}\nrobots:\n";
  for (int i = 0; i < robots; ++i) {
    out << "  - {name: arm" << i << ", cycle: 1ms, transport: {type: ethercat, interface: " << kMasterInterface
        << ", position: " << i << "}}\n";
  }
  return out.str();
}

double load() {
  double average = 0;
  return getloadavg(&average, 1) == 1 ? average : 0;
}

std::vector<std::string> bare_loop(const Setting& setting, const EthercatCell& cell) {
  auto command = role("bare-ethernet", setting, setting.duration);
  const nanoseconds begin = cell.last_cycle() + 500ms + 500us;  // half a cycle from the bridge's
  command.insert(command.end(), {"--begin-ns", std::to_string(begin.count())});
  for (const std::size_t size : cell.frames_of_a_cycle())
    command.insert(command.end(), {"--frame", std::to_string(size)});
  return command;
}

// One measurement of both, and what each said of it.
struct Comparison {
  json bare;
  RoundTrips trips;
  long long cycles = 0, missed_cycles = 0, lost_frames = 0, late_frames = 0, working_counter_misses = 0, losses = 0;
  double cpu_percent = 0, bare_cpu_percent = 0;
};

// Counters since the bridge began, of the segment or summed up over the robots.
struct Counts {
  long long missed_cycles, lost_frames, late_frames, working_counter_misses, losses;
  explicit Counts(const StatusWatch& watch)
      : missed_cycles(static_cast<long long>(watch.most_missed_cycles())),
        lost_frames(of_segment(watch, "lost_frames")),
        late_frames(of_segment(watch, "late_frames")),
        working_counter_misses(watch.total_of_counter("working_counter_misses")),
        losses(watch.total_of_counter("losses")) {}
  static long long of_segment(const StatusWatch& watch, const char* name) {
    return counter_of(watch.last.begin()->second, name);
  }
};

Comparison compare(const Setting& setting, EthercatCell& cell, BridgeProcess& bridge) {
  Comparison out;
  StatusWatch watch(setting);
  const auto run = [&](seconds duration) {
    auto beside = std::async(std::launch::async, [&] { watch.run(duration); });
    cell.run(duration);
    beside.get();
  };
  cell.run_until_operational();
  Process loop(bare_loop(setting, cell));
  run(kStartUp);
  cell.restart();
  const Counts before(watch);
  watch.each = [&](const meca500::BridgeStatus& status) {
    if (std::string_view(status.robot().c_str()) != "arm0") return;
    out.trips.second({.p50 = counter_of(status, "round_trip_p50"),
                      .p99 = counter_of(status, "round_trip_p99"),
                      .max = counter_of(status, "round_trip_max")});
  };
  const double cpu_before = bridge.process.cpu_seconds(), bare_before = loop.cpu_seconds();
  run(setting.duration - 1s);
  const double cpu_after = bridge.process.cpu_seconds(), bare_after = loop.cpu_seconds();
  const Counts after(watch);
  while (loop.running()) cell.run(50ms);
  out.bare = json::parse(loop.finish());
  const auto percent = 100 / static_cast<double>((setting.duration - 1s).count());
  out.cpu_percent = percent * (cpu_after - cpu_before);
  out.bare_cpu_percent = percent * (bare_after - bare_before);
  out.missed_cycles = after.missed_cycles - before.missed_cycles;
  out.lost_frames = after.lost_frames - before.lost_frames;
  out.late_frames = after.late_frames - before.late_frames;
  out.working_counter_misses = after.working_counter_misses - before.working_counter_misses;
  out.losses = after.losses - before.losses;
  return out;
}

json rhythm_row(Rhythm& rhythm) {
  return {{"cycles", rhythm.periods.count()},
          {"mean_us", rhythm.periods.mean_us()},
          {"deviation_us", rhythm.periods.deviation_us()},
          {"off_p50_us", percentile(rhythm.off_us, 0.5)},
          {"off_p99_us", percentile(rhythm.off_us, 0.99)},
          {"off_max_us", percentile(rhythm.off_us, 1)}};
}

}  // namespace

json measure_ethercat_period(const Setting& setting) {
  const EthercatCable cable;
  json result;
  for (const int robots : {1, 8}) {
    EthercatCell cell(robots);
    BridgeProcess bridge(setting, configuration(setting, robots));
    const Comparison got = compare(setting, cell, bridge);
    bridge.process.stop();
    json ours = rhythm_row(cell.rhythm()), bare = rhythm_row(cell.bare_rhythm()), ratios;
    ours["trip_p50_us"] = got.trips.p50_us();
    ours["trip_p99_us"] = got.trips.p99_us();
    ours["trip_max_us"] = got.trips.max_us();
    ours["robots_us"] = cell.robots_us();
    ours["missed_cycles"] = got.missed_cycles;
    ours["lost_frames"] = got.lost_frames;
    ours["real_time"] = cell.real_time();
    ours["load"] = load();
    for (const char* figure : {"trip_p50_us", "trip_p99_us", "trip_max_us"}) bare[figure] = got.bare[figure];
    bare["missed_cycles"] = got.bare["missed_cycles"];
    bare["lost_frames"] = got.bare["lost"];
    for (const char* figure :
         {"deviation_us", "off_p50_us", "off_p99_us", "off_max_us", "trip_p50_us", "trip_p99_us", "trip_max_us"})
      ratios[figure] = ratio(ours[figure], bare[figure]);
    const std::string name = std::to_string(robots) + (robots == 1 ? " robot, " : " robots, ");
    result[name + "bridge"] = ours;
    result[name + "bare"] = bare;
    result[name + "ratio"] = ratios;
  }
  return result;
}

json measure_ethercat_latency(const Setting& setting) {
  const EthercatCable cable;
  json ours, raw, result;
  bool real_time = false;
  {
    EthercatCell cell(1, true);
    BridgeProcess bridge(setting, configuration(setting, 1, true));
    cell.run_until_operational();
    auto command = role("latency-reader", setting, setting.duration);
    command.push_back("--from-robot");
    Process reader(command);
    while (reader.running()) cell.run(50ms);
    ours = json::parse(reader.finish());
    real_time = cell.real_time();
    bridge.process.stop();
  }
  {
    auto command = role("raw-writer", setting, setting.duration + 5s);
    command.insert(command.end(), {"--whole-image", "--rate", "1000"});
    Process writer(command);
    Process reader(role("latency-reader", setting, setting.duration));
    raw = json::parse(reader.finish());
    writer.finish();
  }
  json& row = result["1 ms"];
  for (const char* figure : {"samples", "p50_us", "p99_us", "to_bridge_p50_us", "to_bridge_p99_us"})
    row[figure] = ours[figure];
  row["raw_p50_us"] = raw["p50_us"];
  row["raw_p99_us"] = raw["p99_us"];
  row["p50_ratio"] = ratio(ours["p50_us"], raw["p50_us"]);
  row["p99_ratio"] = ratio(ours["p99_us"], raw["p99_us"]);
  row["real_time"] = real_time;
  row["load"] = load();
  return result;
}

json measure_ethercat_robots(const Setting& setting) {
  const EthercatCable cable;
  json result = json::array();
  for (const int robots : {1, 8, 16, 32}) {
    EthercatCell cell(robots);
    BridgeProcess bridge(setting, configuration(setting, robots));
    const Comparison got = compare(setting, cell, bridge);
    bridge.process.stop();
    json row;
    row["robots"] = robots;
    row["frames"] = cell.frames_of_a_cycle().size();
    row["bridge_cpu_percent"] = got.cpu_percent;
    row["bare_cpu_percent"] = got.bare_cpu_percent;
    row["cycles"] = cell.rhythm().periods.count();
    row["missed_cycles"] = got.missed_cycles;
    row["bare_missed"] = got.bare["missed_cycles"];
    row["lost_frames"] = got.lost_frames;
    row["bare_lost"] = got.bare["lost"];
    row["late_frames"] = got.late_frames;
    row["wkc_misses"] = got.working_counter_misses;
    row["losses"] = got.losses;
    row["trip_p50_us"] = got.trips.p50_us();
    row["bare_p50_us"] = got.bare["trip_p50_us"];
    row["trip_p99_us"] = got.trips.p99_us();
    row["bare_p99_us"] = got.bare["trip_p99_us"];
    row["robots_us"] = cell.robots_us();
    row["real_time"] = cell.real_time();
    row["load"] = load();
    result.push_back(row);
  }
  return result;
}

}  // namespace meca::bench
