// The simulated robot behind the robot's end of EtherCAT, as a machine without I/O: the model (sim/robot.hpp), the
// device (transports/ethercat/device.hpp) and what happens where they meet. Frames reach the device through the chain
// of its segment (ethercat_segment.hpp). No clock; allocates only in the constructor.
#pragma once

#include "sim/meca_sim/connection_loss.hpp"
#include "sim/network_faults.hpp"
#include "sim/robot.hpp"
#include "transports/ethercat/device.hpp"
#include "transports/image/codec.hpp"

namespace meca::sim {

class EthercatRobot {
 public:
  // The model's own cycle while no outputs come. With outputs the host's cycle is the model's, as in a device that is
  // synchronised by its sync manager: an image is applied when it arrives, and the next frame carries what came of it.
  static constexpr Time kCycle = std::chrono::milliseconds(1);

  // A connection is the time in OP. `foreign`: another maker's device is in its place from the beginning.
  EthercatRobot(const RobotOptions& model, const ethercat::DeviceSettings& device, bool foreign, ConnectionLoss on_loss,
                Time now);

  // Brings device, model and faults up to `now`, and applies the outputs that have arrived; after every frame, before
  // the next one. Of a long silence (a debugger) the model lives 100 ms.
  void advance(Time now) noexcept;
  Time next_event() const noexcept;  // when advance() has something to do without a frame

  // False: it has no power, or is starting up; frames end before it. So does another maker's device in its place.
  bool powered() const noexcept { return robot_.present() && !without_power_; }

  Robot& robot() noexcept { return robot_; }
  const Robot& robot() const noexcept { return robot_; }
  ethercat::Device& device() noexcept { return device_; }
  const ethercat::Device& device() const noexcept { return device_; }
  NetworkFaults& faults() noexcept { return faults_; }  // act from the next advance() on
  const NetworkFaults& faults() const noexcept { return faults_; }

 private:
  void carry_faults(Time now) noexcept;
  void exchange_device(Time now) noexcept;
  void live(Time now) noexcept;
  void watch_power(Time now) noexcept;
  void watch_connection() noexcept;
  void show_inputs() noexcept;
  Time next_cycle() const noexcept { return lived_until_ + (follows_host_ ? 2 * kCycle : kCycle); }

  Robot robot_;
  ethercat::Device device_;
  image::Format format_;
  ConnectionLoss on_loss_;
  NetworkFaults faults_;
  NetworkFaults::Events seen_;  // of the faults
  Time lived_until_;
  Time next_tick_;
  bool follows_host_ = false;  // its outputs come: the next ones are waited for a little longer than a cycle
  bool without_power_ = false, foreign_ = false, was_powered_ = true, was_operational_ = false;
};

}  // namespace meca::sim
