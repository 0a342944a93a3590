#include "transports/net/poller.hpp"

#include <algorithm>

#include "transports/net/clock.hpp"

namespace meca::net {

Poller::Poller(std::size_t slots) : polled_(slots, pollfd{-1, 0, 0}) {}

void Poller::watch(std::size_t slot, int descriptor, bool write) noexcept {
  polled_[slot] = {descriptor, static_cast<short>(write ? POLLIN | POLLOUT : POLLIN), 0};
}

bool Poller::wait(std::chrono::nanoseconds until) noexcept {
  const auto left = std::max(until - monotonic(), std::chrono::nanoseconds{});
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec timeout{.tv_sec = static_cast<time_t>(seconds.count()),
                         .tv_nsec = static_cast<long>((left - seconds).count())};
  const int ready = ::ppoll(polled_.data(), polled_.size(), &timeout, nullptr);
  if (ready < 0) std::ranges::for_each(polled_, [](pollfd& each) { each.revents = 0; });
  return ready > 0;
}

bool Poller::ready(std::size_t slot) const noexcept { return polled_[slot].revents != 0; }

}  // namespace meca::net
