#include "transports/net/udp.hpp"

#include <netinet/in.h>
#include <netinet/ip.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "transports/net/socket_address.hpp"

namespace meca::net {
namespace {

template <class T>
bool set(int descriptor, int level, int name, const T& value) noexcept {
  return ::setsockopt(descriptor, level, name, &value, sizeof value) == 0;
}

ip_mreqn membership(std::uint32_t group, std::uint32_t interface_address) noexcept {
  ip_mreqn out{};
  out.imr_multiaddr.s_addr = htonl(group);
  out.imr_address.s_addr = htonl(interface_address);
  return out;
}

std::string why_not(const Endpoint& local) {
  const std::string port = "UDP port " + std::to_string(local.port);
  const std::string at = local.ipv4 != 0 ? " of " + to_string(local.ipv4) : "";
  switch (errno) {
    case EADDRINUSE:
      return port + at + " is taken by another program on this machine; stop it, " +
             (local.ipv4 == 0 ? "bind to one address, " : "") + "or choose another port";
    case EADDRNOTAVAIL:
      return to_string(local.ipv4) + " is not an address of this machine";
    case EACCES:
      return port + at + " needs rights that this program does not have";
    default:
      return port + at + " cannot be opened: " + std::strerror(errno);
  }
}

}  // namespace

UdpSocket::UdpSocket(const Endpoint& local, const UdpOptions& options)
    : file_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  if (!file_) throw std::runtime_error(std::string("a UDP socket cannot be opened: ") + std::strerror(errno));
  const int fd = file_.get();
  if (options.share_port) set(fd, SOL_SOCKET, SO_REUSEADDR, 1);
  if (options.broadcast) set(fd, SOL_SOCKET, SO_BROADCAST, 1);
  if (options.dscp != 0) set(fd, IPPROTO_IP, IP_TOS, options.dscp << 2);
  if (options.receive_buffer != 0) set(fd, SOL_SOCKET, SO_RCVBUF, options.receive_buffer);
  set(fd, IPPROTO_IP, IP_MULTICAST_TTL, int{options.multicast_ttl});
  // Without it every group that any program of this machine has joined would reach this socket.
  set(fd, IPPROTO_IP, IP_MULTICAST_ALL, 0);
  if (options.multicast_interface != 0) {
    set(fd, IPPROTO_IP, IP_MULTICAST_IF, membership(0, options.multicast_interface));
  }
  const sockaddr_in address = to_sockaddr(local);
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error(why_not(local));
  }
}

Endpoint UdpSocket::local() const noexcept {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (::getsockname(file_.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) return {};
  return from_sockaddr(address);
}

std::optional<UdpSocket::Received> UdpSocket::receive(std::span<std::byte> buffer) noexcept {
  sockaddr_in from{};
  socklen_t size = sizeof from;
  for (;;) {
    const ssize_t count =
        ::recvfrom(file_.get(), buffer.data(), buffer.size(), MSG_TRUNC, reinterpret_cast<sockaddr*>(&from), &size);
    if (count >= 0) return Received{from_sockaddr(from), static_cast<std::size_t>(count)};
    // An ICMP "port unreachable" of something sent before is told by the next call; the one after it may succeed.
    if (errno != EINTR && errno != ECONNREFUSED) return std::nullopt;
  }
}

bool UdpSocket::send(const Endpoint& to, std::span<const std::byte> datagram) noexcept {
  const sockaddr_in address = to_sockaddr(to);
  for (int attempt = 0; attempt < 2; ++attempt) {
    const ssize_t sent = ::sendto(file_.get(), datagram.data(), datagram.size(), 0,
                                  reinterpret_cast<const sockaddr*>(&address), sizeof address);
    if (sent >= 0) return true;
    if (errno != EINTR && errno != ECONNREFUSED) return false;
  }
  return false;
}

bool UdpSocket::join(std::uint32_t group, std::uint32_t interface_address) noexcept {
  return set(file_.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, membership(group, interface_address));
}
void UdpSocket::leave(std::uint32_t group, std::uint32_t interface_address) noexcept {
  set(file_.get(), IPPROTO_IP, IP_DROP_MEMBERSHIP, membership(group, interface_address));
}

}  // namespace meca::net
