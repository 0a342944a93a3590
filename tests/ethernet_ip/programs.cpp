#include "tests/ethernet_ip/programs.hpp"

#include <unistd.h>

#include <numeric>

#include "transports/net/ipv4.hpp"

namespace meca::test {
namespace {

constexpr int kDomain = 72;

std::vector<std::string> with(const std::string& address, const std::vector<std::string>& more) {
  std::vector<std::string> words{"--bind", address};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

std::string own_address(unsigned which) {
  return net::to_string(0x7F800000u | ((static_cast<unsigned>(::getpid()) * 8 + which) & 0x3FFFFFu));
}

SimProgram::SimProgram(const std::string& address, const std::vector<std::string>& more)
    : Simulator(with(address, more), 1, "EtherNet/IP at ") {}

// The watchdog and the lease leave a busy machine its time.
std::string robot(const std::string& name, const std::string& address, const std::string& more,
                  const std::string& cycle) {
  return "  - {name: " + name + ", transport: {type: ethernet_ip, address: " + address +
         ", timeout_multiplier: " + (cycle == "10ms" ? "256" : "64") + more + "}, cycle: " + cycle +
         ", control: {lease: 2s, velocity_lease: 1s}}\n";
}

BridgeProgram::BridgeProgram(const std::vector<std::string>& robots, const std::string& bus)
    : BridgeProcess(kDomain, "ethernet_ip: {" + bus + "}\nrobots:\n" +
                                 std::accumulate(robots.begin(), robots.end(), std::string())) {}

}  // namespace meca::test
