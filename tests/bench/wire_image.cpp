#include "tests/bench/wire_image.hpp"

#include <algorithm>
#include <iterator>

#include "transports/image/motion_commands.hpp"

namespace meca::bench {

bool WireImage::moves_by_velocity() const {
  const bool velocity = command >= image::kMoveJointsVel && command <= image::kMoveLinVelTrf;
  return velocity && std::ranges::any_of(arguments, [](float v) { return v != 0; });
}

WireImages::const_iterator at_time(const WireImages& images, std::int64_t time_ns) {
  // From the end: what is asked for is recent. Not a binary search: the wall clock may be set back.
  const auto found =
      std::find_if(images.rbegin(), images.rend(), [&](const auto& entry) { return entry.second.time_ns == time_ns; });
  return found == images.rend() ? images.end() : std::prev(found.base());
}

}  // namespace meca::bench
