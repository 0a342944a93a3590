// Repeatable noise of what a robot measures.
#pragma once

#include "sim/robot.hpp"

namespace meca::sim {

// Uniform in -1..1, a hash of seed, cycle and channel (0..63): no state, so all that is measured in a cycle is of the
// same arm. 0 with RobotOptions::noise off.
inline double noise(const RobotOptions& options, std::uint64_t cycle, std::uint64_t channel) noexcept {
  if (!options.noise) return 0;
  std::uint64_t x = options.seed * 0x9E3779B97F4A7C15u + cycle * 64 + channel;  // splitmix64
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  x ^= x >> 31;
  return static_cast<double>(x >> 11) * 0x1.0p-52 - 1.0;
}

}  // namespace meca::sim
