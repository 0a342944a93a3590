// The encapsulation of EtherNet/IP: a 24 byte header, and behind it a "common packet format" (CPF) list of typed items.
// Bytes <-> structs only. Little-endian but for the socket addresses (CIP Vol 2, chapter 2; facts as in
// the project's tests, which quote captures of independent stacks).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "transports/wire/reader.hpp"
#include "transports/wire/writer.hpp"

namespace meca::ethernet_ip {

using wire::Bytes;

inline constexpr std::uint16_t kTcpPort = 44818;  // explicit messages; ListIdentity over UDP too
inline constexpr std::uint16_t kIoPort = 2222;    // class 1 I/O, UDP
inline constexpr std::size_t kHeaderSize = 24;
inline constexpr std::size_t kMaxData = 504;  // of the messages we send; larger ones are taken and refused in words

enum class Command : std::uint16_t {  // CIP Vol 2, 2-3.2
  kNop = 0x0000,
  kListServices = 0x0004,
  kListIdentity = 0x0063,
  kListInterfaces = 0x0064,
  kRegisterSession = 0x0065,
  kUnregisterSession = 0x0066,
  kSendRrData = 0x006F,
  kSendUnitData = 0x0070,
};

enum class Status : std::uint32_t {  // CIP Vol 2, 2-3.4
  kSuccess = 0x00,
  kUnsupportedCommand = 0x01,
  kNoMemory = 0x02,
  kIncorrectData = 0x03,
  kInvalidSession = 0x64,
  kInvalidLength = 0x65,
  kUnsupportedVersion = 0x69,
};
// "the session handle is not (or no longer) valid"; for a status that no document names, says so.
std::string_view text_of(Status status) noexcept;

struct Header {
  std::uint16_t command = 0;  // a Command, or whatever came
  std::uint16_t length = 0;   // of what follows the header
  std::uint32_t session = 0;
  std::uint32_t status = 0;
  std::array<std::byte, 8> context{};  // echoed by the target
  std::uint32_t options = 0;           // 0, or the message is to be discarded
};
std::optional<Header> read_header(Bytes bytes) noexcept;
void write(wire::Writer& out, const Header& header) noexcept;

// ---- Items

enum class ItemType : std::uint16_t {  // CIP Vol 2, 2-6.2
  kNullAddress = 0x0000,
  kListIdentity = 0x000C,
  kConnectedAddress = 0x00A1,
  kConnectedData = 0x00B1,
  kUnconnectedData = 0x00B2,
  kListServices = 0x0100,
  kSocketAddressOToT = 0x8000,
  kSocketAddressTToO = 0x8001,
  kSequencedAddress = 0x8002,
};

struct Item {
  std::uint16_t type = 0;
  Bytes data;
};

// Items of one message, pointing into its bytes. More than `kMost` are an error: no message of ours has more.
struct Items {
  static constexpr std::size_t kMost = 8;
  std::array<Item, kMost> all{};
  std::size_t count = 0;
  const Item* find(ItemType type) const noexcept;  // the first; nullptr: none
};
std::optional<Items> read_items(wire::Reader& in) noexcept;
// Writes type and length of an item; the caller writes `length` bytes behind it.
void write_item(wire::Writer& out, ItemType type, std::size_t length) noexcept;

// IPv4 address and port, host byte order.
struct SocketAddress {
  std::uint32_t ipv4 = 0;
  std::uint16_t port = 0;
  friend bool operator==(const SocketAddress&, const SocketAddress&) = default;
};
// 16 bytes, big-endian: family 2, port, address, zeros (CIP Vol 2, 2-6.3.3).
std::optional<SocketAddress> read_socket_address(Bytes bytes) noexcept;
void write(wire::Writer& out, const SocketAddress& address) noexcept;

// ---- Discovery

// What a device says of itself (Identity object, class 1, and ListIdentity).
struct Identity {
  static constexpr std::size_t kMaxName = 32;
  std::uint16_t vendor_id = 0, device_type = 0, product_code = 0;
  std::uint8_t major = 0, minor = 0;
  std::uint16_t status = 0;
  std::uint32_t serial_number = 0;
  std::array<char, kMaxName> name_bytes{};  // SHORT_STRING, cut at kMaxName
  std::uint8_t name_length = 0;
  std::uint8_t state = 0;  // 0xFF: not given

  std::string_view name() const noexcept { return {name_bytes.data(), name_length}; }
  void set_name(std::string_view name) noexcept;
  friend bool operator==(const Identity&, const Identity&) = default;
};
// The Identity object's attributes 1 to 7 in one piece (GetAttributesAll).
std::optional<Identity> read_identity(wire::Reader& in) noexcept;
void write(wire::Writer& out, const Identity& identity) noexcept;

struct ListedIdentity {
  SocketAddress address;  // as the device believes; only a hint: the sender of the datagram is what can be reached
  Identity identity;
};
// The data of a ListIdentity reply, behind its header.
std::optional<ListedIdentity> read_listed_identity(Bytes data) noexcept;
void write(wire::Writer& out, const ListedIdentity& listed) noexcept;

}  // namespace meca::ethernet_ip
