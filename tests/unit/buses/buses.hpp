// Every bus that a test can put between the bridge and the simulated robot.
#pragma once

#include <memory>

#include "tests/unit/buses/ethercat_wire.hpp"
#include "tests/unit/buses/ethernet_ip_wire.hpp"

namespace meca::test {

// The cycle of that bus, and what is counted in cycles by default.
inline CycleSettings settings_on(Bus bus, CycleSettings s = {}) {
  switch (bus) {
    case Bus::kEthernetIp:
      return EthernetIpWire::settings(s);
    case Bus::kEthercat:
      return EthercatWire::settings(s);
    case Bus::kBuiltin:
      break;
  }
  return s;
}

// Null for the built-in robot: the bench has that link by itself.
inline std::unique_ptr<BusWire> lay_wire(Bus bus, Bench& bench) {
  switch (bus) {
    case Bus::kEthernetIp:
      return std::make_unique<EthernetIpWire>(bench);
    case Bus::kEthercat:
      return std::make_unique<EthercatWire>(bench);
    case Bus::kBuiltin:
      break;
  }
  return nullptr;
}

}  // namespace meca::test
