// IPv4 addresses as numbers in host byte order, as text, and as the addresses of this machine's interfaces.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meca::net {

struct Endpoint {
  std::uint32_t ipv4 = 0;  // host byte order; 0: any
  std::uint16_t port = 0;
  friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

std::optional<std::uint32_t> parse_ipv4(std::string_view text) noexcept;  // "192.168.0.100"
std::string to_string(std::uint32_t ipv4);
std::string to_string(const Endpoint& endpoint);  // "192.168.0.100:44818"

// The IPv4 address of a host by name or number. Blocks: not for the cycle thread. Throws std::runtime_error with a
// sentence.
std::uint32_t resolve_ipv4(const std::string& host);

struct Interface {
  std::string name;  // "eth0"
  std::uint32_t address = 0, netmask = 0;
  std::uint32_t broadcast() const noexcept { return address | ~netmask; }
};
std::vector<Interface> ipv4_interfaces();  // those that are up; several entries for several addresses
// Which of our own addresses packets to `ipv4` leave from; 0: no route.
std::uint32_t source_for(std::uint32_t ipv4) noexcept;

}  // namespace meca::net
