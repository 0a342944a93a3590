#include "bridge/wakeup.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace meca::bridge {

Wakeup::Wakeup() : fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "no eventfd for the publisher thread");
}

Wakeup::~Wakeup() { close(fd_); }

void Wakeup::notify() noexcept {
  if (notified_.exchange(true)) return;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(fd_, &one, sizeof one);
}

void Wakeup::wait(std::chrono::milliseconds timeout) noexcept {
  pollfd poller{fd_, POLLIN, 0};
  poll(&poller, 1, static_cast<int>(timeout.count()));
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = read(fd_, &count, sizeof count);
  // After the read: a notify() from now on writes again. One that came between is seen by the caller's next look.
  notified_.exchange(false);
}

}  // namespace meca::bridge
