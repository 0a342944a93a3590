#include "bridge/config_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

namespace meca::bridge::config_values {
namespace {

using std::chrono::nanoseconds;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_alphanumeric(char c) { return is_digit(c) || is_lower(c) || is_upper(c); }

// Plain decimal number at the start of `text`; what follows it, without leading spaces, goes to `unit`.
std::optional<double> number_and_unit(std::string_view text, std::string_view& unit) {
  if (text.empty() || !is_digit(text.front())) return std::nullopt;  // no sign, no "inf"
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc{}) return std::nullopt;
  unit = text.substr(static_cast<std::size_t>(end - text.data()));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  return value;
}

std::optional<nanoseconds> rounded(double ns) {
  constexpr double kDay = 86'400e9;
  if (!(ns >= 0 && ns <= kDay)) return std::nullopt;
  return nanoseconds(std::llround(ns));
}

struct Unit {
  std::string_view name;
  double ns;
};
constexpr std::array kUnits{Unit{"s", 1e9}, Unit{"ms", 1e6}, Unit{"us", 1e3}, Unit{"ns", 1}};

// Each label between dots passes `label`, the whole is at most `longest` bytes.
template <typename Label>
bool labels(std::string_view text, std::size_t longest, Label label) {
  if (text.empty() || text.size() > longest) return false;
  while (true) {
    const std::size_t dot = text.find('.');
    const std::string_view part = text.substr(0, dot);
    if (part.empty() || part.size() > 63 || part.front() == '-' || part.back() == '-') return false;
    if (!std::all_of(part.begin(), part.end(), label)) return false;
    if (dot == std::string_view::npos) return true;
    text.remove_prefix(dot + 1);
  }
}

}  // namespace

std::optional<nanoseconds> duration(std::string_view text) {
  std::string_view unit;
  const std::optional<double> value = number_and_unit(text, unit);
  if (!value) return std::nullopt;
  for (const Unit& known : kUnits) {
    if (unit == known.name) return rounded(*value * known.ns);
  }
  return std::nullopt;
}

std::optional<Rate> rate(std::string_view text) {
  if (text == "every_cycle") return Rate{RateKind::kEveryCycle, {}};
  if (text == "on_change") return Rate{RateKind::kOnChange, {}};
  if (text == "off") return Rate{RateKind::kOff, {}};
  std::optional<nanoseconds> period = duration(text);
  std::string_view unit;
  if (const std::optional<double> value = number_and_unit(text, unit); value && unit == "Hz" && *value > 0) {
    period = rounded(1e9 / *value);
  }
  if (!period || period->count() == 0) return std::nullopt;
  return Rate{RateKind::kPeriod, *period};
}

std::optional<std::int64_t> integer(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_ipv4(std::string_view text) {
  for (int part = 0; part < 4; ++part) {
    const std::size_t dot = text.find('.');
    if ((dot == std::string_view::npos) != (part == 3)) return false;
    const std::string_view digits = text.substr(0, dot);
    if (digits.empty() || digits.size() > 3 || !std::all_of(digits.begin(), digits.end(), is_digit)) return false;
    if (integer(digits).value_or(256) > 255) return false;
    if (part < 3) text.remove_prefix(dot + 1);
  }
  return true;
}

bool is_host_name(std::string_view text) {
  // Digits and dots alone are meant as an address, and then must be one.
  if (std::all_of(text.begin(), text.end(), [](char c) { return is_digit(c) || c == '.'; })) return false;
  return labels(text, 253, [](char c) { return is_alphanumeric(c) || c == '-'; });
}

bool is_robot_name(std::string_view text) {
  return !text.empty() && text.size() <= 63 &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_alphanumeric(c) || c == '_' || c == '-'; });
}

bool is_client_pattern(std::string_view text) {
  if (text.empty() || text.size() > 63 || text.find('*') < text.size() - 1) return false;
  return std::none_of(text.begin(), text.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

bool is_interface_name(std::string_view text) {
  return !text.empty() && text.size() <= 15 && text != "." && text != ".." &&
         std::none_of(text.begin(), text.end(),
                      [](char c) { return c == '/' || c == ' ' || c == '\t' || c == '\n' || c == '\r'; });
}

bool is_station_name(std::string_view text) {
  return !is_ipv4(text) && labels(text, 240, [](char c) { return is_digit(c) || is_lower(c) || c == '-'; });
}

}  // namespace meca::bridge::config_values

namespace meca::bridge {

std::string to_string(std::chrono::nanoseconds duration) {
  const auto ns = static_cast<double>(duration.count());
  for (const config_values::Unit& unit : config_values::kUnits) {
    if (ns < unit.ns && unit.ns > 1) continue;
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.6g%s", ns / unit.ns, std::string(unit.name).c_str());
    return buffer.data();
  }
  return "0ns";
}

std::optional<transports::FirmwareVersion> parse_firmware(std::string_view text) {
  std::array<std::uint16_t, 4> numbers{};
  for (std::size_t part = 0; part < numbers.size(); ++part) {
    const std::size_t dot = text.find('.');
    const std::string_view digits = text.substr(0, dot);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), numbers[part]);
    if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    if (dot == std::string_view::npos)
      return transports::FirmwareVersion{numbers[0], numbers[1], numbers[2], numbers[3]};
    text.remove_prefix(dot + 1);
  }
  return std::nullopt;  // a fifth number
}

}  // namespace meca::bridge
