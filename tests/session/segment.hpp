// An EtherCAT segment in a network namespace of its own: the bridge's end on eth1, robots on robot1; for rings eth2 and
// robot2 as well.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/network_namespace.hpp"
#include "tests/session/bus_turner.hpp"
#include "tests/session/chain_host.hpp"
#include "transports/ethercat/transport.hpp"

namespace meca::test {

inline ethercat::BusOptions usual_segment() {
  ethercat::BusOptions out;
  out.interface = "eth1";
  out.watchdog = 1s;  // the machine may be busy
  return out;
}

inline std::vector<ethercat::RobotPlace> first(std::size_t robots) {
  std::vector<ethercat::RobotPlace> out(robots);
  for (std::size_t i = 0; i < robots; ++i) out[i].position = static_cast<std::uint16_t>(i);
  return out;
}

inline ChainOptions chain_of(std::size_t robots) {
  ChainOptions out;
  out.interface = "robot1";
  out.robots.assign(robots, {});
  return out;
}

class Segment : public BusTurner {
 public:
  explicit Segment(const std::vector<ethercat::RobotPlace>& places,
                   const ethercat::BusOptions& options = usual_segment())
      : BusTurner(ethercat::make_transport(places, options), places.size(), options.cycle) {}
};

class OnACable : public testing::Test {
 protected:
  void SetUp() override {
    if (!network.usable()) GTEST_SKIP() << kNoNamespace;
    network.cable("eth1", "robot1");
    network.cable("eth2", "robot2");
  }

  NetworkNamespace network;
};

}  // namespace meca::test
