// The cable between a bridge and its robots on EtherCAT: a pair of virtual interfaces in a network of our own.
#pragma once

#include "tests/bench/scenarios.hpp"
#include "tests/network_namespace.hpp"

namespace meca::bench {

inline constexpr const char* kMasterInterface = "meca0";
inline constexpr const char* kRobotInterface = "meca1";

// This process, and those that it starts from then on, are in it. Only before there are threads.
class EthercatCable {
 public:
  EthercatCable() {
    if (!network_.usable()) throw NotTold(std::string("EtherCAT ") + test::kNoNamespace);
    network_.cable(kMasterInterface, kRobotInterface);
  }

 private:
  test::NetworkNamespace network_;
};

}  // namespace meca::bench
