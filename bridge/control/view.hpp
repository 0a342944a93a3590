// What every control machine may look at in one cycle: the robot's last image, how to read it, and the time.
#pragma once

#include <chrono>
#include <cstdint>

#include "transports/image/image.hpp"

namespace meca::control {

using Time = std::chrono::nanoseconds;  // monotonic

struct View {
  const image::Inputs& in;
  image::Layout layout;
  bool fresh;  // `in` arrived since the last cycle; only then is it evidence of anything
  Time now;
  std::int64_t unix_ns = 0;  // wall clock, for people and for HostTime
};

// How many fresh images to wait before a status bit that has no edge of its own is believed to answer our last image.
// inferred: an answer may lag the question by up to two bus cycles (frame in flight, robot's own cycle).
inline constexpr int kSettleImages = 3;

// Paused and at rest for so many images: what the robot then says of its queue is its last word. inferred: EOM, EOB and
// FIFOSpace may lag behind Paused, but not for this long.
inline constexpr int kRestImages = 20;

// Any stop signal, present or waiting to be reset. Bits the Meca500 does not have count too: if one is ever set,
// something is wrong enough not to move.
bool safety_stop(const image::Inputs& in) noexcept;

// A stop that ResumeMotion would not clear: its cause is still there, or only the Reset button clears it (E-Stop).
bool unresettable_stop(const image::Inputs& in, image::Layout layout) noexcept;

}  // namespace meca::control
