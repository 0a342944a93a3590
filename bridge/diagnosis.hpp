// Why the robot is not moving, in one line for a tired person: the most important cause first, and the remedy.
#pragma once

#include <string>

#include "bridge/cycle.hpp"

namespace meca::bridge {

struct Diagnosis {
  bool ready = false;   // a motion command of the owner would move the robot now
  std::string cause;    // "P-Stop 2 is active"; empty when ready
  std::string remedy;   // "release it, then resume"
};

Diagnosis diagnose(const CycleRecord& record);

}  // namespace meca::bridge
