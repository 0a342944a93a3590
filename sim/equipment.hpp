// What a simulated robot is fitted and loaded with beside its arm: the tool on its flange, variables and programs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meca::sim {

// Numbers of dynamic data type 52 (GetRtExtToolStatus).
enum class ToolType : std::uint8_t {
  kNone = 0,
  kMegp25e = 10,   // electric parallel gripper, short stroke
  kMegp25ls = 11,  // the same with a long stroke
  kMpm500 = 20,    // pneumatic module: two valves
};

// A variable as a user creates it over TCP/IP (CreateVariable), for use over a cyclic protocol; firmware 11 (spec 5.8).
struct Variable {
  std::uint32_t cyclic_id = 0;    // 10000..19999
  std::size_t size = 1;           // 1: a number; up to 6: an array
  std::array<float, 6> values{};  // initial; the first `size` count
};

// What the built-in robot has: 10000, the number 50 (a speed in percent); 10001, the number 0; 10010, the six numbers
// 0 (a joint set).
std::vector<Variable> example_variables();

// A program as a user saves it over TCP/IP, started over a cyclic protocol by StartProgram (spec 2.1, id 100).
struct ProgramCommand {
  std::uint32_t id = 0;  // of a command that goes through the queue
  std::array<float, 6> arguments{};
};
struct Program {
  std::uint16_t number = 0;  // 1..65534
  std::vector<ProgramCommand> commands;
};

// What every robot has unless told otherwise: 1 turns joint 1 to 10 degrees and all joints to 0; 2 waits for a second;
// 3 runs 1, 2 and 1; 4 starts itself and fails (3023).
std::vector<Program> example_programs();

}  // namespace meca::sim
