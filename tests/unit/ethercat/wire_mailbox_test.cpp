// Mailbox and CoE: mails of independent stacks, the ones that no capture has by the layout of ETG.1000.6.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/unit/ethercat/wire_golden.hpp"
#include "transports/ethercat/mailbox.hpp"

namespace meca::ethercat {
namespace {

using golden::from_hex;
using Kind = SdoMessage::Kind;

constexpr std::size_t kRoom = 128;

std::string hex(Bytes bytes) {
  std::string out;
  for (const std::byte byte : bytes) {
    std::array<char, 4> two;
    std::snprintf(two.data(), two.size(), "%s%02X", out.empty() ? "" : " ", std::to_integer<unsigned>(byte));
    out += two.data();
  }
  return out;
}

std::string number(unsigned value, int digits) {
  std::array<char, 12> out;
  std::snprintf(out.data(), out.size(), "%0*X", digits, value);
  return out.data();
}

std::string address(const SdoMessage& sdo) {
  return " " + number(sdo.address.index, 4) + ":" + number(sdo.address.sub, 2);
}

std::string value(const SdoMessage& sdo) {
  const bool all = sdo.data.size() == sdo.size;
  return std::string(sdo.complete_access ? ", complete" : "") + (sdo.expedited ? ", expedited" : "") + ", " +
         (all ? "" : std::to_string(sdo.data.size()) + " of ") + std::to_string(sdo.size) + " bytes";
}

std::string segment(const SdoMessage& sdo) {
  return std::string(", toggle ") + (sdo.toggle ? "1" : "0") + (sdo.last ? ", last" : "") + ", " +
         std::to_string(sdo.data.size()) + " bytes";
}

std::string text(const SdoMessage& sdo) {
  const std::string complete = sdo.complete_access ? ", complete" : "",
                    toggle = sdo.toggle ? ", toggle 1" : ", toggle 0";
  switch (sdo.kind) {
    case Kind::kUploadRequest:
      return "upload" + address(sdo) + complete;
    case Kind::kUploadResponse:
      return "uploaded" + address(sdo) + value(sdo);
    case Kind::kDownloadRequest:
      return "download" + address(sdo) + value(sdo);
    case Kind::kDownloadResponse:
      return "downloaded" + address(sdo) + complete;
    case Kind::kUploadSegmentRequest:
      return "upload segment" + toggle;
    case Kind::kUploadSegmentResponse:
      return "segment uploaded" + segment(sdo);
    case Kind::kDownloadSegmentRequest:
      return "download segment" + segment(sdo);
    case Kind::kDownloadSegmentResponse:
      return "segment downloaded" + toggle;
    case Kind::kAbort:
      return "abort" + address(sdo) + ", " + number(sdo.abort, 8);
    case Kind::kUnknown:
      return "unknown" + address(sdo);
  }
  return "";
}

// What a mail's memory says, "" for a mail that ends too early.
std::string mail_text(Bytes memory) {
  const auto mail = parse_mail(memory);
  if (!mail || mail->header.type != static_cast<std::uint8_t>(MailboxType::kCoe)) return "";
  wire::Reader in(mail->payload);
  const CoeHeader coe = read_coe_header(in);
  const auto sdo = parse_sdo(static_cast<CoeService>(coe.service), in.rest());
  return sdo ? text(*sdo) : "";
}

std::string sdo_text(CoeService service, std::string_view bytes) {
  const auto memory = from_hex(bytes);
  const auto sdo = parse_sdo(service, memory);
  return sdo ? text(*sdo) : "missing bytes";
}

std::string written(const SdoMessage& sdo) {
  std::vector<std::byte> buffer(kRoom);
  wire::Writer out(buffer);
  write(out, sdo);
  EXPECT_TRUE(out.ok());
  return hex(out.written());
}

struct Golden {
  std::string_view mail;
  const char* says;
};
constexpr Golden kSdo[] = {
    {golden::kUploadVendorRequest, "upload 1018:01"},
    {golden::kUploadVendorResponse, "uploaded 1018:01, expedited, 4 bytes"},
    {golden::kUploadNameResponse, "uploaded 1008:00, 7 bytes"},
    {golden::kUploadCountResponse, "uploaded 1C12:00, expedited, 1 bytes"},
    {golden::kUploadEntryResponse, "uploaded 1C12:01, expedited, 2 bytes"},
    {golden::kNoObject, "abort 5FFF:00, 06020000"},
    {golden::kNoSubindex, "abort 1018:09, 06090011"},
    {golden::kDownloadRequest, "download 10F1:02, expedited, 2 bytes"},
    {golden::kDownloadResponse, "downloaded 10F1:02"},
    {golden::kReadOnly, "abort 1018:01, 06010002"},
    {golden::kCompleteRequest, "upload 1C12:00, complete"},
    {golden::kCompleteResponse, "uploaded 1C12:00, complete, 20 bytes"},
    {golden::kLongUpload, "uploaded 2F00:00, 112 of 512 bytes"},
    {golden::kLongUploadSegmentRequest, "upload segment, toggle 0"},
    {golden::kLongUploadSegment, "segment uploaded, toggle 0, 119 bytes"},
    {golden::kLongUploadSegmentRequest1, "upload segment, toggle 1"},
    {golden::kLongUploadLast, "segment uploaded, toggle 1, last, 43 bytes"},
    {golden::kLongDownload, "download 2F00:00, 112 of 512 bytes"},
    {golden::kLongDownloadWithoutData, "download 2F00:00, 0 of 512 bytes"},
    {golden::kLongDownloadSegment, "download segment, toggle 0, 119 bytes"},
    {golden::kLongDownloadSegmentResponse, "segment downloaded, toggle 0"},
    {golden::kLongDownloadSegmentResponse1, "segment downloaded, toggle 1"},
    {golden::kLongDownloadLast, "download segment, toggle 1, last, 43 bytes"},
    {golden::kSafetyMapping, "uploaded 1A11:00, complete, 112 of 122 bytes"},
    {golden::kSafetyMappingLast, "segment uploaded, toggle 0, last, 10 bytes"},
};
static_assert(std::size(kSdo) == std::size(golden::kMails));

TEST(EtherCatMailbox, SdoMailsOfIndependentStacksAreReadByName) {
  for (const auto& [mail, says] : kSdo) EXPECT_EQ(mail_text(from_hex(mail)), says) << mail;
}

TEST(EtherCatMailbox, TheHeaderIsReadAndWrittenAsItIsOnTheWire) {
  const auto memory = from_hex(golden::kUploadNameResponse);
  const auto mail = parse_mail(memory);
  ASSERT_TRUE(mail);
  EXPECT_EQ(mail->header.length, 17);
  EXPECT_EQ(mail->header.address, 0);
  EXPECT_EQ(mail->header.channel, 0);
  EXPECT_EQ(mail->header.priority, 0);
  EXPECT_EQ(mail->header.type, static_cast<std::uint8_t>(MailboxType::kCoe));
  EXPECT_EQ(mail->header.counter, 2);
  EXPECT_EQ(mail->payload.size(), 17U);

  std::array<std::byte, kMailboxHeader> buffer;
  wire::Writer out(buffer);
  write(out, MailboxHeader{0x0102, 0x1003, 5, 2, 15, 7});
  EXPECT_EQ(hex(buffer), "02 01 03 10 85 7F");
  const auto back = parse_mail(from_hex("00 00 03 10 85 FF"));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->header.channel, 5);
  EXPECT_EQ(back->header.priority, 2);
  EXPECT_EQ(back->header.type, static_cast<std::uint8_t>(MailboxType::kVoe));
  EXPECT_EQ(back->header.counter, 7) << "the highest bit is reserved";
}

TEST(EtherCatMailbox, WhatStandsBehindAMailIsNotPartOfIt) {
  auto memory = from_hex(golden::kUploadNameResponse);
  memory.resize(kRoom, std::byte{0xEE});
  EXPECT_EQ(mail_text(memory), "uploaded 1008:00, 7 bytes");
}

TEST(EtherCatMailbox, AMailThatEndsTooEarlyIsNone) {
  for (const auto& [golden, says] : kSdo) {
    const auto whole = from_hex(golden);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_FALSE(parse_mail(part)) << size << " bytes of " << says;
    }
  }
}

TEST(EtherCatMailbox, AnSdoMessageThatEndsTooEarlyIsNoneOrSaysLess) {
  for (const auto& [golden, says] : kSdo) {
    const auto memory = from_hex(golden);
    const auto mail = parse_mail(memory);
    ASSERT_TRUE(mail);
    wire::Reader in(mail->payload);
    const auto service = static_cast<CoeService>(read_coe_header(in).service);
    const Bytes whole = in.rest();
    const auto full = parse_sdo(service, whole);
    ASSERT_TRUE(full);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      const auto less = parse_sdo(service, part);
      if (!less) continue;
      EXPECT_EQ(less->kind, full->kind) << size << " bytes of " << says;
      EXPECT_LE(less->data.size(), full->data.size()) << size << " bytes of " << says;
      EXPECT_TRUE(std::equal(less->data.begin(), less->data.end(), full->data.begin()));
    }
    EXPECT_FALSE(parse_sdo(service, {})) << says;
  }
}

TEST(EtherCatMailbox, TheCounterGoesFromOneToSevenAndRoundAndNeverToZero) {
  EXPECT_EQ(next_mailbox_counter(0), 1);
  EXPECT_EQ(next_mailbox_counter(1), 2);
  EXPECT_EQ(next_mailbox_counter(6), 7);
  EXPECT_EQ(next_mailbox_counter(7), 1);
}

// ETG.1000.6, 5.6.1: type 1, then the detail.
TEST(EtherCatMailbox, AnErrorReplyGivesItsDetail) {
  EXPECT_EQ(parse_mailbox_error(from_hex("01 00 02 00")), std::optional<std::uint16_t>(2));
  EXPECT_EQ(parse_mailbox_error(from_hex("02 00 02 00")), std::nullopt);
  EXPECT_EQ(parse_mailbox_error(from_hex("01 00 02")), std::nullopt);
}

TEST(EtherCatMailbox, TheCoeHeaderHoldsNumberAndService) {
  const auto bytes = from_hex("FF 31");
  wire::Reader in(bytes);
  const CoeHeader header = read_coe_header(in);
  EXPECT_EQ(header.number, 0x1FF);
  EXPECT_EQ(header.service, static_cast<std::uint8_t>(CoeService::kSdoResponse));
  std::array<std::byte, kCoeHeader> buffer;
  wire::Writer out(buffer);
  write(out, header);
  EXPECT_EQ(hex(buffer), "FF 31");
}

// ---- SDO, what no capture has

TEST(EtherCatSdo, TheSameSpecifierIsAnotherThingInARequestAndInAResponse) {
  const auto both = [](std::string_view bytes) {
    return sdo_text(CoeService::kSdoRequest, bytes) + " | " + sdo_text(CoeService::kSdoResponse, bytes);
  };
  EXPECT_EQ(both("00 01 02 03 04 05 06 07"),
            "download segment, toggle 0, 7 bytes | segment uploaded, toggle 0, 7 bytes");
  EXPECT_EQ(both("2F 18 10 01 04 00 00 00"), "download 1018:01, expedited, 1 bytes | segment downloaded, toggle 0");
  EXPECT_EQ(both("43 18 10 01 04 00 00 00"), "upload 1018:01 | uploaded 1018:01, expedited, 4 bytes");
  EXPECT_EQ(both("60 18 10 01 00 00 00 00"), "upload segment, toggle 0 | downloaded 1018:01");
  EXPECT_EQ(both("A0 18 10 01 00 00 00 00"), "unknown 1018:01 | unknown 1018:01");
}

TEST(EtherCatSdo, AnAbortIsOneWhateverItsOtherBits) {  // KickCAT's simulator sends 83h
  EXPECT_EQ(sdo_text(CoeService::kSdoResponse, "83 18 10 01 11 00 09 06"), "abort 1018:01, 06090011");
  EXPECT_EQ(sdo_text(CoeService::kSdoRequest, "80 18 10 01 11 00 09 06"), "abort 1018:01, 06090011");
}

TEST(EtherCatSdo, OtherServicesAreNoSdo) {
  EXPECT_EQ(sdo_text(CoeService::kEmergency, "40 18 10 01 00 00 00 00"), "missing bytes");
  EXPECT_EQ(sdo_text(CoeService::kSdoInformation, "40 18 10 01 00 00 00 00"), "missing bytes");
}

TEST(EtherCatSdo, AnExpeditedValueWithoutIndicatedSizeHasFourBytes) {
  EXPECT_EQ(sdo_text(CoeService::kSdoResponse, "42 18 10 01 01 02 03 04"), "uploaded 1018:01, expedited, 4 bytes");
}

TEST(EtherCatSdo, ValuesEndWhereTheirSizeSaysAndShortSegmentsWhereTheirCommandSays) {
  EXPECT_EQ(sdo_text(CoeService::kSdoResponse, "41 08 10 00 03 00 00 00 41 42 43 00 00"), "uploaded 1008:00, 3 bytes");
  EXPECT_EQ(sdo_text(CoeService::kSdoResponse, "0B 41 42 00 00 00 00 00"), "segment uploaded, toggle 0, last, 2 bytes");
  EXPECT_EQ(sdo_text(CoeService::kSdoResponse, "0B 41 42"), "segment uploaded, toggle 0, last, 2 bytes");
  EXPECT_EQ(sdo_text(CoeService::kSdoResponse, "09 41 42"), "missing bytes") << "3 were promised";
}

TEST(EtherCatSdo, WhatBeginsATransferHasEightBytesAlsoWhereTheLastAreReserved) {
  EXPECT_EQ(sdo_text(CoeService::kSdoRequest, "40 18 10 01 00 00 00"), "missing bytes");
  EXPECT_EQ(sdo_text(CoeService::kSdoResponse, "60 18 10 01 00 00 00"), "missing bytes");
  EXPECT_EQ(sdo_text(CoeService::kSdoResponse, "43 18 10 01 00 00 00"), "missing bytes");
  EXPECT_EQ(sdo_text(CoeService::kSdoRequest, "60"), "upload segment, toggle 0") << "of a segment they do not matter";
}

TEST(EtherCatSdo, MessagesAreWrittenAsTheOtherStacksWriteThem) {
  const auto bytes = from_hex("07 00");
  EXPECT_EQ(written({.kind = Kind::kUploadRequest, .address = {0x1018, 1}}), "40 18 10 01 00 00 00 00");
  EXPECT_EQ(written({.kind = Kind::kUploadRequest, .address = {0x1C12, 0}, .complete_access = true}),
            "50 12 1C 00 00 00 00 00");
  EXPECT_EQ(
      written({.kind = Kind::kDownloadRequest, .address = {0x10F1, 2}, .expedited = true, .size = 2, .data = bytes}),
      "2B F1 10 02 07 00 00 00");
  EXPECT_EQ(written({.kind = Kind::kDownloadRequest, .address = {0x10F1, 2}, .size = 2, .data = bytes}),
            "21 F1 10 02 02 00 00 00 07 00");
  EXPECT_EQ(written({.kind = Kind::kDownloadResponse, .address = {0x10F1, 2}}), "60 F1 10 02 00 00 00 00");
  EXPECT_EQ(written({.kind = Kind::kUploadSegmentRequest, .toggle = true}), "70 00 00 00 00 00 00 00");
  EXPECT_EQ(written({.kind = Kind::kDownloadSegmentResponse, .toggle = true}), "30 00 00 00 00 00 00 00");
  EXPECT_EQ(written({.kind = Kind::kUploadSegmentResponse, .toggle = true, .last = true, .data = bytes}),
            "1B 07 00 00 00 00 00 00");
  EXPECT_EQ(written({.kind = Kind::kAbort, .address = {0x5FFF, 0}, .abort = 0x06020000}), "80 FF 5F 00 00 00 02 06");
  EXPECT_EQ(written({.kind = Kind::kUnknown}), "");
}

TEST(EtherCatSdo, AnExpeditedValueOfNoOrFiveBytesIsWrittenAsALongOne) {
  const auto five = from_hex("01 02 03 04 05");
  const SdoMessage message{
      .kind = Kind::kUploadResponse, .address = {0x1008, 0}, .expedited = true, .size = 5, .data = five};
  EXPECT_EQ(written(message), "41 08 10 00 05 00 00 00 01 02 03 04 05");
  EXPECT_EQ(written({.kind = Kind::kUploadResponse, .address = {0x1008, 0}, .expedited = true}),
            "41 08 10 00 00 00 00 00");
}

TEST(EtherCatSdo, WhatWasReadReadsTheSameAfterItIsWritten) {
  for (const auto& [golden, says] : kSdo) {
    const auto memory = from_hex(golden);
    wire::Reader in(Bytes(memory).subspan(kMailboxHeader));
    const auto service = static_cast<CoeService>(read_coe_header(in).service);
    const auto message = parse_sdo(service, in.rest());
    ASSERT_TRUE(message);
    const auto again = from_hex(written(*message));
    const auto back = parse_sdo(service, again);
    ASSERT_TRUE(back) << says;
    EXPECT_EQ(text(*back), says);
    EXPECT_TRUE(std::ranges::equal(back->data, message->data)) << says;
  }
}

// ---- Emergencies and SDO information: no capture has them; ETG.1000.6, 5.6.4 and 5.6.3

TEST(EtherCatEmergency, IsReadAndWritten) {
  const auto emergency = parse_emergency(from_hex("00 A0 81 01 02 03 04 05"));
  ASSERT_TRUE(emergency);
  EXPECT_EQ(emergency->code, 0xA000);
  EXPECT_EQ(emergency->error_register, 0x81);
  EXPECT_EQ(hex(emergency->data), "01 02 03 04 05");
  std::array<std::byte, 8> buffer;
  wire::Writer out(buffer);
  write(out, *emergency);
  EXPECT_EQ(hex(buffer), "00 A0 81 01 02 03 04 05");
  for (std::size_t size = 0; size < buffer.size(); ++size) EXPECT_FALSE(parse_emergency(Bytes(buffer).first(size)));
}

TEST(EtherCatSdoInformation, TheHeaderHoldsOpcodeAndFragments) {
  const auto bytes = from_hex("82 00 03 01");
  wire::Reader in(bytes);
  const auto header = read_sdo_information_header(in);
  EXPECT_TRUE(in.ok());
  EXPECT_EQ(header.opcode, static_cast<std::uint8_t>(SdoInformation::kListResponse));
  EXPECT_TRUE(header.incomplete);
  EXPECT_EQ(header.fragments_left, 0x0103);
  std::array<std::byte, 4> buffer;
  wire::Writer out(buffer);
  write(out, header);
  EXPECT_EQ(hex(buffer), "82 00 03 01");
}

}  // namespace
}  // namespace meca::ethercat
