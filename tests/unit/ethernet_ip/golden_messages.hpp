// Whole messages as independent stacks put them on the wire, in hex: EIPScanner (meca1, hdr), EEIP.NET (eeip) and test
// originators (vendor, wd2) against OpENer adapters with the sizes and the identity of a Meca500. "meca1, frame 8"
// names capture and frame. Messages that no capture has are written by hand, and say so.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "transports/wire/reader.hpp"

namespace meca::ethernet_ip::test {

// "6F 00" -> bytes; blanks are passed over.
inline std::vector<std::byte> from_hex(std::string_view text) {
  std::vector<std::byte> bytes;
  std::size_t digits = 0;
  for (const char c : text) {
    if (c == ' ') continue;
    const auto digit = std::string_view("0123456789ABCDEF").find(c);
    if (digit == std::string_view::npos) throw std::invalid_argument("bad golden hex");
    if (digits++ % 2 == 0)
      bytes.push_back(static_cast<std::byte>(digit << 4));
    else
      bytes.back() |= static_cast<std::byte>(digit);
  }
  if (digits % 2 != 0) throw std::invalid_argument("golden hex with half a byte");
  return bytes;
}

// The same, with the zeros at its end that were cut.
inline std::vector<std::byte> from_hex(std::string_view text, std::size_t size) {
  auto bytes = from_hex(text);
  bytes.resize(size);
  return bytes;
}

inline std::string to_hex(wire::Bytes bytes) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const std::byte b : bytes) {
    out += kDigits[std::to_integer<std::size_t>(b >> 4)];
    out += kDigits[std::to_integer<std::size_t>(b & std::byte{15})];
  }
  return out;
}

namespace golden {

// meca1, frame 4: RegisterSession; the reply gives session 1
inline constexpr std::string_view kRegisterRequest = "65000400000000000000000000000000000000000000000001000000";
// meca1, frame 6
inline constexpr std::string_view kRegisterReply = "65000400010000000000000000000000000000000000000001000000";
// meca1, frame 8: point-to-point, 10 ms, request path of 16 bit segments, no key; the target sends from 0.0.0.0:2222
inline constexpr std::string_view kOpenRequest =
    "6F0044000100000000000000000000000000000000000000000000000000020000000000B20034005404210006002500"
    "01000AF50000000001002DDC010034125B69026B0000000010270000424810270000FE48010320042C962C64";
// meca1, frame 9
inline constexpr std::string_view kOpenReply =
    "6F0042000100000000000000000000000000000000000000000000000000030000000000B2001E00D40000001300E63F"
    "01002DDC010034125B69026B1027000010270000000000801000000208AE000000000000000000000000";
// meca1, frame 974
inline constexpr std::string_view kCloseRequest =
    "6F002C000100000000000000000000000000000000000000000000000000020000000000B2001C004E04210006002500"
    "01000000010034125B69026B030020042C962C64";
// meca1, frame 975
inline constexpr std::string_view kCloseReply =
    "6F001E000100000000000000000000000000000000000000000000000000020000000000B2000E00CE00000001003412"
    "5B69026B0000";
// meca1, frame 977
inline constexpr std::string_view kUnregisterRequest = "660000000100000000000000000000000000000000000000";
// eeip, frame 824: multicast, 10 ms, configuration instance 0, port 2222 named
inline constexpr std::string_view kMulticastOpenRequest =
    "6F0056000100000000000000000000000000000000000000000000000000030000000000B200320054022006240103FA"
    "B530760AAC04EE02927CFF00FFFFFFFF0300000010270000424810270000FE280104200424002C962C64018010000002"
    "08AE000000000000000000000000";
// eeip, frame 825
inline constexpr std::string_view kMulticastOpenReply =
    "6F0056000100000000000000000000000000000000000000000000000000040000000000B2001E00D4000000140086C6"
    "150086C6927CFF00FFFFFFFF1027000010270000000000801000000208AE000000000000000000000000018010000002"
    "08AEEFC001400000000000000000";
// eeip, frame 1628
inline constexpr std::string_view kMulticastCloseRequest =
    "6F002A000100000000000000000000000000000000000000000000000000020000000000B2001A004E022006240103FA"
    "927CFF00FFFFFFFF0400200424002C962C64";
// hdr, frame 8: T->O with a run/idle header: 258 bytes
inline constexpr std::string_view kHeaderOpenRequest =
    "6F0044000100000000000000000000000000000000000000000000000000020000000000B20034005404210006002500"
    "01000AF5000000000100E6F8010001000100000000000000204E00004248204E00000249010320042C962C64";
// hdr, frame 9
inline constexpr std::string_view kHeaderOpenReply =
    "6F0042000100000000000000000000000000000000000000000000000000030000000000B2001E00D400000013003CE4"
    "0100E6F80100010001000000204E0000204E0000000000801000000208AE000000000000000000000000";
// vendor, frame 8: the Forward Open of the vendor's Omron project: multicast, 50 ms, key compatible 10.2
inline constexpr std::string_view kKeyedOpenRequest =
    "6F004A00010000000000000070726F626500000000000000000000000000020000000000B2003A005402200624010AF5"
    "00000000A8653EBF03CBAD0B515151510000000050C30000424850C30000FE28010834041D062B00F4018A0220042C96"
    "2C64";
// vendor, frame 9: by an adapter of revision 11.3
inline constexpr std::string_view kKeyRefused =
    "6F002000010000000000000070726F626500000000000000000000000000020000000000B2001000D4000101160103CB"
    "AD0B515151510000";
// vendor, frame 36: the same with a key of compatible 11.3
inline constexpr std::string_view kKeyed113OpenRequest =
    "6F004A00010000000000000070726F626500000000000000000000000000020000000000B2003A005402200624010AF5"
    "0000000057DAD0CE05CBAD0B515151510000000050C30000424850C30000FE28010834041D062B00F4018B0320042C96"
    "2C64";
// vendor, frame 37
inline constexpr std::string_view kKeyed113OpenReply =
    "6F005600010000000000000070726F626500000000000000000000000000040000000000B2001E00D400000015000544"
    "1600054405CBAD0B5151515150C3000050C30000000000801000000208AE000000000000000000000000018010000002"
    "08AEEFC001400000000000000000";
// wd2, frame 226: another originator has the outputs
inline constexpr std::string_view kOwnedRefused =
    "6F002000010000000000000070726F626500000000000000000000000000020000000000B2001000D40001010601D613"
    "AD0B585151510000";
// meca1, frame 10: T->O, first and third packet; zeros at the end are cut, here and below
inline constexpr std::string_view kInputPacket1 =
    "02000280080001002DDC01000000B100FE00010000000000000000000000000000000000000000000000000000000000"
    "0000000000000000000000000000000000000000000000000000000000000000000000000000000001";
// meca1, frame 13
inline constexpr std::string_view kInputPacket3 =
    "02000280080001002DDC03000000B100FE0003000000000001000000090A0B0C0D0E0F101112131415161718191A1B1C"
    "1D1E1F202122232425262728292A2B2C2D2E2F303132333435363738393A3B3C010000000100000003";
// meca1, frame 12: O->T, first packet
inline constexpr std::string_view kOutputPacket1 =
    "0200028008001300E63F01000000B10042000100010000000000000001000000090A0B0C0D0E0F101112131415161718"
    "191A1B1C1D1E1F202122232425262728292A2B2C2D2E2F303132333435363738393A3B3C";
// eeip, frame 826: T->O to the group
inline constexpr std::string_view kMulticastInputPacket1 =
    "020002800800150086C601000000B100FE00010000000000000000000000000000000000000000000000000000000000"
    "00000000000000000000000000000000000000000000000000000000000000008D010000010000009301";
// hdr, frame 10: T->O with a run/idle header
inline constexpr std::string_view kHeaderInputPacket1 =
    "0200028008000100E6F801000000B1000201010000000000000000000000000000000000000000000000000000000000"
    "000000000000000000000000000000000000000000000000000000000000000000000000000000000000000001";
// By hand: Large Forward Open of the same connection as meca1's, 8 bit path segments.
inline constexpr std::string_view kLargeOpenRequest =
    "6F0044000100000000000000000000000000000000000000000000000000020000000000B20034005B02200624010A02"
    "0000000001002DDC010034125B69026B00000000102700004200004810270000FE000048010320042C962C64";
// By hand: GetAttributesAll of the identity, and the answer of a Meca500 of firmware 11.3.
inline constexpr std::string_view kIdentityRequest =
    "6F0016000100000000000000000000000000000000000000000000000000020000000000B2000600010220012401";
inline constexpr std::string_view kIdentityReply =
    "6F002A000100000000000000000000000000000000000000000000000000020000000000B2001A00810000001D062B00"
    "F4010B03000015CD5B07074D656361353030";
// By hand, after a recorded one: data of a ListIdentity reply.
inline constexpr std::string_view kListedIdentity =
    "01000C00290001000002AF12AC1C010300000000000000001D062B00F4010B03000015CD5B07074D65636135303000";

inline constexpr std::array kMessages{
    kRegisterRequest,   kRegisterReply,     kOpenRequest,          kOpenReply,          kCloseRequest,
    kCloseReply,        kUnregisterRequest, kMulticastOpenRequest, kMulticastOpenReply, kMulticastCloseRequest,
    kHeaderOpenRequest, kHeaderOpenReply,   kKeyedOpenRequest,     kKeyRefused,         kKeyed113OpenRequest,
    kKeyed113OpenReply, kOwnedRefused,      kLargeOpenRequest,     kIdentityRequest,    kIdentityReply,
};

}  // namespace golden
}  // namespace meca::ethernet_ip::test
