#include "transports/ethernet_ip/cip.hpp"

namespace meca::ethernet_ip {
namespace {

// CIP Vol 1, C-1.4: logical segments. Bits 0-1 are the width of the number: 8 or 16 bits.
constexpr std::uint8_t kLogicalClass = 0x20, kLogicalInstance = 0x24, kLogicalConnectionPoint = 0x2C,
                       kLogicalAttribute = 0x30, kWidthMask = 0x03, kWidth16 = 0x01;
constexpr std::uint8_t kElectronicKey = 0x34, kKeyFormat4 = 0x04, kSimpleData = 0x80;
constexpr std::uint8_t kCompatibleBit = 0x80;

ElectronicKey read_key(wire::Reader& in) noexcept {
  ElectronicKey k;
  k.vendor_id = in.u16();
  k.device_type = in.u16();
  k.product_code = in.u16();
  const std::uint8_t major = in.u8();
  k.compatible = (major & kCompatibleBit) != 0;
  k.major = major & 0x7F;
  k.minor = in.u8();
  return k;
}

PathError read_segment(wire::Reader& in, Path& path) noexcept {
  const std::uint8_t type = in.u8();
  if (type == kElectronicKey) {
    if (in.u8() != kKeyFormat4) return PathError::kBadKeyFormat;
    path.key = read_key(in);
    return PathError::kNone;
  }
  if (type == kSimpleData) {
    in.skip(std::size_t{2} * in.u8());
    path.data_segment = true;
    return PathError::kNone;
  }
  const std::uint8_t width = type & kWidthMask;
  if (width > kWidth16) return PathError::kUnknown;
  std::uint32_t number = 0;
  if (width == kWidth16) {
    in.u8();  // pad
    number = in.u16();
  } else {
    number = in.u8();
  }
  switch (type & ~kWidthMask) {
    case kLogicalClass:
      path.class_id = number;
      return PathError::kNone;
    case kLogicalInstance:
      path.instance_id = number;
      return PathError::kNone;
    case kLogicalAttribute:
      path.attribute_id = number;
      return PathError::kNone;
    case kLogicalConnectionPoint:
      if (path.connection_point_count == path.connection_points.size()) return PathError::kTooMany;
      path.connection_points[path.connection_point_count++] = number;
      return PathError::kNone;
    default:
      return PathError::kUnknown;  // a byte from the wire
  }
}

void write_logical(wire::Writer& out, std::uint8_t type, std::uint16_t number) noexcept {
  if (number <= 0xFF) {
    out.u8(type);
    out.u8(static_cast<std::uint8_t>(number));
  } else {
    out.u8(type | kWidth16);
    out.u8(0);
    out.u16(number);
  }
}

ConnectionTriad read_triad(wire::Reader& in) noexcept {
  ConnectionTriad t;
  t.connection_serial = in.u16();
  t.originator_vendor = in.u16();
  t.originator_serial = in.u32();
  return t;
}

void write_triad(wire::Writer& out, const ConnectionTriad& t) noexcept {
  out.u16(t.connection_serial);
  out.u16(t.originator_vendor);
  out.u32(t.originator_serial);
}

// A path whose length in words was read already and that must be all that is left.
GeneralStatus read_whole_path(wire::Reader& in, std::size_t words, Bytes& path) noexcept {
  if (!in.ok() || in.remaining() < 2 * words) return GeneralStatus::kNotEnoughData;
  if (in.remaining() > 2 * words) return GeneralStatus::kTooMuchData;
  path = in.rest();
  return GeneralStatus::kSuccess;
}

}  // namespace

PathError read_path(Bytes bytes, Path& path) noexcept {
  wire::Reader in(bytes);
  path = {};
  while (in.remaining() > 0) {
    if (const PathError error = read_segment(in, path); error != PathError::kNone) return error;
  }
  return in.ok() ? PathError::kNone : PathError::kMalformed;
}

void write_path(wire::Writer& out, std::uint16_t class_id, std::uint16_t instance_id,
                std::uint16_t attribute_id) noexcept {
  write_logical(out, kLogicalClass, class_id);
  write_logical(out, kLogicalInstance, instance_id);
  if (attribute_id != 0) write_logical(out, kLogicalAttribute, attribute_id);
}

void write_key(wire::Writer& out, const ElectronicKey& k) noexcept {
  out.u8(kElectronicKey);
  out.u8(kKeyFormat4);
  out.u16(k.vendor_id);
  out.u16(k.device_type);
  out.u16(k.product_code);
  out.u8(static_cast<std::uint8_t>((k.major & 0x7F) | (k.compatible ? kCompatibleBit : 0)));
  out.u8(k.minor);
}

void write_connection_points(wire::Writer& out, std::uint8_t o_to_t, std::uint8_t t_to_o) noexcept {
  write_logical(out, kLogicalClass, kAssemblyClass);
  write_logical(out, kLogicalConnectionPoint, o_to_t);
  write_logical(out, kLogicalConnectionPoint, t_to_o);
}

std::optional<Request> read_request(Bytes bytes) noexcept {
  wire::Reader in(bytes);
  Request r;
  r.service = in.u8();
  r.path = in.bytes(std::size_t{2} * in.u8());
  r.data = in.rest();
  if (!in.ok() || (r.service & kReplyBit) != 0) return std::nullopt;
  return r;
}

void write_request(wire::Writer& out, Service service, std::uint16_t class_id, std::uint16_t instance_id,
                   std::uint16_t attribute_id) noexcept {
  std::array<std::byte, 12> bytes{};  // three 16 bit segments at most
  wire::Writer path(bytes);
  write_path(path, class_id, instance_id, attribute_id);
  out.u8(static_cast<std::uint8_t>(service));
  out.u8(static_cast<std::uint8_t>(path.size() / 2));
  out.bytes(path.written());
}

std::optional<Reply> read_reply(Bytes bytes) noexcept {
  wire::Reader in(bytes);
  Reply r;
  const std::uint8_t service = in.u8();
  in.u8();  // reserved
  r.service = service & static_cast<std::uint8_t>(~kReplyBit);
  r.general = in.u8();
  const std::size_t words = in.u8();
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint16_t word = in.u16();
    if (r.extended_count < Reply::kMostExtended) r.extended[r.extended_count++] = word;
  }
  r.data = in.rest();
  if (!in.ok() || (service & kReplyBit) == 0) return std::nullopt;
  return r;
}

void write_reply(wire::Writer& out, std::uint8_t service, GeneralStatus general,
                 std::span<const std::uint16_t> extended) noexcept {
  out.u8(service | kReplyBit);
  out.u8(0);
  out.u8(static_cast<std::uint8_t>(general));
  out.u8(static_cast<std::uint8_t>(extended.size()));
  for (const std::uint16_t word : extended) out.u16(word);
}

std::uint16_t to_word(const NetworkParameters& p) noexcept {
  return static_cast<std::uint16_t>((p.redundant_owner ? 0x8000 : 0) | static_cast<unsigned>(p.type) << 13 |
                                    static_cast<unsigned>(p.priority) << 10 | (p.variable_size ? 0x0200 : 0) |
                                    (p.size & 0x1FF));
}

std::uint32_t to_long_word(const NetworkParameters& p) noexcept {
  return (p.redundant_owner ? 0x8000'0000u : 0u) | static_cast<std::uint32_t>(p.type) << 29 |
         static_cast<std::uint32_t>(p.priority) << 26 | (p.variable_size ? 0x0200'0000u : 0u) | p.size;
}

NetworkParameters from_word(std::uint16_t w) noexcept {
  return {.type = static_cast<ConnectionType>(w >> 13 & 3),
          .priority = static_cast<Priority>(w >> 10 & 3),
          .redundant_owner = (w & 0x8000) != 0,
          .variable_size = (w & 0x0200) != 0,
          .size = static_cast<std::uint16_t>(w & 0x1FF)};
}

NetworkParameters from_long_word(std::uint32_t w) noexcept {
  return {.type = static_cast<ConnectionType>(w >> 29 & 3),
          .priority = static_cast<Priority>(w >> 26 & 3),
          .redundant_owner = (w & 0x8000'0000u) != 0,
          .variable_size = (w & 0x0200'0000u) != 0,
          .size = static_cast<std::uint16_t>(w & 0xFFFF)};
}

GeneralStatus read_forward_open(Bytes data, bool large, ForwardOpen& f) noexcept {
  wire::Reader in(data);
  const auto parameters = [&] { return large ? from_long_word(in.u32()) : from_word(in.u16()); };
  f.large = large;
  f.priority_tick = in.u8();
  f.timeout_ticks = in.u8();
  f.o_to_t_id = in.u32();
  f.t_to_o_id = in.u32();
  f.triad = read_triad(in);
  f.multiplier_code = in.u8();
  in.skip(3);  // reserved
  f.o_to_t_rpi_us = in.u32();
  f.o_to_t = parameters();
  f.t_to_o_rpi_us = in.u32();
  f.t_to_o = parameters();
  f.transport = in.u8();
  const std::size_t words = in.u8();
  return read_whole_path(in, words, f.path);
}

void write_forward_open(wire::Writer& out, const ForwardOpen& f) noexcept {
  const auto parameters = [&](const NetworkParameters& p) {
    if (f.large) {
      out.u32(to_long_word(p));
    } else {
      out.u16(to_word(p));
    }
  };
  out.u8(f.priority_tick);
  out.u8(f.timeout_ticks);
  out.u32(f.o_to_t_id);
  out.u32(f.t_to_o_id);
  write_triad(out, f.triad);
  out.u8(f.multiplier_code);
  out.zeros(3);
  out.u32(f.o_to_t_rpi_us);
  parameters(f.o_to_t);
  out.u32(f.t_to_o_rpi_us);
  parameters(f.t_to_o);
  out.u8(f.transport);
}

std::optional<ForwardOpenReply> read_forward_open_reply(Bytes data) noexcept {
  wire::Reader in(data);
  ForwardOpenReply r;
  r.o_to_t_id = in.u32();
  r.t_to_o_id = in.u32();
  r.triad = read_triad(in);
  r.o_to_t_api_us = in.u32();
  r.t_to_o_api_us = in.u32();
  if (!in.ok()) return std::nullopt;  // an application reply may follow; this device has none
  return r;
}

void write(wire::Writer& out, const ForwardOpenReply& r) noexcept {
  out.u32(r.o_to_t_id);
  out.u32(r.t_to_o_id);
  write_triad(out, r.triad);
  out.u32(r.o_to_t_api_us);
  out.u32(r.t_to_o_api_us);
  out.zeros(2);  // no application reply; reserved
}

std::optional<ConnectionFailure> read_connection_failure(Bytes data) noexcept {
  wire::Reader in(data);
  ConnectionFailure f;
  f.triad = read_triad(in);
  f.remaining_path_words = in.u8();
  if (!in.ok()) return std::nullopt;
  return f;
}

void write(wire::Writer& out, const ConnectionFailure& f) noexcept {
  write_triad(out, f.triad);
  out.u8(f.remaining_path_words);
  out.u8(0);
}

GeneralStatus read_forward_close(Bytes data, ForwardClose& f) noexcept {
  wire::Reader in(data);
  f.priority_tick = in.u8();
  f.timeout_ticks = in.u8();
  f.triad = read_triad(in);
  const std::size_t words = in.u8();
  in.u8();  // reserved
  return read_whole_path(in, words, f.path);
}

void write_forward_close(wire::Writer& out, const ForwardClose& f, Bytes path) noexcept {
  out.u8(f.priority_tick);
  out.u8(f.timeout_ticks);
  write_triad(out, f.triad);
  out.u8(static_cast<std::uint8_t>(path.size() / 2));
  out.u8(0);
  out.bytes(path);
}

std::optional<ConnectionTriad> read_forward_close_reply(Bytes data) noexcept {
  wire::Reader in(data);
  const ConnectionTriad triad = read_triad(in);
  if (!in.ok()) return std::nullopt;
  return triad;
}

void write_forward_close_reply(wire::Writer& out, const ConnectionTriad& triad) noexcept {
  write_triad(out, triad);
  out.zeros(2);  // no application reply; reserved
}

}  // namespace meca::ethernet_ip
