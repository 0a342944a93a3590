// One robot on the bus: its originator with the TCP connection, the multicast membership and the measurements that
// belong to it.
#pragma once

#include <span>

#include "transports/ethernet_ip/originator.hpp"
#include "transports/ethernet_ip/period_meter.hpp"
#include "transports/net/tcp.hpp"
#include "transports/net/udp.hpp"
#include "transports/transport.hpp"

namespace meca::ethernet_ip {

// What Exchange::counters hold, in this order.
std::span<const transports::CounterInfo> link_counters() noexcept;

class RobotLink {
 public:
  // `own`: the address to connect from; 0: the system's choice.
  RobotLink(const OriginatorSettings& settings, std::uint16_t first_connection_serial, std::uint32_t own);

  std::uint32_t address() const noexcept { return address_; }

  void tick(net::UdpSocket& udp, Time now) noexcept;
  bool io_received(const net::Endpoint& from, Bytes datagram, Time now) noexcept;  // true: from this robot
  // True once for each wait of the loop (told apart by its deadline) in which a new image has come: a robot that sends
  // faster than the loop turns costs no more than one turn more.
  bool wakes(Time deadline) noexcept;

  // Sends what is due.
  void produce(net::UdpSocket& udp, const transports::Exchange& exchange, Time now) noexcept;
  std::optional<Time> next_send() const noexcept { return originator_.next_send(); }

  int descriptor() const noexcept { return stream_.descriptor(); }  // of TCP, negative: none
  bool wants_to_write() const noexcept { return connecting_ || !originator_.tcp_output().empty(); }
  void tcp_ready(net::UdpSocket& udp, Time now) noexcept;

  void fill(transports::Exchange& exchange, std::uint64_t unknown_packets) noexcept;

  void close(Time now) noexcept { originator_.close(now); }
  bool closed() const noexcept { return originator_.state() == Originator::State::kClosed; }
  void hang_up(net::UdpSocket& udp) noexcept;  // whatever is left

 private:
  void connect_or_hang_up(Time now) noexcept;
  void receive_tcp(Time now) noexcept;
  void send_tcp(Time now) noexcept;
  void tcp_lost(Time now) noexcept;
  void follow_group(net::UdpSocket& udp, Time now) noexcept;
  transports::LinkState link() const noexcept;

  Originator originator_;
  std::uint32_t address_, own_;
  std::uint16_t tcp_port_;
  net::TcpStream stream_;
  bool connecting_ = false;
  std::uint32_t group_ = 0, group_interface_ = 0;  // the group we are a member of, and on which own address
  bool arrived_ = false;                           // a new image since the last fill()
  Time woke_for_{};
  PeriodMeter sent_, received_;
  std::uint64_t failed_sends_ = 0;
};

}  // namespace meca::ethernet_ip
