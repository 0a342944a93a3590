#include "tests/bench/eip_scenarios.hpp"

#include <stdlib.h>

#include <algorithm>
#include <future>
#include <sstream>
#include <string>

#include "tests/bench/bridge_process.hpp"
#include "tests/bench/clock.hpp"
#include "tests/bench/eip_cell.hpp"
#include "tests/bench/process.hpp"
#include "tests/bench/status_watch.hpp"

namespace meca::bench {
namespace {

using json = nlohmann::ordered_json;
using namespace std::chrono_literals;
using std::chrono::milliseconds;
using std::chrono::seconds;

std::string configuration(const Setting& setting, int robots, milliseconds interval, bool whole_image = false) {
  std::ostringstream out;
  out << "dds:\n  domain: " << setting.domain << "\n";
  if (whole_image) out << "  topics:\n    CyclicState: {rate: every_cycle}\n";
  out << "log: {level: error}\nethernet_ip: {bind: " << kEipHost << "}\nrobots:\n";
  for (int i = 0; i < robots; ++i) {
    out << "  - {name: arm" << i << ", cycle: " << interval.count()
        << "ms, transport: {type: ethernet_ip, address: " << eip_address(i)
        << ", fast: true, timeout_multiplier: 128}}\n";
  }
  return out.str();
}

std::string name_of(milliseconds interval) { return std::to_string(interval.count()) + " ms"; }

// Runs until it is told to stop.
std::vector<std::string> bare_sender(const Setting& setting, milliseconds interval, int streams) {
  auto command = role("bare-sender", setting, setting.duration + 10s);
  command.insert(command.end(), {"--period-us", std::to_string(std::chrono::microseconds(interval).count()),
                                 "--streams", std::to_string(streams)});
  return command;
}

double load() {
  double average = 0;
  return getloadavg(&average, 1) == 1 ? average : 0;
}

}  // namespace

json measure_eip_period(const Setting& setting) {
  json result;
  for (const milliseconds interval : {10ms, 2ms}) {
    EipCell cell(1);
    BridgeProcess bridge(setting, configuration(setting, 1, interval));
    cell.run_until_connected();
    Process sender(bare_sender(setting, interval, 1));
    cell.run(2s);  // start-up is not measured
    cell.restart();
    cell.run(setting.duration);
    const Arrivals ours = cell.arrivals();
    const PeriodStatistics bare = cell.bare_periods();
    json& row = result[name_of(interval)];
    row["periods"] = ours.periods.count();
    row["lost"] = ours.lost;
    row["mean_us"] = ours.periods.mean_us();
    row["deviation_us"] = ours.periods.deviation_us();
    row["max_us"] = ours.periods.max_us();
    row["bare_mean_us"] = bare.mean_us();
    row["bare_deviation_us"] = bare.deviation_us();
    row["bare_max_us"] = bare.max_us();
    row["deviation_ratio"] = ratio(row["deviation_us"], row["bare_deviation_us"]);
    row["max_ratio"] = ratio(row["max_us"], row["bare_max_us"]);
    row["load"] = load();
    sender.kill();
    bridge.process.stop();
  }
  return result;
}

json measure_eip_latency(const Setting& setting) {
  json result;
  for (const milliseconds interval : {10ms, 2ms}) {
    json ours, raw;
    {
      EipCell cell(1);
      BridgeProcess bridge(setting, configuration(setting, 1, interval, true));
      cell.run_until_connected();
      auto command = role("latency-reader", setting, setting.duration);
      command.push_back("--from-robot");
      Process reader(command);
      while (reader.running()) cell.run(50ms);
      ours = json::parse(reader.finish());
      bridge.process.stop();
    }
    {
      auto command = role("raw-writer", setting, setting.duration + 5s);
      command.insert(command.end(), {"--whole-image", "--rate", std::to_string(1s / interval)});
      Process writer(command);
      Process reader(role("latency-reader", setting, setting.duration));
      raw = json::parse(reader.finish());
      writer.finish();
    }
    json& row = result[name_of(interval)];
    for (const char* figure : {"samples", "p50_us", "p99_us", "to_bridge_p50_us", "to_bridge_p99_us"})
      row[figure] = ours[figure];
    row["raw_p50_us"] = raw["p50_us"];
    row["raw_p99_us"] = raw["p99_us"];
    row["p50_ratio"] = ratio(ours["p50_us"], raw["p50_us"]);
    row["p99_ratio"] = ratio(ours["p99_us"], raw["p99_us"]);
    row["load"] = load();
  }
  return result;
}

json measure_eip_robots(const Setting& setting) {
  constexpr milliseconds kInterval = 10ms;
  json result = json::array();
  for (const int robots : {1, 8, 32}) {
    EipCell cell(robots);
    BridgeProcess bridge(setting, configuration(setting, robots, kInterval));
    StatusWatch watch(setting);
    const auto run = [&](seconds duration) {
      auto beside = std::async(std::launch::async, [&] { watch.run(duration); });
      cell.run(duration);
      beside.get();
    };
    cell.run_until_connected();
    Process sender(bare_sender(setting, kInterval, robots));
    run(3s);  // start-up and discovery are not measured
    cell.restart();
    const auto missed_before = watch.most_missed_cycles();
    const auto lost_before = watch.total_of_counter("lost_packets");
    const auto skipped_before = watch.total_of_counter("skipped_sends");
    const double cpu_before = bridge.process.cpu_seconds(), bare_cpu_before = sender.cpu_seconds();
    run(setting.duration);
    const double cpu_after = bridge.process.cpu_seconds(), bare_cpu_after = sender.cpu_seconds();
    const Arrivals ours = cell.arrivals();
    const PeriodStatistics bare = cell.bare_periods();
    const auto length = static_cast<double>(setting.duration.count());
    json row;
    row["robots"] = robots;
    row["bridge_cpu_percent"] = 100 * (cpu_after - cpu_before) / length;
    row["bare_cpu_percent"] = 100 * (bare_cpu_after - bare_cpu_before) / length;
    row["periods"] = ours.periods.count();
    row["lost_o_to_t"] = ours.lost;
    row["lost_t_to_o"] = watch.total_of_counter("lost_packets") - lost_before;
    row["skipped_sends"] = watch.total_of_counter("skipped_sends") - skipped_before;
    row["timeouts"] = cell.timeouts();
    row["missed_cycles"] = watch.most_missed_cycles() - missed_before;
    row["deviation_us"] = ours.periods.deviation_us();
    row["max_us"] = ours.periods.max_us();
    row["bare_deviation_us"] = bare.deviation_us();
    row["bare_max_us"] = bare.max_us();
    row["deviation_ratio"] = ratio(row["deviation_us"], row["bare_deviation_us"]);
    row["load"] = load();
    result.push_back(row);
    sender.kill();
    bridge.process.stop();
  }
  return result;
}

}  // namespace meca::bench
