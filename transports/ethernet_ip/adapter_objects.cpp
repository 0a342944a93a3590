// The objects that explicit messages reach. Which of them a Meca500 has is not published; these are the ones that every
// EtherNet/IP adapter has to have, with the attributes that scanners and conformance tests read (inferred). Nothing can
// be set from outside: an attribute that exists is not settable, and a reset is not supported.
#include <algorithm>

#include "transports/ethernet_ip/adapter_state.hpp"

namespace meca::ethernet_ip {
namespace {

constexpr std::uint16_t kMessageRouterClass = 0x02;

struct ClassFacts {
  std::uint16_t id, revision, highest_instance, instances, highest_attribute;
  std::span<const std::uint8_t> all;      // of GetAttributesAll, in order; empty: the service is not supported
  std::span<const std::uint8_t> singles;  // of GetAttributeSingle
};

constexpr std::uint8_t kIdentityAttributes[] = {1, 2, 3, 4, 5, 6, 7};
constexpr std::uint8_t kRouterAttributes[] = {1};
constexpr std::uint8_t kAssemblyAttributes[] = {3, 4};
constexpr std::uint8_t kConnectionManagerAttributes[] = {1, 8};
constexpr std::uint8_t kQosAttributes[] = {1, 4, 5, 6, 7, 8};
constexpr std::uint8_t kTcpIpAll[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
constexpr std::uint8_t kTcpIpAttributes[] = {1, 2, 3, 4, 5, 6, 8, 9, 13};
constexpr std::uint8_t kLinkAttributes[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
constexpr std::uint8_t kClassAll[] = {1, 2, 6, 7};  // of every class that has the service for its instances
constexpr std::uint8_t kClassSingles[] = {1, 2, 3, 6, 7};

constexpr ClassFacts kClasses[] = {
    {kIdentityClass, 1, 1, 1, 7, kIdentityAttributes, kIdentityAttributes},
    {kMessageRouterClass, 1, 1, 1, 1, {}, kRouterAttributes},
    {kAssemblyClass, 2, kOutputPoint, 2, 4, {}, kAssemblyAttributes},
    {kConnectionManagerClass, 1, 1, 1, 8, {}, kConnectionManagerAttributes},
    {kQosClass, 1, 1, 1, 8, {}, kQosAttributes},
    {kTcpIpInterfaceClass, 4, 1, 1, 13, kTcpIpAll, kTcpIpAttributes},
    {kEthernetLinkClass, 4, 1, 1, 11, kLinkAttributes, kLinkAttributes},
};

const ClassFacts* find_class(std::uint32_t id) noexcept {
  const auto found = std::ranges::find_if(kClasses, [id](const ClassFacts& c) { return c.id == id; });
  return found == std::end(kClasses) ? nullptr : &*found;
}

bool has_instance(const ClassFacts& c, std::uint32_t instance) noexcept {
  if (c.id == kAssemblyClass) return instance == kInputPoint || instance == kOutputPoint;
  return instance == 1;
}

// Attributes of the class itself (instance 0), the same for every class.
void write_class_attribute(const ClassFacts& c, std::uint32_t attribute, wire::Writer& out) noexcept {
  switch (attribute) {
    case 1:
      return out.u16(c.revision);
    case 2:
      return out.u16(c.highest_instance);
    case 3:
      return out.u16(c.instances);
    case 6:
      return out.u16(kClassSingles[std::size(kClassSingles) - 1]);
    case 7:
      return out.u16(c.highest_attribute);
    default:
      return;
  }
}

void write_identity(const Identity& i, std::uint32_t attribute, wire::Writer& out) noexcept {
  switch (attribute) {
    case 1:
      return out.u16(i.vendor_id);
    case 2:
      return out.u16(i.device_type);
    case 3:
      return out.u16(i.product_code);
    case 4:
      out.u8(i.major);
      return out.u8(i.minor);
    case 5:
      return out.u16(i.status);
    case 6:
      return out.u32(i.serial_number);
    case 7:
      out.u8(i.name_length);
      return out.text(i.name());
    default:
      return;
  }
}

void write_assembly(const AdapterState& s, std::uint32_t instance, std::uint32_t attribute,
                    wire::Writer& out) noexcept {
  const Bytes data = instance == kInputPoint ? Bytes(s.input) : Bytes(s.output);
  if (attribute == 3) return out.bytes(data);
  out.u16(static_cast<std::uint16_t>(data.size()));  // 4
}

// Attribute 1 of the Message Router: the list of classes.
void write_object_list(wire::Writer& out) noexcept {
  out.u16(static_cast<std::uint16_t>(std::size(kClasses)));
  for (const ClassFacts& c : kClasses) out.u16(c.id);
}

void write_connection_manager(const AdapterCounters& counters, std::uint32_t attribute, wire::Writer& out) noexcept {
  // 1: Forward Opens that came, 8: connections that timed out
  const std::uint64_t number = attribute == 1 ? counters.opens + counters.refusals : counters.timeouts;
  out.u16(static_cast<std::uint16_t>(number));
}

// No 802.1Q tags; DSCP of urgent, scheduled, high, low, explicit, as read from a public stack.
void write_qos(std::uint32_t attribute, wire::Writer& out) noexcept {
  constexpr std::uint8_t kDscp[] = {55, 47, 43, 31, 27};
  out.u8(attribute == 1 ? 0 : kDscp[attribute - 4]);
}

// Addresses are numbers here, little-endian like all others.
void write_tcp_ip(const AdapterSettings& s, std::uint32_t attribute, wire::Writer& out) noexcept {
  switch (attribute) {
    case 1:
      return out.u32(1);  // status: configured
    case 2:
      return out.u32(0);  // capability: by the robot's own pages only
    case 3:
      return out.u32(0);  // control: static
    case 4:               // physical link: Ethernet Link, instance 1
      out.u16(2);
      return write_path(out, kEthernetLinkClass, 1);
    case 5:
      out.u32(s.address);
      out.u32(s.netmask);
      return out.zeros(3 * 4 + 2);  // gateway, name servers, domain name
    case 6:
      return out.zeros(2);  // host name
    case 7:
      return out.zeros(6);  // safety network number
    case 8:
      return out.u8(1);  // TTL of multicast
    case 9:
      out.zeros(2);  // default allocation
      out.u16(1);
      return out.u32(multicast_group(s));
    case 10:
      return out.zeros(1);  // no address conflict detection ...
    case 11:
      return out.zeros(1 + 6 + 28);  // ... and no conflict
    case 12:
      return out.zeros(1);  // no quick connect
    case 13:
      return out.u16(static_cast<std::uint16_t>(s.inactivity_timeout.count()));
    default:
      return;
  }
}

// 100 Mbit/s, full duplex, negotiated; all counters 0.
void write_link(const AdapterSettings& s, std::uint32_t attribute, wire::Writer& out) noexcept {
  constexpr std::uint16_t kMegabits = 100;
  switch (attribute) {
    case 1:
      return out.u32(kMegabits);
    case 2:
      return out.u32(0x0F);  // link up, full duplex, negotiation succeeded
    case 3:                  // a locally administered MAC address, made of the IPv4 address: there is no real one
      out.u16(0x0002);
      out.u16(static_cast<std::uint16_t>(s.address >> 24 | (s.address >> 8 & 0xFF00)));
      return out.u16(static_cast<std::uint16_t>((s.address >> 8 & 0xFF) | (s.address << 8 & 0xFF00)));
    case 4:
      return out.zeros(11 * 4);  // interface counters
    case 5:
      return out.zeros(12 * 4);  // media counters
    case 6:
      out.u16(1);  // control: negotiate
      return out.u16(0);
    case 7:
      return out.u8(2);  // twisted pair
    case 8:
      return out.u8(1);  // enabled
    case 9:
      return out.u8(1);  // enabled by the administrator
    case 10:
      return out.u8(0);  // no label
    case 11:
      out.u32(2);  // capability: negotiates; one speed
      out.u8(1);
      out.u16(kMegabits);
      return out.u8(1);  // full duplex
    default:
      return;
  }
}

void write_attribute(const AdapterState& s, const ClassFacts& c, std::uint32_t instance, std::uint32_t attribute,
                     wire::Writer& out) noexcept {
  if (instance == 0) return write_class_attribute(c, attribute, out);
  switch (c.id) {
    case kIdentityClass:
      return write_identity(s.settings.identity, attribute, out);
    case kMessageRouterClass:
      return write_object_list(out);
    case kAssemblyClass:
      return write_assembly(s, instance, attribute, out);
    case kConnectionManagerClass:
      return write_connection_manager(s.counters, attribute, out);
    case kQosClass:
      return write_qos(attribute, out);
    case kTcpIpInterfaceClass:
      return write_tcp_ip(s.settings, attribute, out);
    case kEthernetLinkClass:
      return write_link(s.settings, attribute, out);
    default:
      return;
  }
}

// What the object answers; data is written only with success, and behind the reply's header.
void answer_object(const AdapterState& s, const ClassFacts& c, const Request& request, const Path& path,
                   wire::Writer& out) noexcept {
  const auto refuse = [&](GeneralStatus status) { write_reply(out, request.service, status); };
  const std::uint32_t instance = *path.instance_id;
  const std::span<const std::uint8_t> singles = instance == 0 ? std::span(kClassSingles) : c.singles;
  const std::span<const std::uint8_t> all = c.all.empty() || instance != 0 ? c.all : std::span(kClassAll);
  const std::uint32_t attribute = path.attribute_id.value_or(0);
  const bool known = std::ranges::find(singles, attribute) != singles.end();
  switch (static_cast<Service>(request.service)) {
    case Service::kGetAttributesAll:
      if (all.empty()) return refuse(GeneralStatus::kServiceNotSupported);
      if (!request.data.empty()) return refuse(GeneralStatus::kTooMuchData);
      refuse(GeneralStatus::kSuccess);
      for (const std::uint8_t a : all) write_attribute(s, c, instance, a, out);
      return;
    case Service::kGetAttributeSingle:
      if (!known) return refuse(GeneralStatus::kAttributeNotSupported);
      if (!request.data.empty()) return refuse(GeneralStatus::kTooMuchData);
      refuse(GeneralStatus::kSuccess);
      return write_attribute(s, c, instance, attribute, out);
    case Service::kSetAttributeSingle:
      return refuse(known ? GeneralStatus::kAttributeNotSettable : GeneralStatus::kAttributeNotSupported);
    case Service::kForwardClose:
    case Service::kUnconnectedSend:
    case Service::kForwardOpen:
    case Service::kLargeForwardOpen:
      break;
  }
  refuse(GeneralStatus::kServiceNotSupported);  // a number from the wire
}

bool fits_revision(const AdapterSettings& s, const ElectronicKey& key) noexcept {
  const Identity& us = s.identity;
  if (key.major == 0) return true;
  const AdapterKeyPolicy policy = key.compatible ? s.key_policy : AdapterKeyPolicy::kExact;
  switch (policy) {
    case AdapterKeyPolicy::kExact:
      return key.major == us.major && (key.minor == 0 || key.minor == us.minor);
    case AdapterKeyPolicy::kCompatibleSameMajor:
      return key.major == us.major && key.minor <= us.minor;
    case AdapterKeyPolicy::kCompatibleAnyOlder:
      return key.major < us.major || (key.major == us.major && key.minor <= us.minor);
    case AdapterKeyPolicy::kOff:
      return true;
  }
  return false;
}

}  // namespace

std::optional<std::uint16_t> check_key(const AdapterSettings& s, const ElectronicKey& key) noexcept {
  const auto differs = [](std::uint16_t wanted, std::uint16_t is) { return wanted != 0 && wanted != is; };
  if (s.key_policy == AdapterKeyPolicy::kOff) return std::nullopt;
  if (differs(key.vendor_id, s.identity.vendor_id) || differs(key.product_code, s.identity.product_code)) {
    return std::uint16_t{0x0114};
  }
  if (differs(key.device_type, s.identity.device_type)) return std::uint16_t{0x0115};
  if (!fits_revision(s, key)) return std::uint16_t{0x0116};
  return std::nullopt;
}

bool answer_request(AdapterState& s, const TcpPeer& peer, const Items& items, Bytes cip, Time now, wire::Writer& out,
                    SocketItems& socket_items) noexcept {
  const auto request = read_request(cip);
  if (!request) return false;
  Path path;
  const bool readable = read_path(request->path, path) == PathError::kNone;
  if (!readable || !path.class_id || !path.instance_id || path.connection_point_count > 0 || path.data_segment) {
    write_reply(out, request->service, GeneralStatus::kPathSegmentError);
    return true;
  }
  const auto misfit = path.key ? check_key(s.settings, *path.key) : std::nullopt;
  if (misfit) {
    write_reply(out, request->service, GeneralStatus::kKeyFailureInPath, {&*misfit, 1});
    return true;
  }
  const ClassFacts* c = find_class(*path.class_id);
  if (c == nullptr || (*path.instance_id != 0 && !has_instance(*c, *path.instance_id))) {
    write_reply(out, request->service, GeneralStatus::kPathDestinationUnknown);
    return true;
  }
  const auto service = static_cast<Service>(request->service);
  const bool to_manager = c->id == kConnectionManagerClass && *path.instance_id == 1;
  if (to_manager && (service == Service::kForwardOpen || service == Service::kLargeForwardOpen)) {
    forward_open(s, peer, items, *request, now, out, socket_items);
  } else if (to_manager && service == Service::kForwardClose) {
    forward_close(s, peer, *request, out);
  } else {
    answer_object(s, *c, *request, path, out);
  }
  return true;
}

}  // namespace meca::ethernet_ip
