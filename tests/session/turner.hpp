// The EtherNet/IP transport turned as the bridge's loop turns it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/session/adapter_host.hpp"
#include "tests/session/bus_turner.hpp"
#include "transports/ethernet_ip/transport.hpp"

namespace meca::test {

using ethernet_ip::Time;

inline constexpr Time kCycle = 10ms;

inline const std::string kBridge = "127.0.7.1", kArm1 = "127.0.7.2", kArm2 = "127.0.7.3";

inline ethernet_ip::BusOptions usual_bus() {
  ethernet_ip::BusOptions out;
  out.bind = net::parse_ipv4(kBridge).value();
  out.name = "test";
  return out;
}

inline ethernet_ip::RobotOptions robot(const std::string& address) {
  ethernet_ip::RobotOptions out;
  out.address = address;
  out.timeout_multiplier = 64;  // 640 ms: the machine may be busy
  return out;
}

class Turner : public BusTurner {
 public:
  explicit Turner(const std::vector<ethernet_ip::RobotOptions>& robots,
                  const ethernet_ip::BusOptions& options = usual_bus(), Time cycle = kCycle)
      : BusTurner(ethernet_ip::make_transport(robots, options), robots.size(), cycle) {}
};

}  // namespace meca::test
