#include "transports/net/wait.hpp"

#include <poll.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace meca::net {

void wait_readable(std::span<const int> descriptors, std::chrono::nanoseconds timeout) {
  std::vector<pollfd> polled;
  for (const int descriptor : descriptors) polled.push_back({descriptor, POLLIN, 0});
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(std::max(timeout, std::chrono::nanoseconds{}));
  ::poll(polled.data(), polled.size(), static_cast<int>(std::min<std::int64_t>(left.count(), 1'000'000)));
}

}  // namespace meca::net
