// CIP messages as EtherNet/IP carries them: paths (EPATH), requests and replies of the Message Router, and Forward
// Open, Large Forward Open and Forward Close of the Connection Manager. Bytes <-> structs only; all little-endian. CIP
// Vol 1: 2-4 (Message Router), 3-5 (Connection Manager), appendix C (paths).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "transports/ethernet_ip/encapsulation.hpp"

namespace meca::ethernet_ip {

// ---- Paths

struct ElectronicKey {
  std::uint16_t vendor_id = 0, device_type = 0, product_code = 0;  // 0: not checked
  std::uint8_t major = 0, minor = 0;                               // 0: not checked
  bool compatible = false;                                         // a device that can stand in for this one will do
  friend bool operator==(const ElectronicKey&, const ElectronicKey&) = default;
};

// What a padded path names. Members stay empty where the path has no such segment.
struct Path {
  std::optional<ElectronicKey> key;
  std::optional<std::uint32_t> class_id, instance_id, attribute_id;
  std::array<std::uint32_t, 3> connection_points{};  // as many as the path has, in their order
  std::size_t connection_point_count = 0;
  bool data_segment = false;  // is there; its content concerns nobody here
};

enum class PathError : std::uint8_t {
  kNone,
  kMalformed,     // ends within a segment
  kUnknown,       // a segment type that is not one of the above (port, symbolic, network, ...)
  kBadKeyFormat,  // electronic key of another format than 4
  kTooMany,       // more connection points than a connection has
};
// `bytes`: the path without its length. 8 and 16 bit logical segments.
PathError read_path(Bytes bytes, Path& path) noexcept;

// Class and instance, and an attribute where it is not 0, as 8 bit segments (16 bit where the number needs it).
void write_path(wire::Writer& out, std::uint16_t class_id, std::uint16_t instance_id,
                std::uint16_t attribute_id = 0) noexcept;
void write_key(wire::Writer& out, const ElectronicKey& key) noexcept;
// `20 04 2C <O->T> 2C <T->O>`: the connection path of a device without configuration assembly.
void write_connection_points(wire::Writer& out, std::uint8_t o_to_t, std::uint8_t t_to_o) noexcept;

// ---- Message Router

enum class Service : std::uint8_t {
  kGetAttributesAll = 0x01,
  kGetAttributeSingle = 0x0E,
  kSetAttributeSingle = 0x10,
  kForwardClose = 0x4E,
  kUnconnectedSend = 0x52,
  kForwardOpen = 0x54,
  kLargeForwardOpen = 0x5B,
};
inline constexpr std::uint8_t kReplyBit = 0x80;

inline constexpr std::uint16_t kIdentityClass = 0x01, kAssemblyClass = 0x04, kConnectionManagerClass = 0x06,
                               kQosClass = 0x48, kTcpIpInterfaceClass = 0xF5, kEthernetLinkClass = 0xF6;

struct Request {
  std::uint8_t service = 0;
  Bytes path;  // without its length
  Bytes data;
};
std::optional<Request> read_request(Bytes bytes) noexcept;
// Service and path of a request; the caller writes the data behind it.
void write_request(wire::Writer& out, Service service, std::uint16_t class_id, std::uint16_t instance_id,
                   std::uint16_t attribute_id = 0) noexcept;

// General status codes, CIP Vol 1 appendix B.
enum class GeneralStatus : std::uint8_t {
  kSuccess = 0x00,
  kConnectionFailure = 0x01,  // the first extended word says which
  kResourceUnavailable = 0x02,
  kInvalidParameter = 0x03,
  kPathSegmentError = 0x04,
  kPathDestinationUnknown = 0x05,
  kServiceNotSupported = 0x08,
  kAttributeNotSettable = 0x0E,
  kNotEnoughData = 0x13,
  kAttributeNotSupported = 0x14,
  kTooMuchData = 0x15,
  kKeyFailureInPath = 0x25,
  kVendorSpecific = 0xFF,
};

struct Reply {
  static constexpr std::size_t kMostExtended = 6;  // of 0x0112, the longest
  std::uint8_t service = 0;                        // of the request, without the reply bit
  std::uint8_t general = 0;                        // a GeneralStatus
  std::array<std::uint16_t, kMostExtended> extended{};
  std::size_t extended_count = 0;  // more on the wire are passed over
  Bytes data;

  bool ok() const noexcept { return general == 0; }
};
std::optional<Reply> read_reply(Bytes bytes) noexcept;
// Everything but the data, which the caller writes behind it.
void write_reply(wire::Writer& out, std::uint8_t service, GeneralStatus general,
                 std::span<const std::uint16_t> extended = {}) noexcept;

// ---- Connection Manager

enum class ConnectionType : std::uint8_t { kNull = 0, kMulticast = 1, kPointToPoint = 2, kReserved = 3 };
enum class Priority : std::uint8_t { kLow = 0, kHigh = 1, kScheduled = 2, kUrgent = 3 };

// CIP Vol 1, 3-5.5.1.1: 16 bits in Forward Open, 32 in Large Forward Open.
struct NetworkParameters {
  ConnectionType type = ConnectionType::kPointToPoint;
  Priority priority = Priority::kScheduled;
  bool redundant_owner = false;
  bool variable_size = false;
  std::uint16_t size = 0;  // bytes: data + 2 (sequence count) + 4 with a run/idle header; at most 511 in Forward Open
  friend bool operator==(const NetworkParameters&, const NetworkParameters&) = default;
};
std::uint16_t to_word(const NetworkParameters& p) noexcept;
std::uint32_t to_long_word(const NetworkParameters& p) noexcept;
NetworkParameters from_word(std::uint16_t word) noexcept;
NetworkParameters from_long_word(std::uint32_t word) noexcept;

// Who opened a connection, and which: all three are echoed in every reply, and name it in Forward Close.
struct ConnectionTriad {
  std::uint16_t connection_serial = 0;
  std::uint16_t originator_vendor = 0;
  std::uint32_t originator_serial = 0;
  friend bool operator==(const ConnectionTriad&, const ConnectionTriad&) = default;
};

inline constexpr std::uint8_t kMaxMultiplierCode = 7;
// Timeout multiplier code 0..7: x4, x8 .. x512. CIP Vol 1, 3-5.4.1.4.
constexpr std::uint32_t timeout_multiplier(std::uint8_t code) noexcept { return 4u << (code & 7); }

inline constexpr std::uint8_t kClass1Cyclic = 0x01;  // transport class and trigger: client, cyclic, class 1

struct ForwardOpen {
  bool large = false;
  std::uint8_t priority_tick = 0x0A, timeout_ticks = 2;  // unconnected time-out: 2^tick ms x ticks, here 2.048 s
  std::uint32_t o_to_t_id = 0, t_to_o_id = 0;
  ConnectionTriad triad;
  std::uint8_t multiplier_code = 0;
  std::uint32_t o_to_t_rpi_us = 0, t_to_o_rpi_us = 0;
  NetworkParameters o_to_t, t_to_o;
  std::uint8_t transport = kClass1Cyclic;
  Bytes path;  // read only: the connection path without its length
};
// `data` of a request of service kForwardOpen or kLargeForwardOpen. kNotEnoughData or kTooMuchData where the path
// length does not fit.
GeneralStatus read_forward_open(Bytes data, bool large, ForwardOpen& out) noexcept;
// Everything up to the path; the caller writes its length in words and the path.
void write_forward_open(wire::Writer& out, const ForwardOpen& f) noexcept;

struct ForwardOpenReply {
  std::uint32_t o_to_t_id = 0, t_to_o_id = 0;
  ConnectionTriad triad;
  std::uint32_t o_to_t_api_us = 0, t_to_o_api_us = 0;  // actual packet intervals
};
std::optional<ForwardOpenReply> read_forward_open_reply(Bytes data) noexcept;
void write(wire::Writer& out, const ForwardOpenReply& r) noexcept;

// What follows the status words of a refused Forward Open or Forward Close.
struct ConnectionFailure {
  ConnectionTriad triad;
  std::uint8_t remaining_path_words = 0;
};
std::optional<ConnectionFailure> read_connection_failure(Bytes data) noexcept;
void write(wire::Writer& out, const ConnectionFailure& f) noexcept;

struct ForwardClose {
  std::uint8_t priority_tick = 0x0A, timeout_ticks = 2;
  ConnectionTriad triad;
  Bytes path;  // read only
};
GeneralStatus read_forward_close(Bytes data, ForwardClose& out) noexcept;
// Everything up to the path, whose length has a pad byte behind it (unlike Forward Open).
void write_forward_close(wire::Writer& out, const ForwardClose& f, Bytes path) noexcept;
std::optional<ConnectionTriad> read_forward_close_reply(Bytes data) noexcept;
void write_forward_close_reply(wire::Writer& out, const ConnectionTriad& triad) noexcept;

}  // namespace meca::ethernet_ip
