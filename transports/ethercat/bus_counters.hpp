// What the bus counts and measures of each robot, for Transport::counters(); config/ethercat.yaml explains them.
#pragma once

#include <cstdint>
#include <span>

#include "transports/ethercat/histogram.hpp"
#include "transports/ethercat/master.hpp"
#include "transports/transport.hpp"

namespace meca::ethercat {

// What the owner of the interfaces knows and the master does not.
struct BusFacts {
  Histogram wake_up;  // how late the cycle's frames were sent, against the deadline
  std::uint64_t failed_sends = 0;
};

std::span<const transports::CounterInfo> bus_counters() noexcept;
// In that order, into the first elements of `out` (kMostCounters).
void count(const Master& master, std::size_t robot, const BusFacts& facts, std::span<std::int64_t> out) noexcept;

}  // namespace meca::ethercat
