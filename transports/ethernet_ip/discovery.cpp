#include "transports/ethernet_ip/discovery.hpp"

#include <algorithm>
#include <tuple>

#include "transports/ethernet_ip/originator.hpp"

namespace meca::ethernet_ip {
namespace {

constexpr std::uint32_t kNoSerial = 0;

bool same_device(const FoundDevice& known, std::uint32_t from, const Identity& identity) noexcept {
  const auto key = [](const Identity& i) { return std::tie(i.vendor_id, i.product_code, i.serial_number); };
  if (key(known.identity) != key(identity)) return false;
  return identity.serial_number != kNoSerial || std::ranges::count(known.addresses, from) != 0;
}

}  // namespace

ListIdentityRequest list_identity_request(std::chrono::milliseconds most_delay) noexcept {
  const auto delay = static_cast<std::uint16_t>(std::clamp<std::int64_t>(most_delay.count(), 0, 0xFFFF));
  Header header;
  header.command = static_cast<std::uint16_t>(Command::kListIdentity);
  header.context[0] = static_cast<std::byte>(delay & 0xFF);
  header.context[1] = static_cast<std::byte>(delay >> 8);
  ListIdentityRequest request{};
  wire::Writer out(request);
  write(out, header);
  return request;
}

bool is_meca500(const Identity& identity) noexcept {
  return identity.vendor_id == kMecademicVendor && identity.device_type == kRobotDeviceType &&
         identity.product_code == kMeca500ProductCode;
}

// CIP Vol 1, 5-2.2, attribute 8.
std::string_view device_state_text(std::uint8_t state) noexcept {
  switch (state) {
    case 1:
      return "self-testing";
    case 2:
      return "standby";
    case 3:
      return "operational";
    case 4:
      return "major recoverable fault";
    case 5:
      return "major unrecoverable fault";
    case 0:
    case 0xFF:
      return "not told";
  }
  return "unknown";
}

bool Discovery::received(std::uint32_t from_ipv4, Bytes datagram) {
  const auto header = read_header(datagram);
  if (!header || header->command != static_cast<std::uint16_t>(Command::kListIdentity) || header->status != 0) {
    return false;
  }
  if (header->length != datagram.size() - kHeaderSize) return false;
  const auto listed = read_listed_identity(datagram.subspan(kHeaderSize));
  if (!listed) return false;

  const auto known =
      std::ranges::find_if(devices_, [&](const FoundDevice& d) { return same_device(d, from_ipv4, listed->identity); });
  if (known == devices_.end()) {
    devices_.push_back({{from_ipv4}, listed->address, listed->identity});
  } else {
    if (std::ranges::count(known->addresses, from_ipv4) == 0) known->addresses.push_back(from_ipv4);
    known->identity = listed->identity;  // the newest
  }
  std::ranges::stable_sort(devices_, {}, [](const FoundDevice& d) { return d.addresses.front(); });
  return true;
}

}  // namespace meca::ethernet_ip
