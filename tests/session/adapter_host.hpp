// A robot on EtherNet/IP for tests: the adapter on real sockets at a loopback address of its own, in a thread, with or
// without the simulated Meca500 behind it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "sim/robot.hpp"
#include "transports/ethernet_ip/adapter.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/tcp.hpp"
#include "transports/net/udp.hpp"

namespace meca::test {

// A Meca500 of firmware 11.3.
ethernet_ip::AdapterSettings meca500_at(const std::string& address);

class AdapterHost {
 public:
  // Plugged in from the start.
  explicit AdapterHost(const ethernet_ip::AdapterSettings& settings,
                       std::optional<sim::RobotOptions> model = std::nullopt);
  explicit AdapterHost(const std::string& address) : AdapterHost(meca500_at(address)) {}
  ~AdapterHost();

  // The network cable: without it nobody listens and nothing is sent; what the adapter remembers stays.
  void unplug();
  void plug_in();

  // `f(adapter)` between two rounds of the thread.
  template <class F>
  auto with(F f) {
    const std::lock_guard lock(mutex_);
    return f(adapter_);
  }
  ethernet_ip::AdapterCounters counters() {
    return with([](auto& a) { return a.counters(); });
  }

 private:
  struct Sockets {
    Sockets(std::uint32_t address, std::uint16_t io_port);
    net::TcpListener listener;
    net::UdpSocket io;
    std::array<net::TcpStream, ethernet_ip::Adapter::kMostConnections> tcp;
  };
  void run(const std::stop_token& stop);
  void watch();
  void serve(ethernet_ip::Time now);
  void serve_tcp(ethernet_ip::Time now);
  void serve_io(ethernet_ip::Time now);
  void step_model(ethernet_ip::Time now);

  std::uint32_t address_;
  std::uint16_t io_port_;
  std::mutex mutex_;
  ethernet_ip::Adapter adapter_;
  std::optional<sim::Robot> model_;
  image::Layout layout_ = image::Layout::kFirmware11;
  ethernet_ip::Time stepped_{};
  std::unique_ptr<Sockets> sockets_;
  net::Poller poller_;
  std::jthread thread_;  // last: it uses the rest
};

}  // namespace meca::test
