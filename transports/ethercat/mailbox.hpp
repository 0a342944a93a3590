// Mailbox and CANopen over EtherCAT (CoE): headers, SDO and SDO information services, emergencies (ETG.1000.6, 5.6;
// spec 5.8). Bytes <-> structs only; who waits for what is in sdo_client.hpp and coe_server.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "transports/ethercat/frame.hpp"
#include "transports/image/field.hpp"
#include "transports/wire/writer.hpp"

namespace meca::ethercat {

inline constexpr std::size_t kMailboxHeader = 6, kCoeHeader = 2, kSdoHeader = 8;  // SDO: command, index, sub, 4 bytes

enum class MailboxType : std::uint8_t { kError = 0, kAoe = 1, kEoe = 2, kCoe = 3, kFoe = 4, kSoe = 5, kVoe = 15 };

struct MailboxHeader {
  std::uint16_t length = 0;   // of what follows
  std::uint16_t address = 0;  // station; 0 = the master
  std::uint8_t channel = 0, priority = 0;
  std::uint8_t type = 0;     // MailboxType, or another
  std::uint8_t counter = 0;  // 1..7, 0: not used
};
// A mail out of a mailbox's memory: the header and the `length` bytes it promises; empty when they are not there.
struct Mail {
  MailboxHeader header;
  Bytes payload;
};
std::optional<Mail> parse_mail(Bytes memory) noexcept;
void write(wire::Writer& out, const MailboxHeader& header) noexcept;
constexpr std::uint8_t next_mailbox_counter(std::uint8_t counter) noexcept {  // 1, 2, .. 7, 1
  return static_cast<std::uint8_t>(counter % 7 + 1);
}

// Mailbox error reply (type 0): 1, then one of these.
enum class MailboxError : std::uint16_t {
  kSyntax = 1,
  kUnsupportedProtocol = 2,
  kInvalidChannel = 3,
  kServiceNotSupported = 4,
  kInvalidHeader = 5,
  kSizeTooShort = 6,
  kNoMoreMemory = 7,
  kInvalidSize = 8
};
std::optional<std::uint16_t> parse_mailbox_error(Bytes payload) noexcept;

enum class CoeService : std::uint8_t {
  kEmergency = 1,
  kSdoRequest = 2,
  kSdoResponse = 3,
  kTxPdo = 4,
  kRxPdo = 5,
  kTxPdoRemote = 6,
  kRxPdoRemote = 7,
  kSdoInformation = 8
};
struct CoeHeader {
  std::uint16_t number = 0;
  std::uint8_t service = 0;  // CoeService, or another
};
CoeHeader read_coe_header(wire::Reader& in) noexcept;
void write(wire::Writer& out, const CoeHeader& header) noexcept;

// ---- SDO. What stands after the CoE header.
enum class SdoAbort : std::uint32_t {
  kToggle = 0x05030000,
  kTimeout = 0x05040000,
  kCommand = 0x05040001,
  kMemory = 0x05040005,
  kUnsupportedAccess = 0x06010000,
  kWriteOnly = 0x06010001,
  kReadOnly = 0x06010002,
  kSubindex0NotZero = 0x06010003,
  kNoCompleteAccess = 0x06010004,
  kNoObject = 0x06020000,
  kNotMappable = 0x06040041,
  kMappingTooLong = 0x06040042,
  kIncompatible = 0x06040043,
  kLength = 0x06070010,
  kTooLong = 0x06070012,
  kTooShort = 0x06070013,
  kNoSubindex = 0x06090011,
  kValueRange = 0x06090030,
  kGeneral = 0x08000000,
  kState = 0x08000022
};

struct SdoAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  friend bool operator==(const SdoAddress&, const SdoAddress&) = default;
};

// One SDO message of either direction, whatever it is; which fields mean something depends on `kind`.
struct SdoMessage {
  enum class Kind : std::uint8_t {
    kUploadRequest,            // address, complete_access
    kUploadResponse,           // address, complete_access, size, data: all of it (expedited), or the first part
    kDownloadRequest,          // the same
    kDownloadResponse,         // address, complete_access
    kUploadSegmentRequest,     // toggle
    kUploadSegmentResponse,    // toggle, last, data
    kDownloadSegmentRequest,   // toggle, last, data
    kDownloadSegmentResponse,  // toggle
    kAbort,                    // address, abort
    kUnknown,                  // a command specifier of no service
  };
  Kind kind = Kind::kUnknown;
  SdoAddress address{};
  bool complete_access = false, expedited = false, toggle = false, last = false;
  std::uint32_t size = 0;  // of the whole value
  Bytes data{};
  std::uint32_t abort = 0;
};
// `service`: request or response, which says how the command specifier is to be read; aborts come as either. An abort
// is whatever has the specifier 4, other bits may be set. Empty when bytes are missing.
std::optional<SdoMessage> parse_sdo(CoeService service, Bytes bytes) noexcept;
// Writes the message after its CoE header; what is kUnknown is not written. Expedited where `expedited` is set and
// there are 1 to 4 bytes of data. Segments of fewer than 7 bytes are filled up to 7.
void write(wire::Writer& out, const SdoMessage& message) noexcept;

// ---- Emergencies
struct Emergency {
  std::uint16_t code = 0;
  std::uint8_t error_register = 0;
  std::array<std::byte, 5> data{};
};
std::optional<Emergency> parse_emergency(Bytes bytes) noexcept;
void write(wire::Writer& out, const Emergency& emergency) noexcept;

// ---- SDO information
enum class SdoInformation : std::uint8_t {
  kListRequest = 1,
  kListResponse = 2,
  kObjectRequest = 3,
  kObjectResponse = 4,
  kEntryRequest = 5,
  kEntryResponse = 6,
  kError = 7
};
struct SdoInformationHeader {
  std::uint8_t opcode = 0;  // SdoInformation, or another
  bool incomplete = false;  // more fragments follow
  std::uint16_t fragments_left = 0;
};
SdoInformationHeader read_sdo_information_header(wire::Reader& in) noexcept;
void write(wire::Writer& out, const SdoInformationHeader& header) noexcept;

}  // namespace meca::ethercat
