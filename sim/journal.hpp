// What a simulated robot did, in order: the referee for receipts and for hosts that break the rules.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace meca::sim {

using Time = std::chrono::nanoseconds;

struct Command {
  std::uint32_t id = 0;
  std::uint16_t move_id = 0;         // 0: cyclic mode
  std::array<float, 6> arguments{};  // values, also where the host sent the numbers of variables
  std::uint16_t program = 0;         // number of the offline program it is part of; 0: sent by the host
  friend bool operator==(const Command&, const Command&) = default;
};

enum class Outcome : std::uint8_t {
  kExecuted,   // done as far as the queue is concerned: the next command may start (with blending: at the blend)
  kDiscarded,  // was in the queue or under way when it was cleared
  kRefused,    // never entered the queue, or failed when its turn came; `code` says why
};

struct JournalEntry {
  Time at{};
  Command command;
  Outcome outcome = Outcome::kExecuted;
  std::uint16_t code = 0;  // the robot's error code for kRefused
};

struct Violation {
  Time at{};
  std::string_view what;  // a sentence without full stop
};

// Append-only and of fixed memory: counts for ever, remembers the last `capacity` entries. Never allocates after
// construction.
template <class Entry>
class Log {
 public:
  explicit Log(std::size_t capacity) : capacity_(capacity ? capacity : 1), entries_(new Entry[capacity_]) {}

  void add(const Entry& entry) noexcept { entries_[count_++ % capacity_] = entry; }
  std::uint64_t size() const noexcept { return count_; }                                        // ever added
  std::uint64_t first() const noexcept { return count_ > capacity_ ? count_ - capacity_ : 0; }  // oldest remembered
  // `index` in [first(), size()).
  const Entry& operator[](std::uint64_t index) const noexcept { return entries_[index % capacity_]; }
  const Entry& back() const noexcept { return (*this)[count_ - 1]; }

 private:
  std::size_t capacity_;
  std::unique_ptr<Entry[]> entries_;
  std::uint64_t count_ = 0;
};

// Also counts what became of the commands, for ever.
class Journal : public Log<JournalEntry> {
 public:
  using Log::Log;
  void add(const JournalEntry& entry) noexcept {
    ++counts_[static_cast<std::size_t>(entry.outcome)];
    Log::add(entry);
  }
  std::uint64_t count(Outcome outcome) const noexcept { return counts_[static_cast<std::size_t>(outcome)]; }

 private:
  std::array<std::uint64_t, 3> counts_{};
};

}  // namespace meca::sim
