// The interface the bridge sees of a fieldbus: one bus with one or more robots, exchanged once a cycle.
// A transport knows bytes and links; it knows nothing of DDS, YAML or the meaning of the image.
#pragma once

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <span>
#include <string_view>

#include "transports/image/image.hpp"
#include "transports/text.hpp"

namespace meca::transports {

// Monotonic time since an arbitrary start (CLOCK_MONOTONIC). Time is always handed in, so tests move it by hand.
using Time = std::chrono::nanoseconds;

enum class LinkState : std::uint8_t {
  kDown,        // no conversation with the robot; the transport keeps trying with back-off
  kConnecting,  // the protocol's start-up is under way
  kUp,          // cyclic data is being exchanged
};

struct FirmwareVersion {
  std::uint16_t major{}, minor{}, patch{}, build{};  // all 0 = unknown
  friend auto operator<=>(const FirmwareVersion&, const FirmwareVersion&) = default;
};

// Why a link is not up, a sentence without full stop.
using LinkDetail = FixedText<255>;

// What a bus counts or measures of each robot's connection, by name; how many there may be.
struct CounterInfo {
  std::string_view name;  // "lost_packets": [a-z_0-9], at most 31 characters
  std::string_view unit;  // "", "us", "ns"
};
inline constexpr std::size_t kMostCounters = 32;

// One robot's side of one exchange. The loop owns one per robot; the transport fills the input half.
struct Exchange {
  // host -> robot, written by the loop before exchange()
  image::OutputBytes output{};
  // False: keep the link but send what the protocol calls idle. One that has no such thing (EtherCAT) sends `output`:
  // the loop keeps in it an image that asks nothing of the robot.
  bool output_valid = false;

  // robot -> host, written by the transport in exchange()
  image::InputBytes input{};
  bool fresh = false;  // `input` arrived since the last exchange
  LinkState link = LinkState::kDown;
  FirmwareVersion identity{};  // from the protocol's identity, where it has one (EtherNet/IP); else unknown
  LinkDetail link_detail{};
  std::array<std::int64_t, kMostCounters> counters{};  // in the order of Transport::counters()
};

class Transport {
 public:
  virtual ~Transport() = default;

  // Byte order of multi-byte fields on this bus.
  virtual std::endian byte_order() const noexcept = 0;

  // Opens what the bus needs (may allocate, may throw std::runtime_error with a sentence for the user).
  virtual void open(Time now) = 0;

  // One bus cycle for every robot, in the order of the configuration. Called from the cycle thread only:
  // does not allocate, lock, log or throw; never blocks longer than the bus needs for one frame.
  virtual void exchange(Time now, std::span<Exchange> robots) noexcept = 0;

  // A bus whose frames arrive and are due by themselves waits in the loop's place: until the deadline, or until there
  // is something for exchange() to fetch. Meanwhile it sends what is due, from the outputs that stand in the exchanges
  // of the last exchange(), which live as long as the bus is used. Same rules as for exchange().
  enum class Woke : std::uint8_t { kCannotWait, kDeadline, kArrival };
  virtual Woke wait(Time) noexcept { return Woke::kCannotWait; }

  // By how much the deadlines of the loop should move from the next one on: for a bus that keeps step with a clock of
  // its own (EtherCAT's distributed clocks). Small against the cycle. Asked once a cycle, after exchange().
  virtual Time deadline_shift() const noexcept { return {}; }

  // What stands in Exchange::counters; at most kMostCounters.
  virtual std::span<const CounterInfo> counters() const noexcept { return {}; }

  // The protocol's orderly good-bye (EtherCAT to INIT, Forward Close, PROFINET Release). Bounded in time.
  virtual void close() noexcept = 0;
};

}  // namespace meca::transports
