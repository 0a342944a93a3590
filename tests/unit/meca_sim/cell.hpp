// A simulated robot on EtherNet/IP and a host that talks to it, with time moved by hand and no sockets in between: TCP
// bytes arrive at once, and so do datagrams.
#pragma once

#include <gtest/gtest.h>

#include "sim/meca_sim/ethernet_ip_robot.hpp"
#include "transports/ethernet_ip/originator.hpp"

namespace meca::sim::test {

using namespace std::chrono_literals;

class Cell {
 public:
  static constexpr std::uint32_t kRobot = 0xAC1C0103, kHost = 0xAC1C0102;  // 172.28.1.3, .2
  static constexpr Time kBegin = 1000s;

  explicit Cell(ConnectionLoss on_loss = ConnectionLoss::kStop, const RobotOptions& model = quick())
      : robot(model, adapter(), on_loss, kBegin), host(originator(), 7) {}

  // What takes seconds in a robot takes a millisecond here.
  static RobotOptions quick() {
    RobotOptions options;
    options.activation_time = options.homing_time = options.deactivation_time = 1ms;
    options.boot_time = 500ms;
    options.noise = false;
    return options;
  }

  // Time goes on in quarters of a millisecond, so that neither side's ticks fall on the other's.
  void run(Time duration) {
    for (const Time end = now + duration; now < end; now += 250us) exchange();
  }
  // False: not within the time.
  template <class Condition>
  bool until(Condition condition, Time most = 60s) {
    for (const Time end = now + most; now < end; now += 250us) {
      if (condition()) return true;
      exchange();
    }
    return condition();
  }
  bool connect() {
    return until([this] { return host.running(); });
  }
  // Activated, homed, listening.
  bool make_ready() {
    if (!connect()) return false;
    outputs.robot_control.activate = outputs.robot_control.home = true;
    return until([this] { return inputs().robot_status.homed; });
  }
  void command(std::uint32_t id, std::array<float, 6> arguments) {
    outputs.motion_control.set_point = true;
    ++outputs.motion_control.move_id;
    outputs.motion_command = {id, arguments};
  }

  image::Inputs inputs() const { return image::decode_inputs(host.input(), {}); }

  EthernetIpRobot robot;
  ethernet_ip::Originator host;
  image::Outputs outputs;
  bool run_bit = true;
  bool host_lives = true;  // false: it has died without a word
  Time now = kBegin;

 private:
  static ethernet_ip::AdapterSettings adapter() {
    ethernet_ip::AdapterSettings settings;
    settings.identity = {.vendor_id = 1565, .device_type = 43, .product_code = 500, .major = 11, .minor = 3};
    settings.address = kRobot;
    return settings;
  }
  static ethernet_ip::OriginatorSettings originator() {
    ethernet_ip::OriginatorSettings settings;
    settings.vendor_id = 0x1234;
    settings.serial_number = 0x6B02695B;
    settings.incarnation = 1;
    settings.address = kRobot;
    return settings;
  }

  void exchange() {
    robot.advance(now);
    if (host_lives) exchange_tcp();
    while (const auto datagram = robot.produce(now)) {
      if (host_lives && datagram->to == ethernet_ip::SocketAddress{kHost, 2222}) {
        host.io_received({kRobot, 2222}, datagram->bytes, now);
      }
    }
    if (!host_lives) return;
    host.tick(now);
    image::OutputBytes bytes{};
    image::encode_outputs(outputs, {}, bytes);
    const auto datagram = host.produce(bytes, run_bit, now);
    if (datagram) robot.io_received({kHost, 2222}, datagram->bytes, now);
  }
  void exchange_tcp() {
    ethernet_ip::Adapter& adapter = robot.adapter();
    if (connected_ && (!host.wants_tcp() || adapter.wants_closed(0) || !robot.present())) {
      adapter.tcp_closed(0, now);
      if (host.wants_tcp()) host.tcp_closed("", now);
      connected_ = false;
    } else if (!connected_ && host.wants_tcp()) {
      if (!robot.present()) return host.tcp_closed("connection refused", now);
      adapter.tcp_accepted(0, kHost, now);
      host.tcp_connected(now, kHost);
      connected_ = true;
    }
    if (!connected_ || !robot.hears()) return;
    adapter.tcp_received(0, host.tcp_output(), now);
    host.tcp_sent(host.tcp_output().size());
    host.tcp_received(adapter.tcp_output(0), now);
    adapter.tcp_sent(0, adapter.tcp_output(0).size());
  }

  bool connected_ = false;
};

}  // namespace meca::sim::test
