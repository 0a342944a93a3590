// A host of an EtherNet/IP robot for tests of programs: the originator on sockets of 127.0.0.1, pumped by the test's
// own thread. I/O comes to a port of its own, so that tests and bridges on one machine do not meet.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "transports/ethernet_ip/originator.hpp"
#include "transports/image/codec.hpp"
#include "transports/net/tcp.hpp"
#include "transports/net/udp.hpp"

namespace meca::test {

class EipHost {
 public:
  explicit EipHost(std::uint32_t robot, ethernet_ip::OriginatorSettings settings = {});

  // Goes on until it is true; false when it has not become so within a minute.
  bool until(const std::function<bool()>& condition);
  bool run() {
    return until([this] { return originator.running(); });
  }
  void run_for(std::chrono::nanoseconds time);  // at least

  image::Inputs inputs() const { return image::decode_inputs(originator.input(), {}); }
  bool trouble_has(const std::string& text) const {
    return std::string(originator.trouble()).find(text) != std::string::npos;
  }

  net::UdpSocket io;
  ethernet_ip::Originator originator;
  image::Outputs outputs;
  std::uint64_t hung_up = 0, refused = 0;       // TCP, by the robot
  std::vector<std::byte> last_tcp;              // as it came last
  ethernet_ip::Time connected_at{}, said_at{};  // TCP: when it was connected, when the robot said something then

 private:
  void pump();
  void pump_io(ethernet_ip::Time now);
  void pump_tcp(ethernet_ip::Time now);

  std::uint32_t robot_;
  net::UdpSocket group_io_;  // of a multicast connection
  net::TcpStream tcp_;
  bool connected_ = false;
};

}  // namespace meca::test
