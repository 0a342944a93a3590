// Bytes in tests as people write them: "6F 00 1C".
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace meca::test {

// Blanks and line ends are passed over, capitals do not matter. Throws for anything else, and for half a byte.
inline std::vector<std::byte> from_hex(std::string_view text) {
  std::vector<std::byte> bytes;
  std::size_t digits = 0;
  for (const char c : text) {
    if (c == ' ' || c == '\n') continue;
    const auto digit = std::string_view("0123456789abcdef").find(static_cast<char>(c | 0x20));
    if (digit == std::string_view::npos) throw std::invalid_argument("no hex digit: '" + std::string(1, c) + "'");
    if (digits++ % 2 == 0) {
      bytes.push_back(static_cast<std::byte>(digit << 4));
    } else {
      bytes.back() |= static_cast<std::byte>(digit);
    }
  }
  if (digits % 2 != 0) throw std::invalid_argument("half a byte in hex");
  return bytes;
}

inline std::string to_hex(std::span<const std::byte> bytes, std::string_view between = "",
                          std::string_view digits = "0123456789ABCDEF") {
  std::string out;
  for (const std::byte b : bytes) {
    if (!out.empty()) out += between;
    out += digits[std::to_integer<std::size_t>(b >> 4)];
    out += digits[std::to_integer<std::size_t>(b & std::byte{15})];
  }
  return out;
}

}  // namespace meca::test
