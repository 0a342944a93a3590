// The simulated robot behind the robot's end of EtherNet/IP, as a machine without I/O: the model (sim/robot.hpp), the
// adapter (transports/ethernet_ip/adapter.hpp) and what happens where they meet. Datagrams and time come in, datagrams
// go out; TCP bytes go to the adapter itself. No clock; allocates only in the constructor.
#pragma once

#include <array>
#include <optional>

#include "sim/meca_sim/connection_loss.hpp"
#include "sim/network_faults.hpp"
#include "sim/robot.hpp"
#include "transports/ethernet_ip/adapter.hpp"
#include "transports/image/codec.hpp"

namespace meca::sim {

class EthernetIpRobot {
 public:
  // The model's own cycle, whatever the RPI. inferred: the shortest cycle that the robot offers on any bus.
  static constexpr Time kCycle = std::chrono::milliseconds(1);

  EthernetIpRobot(const RobotOptions& model, const ethernet_ip::AdapterSettings& adapter, ConnectionLoss on_loss,
                  Time now);

  // Brings model, watchdogs and faults up to `now`. Of a long silence (a debugger) the model lives 100 ms.
  void advance(Time now) noexcept;
  // A datagram on the I/O port. Its image, when it is new and says run, is the host's in one cycle of the model, the
  // next one that is free; idle ones are not applied.
  void io_received(const ethernet_ip::SocketAddress& from, ethernet_ip::Bytes datagram, Time now) noexcept;
  // The next T->O packet when one is due, with the inputs of the model's last cycle; call until empty.
  std::optional<ethernet_ip::Adapter::Datagram> produce(Time now) noexcept;
  Time next_event() const noexcept;  // when advance() or produce() has something to do

  // False: the robot is starting up, nobody answers on its address. (An unplugged one is there and hears nothing.)
  bool present() const noexcept { return robot_.present(); }
  bool hears() const noexcept { return present() && !faults_.unplugged; }

  Robot& robot() noexcept { return robot_; }
  const Robot& robot() const noexcept { return robot_; }
  ethernet_ip::Adapter& adapter() noexcept { return adapter_; }
  const ethernet_ip::Adapter& adapter() const noexcept { return adapter_; }
  NetworkFaults& faults() noexcept { return faults_; }  // act from the next call on

 private:
  void carry_faults() noexcept;
  void step() noexcept;
  void leave() noexcept;
  void watch_connection() noexcept;
  void show_inputs() noexcept;

  Robot robot_;
  ethernet_ip::Adapter adapter_;
  image::Format format_;
  ConnectionLoss on_loss_;
  NetworkFaults faults_;
  Time next_cycle_;
  // Images that have arrived and had no cycle yet: no MoveID is passed over, however packets bunch.
  std::array<image::OutputBytes, 4> waiting_{};
  std::size_t waiting_count_ = 0;
  bool was_present_ = true;
  std::uint64_t opens_ = 0, ends_ = 0;  // of connections, as seen last
  std::uint64_t tcp_closures_ = 0;
  bool without_power_ = false;
};

}  // namespace meca::sim
