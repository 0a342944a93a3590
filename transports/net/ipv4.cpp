#include "transports/net/ipv4.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <stdexcept>

#include "transports/net/file.hpp"
#include "transports/net/socket_address.hpp"

namespace meca::net {

std::optional<std::uint32_t> parse_ipv4(std::string_view text) noexcept {
  std::array<char, INET_ADDRSTRLEN> terminated{};
  if (text.size() >= terminated.size()) return std::nullopt;
  text.copy(terminated.data(), text.size());
  in_addr address{};
  if (::inet_pton(AF_INET, terminated.data(), &address) != 1) return std::nullopt;
  return ntohl(address.s_addr);
}

std::string to_string(std::uint32_t ipv4) {
  const in_addr address{htonl(ipv4)};
  std::array<char, INET_ADDRSTRLEN> text{};
  ::inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

std::string to_string(const Endpoint& endpoint) {
  return to_string(endpoint.ipv4) + ":" + std::to_string(endpoint.port);
}

std::uint32_t resolve_ipv4(const std::string& host) {
  if (const auto number = parse_ipv4(host)) return *number;
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), nullptr, &hints, &found); error != 0) {
    throw std::runtime_error("the host name '" + host + "' has no IPv4 address here (" + ::gai_strerror(error) +
                             "); write the address itself");
  }
  const std::uint32_t address = ntohl(reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr.s_addr);
  ::freeaddrinfo(found);
  return address;
}

std::vector<Interface> ipv4_interfaces() {
  std::vector<Interface> out;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return out;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET || (i->ifa_flags & IFF_UP) == 0) continue;
    out.push_back({i->ifa_name, from_sockaddr(*i->ifa_addr).ipv4, from_sockaddr(*i->ifa_netmask).ipv4});
  }
  ::freeifaddrs(list);
  return out;
}

std::uint32_t source_for(std::uint32_t ipv4) noexcept {
  // Connecting a datagram socket sends nothing; it only asks the routing table.
  const File socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in to = to_sockaddr({ipv4, 9});
  sockaddr_in own{};
  socklen_t size = sizeof own;
  if (!socket || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0 ||
      ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&own), &size) != 0) {
    return 0;
  }
  return from_sockaddr(own).ipv4;
}

}  // namespace meca::net
