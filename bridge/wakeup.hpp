// Wakes one sleeping thread from others: an eventfd, written at most once per sleep. notify() takes about a microsecond
// and never blocks, so the cycle thread may call it.
#pragma once

#include <atomic>
#include <chrono>

namespace meca::bridge {

class Wakeup {
 public:
  Wakeup();  // throws std::system_error
  ~Wakeup();
  Wakeup(const Wakeup&) = delete;
  Wakeup& operator=(const Wakeup&) = delete;

  void notify() noexcept;
  // Returns at the next notify(), at once if there was one since the last wait, or when the time is over.
  void wait(std::chrono::milliseconds timeout) noexcept;

 private:
  int fd_ = -1;
  std::atomic<bool> notified_{false};
};

}  // namespace meca::bridge
