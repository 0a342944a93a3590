// Waits for several sockets until a point in time. Allocates in the constructor only.
#pragma once

#include <poll.h>

#include <chrono>
#include <cstddef>
#include <vector>

namespace meca::net {

class Poller {
 public:
  explicit Poller(std::size_t slots);

  // What a slot waits for from now on: bytes or clients to take, with `write` room to send as well. Negative: nothing.
  void watch(std::size_t slot, int descriptor, bool write = false) noexcept;

  // True as soon as a slot is ready; false when the time is over (CLOCK_MONOTONIC; what is ready already is seen even
  // then) or a signal came.
  bool wait(std::chrono::nanoseconds until) noexcept;
  bool ready(std::size_t slot) const noexcept;  // as of the last wait(); errors and hang-ups are ready as well

 private:
  std::vector<pollfd> polled_;
};

}  // namespace meca::net
