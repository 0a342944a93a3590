// Devices in a row, as frames pass them: from the primary side through all that are connected and back, or out of the
// secondary side of a ring. Cuts and missing devices are part of it. No clock, no allocation after construction.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "transports/ethercat/device.hpp"

namespace meca::ethercat {

class Chain {
 public:
  enum class Side : std::uint8_t { kPrimary, kSecondary };

  // Devices are the caller's, in the order of the cable; they outlive the chain. Each frame takes `wire` per device and
  // direction (receive times of the clocks): about 1 us in real devices.
  explicit Chain(std::vector<Device*> devices, Time wire = std::chrono::nanoseconds(1000));

  // A frame comes in at one side: it passes the devices in place, gets the reply bit of the source address (a master's
  // own address may have it already), and leaves at the side that is returned. Nothing: not an EtherCAT frame with at
  // least one whole datagram, or nobody is there (the first device has no power): then nothing comes back. From the
  // secondary side of a whole ring it passes untouched: devices process on the way from port 0 to port 1 only.
  std::optional<Side> process(Side in, std::span<std::byte> frame, Time now) noexcept;

  void set_ring(bool closed_to_master) noexcept;  // a second cable from the last device to the master
  // The cable before device k (0: the master's) is pulled; of the ring's second cable: k = number of devices.
  void cut(std::size_t k) noexcept;
  void heal(std::size_t k) noexcept;
  // A device without power: frames end before it, as at a cut on both its sides. Device::power_cycle() is the caller's.
  void set_powered(std::size_t device, bool powered) noexcept;

  std::size_t size() const noexcept;
  // Frames of that side are processed by the device.
  bool reached(std::size_t device, Side from) const noexcept;

 private:
  // Devices [first, end) that a frame passes.
  struct Stretch {
    std::size_t first = 0, end = 0;
  };
  static constexpr std::size_t kSourceAddress = 6;

  static void pass(Device& device, std::span<std::byte> frame, Time at_port0, std::optional<Time> at_port1) noexcept;
  bool link(std::size_t cable) const noexcept;
  void topology_changed() noexcept;

  std::vector<Device*> devices_;
  std::vector<bool> cable_, powered_;
  bool ring_ = false, whole_ring_ = false;
  Stretch primary_, secondary_;  // what each side reaches
  Time wire_;
};

}  // namespace meca::ethercat
