#include "tests/bench/status_watch.hpp"

#include <algorithm>
#include <stdexcept>

#include "tests/bench/clock.hpp"

namespace meca::bench {
namespace {

dds::ParticipantOptions options(const Setting& setting) {
  dds::ParticipantOptions o;
  o.domain = setting.domain;
  o.name = "bench-status";
  return o;
}

}  // namespace

long long counter_of(const meca500::BridgeStatus& status, std::string_view name) {
  for (const auto& counter : status.transport_counters()) {
    if (std::string_view(counter.name().c_str()) == name) return counter.value();
  }
  return 0;
}

StatusWatch::StatusWatch(const Setting& setting) : participant(options(setting)) {
  reader = participant.create_reader<meca500::BridgeStatus>(
      "meca500/BridgeStatus", {dds::Reliability::kReliable, dds::Durability::kTransientLocal, 10});
}

void StatusWatch::run(std::chrono::seconds duration) {
  const auto end = monotonic_now() + duration;
  lateness_max_us = 0;
  mean_sum_us = 0;
  means = 0;
  meca500::BridgeStatus sample;
  dds::SampleInfo info;
  while (monotonic_now() < end) {
    participant.wait_for_data(std::chrono::milliseconds(100));
    while (reader.take(sample, info)) {
      if (!info.valid_data) continue;
      last[sample.robot().c_str()] = sample;
      lateness_max_us = std::max(lateness_max_us, static_cast<double>(sample.wakeup_lateness_max_us()));
      mean_sum_us += sample.wakeup_lateness_mean_us();
      ++means;
      if (each) each(sample);
    }
  }
  if (last.empty())
    throw std::runtime_error("no BridgeStatus arrived within " + std::to_string(duration.count()) + " s");
}

unsigned long long StatusWatch::total(const std::function<unsigned long long(const meca500::BridgeStatus&)>& of) const {
  unsigned long long sum = 0;
  for (const auto& [robot, status] : last) sum += of(status);
  return sum;
}

unsigned long long StatusWatch::most_missed_cycles() const {
  unsigned long long most = 0;
  for (const auto& [robot, status] : last) most = std::max<unsigned long long>(most, status.missed_cycles());
  return most;
}

long long StatusWatch::total_of_counter(std::string_view name) const {
  long long sum = 0;
  for (const auto& [robot, status] : last) sum += counter_of(status, name);
  return sum;
}

}  // namespace meca::bench
