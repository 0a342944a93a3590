// Endpoint <-> sockaddr_in, for the sources of this folder only.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstring>

#include "transports/net/ipv4.hpp"

namespace meca::net {

inline sockaddr_in to_sockaddr(const Endpoint& endpoint) noexcept {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_addr.s_addr = htonl(endpoint.ipv4);
  out.sin_port = htons(endpoint.port);
  return out;
}

inline Endpoint from_sockaddr(const sockaddr_in& address) noexcept {
  return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
}
inline Endpoint from_sockaddr(const sockaddr& address) noexcept {
  sockaddr_in in{};
  std::memcpy(&in, &address, sizeof in);
  return from_sockaddr(in);
}

}  // namespace meca::net
