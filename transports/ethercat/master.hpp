// Our end of an EtherCAT segment: the master, as a machine without I/O, for all robots on one interface (or two, a
// ring). Time and frames come in, frames and facts go out. No allocation after construction, no clock.
//
// Once a cycle: set_output() for every robot, begin_cycle(), then what next_frame() gives is sent; what arrives goes to
// received(). The process data of all robots stands in one frame (several when it does not fit) and is due once a
// cycle; everything else (finding devices, SII, mailboxes, AL states, clocks, error counters) goes one small frame at a
// time in between, so that it never makes a cycle late.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "transports/ethercat/frame.hpp"
#include "transports/ethercat/histogram.hpp"
#include "transports/ethercat/station.hpp"
#include "transports/image/image.hpp"

namespace meca::ethercat {

struct RobotPlace {
  std::uint16_t position = 0;          // in the chain, 0 = first
  std::optional<std::uint16_t> alias;  // then by alias (SII word 4), wherever it is
};

struct MasterSettings {
  std::vector<RobotPlace> robots;  // at most kMostRobots; places differ
  Time cycle = std::chrono::milliseconds(1);
  MacAddress source{std::byte{0x10}, std::byte{0x10}, std::byte{0x10},
                    std::byte{0x10}, std::byte{0x10}, std::byte{0x10}};
  bool separate = false;  // LRD and LWR in place of LRW; by itself where a device cannot LRW
  // Distributed clocks. Not with `redundant`: in a ring the propagation delays cannot be told apart, so the robots run
  // synchronous to the frames there.
  bool dc = false;
  Time dc_shift{};
  Time watchdog = std::chrono::milliseconds(100);
  bool redundant = false;      // frames go out on both ports; what comes back on either is merged
  std::uint64_t dc_epoch = 0;  // ns since 2000-01-01 at Time 0 of `now`; the owner knows the wall clock
  // A frame that is not back after so long is lost. Nobody waits for process data: an image that is late still counts
  // when it is the newest. Service frames (registers, mailboxes) are waited for; they are sent so far apart.
  Time frame_timeout = std::chrono::milliseconds(20), service_timeout = std::chrono::milliseconds(4),
       service_period = std::chrono::milliseconds(1);
  StationSettings station;  // for its time-outs
};

// Monotonic since construction, of the segment.
struct MasterCounters {
  std::uint64_t cycles = 0, sent_frames = 0, received_frames = 0;
  std::uint64_t lost_frames = 0;  // not back in time
  std::uint64_t late_frames = 0;  // back, but after the next cycle had begun
  std::uint64_t unexpected_frames =
      0;  // replies that match nothing in flight: index, command, address (duplicates too)
  std::uint64_t malformed_frames = 0;
  std::uint64_t scans = 0;  // times that the chain was looked through
};

// Of one robot.
struct RobotCounters {
  std::uint64_t images = 0;  // fresh inputs
  std::uint64_t working_counter_misses =
      0;                     // cycles in which its datagram did not count what it should; inputs not taken
  std::uint64_t losses = 0;  // times that it left OP without being asked
  // Registers 0300 to 0313 of ports 0 and 1, read about once a second; saturating in the device, summed up here.
  std::array<std::uint32_t, 2> invalid_frames{}, rx_errors{}, lost_links{};
  std::int64_t dc_difference_ns = 0;  // register 092C, last seen
};

struct MasterState;

class Master {
 public:
  static constexpr std::size_t kMostRobots = 32, kMostDevices = 64;
  enum class Port : std::uint8_t { kPrimary, kSecondary };

  explicit Master(const MasterSettings& settings);
  ~Master();
  Master(Master&&) noexcept;
  Master& operator=(Master&&) noexcept;

  // ---- Frames
  void begin_cycle(Time now) noexcept;
  // The next frame to send, until empty; valid until the next call. Redundant: on both ports.
  Bytes next_frame(Time now) noexcept;
  // When next_frame() has something without a new cycle, or something in flight is given up; Time::max(): never.
  Time next_event() const noexcept;
  // Redundant: whether what next_frame() gave goes out on both ports. Looking for devices by their position does not:
  // in an open ring two of them would answer.
  bool on_both_ports() const noexcept;
  void received(Port port, Bytes frame, Time now) noexcept;
  // Carrier of a port. Without one nothing is sent there.
  void link_changed(Port port, bool up, Time now) noexcept;
  void close(Time now) noexcept;  // all robots to INIT; keep cycling until closed()
  bool closed() const noexcept;

  // ---- Robots, in the order of the settings
  // Zeros before the first.
  void set_output(std::size_t robot, const image::OutputBytes& output) noexcept;
  bool take_fresh(std::size_t robot) noexcept;  // new inputs since the last call
  const image::InputBytes& input(std::size_t robot) const noexcept;
  const Station& station(std::size_t robot) const noexcept;
  // Why it is not operational, or what it lacks though it is: its part in the process data, the other half of a ring. A
  // sentence without full stop. The chain's trouble where that is the reason ("no carrier on eth1" is the owner's to
  // say), else the station's.
  std::string_view trouble(std::size_t robot) const noexcept;
  const RobotCounters& counters(std::size_t robot) const noexcept;

  // ---- Segment
  const MasterCounters& counters() const noexcept;
  const Histogram& round_trip() const noexcept;  // of cyclic frames, over the last second
  // Redundant: the ring is open, both halves are reached from their own ends. A robot behind the break that comes new
  // into the chain (switched on, exchanged) is only found when the ring is whole again.
  bool ring_open() const noexcept;
  // By how much the owner's next deadline should move so that the frames pass half a cycle before SYNC0; at most a
  // hundredth of the cycle. Zero without DC. To be asked once a cycle.
  Time dc_phase_correction() const noexcept;

 private:
  std::unique_ptr<MasterState> state_;
};

}  // namespace meca::ethercat
