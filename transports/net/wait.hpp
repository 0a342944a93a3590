// Waiting for descriptors; for programs, not for the cycle thread.
#pragma once

#include <chrono>
#include <span>

namespace meca::net {

// Until one of the descriptors can be read, or `timeout` is over; a signal ends it early. The caller looks what it was.
void wait_readable(std::span<const int> descriptors, std::chrono::nanoseconds timeout);

}  // namespace meca::net
