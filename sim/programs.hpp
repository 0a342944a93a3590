// Offline programs: what the robot has saved, and what runs next, which is the rest of the programs under way before
// the queue. No allocation after construction.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim/equipment.hpp"
#include "sim/journal.hpp"
#include "sim/motion_queue.hpp"
#include "transports/image/image.hpp"

namespace meca::sim {

enum class Product : std::uint8_t;

class Programs {
 public:
  // Throws std::invalid_argument: a number outside of 1..65534 or used twice.
  Programs(std::vector<Program> programs, Product product, image::Layout layout);

  const Program* find(float number) const noexcept;  // nullptr: there is none
  // Whether StartProgram can start it: 0, 3017 there is none, 3020 it holds a command that is none, has bad arguments
  // or does not go through the queue (inferred: refused as a whole).
  std::uint16_t check(float number) const noexcept;
  std::size_t size() const noexcept { return saved_.size(); }

 private:
  struct Saved {
    Program program;
    bool valid;
  };
  const Saved* saved(float number) const noexcept;

  std::vector<Saved> saved_;  // ascending by number
};

// Commands in the order in which their turn comes. A program's commands carry its number and the MoveID of the
// StartProgram that began it; behind the last of them stands kProgramEnd.
class Upcoming {
 public:
  // In place of the StartProgram that has ended; no id of the wire, where it would be an unknown command.
  static constexpr std::uint32_t kProgramEnd = 0xFFFFFFFF;

  explicit Upcoming(const Programs& programs)
      : programs_(programs), frames_(std::make_unique<Frame[]>(programs.size() + 1)) {}

  // What the host has sent and has not been taken yet.
  MotionQueue& queue() noexcept { return queue_; }
  const MotionQueue& queue() const noexcept { return queue_; }

  bool empty() const noexcept { return depth_ == 0 && queue_.empty(); }
  Command front() const noexcept;  // only when not empty
  void pop() noexcept;
  // The id of the command with `i` others before it; nullopt behind the last.
  std::optional<std::uint32_t> id_at(std::size_t i) const noexcept;

  // A StartProgram that has been taken: its commands are next. 0, or 3017, 3020 as above, 3023 when it runs already.
  std::uint16_t start(const Command& command) noexcept;
  // Number of the innermost program under way (inferred: not of the one that called it); 0 none.
  std::uint16_t running() const noexcept { return depth_ == 0 ? std::uint16_t{0} : top().program->number; }

 private:
  struct Frame {
    const Program* program;
    Command start;
    std::size_t next;  // of its commands; their number: kProgramEnd is next
  };
  const Frame& top() const noexcept { return frames_[depth_ - 1]; }

  const Programs& programs_;
  MotionQueue queue_;
  std::unique_ptr<Frame[]> frames_;  // never deeper than there are programs, since none runs twice at a time
  std::size_t depth_ = 0;
};

}  // namespace meca::sim
