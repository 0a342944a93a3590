#include "transports/ethercat/mailbox.hpp"

#include <algorithm>

namespace meca::ethercat {
namespace {

// The command byte of an SDO message (ETG.1000.6, 5.6.2): specifier in bits 5 to 7, and below it, of an initiate
// message: complete access, length of expedited data, expedited, size indicated; of a segment: toggle, unused bytes of
// the shortest segment, last.
constexpr std::uint8_t kCompleteAccess = 0x10, kExpedited = 0x02, kSizeIndicated = 0x01;
constexpr std::uint8_t kToggle = 0x10, kLast = 0x01;
constexpr std::size_t kExpeditedBytes = 4, kShortestSegment = 7;

using Kind = SdoMessage::Kind;

// Requests and responses use the same specifiers for different things.
struct Specifier {
  Kind request, response;
};
constexpr std::array<Specifier, 5> kSpecifiers{{
    {Kind::kDownloadSegmentRequest, Kind::kUploadSegmentResponse},
    {Kind::kDownloadRequest, Kind::kDownloadSegmentResponse},
    {Kind::kUploadRequest, Kind::kUploadResponse},
    {Kind::kUploadSegmentRequest, Kind::kDownloadResponse},
    {Kind::kAbort, Kind::kAbort},
}};

constexpr std::uint8_t specifier_of(Kind kind) noexcept {
  std::uint8_t specifier = 0;
  while (kSpecifiers[specifier].request != kind && kSpecifiers[specifier].response != kind) ++specifier;
  return static_cast<std::uint8_t>(specifier << 5);
}

Kind kind_of(CoeService service, std::uint8_t command) noexcept {
  const std::size_t specifier = command >> 5;
  if (specifier >= kSpecifiers.size()) return Kind::kUnknown;
  return service == CoeService::kSdoRequest ? kSpecifiers[specifier].request : kSpecifiers[specifier].response;
}

void read_address(wire::Reader& in, SdoMessage& message) noexcept {
  message.address.index = in.u16();
  message.address.sub = in.u8();
}

// The value of an upload response or a download request, or where it begins.
void read_value(wire::Reader& in, std::uint8_t command, SdoMessage& message) noexcept {
  message.expedited = (command & kExpedited) != 0;
  if (message.expedited) {
    const std::size_t unused = (command & kSizeIndicated) != 0 ? command >> 2 & 3U : 0U;
    const Bytes four = in.bytes(kExpeditedBytes);
    if (!in.ok()) return;
    message.data = four.first(kExpeditedBytes - unused);
    message.size = static_cast<std::uint32_t>(message.data.size());
    return;
  }
  message.size = in.u32();
  const Bytes rest = in.rest();
  message.data = rest.first(std::min<std::size_t>(rest.size(), message.size));
}

// Only segments of up to 7 bytes say how many of them are used.
void read_segment(wire::Reader& in, std::uint8_t command, SdoMessage& message) noexcept {
  message.last = (command & kLast) != 0;
  if (in.remaining() > kShortestSegment) {
    message.data = in.rest();
  } else {
    message.data = in.bytes(kShortestSegment - (command >> 1 & 7U));
  }
}

void write_address(wire::Writer& out, std::uint8_t command, const SdoMessage& message) noexcept {
  out.u8(command);
  out.u16(message.address.index);
  out.u8(message.address.sub);
}

void write_value(wire::Writer& out, std::uint8_t command, const SdoMessage& message) noexcept {
  const std::size_t size = message.data.size();
  if (message.expedited && size > 0 && size <= kExpeditedBytes) {
    const auto unused = static_cast<std::uint8_t>(kExpeditedBytes - size);
    write_address(out, static_cast<std::uint8_t>(command | unused << 2 | kExpedited | kSizeIndicated), message);
    out.bytes(message.data);
    out.zeros(unused);
    return;
  }
  write_address(out, static_cast<std::uint8_t>(command | kSizeIndicated), message);
  out.u32(message.size);
  out.bytes(message.data);
}

void write_segment(wire::Writer& out, std::uint8_t command, const SdoMessage& message) noexcept {
  const std::size_t size = message.data.size();
  const auto unused = static_cast<std::uint8_t>(size < kShortestSegment ? kShortestSegment - size : 0);
  out.u8(static_cast<std::uint8_t>(command | unused << 1 | (message.last ? kLast : 0)));
  out.bytes(message.data);
  out.zeros(unused);
}

}  // namespace

std::optional<Mail> parse_mail(Bytes memory) noexcept {
  wire::Reader in(memory);
  Mail mail;
  mail.header.length = in.u16();
  mail.header.address = in.u16();
  const std::uint8_t channel = in.u8(), type = in.u8();
  mail.header.channel = channel & 0x3F;
  mail.header.priority = channel >> 6;
  mail.header.type = type & 0x0F;
  mail.header.counter = type >> 4 & 0x07;
  mail.payload = in.bytes(mail.header.length);
  if (!in.ok()) return std::nullopt;
  return mail;
}

void write(wire::Writer& out, const MailboxHeader& header) noexcept {
  out.u16(header.length);
  out.u16(header.address);
  out.u8(static_cast<std::uint8_t>((header.channel & 0x3F) | header.priority << 6));
  out.u8(static_cast<std::uint8_t>((header.type & 0x0F) | (header.counter & 0x07) << 4));
}

std::optional<std::uint16_t> parse_mailbox_error(Bytes payload) noexcept {
  constexpr std::uint16_t kErrorReply = 1;
  wire::Reader in(payload);
  const std::uint16_t type = in.u16(), detail = in.u16();
  if (!in.ok() || type != kErrorReply) return std::nullopt;
  return detail;
}

CoeHeader read_coe_header(wire::Reader& in) noexcept {
  const std::uint16_t word = in.u16();
  return {static_cast<std::uint16_t>(word & 0x01FF), static_cast<std::uint8_t>(word >> 12)};
}

void write(wire::Writer& out, const CoeHeader& header) noexcept {
  out.u16(static_cast<std::uint16_t>((header.number & 0x01FF) | header.service << 12));
}

std::optional<SdoMessage> parse_sdo(CoeService service, Bytes bytes) noexcept {
  if (service != CoeService::kSdoRequest && service != CoeService::kSdoResponse) return std::nullopt;
  wire::Reader in(bytes);
  const std::uint8_t command = in.u8();
  SdoMessage message;
  message.kind = kind_of(service, command);
  switch (message.kind) {
    case Kind::kUploadRequest:
    case Kind::kDownloadResponse:
      message.complete_access = (command & kCompleteAccess) != 0;
      read_address(in, message);
      in.skip(kExpeditedBytes);
      break;
    case Kind::kUploadResponse:
    case Kind::kDownloadRequest:
      message.complete_access = (command & kCompleteAccess) != 0;
      read_address(in, message);
      read_value(in, command, message);
      break;
    case Kind::kUploadSegmentResponse:
    case Kind::kDownloadSegmentRequest:
      message.toggle = (command & kToggle) != 0;
      read_segment(in, command, message);
      break;
    case Kind::kUploadSegmentRequest:
    case Kind::kDownloadSegmentResponse:
      message.toggle = (command & kToggle) != 0;
      break;
    case Kind::kAbort:
      read_address(in, message);
      message.abort = in.u32();
      break;
    case Kind::kUnknown:
      read_address(in, message);
      break;
  }
  if (!in.ok()) return std::nullopt;
  return message;
}

void write(wire::Writer& out, const SdoMessage& message) noexcept {
  if (message.kind == Kind::kUnknown) return;
  const std::uint8_t specifier = specifier_of(message.kind);
  const auto initiate = static_cast<std::uint8_t>(specifier | (message.complete_access ? kCompleteAccess : 0));
  const auto segment = static_cast<std::uint8_t>(specifier | (message.toggle ? kToggle : 0));
  switch (message.kind) {
    case Kind::kUploadRequest:
    case Kind::kDownloadResponse:
      write_address(out, initiate, message);
      out.zeros(kExpeditedBytes);
      break;
    case Kind::kUploadResponse:
    case Kind::kDownloadRequest:
      write_value(out, initiate, message);
      break;
    case Kind::kUploadSegmentResponse:
    case Kind::kDownloadSegmentRequest:
      write_segment(out, segment, message);
      break;
    case Kind::kUploadSegmentRequest:
    case Kind::kDownloadSegmentResponse:
      out.u8(segment);
      out.zeros(kShortestSegment);
      break;
    case Kind::kAbort:
      write_address(out, specifier, message);
      out.u32(message.abort);
      break;
    case Kind::kUnknown:
      break;
  }
}

std::optional<Emergency> parse_emergency(Bytes bytes) noexcept {
  wire::Reader in(bytes);
  Emergency emergency;
  emergency.code = in.u16();
  emergency.error_register = in.u8();
  const Bytes data = in.bytes(emergency.data.size());
  if (!in.ok()) return std::nullopt;
  std::copy(data.begin(), data.end(), emergency.data.begin());
  return emergency;
}

void write(wire::Writer& out, const Emergency& emergency) noexcept {
  out.u16(emergency.code);
  out.u8(emergency.error_register);
  out.bytes(emergency.data);
}

SdoInformationHeader read_sdo_information_header(wire::Reader& in) noexcept {
  const std::uint8_t opcode = in.u8();
  in.skip(1);
  return {static_cast<std::uint8_t>(opcode & 0x7F), (opcode & 0x80) != 0, in.u16()};
}

void write(wire::Writer& out, const SdoInformationHeader& header) noexcept {
  out.u8(static_cast<std::uint8_t>((header.opcode & 0x7F) | (header.incomplete ? 0x80 : 0)));
  out.u8(0);
  out.u16(header.fragments_left);
}

}  // namespace meca::ethercat
