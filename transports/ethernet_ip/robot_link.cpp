#include "transports/ethernet_ip/robot_link.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

namespace meca::ethernet_ip {
namespace {

constexpr std::uint8_t kExplicitDscp = 27;
constexpr int kMostReads = 8;  // of TCP in one go: a robot that talks without end must not stop the others

enum Counter : std::size_t {
  kSent,
  kReceived,
  kLost,
  kStale,
  kRepeated,
  kForeign,
  kMalformed,
  kUnknown,
  kWatchdogTrips,
  kReconnects,
  kRefusals,
  kSkippedSends,
  kFailedSends,
  kOToTApi,
  kTToOApi,
  kSendMean,
  kSendMax,
  kSendDeviation,
  kReceiveMean,
  kReceiveMax,
  kReceiveDeviation,
  kCounters,
};

constexpr std::array<transports::CounterInfo, kCounters> kInfo{{
    {"sent_packets", ""},
    {"received_packets", ""},
    {"lost_packets", ""},
    {"stale_packets", ""},
    {"repeated_packets", ""},
    {"foreign_packets", ""},
    {"malformed_packets", ""},
    {"unknown_packets", ""},
    {"watchdog_trips", ""},
    {"reconnects", ""},
    {"refusals", ""},
    {"skipped_sends", ""},
    {"failed_sends", ""},
    {"api_o_to_t", "us"},
    {"api_t_to_o", "us"},
    {"send_period_mean", "us"},
    {"send_period_max", "us"},
    {"send_period_deviation", "us"},
    {"receive_period_mean", "us"},
    {"receive_period_max", "us"},
    {"receive_period_deviation", "us"},
}};
static_assert(kCounters <= transports::kMostCounters);

// The revision is the firmware from 10.x on; 9.x says 2.1, so there the robot has to be asked (dynamic data type 1).
transports::FirmwareVersion firmware_of(const std::optional<Identity>& identity) noexcept {
  if (!identity || identity->major < 10) return {};
  return {identity->major, identity->minor, 0, 0};
}

std::string_view why_not_joined(int error) noexcept {
  switch (error) {
    case ENODEV:
      return "this machine has no interface for it";
    case ENOBUFS:
      return "too many groups on this machine (net.ipv4.igmp_max_memberships)";
    case EADDRINUSE:
      return "another robot of this bridge sends to the same group";
    default:
      return "the system refuses it";
  }
}

}  // namespace

std::span<const transports::CounterInfo> link_counters() noexcept { return kInfo; }

RobotLink::RobotLink(const OriginatorSettings& settings, std::uint16_t first_connection_serial, std::uint32_t own)
    : originator_(settings, first_connection_serial),
      address_(settings.address),
      own_(own),
      tcp_port_(settings.tcp_port) {}

void RobotLink::tick(net::UdpSocket& udp, Time now) noexcept {
  originator_.tick(now);
  connect_or_hang_up(now);
  send_tcp(now);
  follow_group(udp, now);
}

// ---- TCP

void RobotLink::connect_or_hang_up(Time now) noexcept {
  if (!originator_.wants_tcp()) {
    stream_.close();
    connecting_ = false;
  } else if (!stream_) {
    stream_ = net::TcpStream::connect({address_, tcp_port_}, kExplicitDscp, own_);
    connecting_ = static_cast<bool>(stream_);
    if (!connecting_) originator_.tcp_closed(stream_.trouble(), now);
  }
}

void RobotLink::tcp_ready(net::UdpSocket& udp, Time now) noexcept {
  if (connecting_) {
    switch (stream_.progress()) {
      case net::TcpStream::Progress::kConnecting:
        return;
      case net::TcpStream::Progress::kConnected:
        connecting_ = false;
        originator_.tcp_connected(now, stream_.local().ipv4);
        break;
      case net::TcpStream::Progress::kFailed:
        tcp_lost(now);
        return;
    }
  }
  receive_tcp(now);
  send_tcp(now);
  follow_group(udp, now);
}

void RobotLink::receive_tcp(Time now) noexcept {
  std::array<std::byte, 1024> buffer;
  for (int i = 0; i < kMostReads && stream_; ++i) {
    const auto got = stream_.receive(buffer);
    if (got.closed) return tcp_lost(now);
    if (got.bytes == 0) return;
    originator_.tcp_received(Bytes(buffer).first(got.bytes), now);
  }
}

void RobotLink::send_tcp(Time now) noexcept {
  if (!stream_ || connecting_ || originator_.tcp_output().empty()) return;
  const auto sent = stream_.send(originator_.tcp_output());
  originator_.tcp_sent(sent.bytes);
  if (sent.closed) tcp_lost(now);
}

void RobotLink::tcp_lost(Time now) noexcept {
  stream_.close();
  connecting_ = false;
  originator_.tcp_closed(stream_.trouble(), now);
}

// ---- UDP

// The group is known from the reply to Forward Open, when the robot is sending already: at once, then.
void RobotLink::follow_group(net::UdpSocket& udp, Time now) noexcept {
  const std::uint32_t wanted = originator_.group();
  if (wanted == group_) return;
  if (group_ != 0) udp.leave(group_, group_interface_);
  group_ = 0;
  if (wanted == 0) return;
  const std::uint32_t interface = stream_ ? stream_.local().ipv4 : net::source_for(address_);
  if (!udp.join(wanted, interface)) return originator_.join_failed(why_not_joined(errno), now);
  group_ = wanted;
  group_interface_ = interface;
}

bool RobotLink::io_received(const net::Endpoint& from, Bytes datagram, Time now) noexcept {
  const OriginatorCounters& counters = originator_.counters();
  const auto received = counters.received, alive = counters.received + counters.repeated;
  const bool ours = originator_.io_received({from.ipv4, from.port}, datagram, now);
  if (counters.received + counters.repeated != alive) received_.packet(now);
  if (counters.received != received) arrived_ = true;
  return ours;
}

bool RobotLink::wakes(Time deadline) noexcept {
  if (!arrived_ || woke_for_ == deadline) return false;
  woke_for_ = deadline;
  return true;
}

void RobotLink::produce(net::UdpSocket& udp, const transports::Exchange& exchange, Time now) noexcept {
  const auto datagram = originator_.produce(exchange.output, exchange.output_valid, now);
  if (!datagram) return;
  sent_.packet(now);
  if (!udp.send({datagram->to.ipv4, datagram->to.port}, datagram->bytes)) ++failed_sends_;
}

void RobotLink::hang_up(net::UdpSocket& udp) noexcept {
  if (group_ != 0) udp.leave(group_, group_interface_);
  group_ = 0;
  stream_.close();
}

// ---- What the bridge sees

transports::LinkState RobotLink::link() const noexcept {
  using State = Originator::State;
  switch (originator_.state()) {
    case State::kRunning:
      return originator_.running() ? transports::LinkState::kUp : transports::LinkState::kConnecting;
    case State::kConnecting:
    case State::kRegistering:
    case State::kIdentifying:
    case State::kOpening:
      return transports::LinkState::kConnecting;
    case State::kWaiting:
    case State::kClosing:
    case State::kClosed:
      return transports::LinkState::kDown;
  }
  return transports::LinkState::kDown;
}

void RobotLink::fill(transports::Exchange& exchange, std::uint64_t unknown_packets) noexcept {
  exchange.link = link();
  exchange.fresh = originator_.take_fresh();
  if (exchange.fresh) exchange.input = originator_.input();
  arrived_ = false;
  exchange.link_detail = originator_.trouble();
  exchange.identity = firmware_of(originator_.identity());
  if (originator_.state() != Originator::State::kRunning) {
    sent_.restart();
    received_.restart();
  }
  const OriginatorCounters& c = originator_.counters();
  const PeriodMeter::Facts &sent = sent_.facts(), &received = received_.facts();
  const auto put = [&](Counter counter, auto value) { exchange.counters[counter] = static_cast<std::int64_t>(value); };
  put(kSent, c.sent);
  put(kReceived, c.received);
  put(kLost, c.lost);
  put(kStale, c.stale);
  put(kRepeated, c.repeated);
  put(kForeign, c.foreign);
  put(kMalformed, c.malformed);
  put(kUnknown, unknown_packets);
  put(kWatchdogTrips, c.watchdog_trips);
  put(kReconnects, c.opens > 0 ? c.opens - 1 : 0);
  put(kRefusals, c.refusals);
  put(kSkippedSends, c.skipped_sends);
  put(kFailedSends, failed_sends_);
  put(kOToTApi, originator_.o_to_t_api_us());
  put(kTToOApi, originator_.t_to_o_api_us());
  put(kSendMean, sent.mean_us);
  put(kSendMax, sent.max_us);
  put(kSendDeviation, sent.deviation_us);
  put(kReceiveMean, received.mean_us);
  put(kReceiveMax, received.max_us);
  put(kReceiveDeviation, received.deviation_us);
}

}  // namespace meca::ethernet_ip
