// What a simulated robot is fitted and loaded with beside its arm: the tool on its flange.
#pragma once

#include <cstdint>

namespace meca::sim {

// Numbers of dynamic data type 52 (GetRtExtToolStatus).
enum class ToolType : std::uint8_t {
  kNone = 0,
  kMegp25e = 10,   // electric parallel gripper, short stroke
  kMegp25ls = 11,  // the same with a long stroke
  kMpm500 = 20,    // pneumatic module: two valves
};

}  // namespace meca::sim
