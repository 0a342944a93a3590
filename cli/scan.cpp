#include "cli/scan.hpp"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "cli/format.hpp"
#include "cli/plan.hpp"

namespace meca::cli {
namespace {

using ethernet_ip::FoundDevice;
using net::Interface;

constexpr bool is_loopback(std::uint32_t address) { return address >> 24 == 127; }
constexpr bool has_neighbours(std::uint32_t netmask) { return netmask < 0xFFFFFFFE; }  // a tunnel has none

std::string list_of(std::span<const Interface> interfaces) {
  std::string list;
  for (const Interface& i : interfaces) {
    list += (list.empty() ? "" : ", ") + i.name + " (" + net::to_string(i.address) + "/" +
            std::to_string(std::popcount(i.netmask)) + ")";
  }
  return list.empty() ? "none" : list;
}

std::vector<Interface> chosen_interfaces(const Invocation& call, std::span<const Interface> interfaces) {
  std::vector<Interface> chosen;
  for (const std::string& wanted : call.interfaces) {
    const auto before = chosen.size();
    std::ranges::copy_if(interfaces, std::back_inserter(chosen),
                         [&](const Interface& i) { return i.name == wanted || net::to_string(i.address) == wanted; });
    if (chosen.size() == before) {
      throw UsageError("there is no interface '" + wanted +
                       "' that is up and has an IPv4 address; there are: " + list_of(interfaces));
    }
  }
  if (!call.interfaces.empty()) return chosen;
  std::ranges::copy_if(interfaces, std::back_inserter(chosen),
                       [](const Interface& i) { return !is_loopback(i.address) && has_neighbours(i.netmask); });
  return chosen;
}

// Names come from strangers: nothing in them may move the cursor of a terminal.
std::string printable(std::string_view name) {
  std::string out(name);
  std::ranges::replace_if(
      out, [](char c) { return c < 0x20 || c > 0x7E; }, '?');
  return out;
}

std::string revision(const ethernet_ip::Identity& i) { return std::to_string(i.major) + "." + std::to_string(i.minor); }

std::string addresses_of(const FoundDevice& device) {
  std::string list;
  for (const auto address : device.addresses) list += (list.empty() ? "" : ", ") + net::to_string(address);
  return list;
}

}  // namespace

std::vector<ScanTarget> scan_targets(const Invocation& call, std::span<const Interface> interfaces) {
  std::uint32_t to = 0;
  if (!call.address.empty()) {
    const auto address = net::parse_ipv4(call.address);
    if (!address || *address == 0) {
      throw UsageError("--address '" + call.address + "' is no IPv4 address; one is written as 192.168.0.100");
    }
    to = *address;
    if (call.interfaces.empty()) return {{"", 0, to}};
  }
  std::vector<ScanTarget> targets;
  for (const Interface& i : chosen_interfaces(call, interfaces)) {
    const ScanTarget target{i.name, i.address, to != 0 ? to : i.broadcast()};
    // Two of our addresses in one subnet reach the same neighbours.
    const bool asked = std::ranges::any_of(targets, [&](const ScanTarget& t) {
      return t == target || (to == 0 && t.interface == target.interface && t.to == target.to);
    });
    if (!asked) targets.push_back(target);
  }
  if (targets.empty()) {
    throw UsageError("no interface to ask on is up and has an IPv4 address; there are: " + list_of(interfaces));
  }
  return targets;
}

std::chrono::milliseconds answer_delay(std::chrono::nanoseconds wait) noexcept {
  const auto rest = std::chrono::floor<std::chrono::milliseconds>(wait) - kWayThereAndBack;
  return std::clamp(rest, std::chrono::milliseconds(1), ethernet_ip::kMostAnswerDelay);
}

std::string scan_text(std::span<const FoundDevice> devices) {
  std::vector<std::vector<std::string>> rows{
      {"ADDRESS", "NAME", "VENDOR", "TYPE", "PRODUCT", "REVISION", "SERIAL", "STATE", "MECA500"}};
  for (const FoundDevice& device : devices) {
    const auto& i = device.identity;
    rows.push_back({addresses_of(device), printable(i.name()), std::to_string(i.vendor_id),
                    std::to_string(i.device_type), std::to_string(i.product_code), revision(i),
                    std::to_string(i.serial_number), std::string(ethernet_ip::device_state_text(i.state)),
                    is_meca500(i) ? "yes" : "no"});
  }
  const auto robots = std::ranges::count_if(devices, ethernet_ip::is_meca500, &FoundDevice::identity);
  return table(rows) + std::to_string(devices.size()) + (devices.size() == 1 ? " device, " : " devices, ") +
         (robots == 0 ? "no" : std::to_string(robots)) + " Meca500\n";
}

Json to_json(const FoundDevice& device) {
  const auto& i = device.identity;
  Json addresses = Json::array();
  for (const auto address : device.addresses) addresses.push_back(net::to_string(address));
  return {{"addresses", addresses},
          {"claimed_address", net::to_string(device.claimed.ipv4)},
          {"name", i.name()},
          {"vendor_id", i.vendor_id},
          {"device_type", i.device_type},
          {"product_code", i.product_code},
          {"revision", revision(i)},
          {"serial_number", i.serial_number},
          {"status", i.status},
          {"state", ethernet_ip::device_state_text(i.state)},
          {"meca500", is_meca500(i)}};
}

std::string nobody_answered(std::span<const ScanTarget> targets, std::chrono::nanoseconds waited) {
  std::string asked;
  for (const ScanTarget& target : targets) {
    asked += (asked.empty() ? "" : ", ") + net::to_string(target.to) +
             (target.interface.empty() ? "" : " on " + target.interface);
  }
  return "no EtherNet/IP device answered within " + seconds_text(waited) + " (asked: " + asked +
         "); check that the robot has power and a cable to this network, that EtherNet/IP is enabled on it, that this "
         "machine has an address in the robot's network (192.168.0.x from the factory), and that no firewall drops "
         "answers from UDP port 44818; --address asks one robot alone, which more firewalls let through; a meca-sim on "
         "this machine's loopback: --interface lo";
}

}  // namespace meca::cli
