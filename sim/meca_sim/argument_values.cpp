#include "sim/meca_sim/argument_values.hpp"

#include "transports/image/image.hpp"
#include "transports/image/nearest.hpp"

namespace meca::sim {

std::string guess(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view meant = image::nearest(word, known);
  return meant.empty() ? "" : "; did you mean " + in_quotes(meant) + "?";
}

Complaint read_firmware(std::string_view text, Firmware& out) {
  Firmware found;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, found.major);
  const bool dot = first.ec == std::errc{} && first.ptr != end && *first.ptr == '.';
  const auto second = dot ? std::from_chars(first.ptr + 1, end, found.minor) : first;
  const bool known = image::layout_of(found.major).has_value() && found.major <= 11 && found.minor <= 255;
  if (!dot || second.ec != std::errc{} || second.ptr != end || !known) {
    return "found " + in_quotes(text) + "; expected a version of the firmware from 9.0 to 11.x, e.g. 11.3";
  }
  out = found;
  return std::nullopt;
}

// A name is part of the file name of a control socket.
Complaint read_names(std::string_view name, std::size_t count, std::vector<std::string>& out) {
  constexpr std::size_t kLongest = 32;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto is_good = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_' || c == '-';
  };
  if (name.empty() || name.size() > kLongest || !std::ranges::all_of(name, is_good)) {
    return "found " + in_quotes(name) + "; expected 1 to 32 letters, digits, '-' or '_'";
  }
  if (count == 1) {
    out = {std::string(name)};
    return std::nullopt;
  }
  constexpr std::size_t kMostDigits = 4;
  std::size_t letters = name.size();
  while (letters > 0 && name.size() - letters < kMostDigits && is_digit(name[letters - 1])) --letters;
  unsigned number = 1;
  std::from_chars(name.data() + letters, name.data() + name.size(), number);
  out.clear();
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(std::string(name.substr(0, letters)) + std::to_string(number + i));
    if (out.back().size() > kLongest) return "found " + in_quotes(name) + "; with a number behind it, it is too long";
  }
  return std::nullopt;
}

}  // namespace meca::sim
