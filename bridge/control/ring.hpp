// A bounded first-in first-out store for one thread: the memory of the control machines, there from the start.
#pragma once

#include <array>
#include <cstddef>

namespace meca::control {

template <typename T, std::size_t N>
class Ring {
 public:
  static constexpr std::size_t capacity() noexcept { return N; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  bool full() const noexcept { return size_ == N; }

  // False when full: nothing was stored.
  bool push(const T& value) noexcept {
    if (full()) return false;
    slots_[(head_ + size_) % N] = value;
    ++size_;
    return true;
  }
  // The caller has checked empty().
  const T& front() const noexcept { return slots_[head_]; }
  // 0 is the oldest; the caller has checked size().
  const T& at(std::size_t index) const noexcept { return slots_[(head_ + index) % N]; }
  void pop() noexcept {
    head_ = (head_ + 1) % N;
    --size_;
  }

 private:
  std::array<T, N> slots_{};
  std::size_t head_ = 0;
  std::size_t size_ = 0;
};

}  // namespace meca::control
