#include "sim/meca_sim/ethernet_ip_sockets.hpp"

#include <algorithm>
#include <stdexcept>

#include "transports/ethernet_ip/io_packet.hpp"

namespace meca::sim {
namespace {

using ethernet_ip::kIoPort;
using ethernet_ip::kTcpPort;

// DSCP of explicit messages and of scheduled I/O, the defaults of the QoS object (CIP Vol 2, 5-7).
constexpr std::uint8_t kExplicitDscp = 27, kScheduledDscp = 47;
constexpr std::uint32_t kLimitedBroadcast = 0xFFFF'FFFF;
constexpr Time kBeforeListeningAgain = std::chrono::milliseconds(200);

bool is_loopback(std::uint32_t ipv4) noexcept { return ipv4 >> 24 == 127; }

net::UdpSocket io_socket(std::uint32_t address) {
  net::UdpOptions options;
  options.dscp = kScheduledDscp;
  options.multicast_interface = address;
  return {{address, kIoPort}, options};
}

// Other robots of this machine listen to the same broadcasts. Without them this one is only harder to find.
net::UdpSocket broadcast_socket(std::uint32_t address, std::string& trouble) {
  net::UdpOptions options;
  options.share_port = true;
  try {
    return {{address, kTcpPort}, options};
  } catch (const std::runtime_error& error) {
    trouble = "discovery by broadcast is not answered: " + std::string(error.what());
    return {};
  }
}

}  // namespace

EthernetIpSockets::EthernetIpSockets(EthernetIpRobot& robot, const net::Interface& own)
    : robot_(robot),
      explicit_messages_{own.address, kTcpPort},
      listener_(std::in_place, explicit_messages_, kExplicitDscp),
      discovery_(explicit_messages_, {}),
      io_(io_socket(own.address)),
      subnet_broadcast_(broadcast_socket(own.broadcast(), trouble_)) {
  // A broadcast to everybody does not come in over the loopback interface.
  if (!is_loopback(own.address)) any_broadcast_ = broadcast_socket(kLimitedBroadcast, trouble_);
}

void EthernetIpSockets::exchange(Time now) noexcept {
  come_and_go(now);
  receive_io(now);
  receive_discovery(discovery_, false, now);
  receive_discovery(subnet_broadcast_, true, now);
  receive_discovery(any_broadcast_, true, now);
  if (robot_.hears()) {
    welcome(now);
    for (std::size_t id = 0; id < peers_.size(); ++id) serve(id, now);
    send_answers(now);
  }
  while (const auto datagram = robot_.produce(now)) {
    io_.send({datagram->to.ipv4, datagram->to.port}, datagram->bytes);
  }
}

void EthernetIpSockets::wait_for(net::Poller& poller, std::size_t first, Time now) const noexcept {
  constexpr int kNobody = -1;
  const bool hears = robot_.hears();
  poller.watch(first++, io_.descriptor());
  poller.watch(first++, discovery_.descriptor());
  poller.watch(first++, subnet_broadcast_.descriptor());
  poller.watch(first++, any_broadcast_.descriptor());
  poller.watch(first++, hears && listener_ ? listener_->descriptor() : kNobody);
  for (const Peer& peer : peers_) {
    poller.watch(first++, hears ? peer.stream.descriptor() : kNobody, peer.answering && peer.answer_at <= now);
  }
}

Time EthernetIpSockets::next_event(Time now) const noexcept {
  Time next = Time::max();
  if (!robot_.hears()) return next;
  for (const Answer& answer : answers_) {
    if (answer.size > 0) next = std::min(next, answer.at);
  }
  for (const Peer& peer : peers_) {
    if (peer.answering && peer.answer_at > now) next = std::min(next, peer.answer_at);
  }
  return next;
}

// The TCP port is open while the robot is there.
void EthernetIpSockets::come_and_go(Time now) noexcept {
  if (!robot_.present()) {
    for (std::size_t id = 0; id < peers_.size(); ++id) hang_up(id, now);
    for (Answer& answer : answers_) answer.size = 0;
    listener_.reset();
    return;
  }
  if (listener_ || now < listen_again_at_) return;
  listen_again_at_ = now + kBeforeListeningAgain;
  try {
    listener_.emplace(explicit_messages_, kExplicitDscp);
    trouble_.clear();
  } catch (const std::runtime_error& error) {
    trouble_ = error.what();
  }
}

void EthernetIpSockets::welcome(Time now) noexcept {
  while (listener_) {
    auto stream = listener_->accept();
    if (!stream) return;
    const auto free = std::ranges::find_if(peers_, [](const Peer& peer) { return !peer.stream; });
    if (free == peers_.end()) continue;  // one too many: hung up at once
    const auto id = static_cast<std::size_t>(free - peers_.begin());
    robot_.adapter().tcp_accepted(id, stream->peer().ipv4, now);
    *free = {.stream = std::move(*stream)};
  }
}

void EthernetIpSockets::serve(std::size_t id, Time now) noexcept {
  net::TcpStream& stream = peers_[id].stream;
  if (!stream) return;
  const auto [size, closed] = stream.receive(buffer_);
  if (size > 0) robot_.adapter().tcp_received(id, Bytes(buffer_).first(size), now);
  if (closed) return hang_up(id, now);
  answer(id, now);
}

void EthernetIpSockets::answer(std::size_t id, Time now) noexcept {
  Peer& peer = peers_[id];
  ethernet_ip::Adapter& adapter = robot_.adapter();
  if (!adapter.tcp_output(id).empty()) {
    if (!peer.answering) peer.answer_at = now + robot_.faults().late;
    peer.answering = true;
    if (now < peer.answer_at) return;
    const auto [size, closed] = peer.stream.send(adapter.tcp_output(id));
    adapter.tcp_sent(id, size);
    if (closed) return hang_up(id, now);
  }
  if (!adapter.tcp_output(id).empty()) return;
  peer.answering = false;
  if (adapter.wants_closed(id)) hang_up(id, now);
}

void EthernetIpSockets::hang_up(std::size_t id, Time now) noexcept {
  if (!peers_[id].stream) return;
  robot_.adapter().tcp_closed(id, now);
  peers_[id] = {};
}

void EthernetIpSockets::receive_discovery(net::UdpSocket& socket, bool broadcast, Time now) noexcept {
  if (!socket) return;
  for (int i = 0; i < kMostAtOnce; ++i) {
    const auto received = socket.receive(buffer_);
    if (!received) return;
    if (!robot_.hears() || received->size > buffer_.size()) continue;
    const auto said = robot_.adapter().udp_received(Bytes(buffer_).first(received->size), broadcast);
    const auto free = std::ranges::find(answers_, std::size_t{0}, &Answer::size);
    if (free == answers_.end() || said.bytes.empty() || said.bytes.size() > free->bytes.size()) continue;
    free->to = received->from;
    free->at = now + said.delay + robot_.faults().late;
    free->size = said.bytes.size();
    std::ranges::copy(said.bytes, free->bytes.begin());
  }
}

void EthernetIpSockets::receive_io(Time now) noexcept {
  for (int i = 0; i < kMostAtOnce; ++i) {
    const auto received = io_.receive(buffer_);
    if (!received) return;
    const std::size_t size = std::min(received->size, buffer_.size());  // a longer one is of a wrong length anyhow
    robot_.io_received({received->from.ipv4, received->from.port}, Bytes(buffer_).first(size), now);
  }
}

void EthernetIpSockets::send_answers(Time now) noexcept {
  for (Answer& answer : answers_) {
    if (answer.size == 0 || now < answer.at) continue;
    discovery_.send(answer.to, Bytes(answer.bytes).first(answer.size));
    answer.size = 0;
  }
}

}  // namespace meca::sim
