// The CoE server of a device on the bench: the payload of a mail in, the payload of the answer out, as hex.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "transports/ethercat/coe_server.hpp"
#include "transports/ethercat/device.hpp"
#include "transports/ethercat/object_dictionary.hpp"
#include "transports/text.hpp"

namespace meca::ethercat::device_test {

using image::Layout;

inline std::vector<std::byte> bytes(std::string_view hex) {
  std::vector<std::byte> out;
  int half = -1;
  for (const char c : hex) {
    if (c == ' ') continue;
    const auto digit = std::string_view("0123456789abcdef").find(static_cast<char>(c | 0x20));
    if (digit == std::string_view::npos) throw std::invalid_argument("bad hex in a test");
    if (half >= 0) out.push_back(static_cast<std::byte>(half << 4 | static_cast<int>(digit)));
    half = half < 0 ? static_cast<int>(digit) : -1;
  }
  if (half >= 0) throw std::invalid_argument("half a byte in a test");
  return out;
}

inline std::string hex(Bytes data) {
  std::string out;
  for (const std::byte b : data) {
    if (!out.empty()) out += ' ';
    out += "0123456789ABCDEF"[std::to_integer<unsigned>(b) >> 4];
    out += "0123456789ABCDEF"[std::to_integer<unsigned>(b) & 15];
  }
  return out;
}

// A robot of the firmware that the ESI of this layout is of.
inline DeviceSettings meca500(Layout layout = Layout::kFirmware10) {
  DeviceSettings settings;
  settings.layout = layout;
  settings.firmware = layout == Layout::kFirmware9 ? "9.3.3.5809" : "10.2.1.8120";
  return settings;
}

struct CoeRig {
  explicit CoeRig(const DeviceSettings& settings = meca500()) : objects(make_meca500_dictionary(settings)) {}

  // "error N" for a mailbox error, "" for no answer.
  std::string ask(std::string_view request) {
    std::array<std::byte, CoeServer::kMostPayload> buffer;
    wire::Writer out(buffer);
    const auto error = server.request(objects, bytes(request), state, out);
    if (error) return "error " + std::to_string(static_cast<unsigned>(*error));
    return hex(out.written());
  }
  std::string next() {
    std::array<std::byte, CoeServer::kMostPayload> buffer;
    wire::Writer out(buffer);
    server.next_fragment(objects, out);
    return hex(out.written());
  }
  // The value of an upload, or "abort 06020000".
  std::string upload(std::uint16_t index, std::uint8_t sub = 0, bool complete_access = false) {
    std::array<std::byte, 512> buffer;
    std::size_t size = 0;
    if (const auto abort = objects.upload({index, sub}, complete_access, state, buffer, size)) return text(*abort);
    return hex(Bytes(buffer).first(size));
  }
  // "ok", or "abort 06010002".
  std::string download(std::uint16_t index, std::uint8_t sub, std::string_view value, bool complete_access = false) {
    const auto abort = objects.download({index, sub}, complete_access, state, bytes(value));
    return abort ? text(*abort) : "ok";
  }
  static std::string text(SdoAbort abort) {
    return std::string(FixedText<16>::format("abort %08X", static_cast<unsigned>(abort)).view());
  }

  ObjectDictionary objects;
  CoeServer server;
  AlState state = AlState::kPreop;
};

}  // namespace meca::ethercat::device_test
