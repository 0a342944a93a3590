#include "sim/programs.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/error.hpp"
#include "sim/reception.hpp"

namespace meca::sim {

Programs::Programs(std::vector<Program> programs, Product product, image::Layout layout) {
  std::ranges::sort(programs, {}, &Program::number);
  for (Program& p : programs) {
    const bool twice = !saved_.empty() && saved_.back().program.number == p.number;
    if (p.number == 0 || p.number == 65535 || twice) {
      throw std::invalid_argument("program " + std::to_string(p.number) + ": expected one number of 1..65534 each");
    }
    const bool valid = std::ranges::all_of(p.commands, [&](const ProgramCommand& c) {
      return belongs_in_program({c.id, 0, c.arguments}, product, layout);
    });
    saved_.push_back({std::move(p), valid});
  }
}

const Programs::Saved* Programs::saved(float number) const noexcept {
  const auto found = std::ranges::find_if(saved_, [number](const Saved& s) { return s.program.number == number; });
  return found != saved_.end() ? &*found : nullptr;
}

const Program* Programs::find(float number) const noexcept {
  const Saved* found = saved(number);
  return found != nullptr ? &found->program : nullptr;
}

std::uint16_t Programs::check(float number) const noexcept {
  const Saved* found = saved(number);
  if (found == nullptr) return error::kProgramNotFound;
  return found->valid ? error::kNone : error::kProgramInvalid;
}

Command Upcoming::front() const noexcept {
  if (depth_ == 0) return queue_.front();
  const Frame& f = top();
  Command command = f.start;
  if (f.next == f.program->commands.size()) {
    command.id = kProgramEnd;
    return command;
  }
  command.id = f.program->commands[f.next].id;
  command.arguments = f.program->commands[f.next].arguments;
  command.program = f.program->number;
  return command;
}

void Upcoming::pop() noexcept {
  if (depth_ == 0) return queue_.pop();
  Frame& f = frames_[depth_ - 1];
  if (f.next++ == f.program->commands.size()) --depth_;
}

std::optional<std::uint32_t> Upcoming::id_at(std::size_t i) const noexcept {
  for (std::size_t d = depth_; d > 0; --d) {
    const Frame& f = frames_[d - 1];
    const std::size_t left = f.program->commands.size() - f.next;
    if (i < left) return f.program->commands[f.next + i].id;
    if (i == left) return kProgramEnd;
    i -= left + 1;
  }
  return i < queue_.size() ? std::optional(queue_.at(i).id) : std::nullopt;
}

std::uint16_t Upcoming::start(const Command& command) noexcept {
  const float number = command.arguments[0];
  if (const auto code = programs_.check(number); code != error::kNone) return code;
  const Program* program = programs_.find(number);
  for (std::size_t d = 0; d < depth_; ++d) {
    if (frames_[d].program == program) return error::kProgramRecursion;
  }
  frames_[depth_++] = {program, command, 0};
  return error::kNone;
}

}  // namespace meca::sim
