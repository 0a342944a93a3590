// Messages over TCP: RegisterSession, identity, Forward Open and Forward Close, and what the robot answers.
#include <algorithm>

#include "transports/ethernet_ip/originator.hpp"
#include "transports/ethernet_ip/status_text.hpp"

namespace meca::ethernet_ip {
namespace {

constexpr std::uint16_t kConnectionManager = 1;  // instance
constexpr std::uint16_t kDevice = 1;             // instance of the Identity object
constexpr std::size_t kMostMessage = 128;        // of CIP; a Large Forward Open with key takes 68

int length(std::string_view s) noexcept { return static_cast<int>(s.size()); }
constexpr bool is_multicast(std::uint32_t ipv4) noexcept { return ipv4 >> 28 == 0xE; }

}  // namespace

// ---- What we send

// What is pending has the time of a reply; while closing, everything together has.
void Originator::expect(Pending answer, Time now) noexcept {
  pending_ = answer;
  if (state_ != State::kClosing) deadline_ = now + settings_.reply_timeout;
}

void Originator::send_encapsulated(Command command, Bytes data) noexcept {
  wire::Writer out(std::span<std::byte>(output_).subspan(output_end_));
  Header header;
  header.command = static_cast<std::uint16_t>(command);
  header.length = static_cast<std::uint16_t>(data.size());
  header.session = session_;
  write(out, header);
  out.bytes(data);
  output_end_ += out.size();
}

void Originator::send_register_session(Time now) noexcept {
  constexpr std::array<std::byte, 4> kVersion1{std::byte{1}};  // options 0
  session_ = 0;
  send_encapsulated(Command::kRegisterSession, kVersion1);
  expect(Pending::kRegisterSession, now);
}

void Originator::send_unregister_session() noexcept { send_encapsulated(Command::kUnregisterSession, {}); }

// `with_own_port`: tells where T->O shall be sent to (address 0: the sender's own).
void Originator::send_unconnected(Bytes message, bool with_own_port) noexcept {
  std::array<std::byte, kMostMessage + 64> bytes{};
  wire::Writer out(bytes);
  out.u32(0);  // interface handle: CIP
  out.u16(0);  // time-out: the one of the request counts
  out.u16(with_own_port ? 3 : 2);
  write_item(out, ItemType::kNullAddress, 0);
  write_item(out, ItemType::kUnconnectedData, message.size());
  out.bytes(message);
  if (with_own_port) {
    write_item(out, ItemType::kSocketAddressTToO, 16);
    write(out, SocketAddress{0, settings_.io_port});
  }
  send_encapsulated(Command::kSendRrData, out.written());
}

void Originator::send_identity_request(Time now) noexcept {
  std::array<std::byte, kMostMessage> bytes{};
  wire::Writer out(bytes);
  write_request(out, Service::kGetAttributesAll, kIdentityClass, kDevice);
  state_ = State::kIdentifying;
  send_unconnected(out.written(), false);
  expect(Pending::kIdentity, now);
}

// For devices whose Identity object has no GetAttributesAll, as those of one public stack; every device answers this.
void Originator::send_list_identity(Time now) noexcept {
  send_encapsulated(Command::kListIdentity, {});
  expect(Pending::kListIdentity, now);
}

void Originator::send_forward_open(Time now) noexcept {
  if (next_serial_ == 0) next_serial_ = 1;
  open_ = {};
  open_.large = settings_.large;
  open_.triad = {next_serial_++, settings_.vendor_id, settings_.serial_number};
  open_.t_to_o_id = static_cast<std::uint32_t>(settings_.incarnation) << 16 | open_.triad.connection_serial;
  open_.multiplier_code = settings_.multiplier_code;
  open_.o_to_t_rpi_us = settings_.o_to_t_rpi_us;
  open_.t_to_o_rpi_us = settings_.t_to_o_rpi_us;
  open_.o_to_t.size = kOutputSize;
  open_.t_to_o.size = kInputSize;
  open_.t_to_o.type = settings_.multicast ? ConnectionType::kMulticast : ConnectionType::kPointToPoint;

  std::array<std::byte, kMostMessage> bytes{};
  wire::Writer out(bytes);
  write_request(out, settings_.large ? Service::kLargeForwardOpen : Service::kForwardOpen, kConnectionManagerClass,
                kConnectionManager);
  write_forward_open(out, open_);
  out.u8(static_cast<std::uint8_t>(path_size_ / 2));
  out.bytes(Bytes(path_).first(path_size_));
  state_ = State::kOpening;
  maybe_open_ = true;
  send_unconnected(out.written(), !settings_.multicast && settings_.io_port != kIoPort);
  expect(Pending::kForwardOpen, now);
}

void Originator::send_forward_close(Time now) noexcept {
  std::array<std::byte, kMostMessage> bytes{};
  wire::Writer out(bytes);
  write_request(out, Service::kForwardClose, kConnectionManagerClass, kConnectionManager);
  ForwardClose request;
  request.triad = open_.triad;
  write_forward_close(out, request, Bytes(path_).first(path_size_));
  send_unconnected(out.written(), false);
  expect(Pending::kForwardClose, now);
}

// ---- What the robot sends

void Originator::tcp_received(Bytes bytes, Time now) noexcept {
  while (!bytes.empty() && tcp_up_) {
    std::size_t wanted = kHeaderSize;
    auto header = read_header(Bytes(received_).first(received_size_));
    if (header) wanted += header->length;
    const std::size_t taken = std::min(bytes.size(), wanted - received_size_);
    std::ranges::copy(bytes.first(taken), received_.begin() + static_cast<std::ptrdiff_t>(received_size_));
    received_size_ += taken;
    bytes = bytes.subspan(taken);
    if (received_size_ < wanted) return;
    header = read_header(Bytes(received_).first(received_size_));
    if (header->length > kMaxData) return oversized(header->length, now);
    if (received_size_ < kHeaderSize + header->length) continue;  // the header has just become complete
    received_size_ = 0;
    message_received(*header, Bytes(received_).subspan(kHeaderSize, header->length), now);
  }
}

// What follows cannot be told apart any more: the session is over, a running connection goes on without.
void Originator::oversized(std::size_t size, Time now) noexcept {
  const bool running = state_ == State::kRunning;
  drop_tcp();
  if (running) return;
  fail(Text::format("the robot sent a message of %zu bytes over TCP, at most %zu are expected; is it an EtherNet/IP "
                    "device at all?",
                    size, kMaxData),
       now);
}

void Originator::message_received(const Header& header, Bytes data, Time now) noexcept {
  const bool registering = pending_ == Pending::kRegisterSession, listing = pending_ == Pending::kListIdentity;
  const Command expected = registering ? Command::kRegisterSession
                           : listing   ? Command::kListIdentity
                                       : Command::kSendRrData;
  // Unasked, late, NOP, or one that is to be discarded.
  if (pending_ == Pending::kNothing || header.options != 0) return;
  if (header.command != static_cast<std::uint16_t>(expected)) return;
  if (header.status != 0) {
    if (pending_ == Pending::kForwardOpen) maybe_open_ = false;
    const std::string_view meaning = text_of(static_cast<Status>(header.status));
    return fail(Text::format("%s not taken (encapsulation status 0x%02X): %.*s; %s", name_of_pending(),
                             static_cast<unsigned>(header.status), length(meaning), meaning.data(),
                             "restart the robot's EtherNet/IP if it stays so"),
                now);
  }
  if (registering) return session_registered(header.session, now);
  if (listing) {  // belongs to no session
    const auto listed = read_listed_identity(data);
    return identified(listed ? std::optional(listed->identity) : std::nullopt, now);
  }
  if (header.session != session_) {
    return fail(Text::format("answer to %s for session 0x%08X, ours is 0x%08X; restart the robot's EtherNet/IP",
                             name_of_pending(), static_cast<unsigned>(header.session), static_cast<unsigned>(session_)),
                now);
  }
  reply_received(data, now);
}

void Originator::session_registered(std::uint32_t session, Time now) noexcept {
  if (session == 0)
    return fail(Text("RegisterSession answered without a session; restart the robot's EtherNet/IP"), now);
  session_ = session;
  if (state_ == State::kClosing) return send_forward_close(now);
  send_identity_request(now);
}

void Originator::reply_received(Bytes data, Time now) noexcept {
  wire::Reader in(data);
  in.skip(6);  // interface handle, time-out
  const auto items = read_items(in);
  const Item* item = items ? items->find(ItemType::kUnconnectedData) : nullptr;
  const auto reply = item != nullptr ? read_reply(item->data) : std::nullopt;
  if (!reply) {
    return fail(Text::format("answer to %s is malformed (%zu bytes)", name_of_pending(), data.size()), now);
  }
  const auto answers = [&](Service service) { return reply->service == static_cast<std::uint8_t>(service); };
  switch (pending_) {
    case Pending::kIdentity:
      if (answers(Service::kGetAttributesAll)) identity_received(*reply, now);
      return;
    case Pending::kForwardOpen:
      if (answers(open_.large ? Service::kLargeForwardOpen : Service::kForwardOpen)) open_answered(*reply, *items, now);
      return;
    case Pending::kForwardClose:
      if (answers(Service::kForwardClose)) close_answered(now);
      return;
    case Pending::kNothing:
    case Pending::kRegisterSession:
    case Pending::kListIdentity:
      return;
  }
}

void Originator::identity_received(const Reply& reply, Time now) noexcept {
  constexpr auto kNotOffered = static_cast<std::uint8_t>(GeneralStatus::kServiceNotSupported);
  if (reply.general == kNotOffered) return send_list_identity(now);
  if (!reply.ok()) return fail(refusal_text(name_of_pending(), reply), now);
  wire::Reader in(reply.data);
  identified(read_identity(in), now);
}

void Originator::identified(const std::optional<Identity>& identity, Time now) noexcept {
  identity_ = identity;
  if (!identity_) return fail(Text("the robot's identity is malformed; is it a Meca500?"), now);
  const Identity& i = *identity_;
  const bool ours =
      i.vendor_id == kMecademicVendor && i.device_type == kRobotDeviceType && i.product_code == kMeca500ProductCode;
  if (ours) return send_forward_open(now);
  const auto address = dotted(settings_.address);
  fail(Text::format("another device at %.*s: found vendor %u, type %u, product %u '%.*s', expected vendor %u, type %u, "
                    "product %u (Meca500); check the address",
                    length(address), address.view().data(), unsigned{i.vendor_id}, unsigned{i.device_type},
                    unsigned{i.product_code}, length(i.name()), i.name().data(), unsigned{kMecademicVendor},
                    unsigned{kRobotDeviceType}, unsigned{kMeca500ProductCode}),
       now);
}

void Originator::open_answered(const Reply& reply, const Items& items, Time now) noexcept {
  if (!reply.ok()) return open_refused(reply, now);
  const auto opened = read_forward_open_reply(reply.data);
  if (!opened) {
    return fail(Text::format("answer to Forward Open is too short (%zu bytes)", reply.data.size()), now);
  }
  auto wrong = check(*opened);
  if (!wrong) wrong = accept_destination(items);
  if (!wrong) wrong = accept_source(items);
  if (wrong) return fail(*wrong, now);
  run(*opened, now);
}

std::optional<Originator::Text> Originator::check(const ForwardOpenReply& reply) const noexcept {
  const auto& theirs = reply.triad;
  const auto& ours = open_.triad;
  if (theirs != ours) {
    return Text::format(
        "answer to Forward Open is for connection 0x%04X of 0x%04X/0x%08X, asked was 0x%04X of "
        "0x%04X/0x%08X; restart the robot's EtherNet/IP",
        unsigned{theirs.connection_serial}, unsigned{theirs.originator_vendor},
        static_cast<unsigned>(theirs.originator_serial), unsigned{ours.connection_serial},
        unsigned{ours.originator_vendor}, static_cast<unsigned>(ours.originator_serial));
  }
  if (reply.o_to_t_api_us == 0 || reply.t_to_o_api_us == 0) {
    return Text::format("the robot answers with packet intervals of %u and %u us, asked were %u and %u",
                        static_cast<unsigned>(reply.o_to_t_api_us), static_cast<unsigned>(reply.t_to_o_api_us),
                        static_cast<unsigned>(open_.o_to_t_rpi_us), static_cast<unsigned>(open_.t_to_o_rpi_us));
  }
  return std::nullopt;
}

// Where we send to: the robot, whatever port it says. Nowhere else, or we could be made to send to a third party.
std::optional<Originator::Text> Originator::accept_destination(const Items& items) noexcept {
  destination_ = {settings_.address, kIoPort};
  const Item* item = items.find(ItemType::kSocketAddressOToT);
  if (item == nullptr) return std::nullopt;
  const auto given = read_socket_address(item->data);
  if (!given) return Text("the O->T socket address in the answer to Forward Open is malformed");
  if (given->ipv4 != 0 && given->ipv4 != settings_.address) {
    const auto there = dotted(given->ipv4), robot = dotted(settings_.address);
    return Text::format("the robot %.*s wants our outputs sent to %.*s: refused, we send to nobody but the robot",
                        length(robot), robot.view().data(), length(there), there.view().data());
  }
  if (given->port != 0) destination_.port = given->port;
  return std::nullopt;
}

// Where the robot sends to: to us, at the port we listen on, or to a group that we can join.
std::optional<Originator::Text> Originator::accept_source(const Items& items) noexcept {
  const Item* item = items.find(ItemType::kSocketAddressTToO);
  const auto given = item != nullptr ? read_socket_address(item->data) : SocketAddress{0, settings_.io_port};
  if (!given) return Text("the T->O socket address in the answer to Forward Open is malformed");
  const auto there = dotted(given->ipv4);
  if (settings_.multicast && !is_multicast(given->ipv4)) {
    return Text::format("multicast asked, but the robot names no group (%.*s); ask for point-to-point", length(there),
                        there.view().data());
  }
  const bool to_us =
      given->ipv4 == 0 || given->ipv4 == settings_.address || (own_address_ != 0 && given->ipv4 == own_address_);
  if (!settings_.multicast && !to_us) {
    return Text::format("the robot says it will send its inputs to %.*s instead of us: refused", length(there),
                        there.view().data());
  }
  if (given->port != 0 && given->port != settings_.io_port) {
    return Text::format("the robot will send to UDP port %u, but we listen on %u; set the I/O port to %u",
                        unsigned{given->port}, unsigned{settings_.io_port}, unsigned{given->port});
  }
  group_ = settings_.multicast ? given->ipv4 : 0;
  return std::nullopt;
}

void Originator::open_refused(const Reply& reply, Time now) noexcept {
  constexpr std::uint16_t kDuplicate = 0x0100;
  ++counters_.refusals;
  ForwardOpen asked = open_;
  asked.path = Bytes(path_).first(path_size_);
  const Text why = refusal_text("Forward Open", reply, &asked, identity_);
  const bool duplicate = reply.extended_count > 0 && reply.extended[0] == kDuplicate;
  maybe_open_ = duplicate;
  if (!duplicate || duplicate_) return fail(why, now);
  duplicate_ = true;
  trouble_ = why;
  send_forward_close(now);
}

// Closed, or not there any more: gone either way.
void Originator::close_answered(Time now) noexcept {
  maybe_open_ = false;
  if (state_ == State::kOpening) return send_forward_open(now);
  end_session();
}

}  // namespace meca::ethernet_ip
