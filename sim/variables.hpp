// The robot's variables as a cyclic protocol sees them: written, read and used as arguments by number (spec 5.8).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/equipment.hpp"
#include "sim/journal.hpp"

namespace meca::sim {

class Variables {
 public:
  // Throws std::invalid_argument: an id outside of 10000..19999 or used twice, a size outside of 1..6, a value that is
  // not finite.
  explicit Variables(std::vector<Variable> variables);

  // nullptr: there is none of that number.
  const Variable* find(std::uint32_t cyclic_id) const noexcept;

  // SetVariable: the command's id says which; as many of its arguments as the variable has values are taken (inferred:
  // the others are ignored like those of other commands). 0; 1554 no such variable; 1003 a value that is not finite.
  std::uint16_t set(const Command& command) noexcept;

  // UseVariables: puts the values of variables in place of the first `count` arguments, which are their numbers.
  // inferred: an array gives its first element. 0; 1551 an argument is not the number of a variable.
  std::uint16_t resolve(Command& command, std::size_t count) const noexcept;

  // Dynamic data of that type. inferred: zeros when there is no such variable.
  std::array<float, 6> values(std::uint32_t type) const noexcept;

 private:
  std::vector<Variable> variables_;  // ascending by id
};

}  // namespace meca::sim
