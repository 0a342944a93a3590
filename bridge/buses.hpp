// The buses that a configuration asks for, opened, and which of them share a thread.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bridge/config.hpp"
#include "bridge/loop.hpp"

namespace meca::bridge {

// What one Loop will own.
struct LoopPlan {
  Time cycle{};
  std::vector<LoopBus> buses;
  struct Robot {
    std::size_t index;  // in the configuration
    std::span<const transports::CounterInfo> counters;
  };
  std::vector<Robot> robots;
};

// Built-in robots with the same cycle share a thread; all EtherNet/IP robots are one bus with a thread of its own, and
// so are the robots of an EtherCAT segment. Throws std::runtime_error with a sentence for the user. `channels`: one per
// robot, in the order of the configuration.
std::vector<LoopPlan> open_buses(const Config& config, const std::vector<std::unique_ptr<RobotChannel>>& channels);

}  // namespace meca::bridge
