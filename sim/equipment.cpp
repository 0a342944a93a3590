#include "sim/equipment.hpp"

namespace meca::sim {

std::vector<Variable> example_variables() {
  return {{.cyclic_id = 10000, .size = 1, .values = {50}},
          {.cyclic_id = 10001, .size = 1, .values = {}},
          {.cyclic_id = 10010, .size = 6, .values = {}}};
}

}  // namespace meca::sim
