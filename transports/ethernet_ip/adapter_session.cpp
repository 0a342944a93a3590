// The encapsulation session of the adapter: what comes over TCP 44818 and UDP 44818.
#include <algorithm>

#include "transports/ethernet_ip/adapter_state.hpp"

namespace meca::ethernet_ip {
namespace {

constexpr std::uint16_t kProtocolVersion = 1;
constexpr std::uint16_t kCipOverTcp = 0x0020, kClass01OverUdp = 0x0100;  // capability flags of ListServices
constexpr std::string_view kServiceName{"Communications\0\0", 16};

void write_message(wire::Writer& out, Header header, std::uint32_t session, Status status, Bytes data) noexcept {
  header.session = session;
  header.status = static_cast<std::uint32_t>(status);
  header.length = static_cast<std::uint16_t>(data.size());
  write(out, header);
  out.bytes(data);
}

// One who asks without ever reading is not listening: the connection is given up.
void answer(TcpPeer& peer, const Header& request, std::uint32_t session, Status status, Bytes data = {}) noexcept {
  wire::Writer out(std::span(peer.out).subspan(peer.out_size));
  write_message(out, request, session, status, data);
  if (out.ok()) {
    peer.out_size += out.size();
  } else {
    peer.closing = true;
  }
}

void write_services(wire::Writer& out) noexcept {
  out.u16(1);
  write_item(out, ItemType::kListServices, 4 + kServiceName.size());
  out.u16(kProtocolVersion);
  out.u16(kCipOverTcp | kClass01OverUdp);
  out.text(kServiceName);
}

// The data of the three commands that need no session and go over UDP too. False: another command.
bool write_list(const AdapterState& s, Command command, wire::Writer& out) noexcept {
  switch (command) {
    case Command::kListServices:
      write_services(out);
      return true;
    case Command::kListIdentity:
      write(out, ListedIdentity{{s.settings.address, kTcpPort}, s.settings.identity});
      return true;
    case Command::kListInterfaces:
      out.u16(0);  // CIP is reached without one
      return true;
    case Command::kNop:
    case Command::kRegisterSession:
    case Command::kUnregisterSession:
    case Command::kSendRrData:
    case Command::kSendUnitData:
      break;
  }
  return false;
}

void register_session(AdapterState& s, TcpPeer& peer, const Header& header, Bytes data) noexcept {
  if (data.size() != 4) return answer(peer, header, header.session, Status::kInvalidLength);
  wire::Reader in(data);
  const std::uint16_t version = in.u16();
  const std::uint16_t options = in.u16();
  std::array<std::byte, 4> ours{};
  wire::Writer(ours).u16(kProtocolVersion);
  if (version != kProtocolVersion || options != 0) {
    return answer(peer, header, 0, Status::kUnsupportedVersion, ours);
  }
  if (peer.session != 0) return answer(peer, header, peer.session, Status::kUnsupportedCommand, ours);
  peer.session = ++s.last_session;
  ++s.counters.sessions;
  answer(peer, header, peer.session, Status::kSuccess, ours);
}

void write_socket_item(wire::Writer& out, ItemType type, const std::optional<SocketAddress>& address) noexcept {
  if (!address) return;
  write_item(out, type, 16);
  write(out, *address);
}

void send_rr_data(AdapterState& s, TcpPeer& peer, const Header& header, Bytes data, Time now) noexcept {
  wire::Reader in(data);
  const std::uint32_t interface_handle = in.u32();
  in.u16();  // time-out: for routers
  const auto items = read_items(in);
  const Item* address = items ? items->find(ItemType::kNullAddress) : nullptr;
  const Item* request = items ? items->find(ItemType::kUnconnectedData) : nullptr;
  if (interface_handle != 0 || address == nullptr || !address->data.empty() || request == nullptr) {
    return answer(peer, header, header.session, Status::kIncorrectData);
  }
  std::array<std::byte, kMostReply> buffer;
  wire::Writer out(buffer);
  out.zeros(6);  // interface handle, time-out
  const std::size_t item_count = out.reserve_u16();
  write_item(out, ItemType::kNullAddress, 0);
  out.u16(static_cast<std::uint16_t>(ItemType::kUnconnectedData));
  const std::size_t length = out.reserve_u16();
  const std::size_t begin = out.size();
  SocketItems sockets;
  if (!answer_request(s, peer, *items, request->data, now, out, sockets)) {
    return answer(peer, header, header.session, Status::kIncorrectData);
  }
  out.set_u16(length, static_cast<std::uint16_t>(out.size() - begin));
  out.set_u16(item_count, static_cast<std::uint16_t>(2 + sockets.o_to_t.has_value() + sockets.t_to_o.has_value()));
  write_socket_item(out, ItemType::kSocketAddressOToT, sockets.o_to_t);
  write_socket_item(out, ItemType::kSocketAddressTToO, sockets.t_to_o);
  answer(peer, header, header.session, Status::kSuccess, out.written());
}

void list(const AdapterState& s, TcpPeer& peer, const Header& header, Bytes data) noexcept {
  if (!data.empty()) return answer(peer, header, header.session, Status::kInvalidLength);
  std::array<std::byte, kMostReply> buffer;
  wire::Writer out(buffer);
  write_list(s, static_cast<Command>(header.command), out);
  answer(peer, header, header.session, Status::kSuccess, out.written());
}

void handle(AdapterState& s, TcpPeer& peer, const Header& header, Bytes data, Time now) noexcept {
  const bool in_session = peer.session != 0 && header.session == peer.session;
  switch (static_cast<Command>(header.command)) {
    case Command::kNop:
      return;
    case Command::kListServices:
    case Command::kListIdentity:
    case Command::kListInterfaces:
      return list(s, peer, header, data);
    case Command::kRegisterSession:
      return register_session(s, peer, header, data);
    case Command::kUnregisterSession:
      if (in_session) {
        peer.session = 0;
        peer.closing = true;
      } else {
        ++s.counters.discarded;
      }
      return;
    case Command::kSendRrData:
      if (in_session) return send_rr_data(s, peer, header, data, now);
      return answer(peer, header, header.session, Status::kInvalidSession);
    case Command::kSendUnitData:
      // Belongs to a connection of class 3, and there is none: nobody to answer, as over UDP.
      if (!in_session) return answer(peer, header, header.session, Status::kInvalidSession);
      ++s.counters.discarded;
      return;
  }
  answer(peer, header, header.session, Status::kUnsupportedCommand);  // a number from the wire
}

// CIP Vol 2, 2-3: the receiver discards, without an answer, what comes with options or a status.
bool discarded(AdapterState& s, const Header& header) noexcept {
  if (header.options == 0 && header.status == 0) return false;
  ++s.counters.discarded;
  return true;
}

// The header of a message, and of a short one its data, are complete.
void message_complete(AdapterState& s, TcpPeer& peer, const Header& header, Time now) noexcept {
  const Bytes data = Bytes(peer.in).first(peer.in_size).subspan(kHeaderSize);
  peer.in_size = 0;
  if (header.length > kMostRequest) peer.to_skip = header.length;
  if (discarded(s, header)) return;
  if (header.length > kMostRequest && header.command != static_cast<std::uint16_t>(Command::kNop)) {
    return answer(peer, header, header.session, Status::kInvalidLength);
  }
  handle(s, peer, header, data, now);
}

}  // namespace

void receive_tcp(AdapterState& s, TcpPeer& peer, Bytes bytes, Time now) noexcept {
  peer.last_heard = now;
  const auto take = [&bytes](std::size_t wanted) {
    const Bytes taken = bytes.first(std::min(wanted, bytes.size()));
    bytes = bytes.subspan(taken.size());
    return taken;
  };
  while (!bytes.empty() && !peer.closing) {
    if (peer.to_skip > 0) {
      peer.to_skip -= take(peer.to_skip).size();
      continue;
    }
    const auto known = read_header(Bytes(peer.in).first(peer.in_size));
    const Bytes taken = take(kHeaderSize + (known ? known->length : 0) - peer.in_size);
    std::ranges::copy(taken, peer.in.begin() + static_cast<std::ptrdiff_t>(peer.in_size));
    peer.in_size += taken.size();
    const auto header = read_header(Bytes(peer.in).first(peer.in_size));
    if (!header) continue;
    if (header->length > kMostRequest || peer.in_size == kHeaderSize + header->length) {
      message_complete(s, peer, *header, now);
    }
  }
}

Adapter::Answer answer_udp(AdapterState& s, Bytes datagram, bool broadcast) noexcept {
  const auto header = read_header(datagram);
  std::array<std::byte, kMostReply> buffer;
  wire::Writer data(buffer);
  if (!header || header->length != 0 || datagram.size() != kHeaderSize || header->options != 0 || header->status != 0 ||
      !write_list(s, static_cast<Command>(header->command), data)) {
    ++s.counters.discarded;
    return {};
  }
  wire::Writer out(s.udp_answer);
  write_message(out, *header, header->session, Status::kSuccess, data.written());
  Adapter::Answer answer{.bytes = out.written()};
  if (broadcast && header->command == static_cast<std::uint16_t>(Command::kListIdentity)) {
    // CIP Vol 2, 2-4.2: the asker's longest wait in ms, 0 for two seconds; everybody waits for a random part of it.
    const std::uint16_t asked = wire::Reader(header->context).u16();
    s.random ^= s.random << 13;
    s.random ^= s.random >> 17;
    s.random ^= s.random << 5;
    answer.delay = std::chrono::milliseconds(s.random % ((asked == 0 ? 2000u : asked) + 1));
  }
  return answer;
}

}  // namespace meca::ethernet_ip
