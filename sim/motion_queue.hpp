// The robot's motion queue: first in, first out, 13,000 commands (manual 4.5.2), in memory taken once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "sim/journal.hpp"

namespace meca::sim {

class MotionQueue {
 public:
  static constexpr std::size_t kCapacity = 13000;

  bool push(const Command& command) noexcept {
    if (count_ == kCapacity) return false;
    commands_[(head_ + count_++) % kCapacity] = command;
    return true;
  }
  // Only on a queue that is not empty.
  const Command& front() const noexcept { return commands_[head_]; }
  const Command& at(std::size_t i) const noexcept { return commands_[(head_ + i) % kCapacity]; }  // i < size()
  Command& back() noexcept { return commands_[(head_ + count_ - 1) % kCapacity]; }
  void pop() noexcept {
    head_ = (head_ + 1) % kCapacity;
    --count_;
  }
  bool empty() const noexcept { return count_ == 0; }
  std::size_t size() const noexcept { return count_; }
  std::size_t space() const noexcept { return kCapacity - count_; }

 private:
  std::unique_ptr<Command[]> commands_ = std::make_unique_for_overwrite<Command[]>(kCapacity);
  std::size_t head_ = 0, count_ = 0;
};

}  // namespace meca::sim
