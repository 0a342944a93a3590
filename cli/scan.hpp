// `meca-ctl scan ethernet_ip`: whom to ask, and what is told of the answers. Pure; the asking is run_scan().
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cli/invocation.hpp"
#include "cli/json.hpp"
#include "transports/ethernet_ip/discovery.hpp"
#include "transports/net/ipv4.hpp"

namespace meca::cli {

// One request: from this address of ours to that one. IPv4, host byte order.
struct ScanTarget {
  std::string interface;   // "eth1"; empty: the system's choice
  std::uint32_t from = 0;  // 0: the system's choice
  std::uint32_t to = 0;
  friend bool operator==(const ScanTarget&, const ScanTarget&) = default;
};

// `call.interfaces`: names or own addresses; none: every one but the loopback. `call.address`: whom to ask instead of
// everybody. Throws UsageError with a sentence that lists the interfaces there are.
std::vector<ScanTarget> scan_targets(const Invocation& call, std::span<const net::Interface> interfaces);

// How long to wait for answers (call.timeout_s), and how much of it the devices may take; the rest is the way there and
// back.
inline constexpr std::chrono::milliseconds kScanWait{2500}, kWayThereAndBack{500};
std::chrono::milliseconds answer_delay(std::chrono::nanoseconds wait) noexcept;

// A table with one line per device, and how many of them are a Meca500.
std::string scan_text(std::span<const ethernet_ip::FoundDevice> devices);
Json to_json(const ethernet_ip::FoundDevice& device);
// What to check when nobody answered.
std::string nobody_answered(std::span<const ScanTarget> targets, std::chrono::nanoseconds waited);

}  // namespace meca::cli
