#include "tests/bench/readers.hpp"

#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bridge/dds.hpp"
#include "idl/types.hpp"
#include "tests/bench/clock.hpp"

namespace meca::bench {
namespace {

constexpr dds::Qos kReliable{dds::Reliability::kReliable, dds::Durability::kVolatile, 1};
constexpr dds::Qos kReliableDeep{dds::Reliability::kReliable, dds::Durability::kVolatile, 64};  // misses nothing

dds::ParticipantOptions participant(int domain) {
  dds::ParticipantOptions options;
  options.shared_memory = false;  // as the bridge by default; then the raw writer beside it is read over UDP too
  options.domain = domain;
  options.name = "bench-reader";
  return options;
}

std::int64_t robot_stamp_ns(const meca500::CyclicState& sample) {
  const auto& stamp = sample.robot_timestamp();
  return (static_cast<std::int64_t>(stamp.seconds()) * 1'000'000 + stamp.microseconds()) * 1000;
}

// Takes everything that a topic has; returns how much that was.
template <typename T>
std::function<long()> counter(dds::Participant& p, const char* name) {
  auto reader = p.create_reader<T>(std::string("meca500/") + name, kReliableDeep);
  return [reader, sample = T()]() mutable {
    long n = 0;
    dds::SampleInfo info;
    while (reader.take(sample, info)) n += info.valid_data;
    return n;
  };
}

}  // namespace

void run_latency_reader(int domain, std::chrono::seconds duration, bool from_robot) {
  dds::Participant p(participant(domain));
  auto reader = p.create_reader<meca500::CyclicState>("meca500/CyclicState", kReliable);
  meca500::CyclicState sample;
  dds::SampleInfo info;
  std::vector<double> latencies_us, to_bridge_us;
  latencies_us.reserve(1'000'000);
  to_bridge_us.reserve(1'000'000);
  std::int64_t last_image_ns = 0;
  // Time runs from the first sample: discovery is not what is measured.
  std::chrono::nanoseconds end = monotonic_now() + std::chrono::seconds(20);
  while (monotonic_now() < end) {
    p.wait_for_data(std::chrono::milliseconds(100));
    while (reader.take(sample, info)) {
      if (!info.valid_data) continue;
      if (latencies_us.empty()) end = monotonic_now() + duration;
      const std::int64_t now = unix_now_ns(), received = sample.header().receive_time_ns();
      const std::int64_t begin = from_robot ? robot_stamp_ns(sample) : received;
      if (from_robot && begin == last_image_ns) continue;
      last_image_ns = begin;
      latencies_us.push_back(static_cast<double>(now - begin) / 1000.0);
      to_bridge_us.push_back(static_cast<double>(received - begin) / 1000.0);
    }
  }
  nlohmann::json result;
  result["samples"] = latencies_us.size();
  result["p50_us"] = percentile(latencies_us, 0.50);
  result["p99_us"] = percentile(latencies_us, 0.99);
  if (from_robot) {
    result["to_bridge_p50_us"] = percentile(to_bridge_us, 0.50);
    result["to_bridge_p99_us"] = percentile(to_bridge_us, 0.99);
  }
  std::printf("%s\n", result.dump().c_str());
}

void run_counting_reader(int domain, std::chrono::seconds duration) {
  dds::Participant p(participant(domain));
  std::vector<std::function<long()>> topics;
  topics.push_back(counter<meca500::RobotStatus>(p, "RobotStatus"));
  topics.push_back(counter<meca500::MotionStatus>(p, "MotionStatus"));
  topics.push_back(counter<meca500::TargetJointSet>(p, "TargetJointSet"));
  topics.push_back(counter<meca500::TargetEndEffectorPose>(p, "TargetEndEffectorPose"));
  topics.push_back(counter<meca500::TargetConfiguration>(p, "TargetConfiguration"));
  topics.push_back(counter<meca500::TargetWrf>(p, "TargetWrf"));
  topics.push_back(counter<meca500::TargetTrf>(p, "TargetTrf"));
  topics.push_back(counter<meca500::RobotTimestamp>(p, "RobotTimestamp"));
  topics.push_back(counter<meca500::SafetyStatus>(p, "SafetyStatus"));
  topics.push_back(counter<meca500::DynamicData>(p, "DynamicData"));
  topics.push_back(counter<meca500::BridgeStatus>(p, "BridgeStatus"));
  long samples = 0;
  const auto begin = monotonic_now();
  while (monotonic_now() < begin + duration) {
    p.wait_for_data(std::chrono::milliseconds(100));
    for (auto& take_all : topics) samples += take_all();
  }
  nlohmann::json result;
  result["samples"] = samples;
  result["per_second"] = static_cast<double>(samples) / static_cast<double>(duration.count());
  std::printf("%s\n", result.dump().c_str());
}

}  // namespace meca::bench
