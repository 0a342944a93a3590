// The CoE server of a device on the bench: the payload of a mail in, the payload of the answer out, as hex.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/hex.hpp"
#include "transports/ethercat/coe_server.hpp"
#include "transports/ethercat/device.hpp"
#include "transports/ethercat/object_dictionary.hpp"
#include "transports/text.hpp"

namespace meca::ethercat::device_test {

using image::Layout;

inline std::vector<std::byte> bytes(std::string_view hex) { return meca::test::from_hex(hex); }

inline std::string hex(Bytes data) { return meca::test::to_hex(data, " "); }

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
