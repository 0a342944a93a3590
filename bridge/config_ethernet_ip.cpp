#include "bridge/config_ethernet_ip.hpp"

#include <algorithm>
#include <array>

#include "bridge/config_values.hpp"

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr nanoseconds kShortestRpi = 10ms, kLongestRpi = 10s;  // EDS 11.3
constexpr nanoseconds kShortestFastRpi = 1ms;
// A general purpose system is late by some 10 ms now and then; a robot that is left alone should notice it soon.
constexpr nanoseconds kTightWatchdog = 40ms, kLazyWatchdog = 5s;

constexpr std::string_view kAnyAddress = "0.0.0.0";

bool is_address(std::string_view text) { return config_values::is_ipv4(text) || config_values::is_host_name(text); }

bool is_serial_number(std::string_view text) {
  const auto number = config_values::integer(text);
  return text == "auto" || (number && *number >= 1 && *number <= 4294967295);
}

// Of an electronic key: 7 bits of major, 8 of minor, and 0 would mean "any".
bool is_revision(std::string_view text) {
  const auto version = parse_firmware(text);
  return version && std::ranges::count(text, '.') == 1 && version->major >= 1 && version->major <= 127 &&
         version->minor >= 1 && version->minor <= 255;
}

void read_key(const Section& transport, EthernetIpConfig& out) {
  static constexpr std::array<std::string_view, 3> kPolicies{"none", "compatible", "exact"};
  std::size_t policy = 0;
  if (transport.choice("key", kPolicies, policy)) out.key = static_cast<ethernet_ip::KeyPolicy>(policy);
  std::string revision;
  const bool given =
      transport.text("key_revision", "major.minor of the key, 1.1 to 127.255, e.g. \"11.3\"", is_revision, revision);
  if (!given) return;
  const auto version = *parse_firmware(revision);
  out.key_major = static_cast<std::uint8_t>(version.major);
  out.key_minor = static_cast<std::uint8_t>(version.minor);
  if (out.key != ethernet_ip::KeyPolicy::kNone) return;
  transport.report().warning(transport.mark("key_revision"), transport.path("key_revision"),
                             "is not used without a key; write 'key: compatible' or 'key: exact' as well");
}

}  // namespace

EthernetIpBusConfig read_ethernet_ip_bus(const Section& root, const std::vector<RobotConfig>& robots) {
  EthernetIpBusConfig out;
  const Section bus = root.child("ethernet_ip", "ethernet_ip");
  bus.text("bind", "the IPv4 address of one of this machine's interfaces, or 0.0.0.0 for all", config_values::is_ipv4,
           out.bind);
  bus.integer("io_port", 1, 65535, out.io_port);
  bus.integer("vendor_id", 1, 65535, out.vendor_id);
  std::string serial;
  if (bus.text("serial_number", "auto, or a whole number from 1 to 4294967295", is_serial_number, serial)) {
    out.serial_number = serial == "auto" ? 0 : static_cast<std::uint32_t>(*config_values::integer(serial));
  }
  const auto listener =
      std::ranges::find_if(robots, [](const RobotConfig& each) { return each.ethernet_ip.multicast; });
  if (listener != robots.end() && out.bind != kAnyAddress) {
    bus.report().error(bus.mark("bind"), bus.path("bind"),
                       "multicast, as '" + listener->name +
                           "' asks for, does not reach a socket of one address; write " + std::string(kAnyAddress) +
                           ", or leave multicast out");
  }
  return out;
}

void read_ethernet_ip(const Section& transport, EthernetIpConfig& out) {
  transport.require("address", "address: 192.168.0.100");
  transport.text("address", "an IPv4 address or a host name, e.g. 192.168.0.100", is_address, out.address);
  transport.integer("tcp_port", 1, 65535, out.tcp_port);
  transport.flag("fast", out.fast);
  transport.duration("rpi", shortest_rpi(out), kLongestRpi, out.rpi);
  static constexpr std::array<std::string_view, 8> kMultipliers{"4", "8", "16", "32", "64", "128", "256", "512"};
  std::size_t code = 0;
  if (transport.choice("timeout_multiplier", kMultipliers, code)) out.timeout_multiplier = 4u << code;
  transport.flag("multicast", out.multicast);
  transport.flag("large_forward_open", out.large_forward_open);
  read_key(transport, out);
}

nanoseconds shortest_rpi(const EthernetIpConfig& config) { return config.fast ? kShortestFastRpi : kShortestRpi; }

void settle_ethernet_ip(const Section& transport, nanoseconds cycle, EthernetIpConfig& config) {
  if (config.rpi == nanoseconds{}) config.rpi = cycle;
  if (config.rpi < cycle) {
    transport.report().error(transport.mark("rpi"), transport.path("rpi"),
                             to_string(config.rpi) + " is shorter than the cycle of " + to_string(cycle) +
                                 ": the bridge would not look at every packet; leave it out, or shorten the cycle");
    return;
  }
  const nanoseconds watchdog = config.rpi * config.timeout_multiplier;
  if (watchdog > kTightWatchdog && watchdog <= kLazyWatchdog) return;
  const std::string key = transport.find("timeout_multiplier") == nullptr ? "rpi" : "timeout_multiplier";
  const std::string product =
      std::to_string(config.timeout_multiplier) + " x " + to_string(config.rpi) + " = " + to_string(watchdog);
  transport.report().warning(
      transport.mark(key), transport.path(key),
      product +
          (watchdog > kLazyWatchdog
               ? ": the robot notices only then that the bridge is gone; 5s or less is better"
               : ": a few late packets end the connection; from 80ms on it suits a system that is not real-time"));
}

}  // namespace meca::bridge
