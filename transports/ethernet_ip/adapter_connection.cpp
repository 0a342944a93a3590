// The Connection Manager of the adapter: who may open the one connection, and with what. The numbers in the checks are
// extended status codes; what each means for a person: README.md.
#include <algorithm>

#include "transports/ethernet_ip/adapter_state.hpp"

namespace meca::ethernet_ip {
namespace {

constexpr std::uint32_t kShortestRpiUs = 10'000, kLongestRpiUs = 10'000'000;  // EDS
constexpr std::uint32_t kShortestPeriodUs = 1'000;                            // lenient, and what an API fault gets
constexpr Time kFirstPacketTimeout = std::chrono::seconds(10);                // or the watchdog where that is longer
constexpr std::uint16_t kHeartbeatSize = 2;                                   // O->T of input-only and listen-only

struct Refusal {
  GeneralStatus general = GeneralStatus::kConnectionFailure;
  std::array<std::uint16_t, 2> extended{};
  std::size_t count = 0;
};
using Check = std::optional<Refusal>;

Refusal refusal(std::uint16_t extended) noexcept {
  return {.general = GeneralStatus::kConnectionFailure, .extended = {extended}, .count = 1};
}
Refusal refusal(std::uint16_t extended, std::uint16_t right_size) noexcept {
  return {.general = GeneralStatus::kConnectionFailure, .extended = {extended, right_size}, .count = 2};
}

// Bit 7: direction, 6-4: trigger, 3-0: class. The EDS knows client, cyclic, class 1.
Check check_transport(const ForwardOpen& f) noexcept {
  if ((f.transport & 0x0F) != 1) return refusal(0x011C);
  if ((f.transport & 0x70) != 0) return refusal(0x011D);
  if ((f.transport & 0x80) != 0) return refusal(0x011E);
  if (f.multiplier_code > kMaxMultiplierCode) return refusal(0x0133);
  return std::nullopt;
}

// O->T point to point, T->O that or multicast, fixed sizes (EDS); every priority is served as scheduled.
Check check_parameters(const ForwardOpen& f) noexcept {
  if (f.o_to_t.type == ConnectionType::kNull && f.t_to_o.type == ConnectionType::kNull) return refusal(0x0132);
  if (f.o_to_t.type != ConnectionType::kPointToPoint) return refusal(0x0123);
  if (f.t_to_o.type != ConnectionType::kPointToPoint && f.t_to_o.type != ConnectionType::kMulticast) {
    return refusal(0x0124);
  }
  if (f.o_to_t.redundant_owner || f.t_to_o.redundant_owner) return refusal(0x0125);
  if (f.o_to_t.variable_size) return refusal(0x011F);
  if (f.t_to_o.variable_size) return refusal(0x0120);
  return std::nullopt;
}

Check check_rpi(const AdapterSettings& s, const ForwardOpen& f) noexcept {
  const auto outside = [&](std::uint32_t rpi) {
    return s.lenient_rpi ? rpi < kShortestPeriodUs : rpi < kShortestRpiUs || rpi > kLongestRpiUs;
  };
  if (outside(f.o_to_t_rpi_us) || outside(f.t_to_o_rpi_us)) return refusal(0x0111);
  return std::nullopt;
}

// `20 04 [24 00] 2C 96 2C 64`, a key in front of it; a configuration instance of 0 means none.
Check check_path(const AdapterSettings& s, const ForwardOpen& f) noexcept {
  Path path;
  if (f.path.empty() || read_path(f.path, path) != PathError::kNone) return refusal(0x0315);
  if (path.key) {
    if (const auto misfit = check_key(s, *path.key)) return refusal(*misfit);
  }
  if (path.class_id != kAssemblyClass || path.attribute_id || path.connection_point_count != 2) {
    return refusal(0x0315);
  }
  if (path.instance_id.value_or(0) != 0) return refusal(0x0129);
  if (path.data_segment) return refusal(0x0126);
  if (path.connection_points[0] != kOutputPoint) {
    return refusal(f.o_to_t.size == kHeartbeatSize ? std::uint16_t{0x012F} : std::uint16_t{0x012A});
  }
  if (path.connection_points[1] != kInputPoint) return refusal(0x012B);
  return std::nullopt;
}

Check check_sizes(const AdapterState& s, const ForwardOpen& f) noexcept {
  const std::uint16_t input_size = s.faults.wrong_size.value_or(kInputSize);
  if (f.o_to_t.size != kOutputSize) return refusal(0x0127, kOutputSize);
  if (f.t_to_o.size != input_size) return refusal(0x0128, input_size);
  return std::nullopt;
}

Check check_owner(const AdapterState& s, const ForwardOpen& f) noexcept {
  if (s.io.open) return refusal(0x0106);
  if (s.kept_owner && *s.kept_owner != Owner{f.triad.originator_vendor, f.triad.originator_serial}) {
    return refusal(0x0106);
  }
  return std::nullopt;
}

// Where T->O is wanted. An address that is neither "mine" nor the asker's would make us send to a third party.
Check check_socket(const TcpPeer& peer, const Items& items, SocketAddress& to) noexcept {
  to = {peer.ipv4, kIoPort};
  const Item* item = items.find(ItemType::kSocketAddressTToO);
  if (item == nullptr) return std::nullopt;
  const auto wanted = read_socket_address(item->data);
  if (!wanted || wanted->port == 0 || (wanted->ipv4 != 0 && wanted->ipv4 != peer.ipv4)) return refusal(0x0205);
  to.port = wanted->port;
  return std::nullopt;
}

Check check_multicast(const AdapterSettings& s, const TcpPeer& peer, const ForwardOpen& f) noexcept {
  if (f.t_to_o.type != ConnectionType::kMulticast) return std::nullopt;
  if (((peer.ipv4 ^ s.address) & s.netmask) != 0) return refusal(0x0813);  // TTL 1 does not get there
  return std::nullopt;
}

Check check(const AdapterState& s, const TcpPeer& peer, const Items& items, const ForwardOpen& f,
            SocketAddress& to) noexcept {
  if (s.faults.refuse_open) return refusal(*s.faults.refuse_open);
  if (s.io.open && s.io.triad == f.triad) return refusal(0x0100);
  if (const Check no = check_transport(f)) return no;
  if (const Check no = check_parameters(f)) return no;
  if (const Check no = check_rpi(s.settings, f)) return no;
  if (const Check no = check_path(s.settings, f)) return no;
  if (const Check no = check_sizes(s, f)) return no;
  if (const Check no = check_owner(s, f)) return no;
  if (const Check no = check_socket(peer, items, to)) return no;
  return check_multicast(s.settings, peer, f);
}

std::uint32_t new_connection_id(AdapterState& s) noexcept {
  if (++s.last_connection_id == 0) ++s.last_connection_id;
  return s.last_connection_id;
}

ForwardOpenReply open(AdapterState& s, const TcpPeer& peer, const ForwardOpen& f, const SocketAddress& to,
                      Time now) noexcept {
  const std::uint32_t o_to_t_api = s.faults.api_us.value_or(f.o_to_t_rpi_us);
  const std::uint32_t t_to_o_api = s.faults.api_us.value_or(f.t_to_o_rpi_us);
  const auto interval = [](std::uint32_t us) {
    return Time(std::chrono::microseconds(std::max(us, kShortestPeriodUs)));
  };

  IoConnection io;
  io.open = true;
  io.triad = f.triad;
  io.originator = peer.ipv4;
  io.o_to_t_id = new_connection_id(s);
  io.multicast = f.t_to_o.type == ConnectionType::kMulticast;
  io.t_to_o_id = io.multicast ? new_connection_id(s) : f.t_to_o_id;
  io.to = io.multicast ? SocketAddress{multicast_group(s.settings), kIoPort} : to;
  io.watchdog = interval(o_to_t_api) * timeout_multiplier(f.multiplier_code);
  io.deadline = now + std::max(kFirstPacketTimeout, io.watchdog);
  io.period = interval(t_to_o_api);
  io.next_send = now;
  io.input_size = f.t_to_o.size;
  s.io = io;
  s.output = {};
  s.kept_owner.reset();
  ++s.counters.opens;
  return {io.o_to_t_id, io.t_to_o_id, f.triad, o_to_t_api, t_to_o_api};
}

SocketItems socket_items_of(const AdapterState& s, bool t_to_o_port_asked) noexcept {
  const auto say = [&](std::uint32_t ipv4, std::uint16_t port) {
    return s.faults.foreign_address.value_or(SocketAddress{ipv4, port});
  };
  SocketItems items;
  const bool wanted = s.settings.socket_items && !s.faults.no_socket_items;
  if (wanted || s.faults.foreign_address) items.o_to_t = say(0, s.settings.io_port);  // 0.0.0.0: here
  if (s.io.multicast) {
    items.t_to_o = say(s.io.to.ipv4, s.io.to.port);
  } else if (items.o_to_t && (t_to_o_port_asked || s.faults.foreign_address)) {
    items.t_to_o = say(0, s.io.to.port);
  }
  return items;
}

void write_failure(wire::Writer& out, std::uint8_t service, const Refusal& no, const ConnectionTriad& triad) noexcept {
  write_reply(out, service, no.general, std::span(no.extended).first(no.count));
  write(out, ConnectionFailure{triad, 0});
}

bool same_points(Bytes path_bytes) noexcept {
  Path path;
  return read_path(path_bytes, path) == PathError::kNone && path.connection_point_count == 2 &&
         path.connection_points[0] == kOutputPoint && path.connection_points[1] == kInputPoint;
}

}  // namespace

std::uint32_t multicast_group(const AdapterSettings& s) noexcept {
  constexpr std::uint32_t kFirst = 0xEFC0'0100;  // 239.192.1.0
  const std::uint32_t host = s.address & ~s.netmask;
  return kFirst + ((host - 1) & 0x3FF) * 32;
}

void forward_open(AdapterState& s, const TcpPeer& peer, const Items& items, const Request& request, Time now,
                  wire::Writer& out, SocketItems& socket_items) noexcept {
  check_watchdog(s, now);  // what is overdue no longer owns anything
  const bool large = request.service == static_cast<std::uint8_t>(Service::kLargeForwardOpen);
  ForwardOpen f;
  SocketAddress to;
  const GeneralStatus form = read_forward_open(request.data, large, f);
  const Check no = form == GeneralStatus::kSuccess ? check(s, peer, items, f, to) : Refusal{.general = form};
  if (no) {
    ++s.counters.refusals;
    return write_failure(out, request.service, *no, f.triad);
  }
  const ForwardOpenReply reply = open(s, peer, f, to, now);
  write_reply(out, request.service, GeneralStatus::kSuccess);
  write(out, reply);
  socket_items = socket_items_of(s, items.find(ItemType::kSocketAddressTToO) != nullptr);
}

void forward_close(AdapterState& s, const TcpPeer& peer, const Request& request, wire::Writer& out) noexcept {
  ForwardClose f;
  const GeneralStatus form = read_forward_close(request.data, f);
  Check no;
  if (form != GeneralStatus::kSuccess) {
    no = Refusal{.general = form};
  } else if (!s.io.open || s.io.triad != f.triad || s.io.originator != peer.ipv4) {
    no = refusal(0x0107);  // from another address too: it is not theirs
  } else if (!same_points(f.path)) {
    no = refusal(0x0316);
  }
  if (no) return write_failure(out, request.service, *no, f.triad);
  end_connection(s);
  ++s.counters.closes;
  write_reply(out, request.service, GeneralStatus::kSuccess);
  write_forward_close_reply(out, f.triad);
}

}  // namespace meca::ethernet_ip
