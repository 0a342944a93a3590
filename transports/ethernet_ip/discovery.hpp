// Who is there: one ListIdentity over UDP 44818 to a device or to a whole network, and what comes back, merged. Without
// I/O, as everything here; for people and start-up, not for the cycle thread: it allocates.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "transports/ethernet_ip/encapsulation.hpp"

namespace meca::ethernet_ip {

// A broadcast is answered after a random time, so that a network full of devices does not answer at once: at most this
// when the request names no other (spec 4.3; seen up to 1.6 s from public stacks).
inline constexpr std::chrono::milliseconds kMostAnswerDelay{2000};

// `most_delay`: what a device may take to answer a broadcast, 1 ms to 65.5 s; 0: its own choice, kMostAnswerDelay. A
// device that was asked alone answers at once.
using ListIdentityRequest = std::array<std::byte, kHeaderSize>;
ListIdentityRequest list_identity_request(std::chrono::milliseconds most_delay) noexcept;

struct FoundDevice {
  std::vector<std::uint32_t> addresses;  // that answers came from, host byte order, as they came; at least one
  SocketAddress claimed;                 // what the device believes of itself; a hint, all zero where it says nothing
  Identity identity;
};

bool is_meca500(const Identity& identity) noexcept;  // by vendor, type and product

// "operational", "major recoverable fault"; "not told" for 0 and 0xFF, which devices send that do not know.
std::string_view device_state_text(std::uint8_t state) noexcept;

class Discovery {
 public:
  // False: no answer to ListIdentity, and nothing was learnt.
  bool received(std::uint32_t from_ipv4, Bytes datagram);

  // In the order of their first addresses. A device that answers twice, or from several addresses, is one: vendor,
  // product and serial number say so. Devices without serial number (0) are told apart by address.
  std::span<const FoundDevice> devices() const noexcept { return devices_; }

 private:
  std::vector<FoundDevice> devices_;
};

}  // namespace meca::ethernet_ip
