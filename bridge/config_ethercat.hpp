// The EtherCAT parts of the configuration: the segments, and the transport of a robot.
#pragma once

#include <chrono>
#include <vector>

#include "bridge/config.hpp"
#include "bridge/config_reader.hpp"

namespace meca::bridge {

// Slower, and its process data would look dead to the robots' own watchdogs.
inline constexpr std::chrono::nanoseconds kLongestEthercatCycle = std::chrono::milliseconds(20);

// One of every interface that an EtherCAT robot names: as the section says, else with the defaults.
std::vector<EthercatSegmentConfig> read_ethercat_segments(const Section& root, const std::vector<RobotConfig>& robots);

void read_ethercat(const Section& transport, EthercatConfig& out);

}  // namespace meca::bridge
