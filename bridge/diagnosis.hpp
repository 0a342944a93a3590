// Why the robot is not moving, in one line for a tired person: the most important cause first, and the remedy.
#pragma once

#include <cstddef>
#include <string>

#include "bridge/cycle.hpp"

namespace meca::bridge {

struct Diagnosis {
  static constexpr std::size_t kMaxText = 255;  // bytes: string<255> of BridgeStatus
  bool ready = false;                           // a motion command of the owner would move the robot now
  std::string cause;                            // "P-Stop 2 is active"; empty when ready
  std::string remedy;                           // "release it, then 'meca-ctl resume'"; empty when ready
};

// The first cause in the order in which a person has to remove them; what lies behind it shows when it is gone. Nobody
// owning control and an empty queue are no causes: the next command takes control and moves. Allocates: not for the
// cycle thread.
Diagnosis diagnose(const CycleRecord& record);

}  // namespace meca::bridge
