// A UDP socket that never blocks and, after it was opened, never allocates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "transports/net/file.hpp"
#include "transports/net/ipv4.hpp"

namespace meca::net {

struct UdpOptions {
  bool share_port = false;  // SO_REUSEADDR: others may bind the port on another address
  bool broadcast = false;
  std::uint8_t dscp = 0;           // of what is sent; asked for, not insisted on
  std::uint8_t multicast_ttl = 1;  // of what is sent to groups
  int receive_buffer = 0;          // bytes, the kernel's own overhead included; 0: the system's choice
  std::uint32_t multicast_interface =
      0;  // own address of the interface that groups are sent on; 0: the system's choice
};

class UdpSocket {
 public:
  UdpSocket() = default;
  // Bound to `local`; port 0: any. Throws std::runtime_error with a sentence ("UDP port 2222 is taken ...").
  UdpSocket(const Endpoint& local, const UdpOptions& options);

  int descriptor() const noexcept { return file_.get(); }
  explicit operator bool() const noexcept { return static_cast<bool>(file_); }
  Endpoint local() const noexcept;

  struct Received {
    Endpoint from;
    std::size_t size = 0;  // as it was sent: larger than the buffer when it was cut
  };
  // The next datagram, or nothing when none waits.
  std::optional<Received> receive(std::span<std::byte> buffer) noexcept;
  // False: not sent (errno says why); a full send buffer counts as lost, as on the wire.
  bool send(const Endpoint& to, std::span<const std::byte> datagram) noexcept;

  // Membership of a multicast group on the interface with this own address. False: errno says why.
  bool join(std::uint32_t group, std::uint32_t interface_address) noexcept;
  void leave(std::uint32_t group, std::uint32_t interface_address) noexcept;

 private:
  File file_;
};

}  // namespace meca::net
