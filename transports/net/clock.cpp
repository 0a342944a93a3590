#include "transports/net/clock.hpp"

#include <time.h>

namespace meca::net {

std::chrono::nanoseconds monotonic() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
}

}  // namespace meca::net
