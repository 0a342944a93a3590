#include "sim/equipment.hpp"

#include "transports/image/motion_commands.hpp"

namespace meca::sim {

std::vector<Variable> example_variables() {
  return {{.cyclic_id = 10000, .size = 1, .values = {50}},
          {.cyclic_id = 10001, .size = 1, .values = {}},
          {.cyclic_id = 10010, .size = 6, .values = {}}};
}

std::vector<Program> example_programs() {
  using namespace image;
  return {{.number = 1, .commands = {{kMoveJoints, {10, 0, 0, 0, 0, 0}}, {kMoveJoints, {0, 0, 0, 0, 0, 0}}}},
          {.number = 2, .commands = {{kDelay, {1}}}},
          {.number = 3, .commands = {{kStartProgram, {1}}, {kStartProgram, {2}}, {kStartProgram, {1}}}},
          {.number = 4, .commands = {{kStartProgram, {4}}}}};
}

}  // namespace meca::sim
