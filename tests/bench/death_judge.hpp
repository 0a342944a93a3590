// Judges one death from the wire log: when the stop came, and that nothing followed it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/wire_image.hpp"

namespace meca::bench {

struct DeathLimits {
  std::int64_t cycle_ns = 1'000'000, lease_ns = 100'000'000, velocity_lease_ns = 50'000'000;
  // Cycles from the one that took the last sign of life to the one that sends the answer.
  std::int64_t most_cycles(std::int64_t lease) const { return lease / cycle_ns + 2; }
};

struct StopFacts {
  std::uint64_t stop_cycle = 0;                 // its step computed the first stop image; the next cycle sends it
  std::int64_t cycles = 0;                      // from the last sign of life to the wire
  std::int64_t on_wire_ns = 0;                  // Unix: stamp of the cycle that sends it
  std::optional<std::int64_t> velocity_cycles;  // the same for the end of a velocity stream
  std::vector<std::string> broken;
};

// `renewal_ns`: ControlStatus.last_renewal_ns. `velocity`: the stream was the owner's only sign of life. Nothing when
// the images have a hole there or do not reach far enough: not measured, which is not "kept".
std::optional<StopFacts> judge_stop(const WireImages& images, std::int64_t renewal_ns, bool velocity,
                                    const DeathLimits& limits);

// From the stop image until the next owner is let: Pause stands and no Resume before `resumed`, SetPoint stays 0 (so no
// MoveID means anything) before `commanded`. Cycles of the bridge. Nothing when there is a hole.
std::optional<std::vector<std::string>> judge_quiet(const WireImages& images, std::uint64_t stop_cycle,
                                                    std::uint64_t resumed, std::uint64_t commanded);

}  // namespace meca::bench
