// Class 1 I/O packets (UDP 2222): connection id and sequence number in front, then the data of one direction.
// CIP Vol 2, 2-6.2.4 and 3-2.2; run/idle header: CIP Vol 1, 3-6.1.4.
#pragma once

#include <cstdint>
#include <optional>

#include "transports/ethernet_ip/encapsulation.hpp"

namespace meca::ethernet_ip {

inline constexpr std::size_t kIoOverhead = 18;  // items and addresses around the data

struct IoPacket {
  std::uint32_t connection_id = 0;
  std::uint32_t sequence = 0;  // of the encapsulation: +1 with every packet
  Bytes data;                  // begins with the 16 bit sequence count of transport class 1
};
std::optional<IoPacket> read_io_packet(Bytes datagram) noexcept;
// Everything up to the data, `length` bytes of which the caller writes behind it.
void write_io_packet(wire::Writer& out, std::uint32_t connection_id, std::uint32_t sequence,
                     std::size_t length) noexcept;

inline constexpr std::uint32_t kRun = 1;  // bit 0 of the run/idle header

// Sequence numbers wrap: newer is what lies less than half the range ahead.
constexpr bool newer(std::uint32_t sequence, std::uint32_t than) noexcept {
  return static_cast<std::int32_t>(sequence - than) > 0;
}
constexpr bool newer(std::uint16_t sequence, std::uint16_t than) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(sequence - than)) > 0;
}

}  // namespace meca::ethernet_ip
