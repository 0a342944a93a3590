// The sockets of a simulated robot on EtherNet/IP: TCP and UDP 44818, UDP 2222. Carries bytes between them and an
// EthernetIpRobot; decides nothing.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "sim/meca_sim/ethernet_ip_robot.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/tcp.hpp"
#include "transports/net/udp.hpp"

namespace meca::sim {

class EthernetIpSockets {
 public:
  static constexpr std::size_t kSlots = 5 + ethernet_ip::Adapter::kMostConnections;  // of a poller

  // The robot has `own` as its address. Throws std::runtime_error with a sentence.
  EthernetIpSockets(EthernetIpRobot& robot, const net::Interface& own);

  // What has arrived goes to the robot, what it answers goes out. Does not block.
  void exchange(Time now) noexcept;
  // What exchange() waits for, in slots of the poller from `first` on.
  void wait_for(net::Poller& poller, std::size_t first, Time now) const noexcept;
  Time next_event(Time now) const noexcept;  // when an answer that is held back may go; Time::max(): none is

  // What could not be had: the ports of broadcasts, or the TCP port again after the robot started up (it is tried
  // again). Empty: nothing.
  const std::string& trouble() const noexcept { return trouble_; }

 private:
  using Bytes = ethernet_ip::Bytes;
  struct Peer {
    net::TcpStream stream;
    Time answer_at{};  // when what it is to be told may go out
    bool answering = false;
  };
  struct Answer {
    net::Endpoint to;
    Time at{};
    std::array<std::byte, 256> bytes{};
    std::size_t size = 0;  // 0: free
  };
  static constexpr int kMostAtOnce = 64;  // datagrams in one exchange: a flood must not stop the robot

  void come_and_go(Time now) noexcept;
  void welcome(Time now) noexcept;
  void serve(std::size_t id, Time now) noexcept;
  void answer(std::size_t id, Time now) noexcept;
  void hang_up(std::size_t id, Time now) noexcept;
  void receive_discovery(net::UdpSocket& socket, bool broadcast, Time now) noexcept;
  void receive_io(Time now) noexcept;
  void send_answers(Time now) noexcept;

  EthernetIpRobot& robot_;
  net::Endpoint explicit_messages_;
  std::optional<net::TcpListener> listener_;  // none while the robot starts up: whoever calls is refused
  Time listen_again_at_{};
  std::string trouble_;
  std::array<Peer, ethernet_ip::Adapter::kMostConnections> peers_;
  net::UdpSocket discovery_, io_;
  // Linux hands a broadcast only to sockets that are bound to the broadcast's address, or to none.
  net::UdpSocket subnet_broadcast_, any_broadcast_;
  std::array<Answer, 16> answers_;
  std::array<std::byte, 2048> buffer_{};
};

}  // namespace meca::sim
