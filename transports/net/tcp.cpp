#include "transports/net/tcp.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "transports/net/socket_address.hpp"

namespace meca::net {
namespace {

std::string_view text_of(int error) noexcept {
  switch (error) {
    case ECONNREFUSED:
      return "connection refused: nothing listens there";
    case ETIMEDOUT:
      return "no answer";
    case EHOSTUNREACH:
      return "host unreachable: no answer to ARP, or no route";
    case ENETUNREACH:
      return "network unreachable: no interface of this machine leads there";
    case ECONNRESET:
      return "connection reset by the other end";
    case EPIPE:
      return "the other end has closed the connection";
    case EMFILE:
    case ENFILE:
      return "no file descriptors left on this machine";
    case EADDRNOTAVAIL:
      return "the own address to connect from is not an address of this machine";
    case EACCES:
    case EPERM:
      return "not permitted: a firewall of this machine forbids it";
    default:
      return "the connection broke";
  }
}

void prepare(int descriptor, std::uint8_t dscp) noexcept {
  const int on = 1, tos = dscp << 2;
  ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (dscp != 0) ::setsockopt(descriptor, IPPROTO_IP, IP_TOS, &tos, sizeof tos);
}

using AskName = int (*)(int, sockaddr*, socklen_t*);
Endpoint name_of(int descriptor, AskName ask) noexcept {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (ask(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) return {};
  return from_sockaddr(address);
}

}  // namespace

TcpStream TcpStream::connect(const Endpoint& to, std::uint8_t dscp, std::uint32_t from) noexcept {
  TcpStream out(File(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)));
  if (!out.file_) {
    out.trouble_ = text_of(errno);
    return out;
  }
  prepare(out.file_.get(), dscp);
  const sockaddr_in address = to_sockaddr(to), own = to_sockaddr({from, 0});
  int result = 0;
  if (from != 0) result = ::bind(out.file_.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own);
  if (result == 0) result = ::connect(out.file_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  if (result != 0 && errno != EINPROGRESS) {
    out.trouble_ = text_of(errno);
    out.close();
  }
  return out;
}

TcpStream::Progress TcpStream::progress() noexcept {
  if (!file_) return Progress::kFailed;
  pollfd polled{file_.get(), POLLOUT, 0};
  if (::poll(&polled, 1, 0) <= 0) return Progress::kConnecting;
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(file_.get(), SOL_SOCKET, SO_ERROR, &error, &size);
  if (error == 0) return Progress::kConnected;
  trouble_ = text_of(error);
  close();
  return Progress::kFailed;
}

TcpStream::Count TcpStream::receive(std::span<std::byte> buffer) noexcept {
  for (;;) {
    const ssize_t count = ::recv(file_.get(), buffer.data(), buffer.size(), 0);
    if (count > 0) return {static_cast<std::size_t>(count), false};
    if (count == 0) return {0, !buffer.empty()};
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return {};
    trouble_ = text_of(errno);
    return {0, true};
  }
}

TcpStream::Count TcpStream::send(std::span<const std::byte> bytes) noexcept {
  for (;;) {
    const ssize_t count = ::send(file_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count >= 0) return {static_cast<std::size_t>(count), false};
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return {};
    trouble_ = text_of(errno);
    return {0, true};
  }
}

Endpoint TcpStream::local() const noexcept { return name_of(file_.get(), ::getsockname); }
Endpoint TcpStream::peer() const noexcept { return name_of(file_.get(), ::getpeername); }

TcpListener::TcpListener(const Endpoint& local, std::uint8_t dscp)
    : file_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)), dscp_(dscp) {
  const int on = 1;
  const sockaddr_in address = to_sockaddr(local);
  if (file_) ::setsockopt(file_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (file_ && ::bind(file_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::listen(file_.get(), 16) == 0) {
    return;
  }
  const std::string where =
      "TCP port " + std::to_string(local.port) + (local.ipv4 ? " of " + to_string(local.ipv4) : "");
  if (errno == EADDRINUSE) {
    throw std::runtime_error(where +
                             " is taken by another program on this machine; stop it, or choose another address");
  }
  if (errno == EADDRNOTAVAIL) throw std::runtime_error(to_string(local.ipv4) + " is not an address of this machine");
  throw std::runtime_error(where + " cannot be opened: " + std::strerror(errno));
}

std::optional<TcpStream> TcpListener::accept() noexcept {
  File file(::accept4(file_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!file) return std::nullopt;
  prepare(file.get(), dscp_);
  return TcpStream(std::move(file));
}

Endpoint TcpListener::local() const noexcept { return name_of(file_.get(), ::getsockname); }

}  // namespace meca::net
