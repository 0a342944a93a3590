// Robots on EtherNet/IP, as a measuring instrument: adapters on real sockets at loopback addresses, where the kernel
// stamps every packet as it arrives, and the robot stamps every image as it leaves.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/period_statistics.hpp"
#include "transports/ethernet_ip/adapter.hpp"
#include "transports/image/image.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/tcp.hpp"
#include "transports/net/udp.hpp"

namespace meca::bench {

// Of the machine that the bridge is on; not 127.0.0.1, where somebody's own bridge may be at work.
inline constexpr const char* kEipHost = "127.0.2.1";
std::string eip_address(int robot);  // 127.0.1.1 for robot 0
// Where a bare sender sends to, at the address of robot 0: one stream a first byte.
inline constexpr std::uint16_t kBarePort = 2223;
inline constexpr int kMostRobots = 64;
// As long as an O->T packet.
inline constexpr std::size_t kBareSize = ethernet_ip::kIoOverhead + 6 + image::kOutputSize;

// A datagram, and when the kernel got it (CLOCK_REALTIME; on the loopback interface that is when it was sent).
struct StampedDatagram {
  net::Endpoint from;
  std::span<const std::byte> bytes;  // until the next call
  std::chrono::nanoseconds at{};
};
class StampingSocket {
 public:
  explicit StampingSocket(const net::Endpoint& local);  // throws std::runtime_error
  net::UdpSocket& socket() { return socket_; }
  std::optional<StampedDatagram> receive();

 private:
  net::UdpSocket socket_;
  std::array<std::byte, 1500> buffer_{};
};

// O->T as one robot saw it.
struct Arrivals {
  PeriodStatistics periods;
  std::int64_t lost = 0;  // gaps in the sequence numbers
  std::optional<std::uint32_t> sequence;
  void packet(std::uint32_t number, std::chrono::nanoseconds at);
};

// Runs on the thread that calls it, and only while it is called.
class EipCell {
 public:
  explicit EipCell(int robots);  // at most kMostRobots; throws std::runtime_error

  void run(std::chrono::nanoseconds duration);
  // Until every robot has an open connection and the bridge's packets flow; throws std::runtime_error after 30 s.
  void run_until_connected();

  void restart();                         // forgets what was measured
  Arrivals arrivals() const;              // of all robots
  PeriodStatistics bare_periods() const;  // of all streams
  std::int64_t timeouts() const;          // connections that ended by a watchdog, since the beginning

 private:
  struct Robot {
    explicit Robot(int number);
    ethernet_ip::Adapter adapter;
    net::TcpListener listener;
    net::TcpStream stream;  // one: the bridge's
    StampingSocket io;
    Arrivals arrivals;
  };
  void produce(Robot& robot);
  void serve_tcp(Robot& robot, std::chrono::nanoseconds now);
  void serve_io(Robot& robot, std::chrono::nanoseconds now);
  void serve_bare();

  std::vector<Robot> robots_;
  StampingSocket bare_;
  std::array<PeriodStatistics, kMostRobots> bare_periods_;
  net::Poller poller_;
};

// The yardstick: wakes at absolute deadlines and sends one datagram for each stream, and does nothing else.
void run_bare_sender(std::chrono::microseconds period, int streams, std::chrono::seconds duration);

}  // namespace meca::bench
