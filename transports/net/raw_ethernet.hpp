// Raw Ethernet frames of one EtherType on one network interface (packet(7)): never blocks and, after it was opened,
// never allocates. Needs CAP_NET_RAW.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "transports/net/file.hpp"

namespace meca::net {

class RawEthernet {
 public:
  static constexpr std::size_t kLongestFrame = 1514;  // bytes, header included, without FCS and VLAN tag

  RawEthernet() = default;
  // Throws std::runtime_error with a sentence: no such interface, not Ethernet, frames too short, no right. An
  // interface that is down is no error: link() says so, and frames pass once it is up.
  RawEthernet(const std::string& interface, std::uint16_t ether_type);

  // kNoCarrier: no cable, or nobody at its other end. kDown: switched off here ("ip link set eth1 up"). kGone: the
  // interface was taken away.
  enum class Link : std::uint8_t { kUp, kNoCarrier, kDown, kGone };
  // Two short system calls: a few times a second, not in every cycle. Finds an interface that went and came back.
  Link link() noexcept;

  // False: not sent; a full send queue and a link that is down count as lost, as on the wire.
  bool send(std::span<const std::byte> frame) noexcept;
  // The next frame from the wire (not what this machine sends itself), or nothing when none waits. Its size as it came:
  // larger than the buffer when it was cut.
  std::optional<std::size_t> receive(std::span<std::byte> buffer) noexcept;

  int descriptor() const noexcept { return file_.get(); }
  explicit operator bool() const noexcept { return static_cast<bool>(file_); }
  const std::string& interface() const noexcept { return interface_; }
  const std::array<std::byte, 6>& address() const noexcept { return address_; }  // MAC

 private:
  bool bind(int index) noexcept;

  File file_;
  std::string interface_;
  std::uint16_t ether_type_ = 0;
  int index_ = 0;
  std::array<std::byte, 6> address_{};
};

}  // namespace meca::net
