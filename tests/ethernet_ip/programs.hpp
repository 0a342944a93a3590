// A cell on EtherNet/IP as its user starts it, on addresses of this test only.
#pragma once

#include "tests/programs/programs.hpp"

namespace meca::test {

// Eight addresses of 127.128.0.0/10 for each process: test programs that run at the same time do not meet.
std::string own_address(unsigned which);
inline std::string bridge_address() { return own_address(0); }
inline std::string arm1_address() { return own_address(1); }
inline std::string arm2_address() { return own_address(2); }
inline std::string second_bridge_address() { return own_address(3); }

class SimProgram : public Simulator {
 public:
  explicit SimProgram(const std::string& address, const std::vector<std::string>& more = {});
};

// One entry of `robots:`; `more` goes into its transport section, as in ", key: exact".
std::string robot(const std::string& name, const std::string& address, const std::string& more = "",
                  const std::string& cycle = "10ms");

class BridgeProgram : public BridgeProcess {
 public:
  // `bus`: what the section ethernet_ip says.
  explicit BridgeProgram(const std::vector<std::string>& robots, const std::string& bus = "bind: " + bridge_address());
};

}  // namespace meca::test
