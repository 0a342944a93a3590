// Decides whether the robot takes a command the moment it arrives, and with which error code it does not.
#pragma once

#include <cstdint>

#include "sim/journal.hpp"
#include "sim/programs.hpp"
#include "sim/robot.hpp"
#include "sim/tool.hpp"
#include "sim/variables.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::sim {

struct Readiness {
  Product product;
  image::Layout layout;
  bool off, activated, homed, recovery_mode;
  const ExternalTool& tool;
  const Variables& variables;
  const Programs& programs;
};

struct Verdict {
  std::uint16_t code = 0;                          // 0: take it
  const image::MotionCommandInfo* info = nullptr;  // of a command that is taken
  Command command = {};                            // as it is carried out: values in place of variables
};

// inferred: UseVariables takes the values that the variables have on reception; ranges hold for the values.
// What the model does not do yet is refused too, with the code a robot without that equipment gives; see sim/README.md.
Verdict examine(const Command& command, bool use_variables, const Readiness& readiness) noexcept;

// Whether a saved program may hold it: a known command of this firmware that goes through the queue, with good
// arguments.
bool belongs_in_program(const Command& command, Product product, image::Layout layout) noexcept;

}  // namespace meca::sim
