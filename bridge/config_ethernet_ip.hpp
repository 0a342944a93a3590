// The EtherNet/IP parts of the configuration: the section of the bus, and the transport of a robot.
#pragma once

#include <chrono>
#include <vector>

#include "bridge/config.hpp"
#include "bridge/config_reader.hpp"

namespace meca::bridge {

EthernetIpBusConfig read_ethernet_ip_bus(const Section& root, const std::vector<RobotConfig>& robots);

void read_ethernet_ip(const Section& transport, EthernetIpConfig& out);
// What the shortest cycle and RPI are: the minimum of the vendor's EDS 11.3, unless the device is said to be faster.
std::chrono::nanoseconds shortest_rpi(const EthernetIpConfig& config);
// Once the robot's cycle is known: RPI and cycle, and the watchdog that follows from them.
void settle_ethernet_ip(const Section& transport, std::chrono::nanoseconds cycle, EthernetIpConfig& config);

}  // namespace meca::bridge
