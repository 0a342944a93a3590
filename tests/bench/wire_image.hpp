// What the bridge put on the wire, cycle by cycle.
#pragma once

#include <array>
#include <cstdint>
#include <map>

namespace meca::bench {

struct WireImage {
  std::int64_t time_ns = 0;  // Unix: the bridge's stamp of the cycle
  bool has_control = false, has_command = false;
  bool set_point = false, pause = false, clear = false, resume = false;
  std::uint16_t move_id = 0;
  std::uint32_t command = 0;
  std::array<float, 6> arguments{};

  bool complete() const { return has_control && has_command; }
  bool moves_by_velocity() const;  // a velocity command with a velocity that is not zero
  bool stops() const { return pause && !set_point && !moves_by_velocity(); }
};

// By the number of the cycle whose step computed the image. The exchange that opens the next cycle gives it to the
// robot: an image of cycle n is on the wire in cycle n + 1.
using WireImages = std::map<std::uint64_t, WireImage>;

// The cycle with exactly this stamp; end() when it is not there.
WireImages::const_iterator at_time(const WireImages& images, std::int64_t time_ns);

}  // namespace meca::bench
