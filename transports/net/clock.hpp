// The monotonic clock, for those who own sockets; everybody else is told the time.
#pragma once

#include <chrono>

namespace meca::net {

std::chrono::nanoseconds monotonic() noexcept;  // CLOCK_MONOTONIC

}  // namespace meca::net
