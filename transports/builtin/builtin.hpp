// The built-in robot as a transport: the simulated Meca500 in the same process, no network at all.
#pragma once

#include <memory>
#include <vector>

#include "sim/robot.hpp"
#include "transports/panel/control_panel.hpp"
#include "transports/transport.hpp"

namespace meca::transports {

// One bus with as many simulated robots as there are options, all advancing by the time between two exchanges.
// `panels`: their control sockets in the same order, nullptr (or none at all) for robots without one.
std::unique_ptr<Transport> make_builtin(std::vector<sim::RobotOptions> robots,
                                        std::vector<std::unique_ptr<ControlPanel>> panels = {});

}  // namespace meca::transports
