#include "tests/bench/scenarios.hpp"

#include <signal.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <thread>

#include "tests/bench/bridge_process.hpp"
#include "tests/bench/clock.hpp"
#include "tests/bench/process.hpp"
#include "tests/bench/status_watch.hpp"

namespace meca::bench {
namespace {

using json = nlohmann::ordered_json;
using std::chrono::seconds;

std::string configuration(const Setting& setting, int robots, bool whole_image = false) {
  std::ostringstream out;
  out << "dds:\n  domain: " << setting.domain << "\n";
  if (whole_image) out << "  topics:\n    CyclicState: {rate: every_cycle}\n";
  out << "log: {level: warn}\nrobots:\n";
  for (int i = 0; i < robots; ++i) {
    out << "  - {name: arm" << i << ", cycle: 1ms, transport: {type: builtin}}\n";
  }
  return out.str();
}

struct BareLoop {
  double mean_us = 0, max_us = 0;
  long cycles = 0, missed = 0;  // missed: woken after the next deadline
};

BareLoop bare_loop(seconds duration) {
  BareLoop result;
  double sum = 0;
  const auto end = monotonic_now() + duration;
  for (auto deadline = monotonic_now(); deadline < end;) {
    deadline += std::chrono::milliseconds(1);
    sleep_until(deadline);
    const auto late = monotonic_now() - deadline;
    const double us = std::chrono::duration<double, std::micro>(late).count();
    sum += us;
    result.max_us = std::max(result.max_us, us);
    ++result.cycles;
    const long skipped = late / std::chrono::milliseconds(1);
    result.missed += skipped;
    deadline += std::chrono::milliseconds(skipped);
  }
  result.mean_us = sum / static_cast<double>(std::max(result.cycles, 1L));
  return result;
}

}  // namespace

json measure_latency(const Setting& setting) {
  json result;
  {
    BridgeProcess bridge(setting, configuration(setting, 1, true));
    Process reader(role("latency-reader", setting, setting.duration));
    result["bridge"] = json::parse(reader.finish());
    bridge.process.stop();
  }
  {
    auto command = role("raw-writer", setting, setting.duration + seconds(5));
    command.insert(command.end(), {"--whole-image", "--rate", "1000"});
    Process writer(command);
    Process reader(role("latency-reader", setting, setting.duration));
    result["raw_fast_dds"] = json::parse(reader.finish());
    writer.finish();
  }
  for (const char* figure : {"p50_us", "p99_us"}) {
    result["ratio"][figure] = ratio(result["bridge"][figure], result["raw_fast_dds"][figure]);
  }
  return result;
}

json measure_cpu(const Setting& setting) {
  json result = json::array();
  for (const int robots : {1, 4, 16, 64}) {
    json row;
    row["robots"] = robots;
    {
      BridgeProcess bridge(setting, configuration(setting, robots));
      std::this_thread::sleep_for(seconds(3));  // start-up and discovery are not measured
      Process reader(role("counting-reader", setting, setting.duration));
      std::this_thread::sleep_for(seconds(1));
      row["bridge_cpu"] = cpu_share(bridge.process, setting.duration - seconds(2));
      row["writes_per_second"] = json::parse(reader.finish())["per_second"];
      bridge.process.stop();
    }
    {
      auto command = role("raw-writer", setting, setting.duration + seconds(4));
      command.insert(command.end(), {"--robots", std::to_string(robots), "--rate",
                                     std::to_string(row["writes_per_second"].get<double>())});
      Process writer(command);
      Process reader(role("counting-reader", setting, setting.duration));
      std::this_thread::sleep_for(seconds(2));
      row["raw_fast_dds_cpu"] = cpu_share(writer, setting.duration - seconds(2));
      reader.finish();
      writer.finish();
    }
    row["bridge_cpu_per_robot"] = row["bridge_cpu"].get<double>() / robots;
    row["ratio"] = ratio(row["bridge_cpu"], row["raw_fast_dds_cpu"]);
    result.push_back(row);
  }
  return result;
}

json measure_wakeup(const Setting& setting) {
  json result;
  {
    BridgeProcess bridge(setting, configuration(setting, 1));
    StatusWatch watch(setting);
    watch.run(seconds(3));
    watch.run(setting.duration);
    result["bridge"] = {{"mean_us", watch.mean_sum_us / static_cast<double>(std::max(watch.means, 1L))},
                        {"max_us", watch.lateness_max_us}};
    bridge.process.stop();
  }
  const BareLoop bare = bare_loop(setting.duration);
  result["clock_nanosleep"] = {{"mean_us", bare.mean_us}, {"max_us", bare.max_us}};
  for (const char* figure : {"mean_us", "max_us"}) {
    result["ratio"][figure] = ratio(result["bridge"][figure], result["clock_nanosleep"][figure]);
  }
  return result;
}

json measure_stopped_reader(const Setting& setting) {
  json result;
  BridgeProcess bridge(setting, configuration(setting, 4));
  StatusWatch watch(setting);
  watch.run(seconds(3));
  const auto phase = [&](const char* name) {
    const auto missed = [](const auto& s) { return s.missed_cycles(); };
    const auto cycles = [](const auto& s) { return s.cycles(); };
    const auto missed_before = watch.total(missed), cycles_before = watch.total(cycles);
    // The bare loop runs beside the bridge: what it misses too was the machine's doing, not ours.
    BareLoop bare;
    std::thread beside([&] { bare = bare_loop(setting.duration); });
    watch.run(setting.duration);
    beside.join();
    result[name] = {{"cycles", watch.total(cycles) - cycles_before},
                    {"missed_cycles", watch.total(missed) - missed_before},
                    {"lateness_max_us", watch.lateness_max_us},
                    {"bare_loop_missed", bare.missed},
                    {"bare_loop_lateness_max_us", bare.max_us}};
  };
  phase("no_reader");
  Process reader(role("counting-reader", setting, setting.duration * 2 + seconds(60)));
  std::this_thread::sleep_for(seconds(2));
  phase("reader");
  reader.signal(SIGSTOP);
  phase("reader_stopped");
  reader.signal(SIGCONT);
  bridge.process.stop();
  return result;
}

}  // namespace meca::bench
