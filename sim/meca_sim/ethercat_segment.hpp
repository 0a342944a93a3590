// Simulated robots on EtherCAT, one behind the other on a cable, as a machine without I/O: frames and time come in,
// frames go out. No clock; allocates only in the constructor.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sim/meca_sim/ethercat_robot.hpp"
#include "transports/ethercat/chain.hpp"

namespace meca::sim {

class EthercatSegment {
 public:
  using Side = ethercat::Chain::Side;
  struct Member {
    RobotOptions model;
    ethercat::DeviceSettings device;
    bool foreign = false;  // from the beginning (NetworkFaults::foreign)
  };
  static constexpr std::size_t kMostRobots = 32;

  // At least one robot, in the order of the cable. `ring`: a second cable leads from the last one to the master.
  EthercatSegment(const std::vector<Member>& members, bool ring, ConnectionLoss on_loss, Time now);
  EthercatSegment(const EthercatSegment&) = delete;
  EthercatSegment& operator=(const EthercatSegment&) = delete;

  // A frame comes in at one side. What is left in its place goes out at the side that is returned, at once: advance()
  // comes behind that, and before the next frame. Nothing: nothing comes back, or not yet (take_late()).
  std::optional<Side> process(Side in, std::span<std::byte> frame, Time now) noexcept;
  // Frames that were held back and are due (the faults "late", "duplicate", "corrupt"), until empty; valid until the
  // next call of process().
  struct LateFrame {
    Side out{};
    std::span<const std::byte> bytes;
  };
  std::optional<LateFrame> take_late(Time now) noexcept;

  // Brings faults, cables, devices and models up to `now`.
  void advance(Time now) noexcept;
  Time next_event() const noexcept;  // when advance() or take_late() has something to do without a frame

  // Whether a cable of the master's has somebody at its other end; true in the beginning.
  void set_carrier(Side side, bool carrier) noexcept;

  std::size_t size() const noexcept { return robots_.size(); }
  EthercatRobot& robot(std::size_t position) noexcept { return robots_[position]; }
  const ethercat::Chain& chain() const noexcept { return chain_; }

 private:
  struct Held {
    std::array<std::byte, ethercat::kLongestFrame> bytes{};
    std::size_t size = 0;
    Side out{};
    Time at{};
  };

  bool is_lost() noexcept;
  void hold(Side out, std::span<const std::byte> frame, Time at) noexcept;
  void lay_cables() noexcept;
  bool is_cut(std::size_t cable) const noexcept;

  std::vector<EthercatRobot> robots_;
  ethercat::Chain chain_;
  std::array<bool, 2> carrier_{true, true};
  std::vector<bool> cut_, powered_;    // as the chain was told
  std::vector<std::uint32_t> passed_;  // frames since the last that "lose every" lost, by robot
  std::vector<Held> held_;             // in the order in which they came
  std::size_t first_held_ = 0, held_count_ = 0;
};

}  // namespace meca::sim
