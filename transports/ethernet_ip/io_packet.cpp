#include "transports/ethernet_ip/io_packet.hpp"

namespace meca::ethernet_ip {

std::optional<IoPacket> read_io_packet(Bytes datagram) noexcept {
  wire::Reader in(datagram);
  const auto items = read_items(in);
  if (!items || items->count < 2) return std::nullopt;
  const Item& address = items->all[0];
  const Item& data = items->all[1];
  if (address.type != static_cast<std::uint16_t>(ItemType::kSequencedAddress) ||
      data.type != static_cast<std::uint16_t>(ItemType::kConnectedData)) {
    return std::nullopt;
  }
  wire::Reader numbers(address.data);
  IoPacket packet;
  packet.connection_id = numbers.u32();
  packet.sequence = numbers.u32();
  packet.data = data.data;
  if (!numbers.ok()) return std::nullopt;
  return packet;
}

void write_io_packet(wire::Writer& out, std::uint32_t connection_id, std::uint32_t sequence,
                     std::size_t length) noexcept {
  out.u16(2);
  write_item(out, ItemType::kSequencedAddress, 8);
  out.u32(connection_id);
  out.u32(sequence);
  write_item(out, ItemType::kConnectedData, length);
}

}  // namespace meca::ethernet_ip
