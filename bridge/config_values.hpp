// The small notations of the configuration: durations, rates, versions, addresses, names. Pure functions on text.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "bridge/config.hpp"
#include "transports/image/nearest.hpp"

namespace meca::bridge::config_values {

// "500us", "1ms", "10 ms", "0.5s": a number >= 0 and one of ns, us, ms, s. Empty for anything else, and beyond a day.
std::optional<std::chrono::nanoseconds> duration(std::string_view text);

struct Rate {
  RateKind kind = RateKind::kOnChange;
  std::chrono::nanoseconds period{};
};
// "every_cycle", "on_change", "off", a duration > 0, or a frequency > 0 as "100Hz".
std::optional<Rate> rate(std::string_view text);

std::optional<std::int64_t> integer(std::string_view text);  // decimal, optional sign
bool is_ipv4(std::string_view text);
bool is_host_name(std::string_view text);       // RFC 1123
bool is_robot_name(std::string_view text);      // 1..63 bytes of A-Z a-z 0-9 _ -
bool is_client_pattern(std::string_view text);  // 1..63 printable bytes; '*' only as the last
bool is_interface_name(std::string_view text);  // 1..15 bytes, no '/' and no space (Linux)
// PROFINET NameOfStation: labels of a-z 0-9 - joined by dots, 1..240 bytes, a label 1..63; not an IP address.
bool is_station_name(std::string_view text);

using image::nearest;

}  // namespace meca::bridge::config_values
