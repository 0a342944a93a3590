// The built-in robot as a transport: the simulated Meca500 in the same process, no network at all.
#pragma once

#include <memory>
#include <vector>

#include "sim/robot.hpp"
#include "transports/transport.hpp"

namespace meca::transports {

// One bus with as many simulated robots as there are options, all advancing by the time between two exchanges.
std::unique_ptr<Transport> make_builtin(std::vector<sim::RobotOptions> robots);

}  // namespace meca::transports
