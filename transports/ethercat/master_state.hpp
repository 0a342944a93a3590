// The inside of the master: what it knows of each robot and of the segment. Who does what:
// master.cpp the front, frames in and out; master_cyclic.cpp process data; master_service.cpp everything in between;
// master_binding.cpp which robot is which device of the chain.
#pragma once

#include <optional>
#include <vector>

#include "transports/ethercat/chain_scan.hpp"
#include "transports/ethercat/clocks.hpp"
#include "transports/ethercat/in_flight.hpp"
#include "transports/ethercat/master.hpp"

namespace meca::ethercat {

// One datagram carries the process data of one robot: outputs, then inputs, next to each other in the logical address
// space. A datagram for all would be 12 bytes a robot shorter, but its working counter could not say who failed: so one
// robot's trouble stays its own.
inline constexpr std::uint32_t kLogicalSize = kOutputSize + kInputSize;
inline constexpr std::uint16_t kBothWays = 3, kOneWay = 1;  // working counters: +1 read, +2 written in one pass

struct ErrorCounterReading {
  bool known = false, clear = false;
  std::array<std::uint8_t, 6> last{};
};

struct Robot {
  Robot(const RobotPlace& where, const StationSettings& settings) : place(where), station(settings) {}

  RobotPlace place;
  Station station;
  RobotCounters counters;
  image::OutputBytes output{};
  image::InputBytes input{};
  bool fresh = false;

  std::uint32_t life = 0;       // of the device that it is; 0: none
  std::uint8_t generation = 0;  // of that binding, to tell an old answer
  bool cannot_lrw = false;
  transports::LinkDetail trouble;  // of the chain

  std::uint64_t input_cycle = 0;                      // that `input` was asked for in
  unsigned misses = 0;                                // of the working counter, in a row
  std::uint16_t wrong_counter = 0;                    // the last of them
  std::uint64_t inputs_cycle = 0, outputs_cycle = 0;  // separate datagrams that counted
  unsigned silent = 0;                                // questions for the AL status, in a row
  bool al_due = false, was_operational = false;
  Time next_al{}, next_errors{}, next_difference{};
  ErrorCounterReading errors;
};

struct MasterState {
  explicit MasterState(const MasterSettings& from);

  // master.cpp
  bool any_port() const noexcept { return ports[0] || ports[1]; }
  bool both_ends() const noexcept { return settings.redundant && ports[0] && ports[1]; }
  // What comes back of a frame. A port that has carrier and yet brings nothing back (a cable that leads elsewhere) must
  // not make every image as old as the time-out: it is not waited for until something comes from there again.
  static constexpr unsigned kMissedCopies = 3;
  InFlight::Copies copies() const noexcept {
    if (!both_ends()) return {};
    if (single_copies < kMissedCopies) return {.count = 2};
    return {.count = 1, .from = talking_port};
  }
  InFlight::Timeouts timeouts() const noexcept { return {settings.frame_timeout, settings.service_timeout}; }
  void give_up_overdue(Time now) noexcept;
  void dispatch(const InFlight::Frame& frame, Bytes reply, Time now) noexcept;
  void lost(const InFlight::Frame& frame, Time now) noexcept;
  Time unequal_pause() noexcept;
  Time silence() const noexcept;  // since somebody in the chain last answered
  void missed_a_copy(const InFlight::Frame& frame) noexcept;
  void ring_is(bool open, std::size_t reached_from_primary) noexcept;
  void out_of_reach(std::string_view why, Time now) noexcept;

  // master_cyclic.cpp
  void begin_cycle() noexcept;
  Bytes cyclic_frame(Time now) noexcept;
  bool add_process_data(std::size_t robot) noexcept;
  void cyclic_reply(const InFlight::Frame& frame, const Purpose& purpose, std::uint16_t working_counter, Bytes data,
                    Time now) noexcept;
  void chain_state(std::uint16_t count, std::uint16_t states) noexcept;
  void take_input(Robot& robot, Bytes input, std::uint64_t cycle) noexcept;
  void miss(Robot& robot, std::uint16_t working_counter) noexcept;
  std::string_view why_not_counted(const Robot& robot) const noexcept;
  void separate_reply(Robot& robot, const InFlight::Frame& frame, bool inputs, std::uint16_t working_counter,
                      Bytes data, Time now) noexcept;
  void reference_time(Bytes data, Time now) noexcept;

  // master_service.cpp
  Bytes service_frame(Time now) noexcept;
  void look_after_scan(Time now) noexcept;
  void add_robots(Time now) noexcept;
  void add_robot(std::size_t robot, Time now) noexcept;
  void service_reply(const Purpose& purpose, std::uint16_t working_counter, Bytes data, Time now) noexcept;
  void service_lost(const Purpose& purpose, Time now) noexcept;
  void al_status_reply(Robot& robot, std::uint16_t working_counter, Bytes data, Time now) noexcept;
  void error_counters_reply(Robot& robot, Bytes data) noexcept;
  Time next_service_event() const noexcept;

  // master_binding.cpp
  void bind(Time now) noexcept;
  void bind(Robot& robot, Time now) noexcept;
  const ChainScan::Device* device_of(const Robot& robot, transports::LinkDetail& why) const noexcept;

  MasterSettings settings;
  std::vector<Robot> robots;
  std::array<bool, 2> ports{true, false};  // have carrier
  MasterCounters counters;
  Histogram round_trip;
  InFlight in_flight;
  ChainScan scan;
  Clocks clocks;
  PhaseControl phase;

  // Cyclic
  std::uint64_t cycle = 0;
  bool cyclic_due = false, chain_state_added = false;
  std::size_t next_robot = 0;
  std::uint64_t heard = 0;              // the cycle in which somebody in the chain last answered
  bool reached = false;                 // since the last out_of_reach()
  bool silent = false;                  // out_of_reach() was called for it, and nobody has answered since
  std::uint16_t count = 0, states = 0;  // of the last cycle that came back
  unsigned count_stands = 0;            // cycles that it has been the same
  std::optional<std::uint16_t> scanned_count;
  bool ring_open = false, ring_open_at_first = false;  // at_first: before the first device
  transports::LinkDetail ring_trouble;                 // where it is open, in words
  unsigned single_copies = 0;                          // cyclic frames in a row of which one copy was missed
  std::size_t talking_port = 0;                        // that the other copy came from

  // Service
  bool service_in_flight = false, both_ports = true, both_ports_in_service = true, scan_wanted = false, closing = false;
  Time next_service{}, next_scan{}, scan_pause{};
  std::uint32_t unreadable_life = 0;  // of the first device that the last scan could not read
  unsigned uneven_frames = 0;         // that leave at unequal distances yet, after a loss
  std::uint32_t dice = 1;             // of unequal_pause()
  std::size_t first_robot = 0;
};

}  // namespace meca::ethercat
