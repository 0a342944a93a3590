#include "transports/ethernet_ip/encapsulation.hpp"

#include <algorithm>

namespace meca::ethernet_ip {
namespace {

constexpr std::uint16_t kFamilyInternet = 2;  // AF_INET, as on the wire
constexpr std::uint16_t kProtocolVersion = 1;
constexpr std::size_t kSocketAddressSize = 16;

void write_attributes(wire::Writer& out, const Identity& i) noexcept {
  out.u16(i.vendor_id);
  out.u16(i.device_type);
  out.u16(i.product_code);
  out.u8(i.major);
  out.u8(i.minor);
  out.u16(i.status);
  out.u32(i.serial_number);
  out.u8(i.name_length);
  out.text(i.name());
}

}  // namespace

std::string_view text_of(Status status) noexcept {
  switch (status) {
    case Status::kSuccess:
      return "success";
    case Status::kUnsupportedCommand:
      return "the device does not know this encapsulation command, or not in this state";
    case Status::kNoMemory:
      return "the device has no memory left for this request";
    case Status::kIncorrectData:
      return "the data of the request is malformed";
    case Status::kInvalidSession:
      return "the session handle is not valid (any more)";
    case Status::kInvalidLength:
      return "the length of the request is wrong";
    case Status::kUnsupportedVersion:
      return "the device does not speak version 1 of the encapsulation protocol";
  }
  return "a status that no document names";  // a number from the wire
}

std::optional<Header> read_header(Bytes bytes) noexcept {
  wire::Reader in(bytes);
  Header h;
  h.command = in.u16();
  h.length = in.u16();
  h.session = in.u32();
  h.status = in.u32();
  const Bytes context = in.bytes(h.context.size());
  h.options = in.u32();
  if (!in.ok()) return std::nullopt;
  std::ranges::copy(context, h.context.begin());
  return h;
}

void write(wire::Writer& out, const Header& h) noexcept {
  out.u16(h.command);
  out.u16(h.length);
  out.u32(h.session);
  out.u32(h.status);
  out.bytes(h.context);
  out.u32(h.options);
}

const Item* Items::find(ItemType type) const noexcept {
  const auto end = all.begin() + static_cast<std::ptrdiff_t>(count);
  const auto found =
      std::find_if(all.begin(), end, [type](const Item& i) { return i.type == static_cast<std::uint16_t>(type); });
  return found == end ? nullptr : &*found;
}

std::optional<Items> read_items(wire::Reader& in) noexcept {
  Items items;
  const std::size_t count = in.u16();
  if (count > Items::kMost) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    Item& item = items.all[items.count++];
    item.type = in.u16();
    item.data = in.bytes(in.u16());
  }
  if (!in.ok()) return std::nullopt;
  return items;
}

void write_item(wire::Writer& out, ItemType type, std::size_t length) noexcept {
  out.u16(static_cast<std::uint16_t>(type));
  out.u16(static_cast<std::uint16_t>(length));
}

std::optional<SocketAddress> read_socket_address(Bytes bytes) noexcept {
  if (bytes.size() != kSocketAddressSize) return std::nullopt;
  wire::Reader in(bytes, std::endian::big);
  if (in.u16() != kFamilyInternet) return std::nullopt;
  SocketAddress out;
  out.port = in.u16();
  out.ipv4 = in.u32();
  return out;
}

void write(wire::Writer& out, const SocketAddress& address) noexcept {
  std::array<std::byte, kSocketAddressSize> bytes{};
  wire::Writer big(bytes, std::endian::big);
  big.u16(kFamilyInternet);
  big.u16(address.port);
  big.u32(address.ipv4);
  out.bytes(bytes);
}

void Identity::set_name(std::string_view name) noexcept {
  name_length = static_cast<std::uint8_t>(std::min(name.size(), kMaxName));
  name_bytes = {};
  std::copy_n(name.begin(), name_length, name_bytes.begin());
}

std::optional<Identity> read_identity(wire::Reader& in) noexcept {
  Identity i;
  i.vendor_id = in.u16();
  i.device_type = in.u16();
  i.product_code = in.u16();
  i.major = in.u8();
  i.minor = in.u8();
  i.status = in.u16();
  i.serial_number = in.u32();
  const Bytes name = in.bytes(in.u8());
  i.state = 0xFF;
  if (!in.ok()) return std::nullopt;
  i.set_name({reinterpret_cast<const char*>(name.data()), name.size()});
  return i;
}

void write(wire::Writer& out, const Identity& identity) noexcept { write_attributes(out, identity); }

std::optional<ListedIdentity> read_listed_identity(Bytes data) noexcept {
  wire::Reader in(data);
  const auto items = read_items(in);
  const Item* item = items ? items->find(ItemType::kListIdentity) : nullptr;
  if (item == nullptr) return std::nullopt;
  wire::Reader body(item->data);
  body.u16();  // encapsulation protocol version
  const auto address = read_socket_address(body.bytes(kSocketAddressSize));
  auto identity = read_identity(body);
  if (!identity) return std::nullopt;
  if (body.remaining() > 0) identity->state = body.u8();
  return ListedIdentity{address.value_or(SocketAddress{}), *identity};
}

void write(wire::Writer& out, const ListedIdentity& listed) noexcept {
  constexpr std::size_t kFixed = 2 + kSocketAddressSize + 15;  // version, address, attributes but the name, state
  out.u16(1);
  write_item(out, ItemType::kListIdentity, kFixed + listed.identity.name_length + 1);
  out.u16(kProtocolVersion);
  write(out, listed.address);
  write_attributes(out, listed.identity);
  out.u8(listed.identity.state);
}

}  // namespace meca::ethernet_ip
