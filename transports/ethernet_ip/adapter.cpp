#include "transports/ethernet_ip/adapter.hpp"

#include <algorithm>
#include <utility>

#include "transports/ethernet_ip/adapter_state.hpp"

namespace meca::ethernet_ip {
namespace {

TcpPeer* peer_of(AdapterState& s, std::size_t id) noexcept {
  return id < s.peers.size() && s.peers[id].used ? &s.peers[id] : nullptr;
}

void close_peer(TcpPeer& peer) noexcept {
  if (!peer.used) return;
  peer.closing = true;
  peer.session = 0;
  peer.out_size = 0;
}

}  // namespace

AdapterState::AdapterState(const AdapterSettings& s) noexcept
    : settings(s),
      last_connection_id(s.identity.serial_number << 8),
      random((s.address ^ s.identity.serial_number) | 1) {}

Adapter::Adapter(const AdapterSettings& settings) : state_(std::make_unique<AdapterState>(settings)) {}
Adapter::~Adapter() = default;
Adapter::Adapter(Adapter&&) noexcept = default;
Adapter& Adapter::operator=(Adapter&&) noexcept = default;

void Adapter::tcp_accepted(std::size_t id, std::uint32_t peer_ipv4, Time now) noexcept {
  if (id >= state_->peers.size()) return;
  TcpPeer& peer = state_->peers[id];
  peer = {};
  peer.used = true;
  peer.ipv4 = peer_ipv4;
  peer.last_heard = now;
}

void Adapter::tcp_closed(std::size_t id, Time) noexcept {
  if (TcpPeer* peer = peer_of(*state_, id)) *peer = {};
}

void Adapter::tcp_received(std::size_t id, Bytes bytes, Time now) noexcept {
  if (TcpPeer* peer = peer_of(*state_, id)) receive_tcp(*state_, *peer, bytes, now);
}

Bytes Adapter::tcp_output(std::size_t id) const noexcept {
  const TcpPeer* peer = peer_of(*state_, id);
  return peer == nullptr ? Bytes{} : Bytes(peer->out).first(peer->out_size);
}

void Adapter::tcp_sent(std::size_t id, std::size_t count) noexcept {
  TcpPeer* peer = peer_of(*state_, id);
  if (peer == nullptr) return;
  count = std::min(count, peer->out_size);
  std::copy_n(peer->out.begin() + static_cast<std::ptrdiff_t>(count), peer->out_size - count, peer->out.begin());
  peer->out_size -= count;
}

bool Adapter::wants_closed(std::size_t id) const noexcept {
  const TcpPeer* peer = peer_of(*state_, id);
  return peer != nullptr && peer->closing;
}

Adapter::Answer Adapter::udp_received(Bytes datagram, bool broadcast) noexcept {
  return answer_udp(*state_, datagram, broadcast);
}

void Adapter::io_received(const SocketAddress& from, Bytes datagram, Time now) noexcept {
  consume(*state_, from, datagram, now);
}

std::optional<Adapter::Datagram> Adapter::produce(Time now) noexcept { return ethernet_ip::produce(*state_, now); }

std::optional<Time> Adapter::next_event() const noexcept {
  std::optional<Time> next;
  const auto earlier = [&next](Time t) { next = next ? std::min(*next, t) : t; };
  const IoConnection& io = state_->io;
  if (io.open) {
    earlier(io.deadline);
    if (!state_->faults.stop_producing) earlier(io.next_send);
  }
  if (state_->settings.inactivity_timeout.count() > 0) {
    for (const TcpPeer& peer : state_->peers) {
      if (peer.used && !peer.closing) earlier(peer.last_heard + state_->settings.inactivity_timeout);
    }
  }
  return next;
}

void Adapter::tick(Time now) noexcept {
  check_watchdog(*state_, now);
  if (state_->settings.inactivity_timeout.count() == 0) return;
  for (TcpPeer& peer : state_->peers) {
    if (peer.used && now - peer.last_heard >= state_->settings.inactivity_timeout) peer.closing = true;
  }
}

void Adapter::set_input(const image::InputBytes& input) noexcept { state_->input = input; }
bool Adapter::connected() const noexcept { return state_->io.open; }
bool Adapter::run() const noexcept { return state_->io.open && state_->io.run; }
std::uint32_t Adapter::originator() const noexcept { return state_->io.open ? state_->io.originator : 0; }
bool Adapter::take_fresh() noexcept { return std::exchange(state_->io.fresh, false); }
const image::OutputBytes& Adapter::output() const noexcept { return state_->output; }

AdapterFaults& Adapter::faults() noexcept { return state_->faults; }

void Adapter::close_tcp_connections() noexcept {
  for (TcpPeer& peer : state_->peers) close_peer(peer);
}

void Adapter::power_cycle() noexcept {
  close_tcp_connections();
  end_connection(*state_);
  state_->kept_owner.reset();
  state_->output = {};
}

const AdapterCounters& Adapter::counters() const noexcept { return state_->counters; }

}  // namespace meca::ethernet_ip
