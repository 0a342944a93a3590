// The robots: part of the configuration.
#pragma once

#include <vector>

#include "bridge/config_reader.hpp"

namespace meca::bridge {

std::vector<RobotConfig> read_robots(const Section& root);

}  // namespace meca::bridge
