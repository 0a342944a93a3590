// The interface the bridge sees of a fieldbus: one bus with one or more robots, exchanged once a cycle.
// A transport knows bytes and links; it knows nothing of DDS, YAML or the meaning of the image.
#pragma once

#include <bit>
#include <chrono>
#include <cstdint>
#include <span>
#include <string_view>

#include "transports/image/image.hpp"

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

// One robot's side of one exchange. The loop owns one per robot; the transport fills the input half.
struct Exchange {
  // host -> robot, written by the loop before exchange()
  image::OutputBytes output{};
  bool output_valid = false;  // false: keep the link but send what the protocol calls idle / nothing new

  // robot -> host, written by the transport in exchange()
  image::InputBytes input{};
  bool fresh = false;  // `input` arrived since the last exchange
  LinkState link = LinkState::kDown;
  FirmwareVersion identity{};  // from the protocol's identity, where it has one (EtherNet/IP); else unknown
  // First words of why the link is not up; points at a string literal, never null-terminated guesses.
  std::string_view link_detail{};
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

  // The protocol's orderly good-bye (EtherCAT to INIT, Forward Close, PROFINET Release). Bounded in time.
  virtual void close() noexcept = 0;
};

}  // namespace meca::transports
