// Robots on EtherCAT for tests: devices in a chain on raw sockets, in a thread, with or without the simulated Meca500
// behind them.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "sim/robot.hpp"
#include "transports/ethercat/chain.hpp"
#include "transports/ethercat/device.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/raw_ethernet.hpp"

namespace meca::test {

struct ChainOptions {
  std::string interface;            // the robots' end of the cable
  std::string redundant_interface;  // of the cable from the last robot; empty: a line
  std::vector<ethercat::DeviceSettings> robots{ethercat::DeviceSettings{}};
  std::optional<sim::RobotOptions> model;  // behind each of them; without: inputs as set with set_input()
};

class ChainHost {
 public:
  explicit ChainHost(const ChainOptions& options);
  ~ChainHost();

  // `f(chain)`, `f(device k)` between two rounds of the thread.
  template <class F>
  auto with_chain(F f) {
    const std::lock_guard lock(mutex_);
    return f(chain_);
  }
  template <class F>
  auto with(std::size_t robot, F f) {
    const std::lock_guard lock(mutex_);
    return f(devices_[robot]);
  }
  ethercat::AlState state(std::size_t robot) {
    return with(robot, [](auto& device) { return device.state(); });
  }
  void power_cycle(std::size_t robot);
  // What stands here of the frame's process data is lost on its way back: no reply while it is on.
  void swallow_replies(bool on);

 private:
  void run(const std::stop_token& stop);
  void serve(ethercat::Time now);
  void pass_frames(std::size_t port, ethercat::Time now);
  void step_model(std::size_t robot, ethercat::Time dt);

  std::vector<ethercat::Device> devices_;
  ethercat::Chain chain_;
  std::vector<sim::Robot> models_;
  std::vector<image::Layout> layouts_;
  std::array<net::RawEthernet, 2> ports_;  // in the order of Chain::Side
  net::Poller poller_;
  ethercat::Time stepped_{};
  bool swallow_ = false;
  std::array<std::byte, ethercat::kLongestFrame> buffer_{};
  std::mutex mutex_;
  std::jthread thread_;  // last: it uses the rest
};

}  // namespace meca::test
