// What a bridge says of itself while it is measured.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "bridge/dds.hpp"
#include "idl/types.hpp"
#include "tests/bench/scenarios.hpp"

namespace meca::bench {

// 0 for one that the transport does not have.
long long counter_of(const meca500::BridgeStatus& status, std::string_view name);

// The last BridgeStatus of every robot, and the worst and the mean of the lateness they reported on the way.
struct StatusWatch {
  explicit StatusWatch(const Setting& setting);

  void run(std::chrono::seconds duration);  // throws std::runtime_error when no BridgeStatus has ever arrived
  unsigned long long total(const std::function<unsigned long long(const meca500::BridgeStatus&)>& of) const;
  // Of the robots' missed cycles the most: those of one bus miss them together.
  unsigned long long most_missed_cycles() const;
  // Of a transport counter, all robots together; 0 for one that the transport does not have.
  long long total_of_counter(std::string_view name) const;

  std::function<void(const meca500::BridgeStatus&)> each;  // called with every one, if set
  dds::Participant participant;
  dds::Reader<meca500::BridgeStatus> reader;
  std::map<std::string, meca500::BridgeStatus> last;
  double lateness_max_us = 0, mean_sum_us = 0;
  long means = 0;
};

}  // namespace meca::bench
