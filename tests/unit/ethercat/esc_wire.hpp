// One ESC at the end of a cable: commands in, what came back out. Time stands still unless a test moves it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/hex.hpp"
#include "transports/ethercat/esc.hpp"
#include "transports/ethercat/sii.hpp"

namespace meca::ethercat::test {

using namespace std::chrono_literals;

inline std::vector<std::byte> hex(std::string_view text) { return meca::test::from_hex(text); }

inline std::string text(Bytes bytes) { return meca::test::to_hex(bytes, " "); }

inline std::vector<std::byte> little_endian(std::uint64_t value, unsigned size) {
  std::vector<std::byte> out;
  for (unsigned i = 0; i < size; ++i) out.push_back(static_cast<std::byte>(value >> 8 * i & 0xFF));
  return out;
}

inline std::uint64_t number(Bytes bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(bytes[i]);
  return value;
}

struct Reply {
  std::vector<std::byte> data;
  unsigned wkc = 0;
  std::uint16_t adp = 0, irq = 0;
  std::string hex() const { return text(data); }
  std::uint64_t value() const { return number(data); }
};

// A datagram on its own, changed by whoever it is passed to.
class Passing {
 public:
  Passing(std::uint8_t command, std::uint32_t address, Bytes data, std::uint16_t wkc = 0, std::uint16_t irq = 0)
      : bytes_(kDatagramOverhead + data.size()) {
    bytes_[0] = std::byte{command};
    put(2, address, 4);
    put(6, data.size(), 2);
    put(8, irq, 2);
    std::ranges::copy(data, bytes_.begin() + kDatagramHeader);
    put(bytes_.size() - 2, wkc, 2);
  }
  MutableDatagram datagram() { return MutableDatagram(std::span(bytes_)); }
  Reply reply() {
    const auto d = datagram();
    return {{d.data().begin(), d.data().end()}, d.working_counter(), d.adp(), d.irq()};
  }

 private:
  void put(std::size_t at, std::uint64_t value, unsigned size) {
    std::ranges::copy(little_endian(value, size), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  std::vector<std::byte> bytes_;
};

inline EscSettings meca500_settings(std::uint16_t alias = 0) {
  EscSettings s;
  s.sii = make_meca500_sii(alias, 0);
  return s;
}

class EscWire : public testing::Test {
 protected:
  static constexpr std::uint16_t kStation = 0x1001;

  EscWire() : esc(meca500_settings()) {}

  Reply send(Command command, std::uint32_t address, Bytes data) {
    Passing passing(static_cast<std::uint8_t>(command), address, data);
    esc.process(passing.datagram(), now);
    return passing.reply();
  }
  // To the first device, by position.
  Reply read(std::uint16_t ado, std::size_t size) {
    return send(Command::kAprd, address_of(0, ado), std::vector<std::byte>(size));
  }
  unsigned write(std::uint16_t ado, std::string_view bytes) { return write(ado, hex(bytes)); }
  unsigned write(std::uint16_t ado, Bytes bytes) { return send(Command::kApwr, address_of(0, ado), bytes).wkc; }

  // Sync managers and FMMUs as all masters set them for a Meca500, process data allowed by the application.
  void configure() {
    for (unsigned n = 0; n < 4; ++n) write(reg::sync_manager(n), sync_manager_bytes(n, true));
    esc.allow_process_data(true, true);
  }

  Esc esc;
  Time now{};
};

}  // namespace meca::ethercat::test
