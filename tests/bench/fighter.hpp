// One of those who fight for a robot: takes control, commands, resends, falls silent, releases and dies, at random.
// What it does and sees goes line by line into a file that outlives it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "idl/types.hpp"

namespace meca::bench {

struct FighterOptions {
  int domain = 0;
  std::string name;
  std::filesystem::path diary;
  std::uint32_t seed = 0;
};

// Fights until SIGTERM or its own SIGKILL. After SIGTERM it waits for the end of everything it sent, at most 30 s.
void run_fighter(const FighterOptions& options);

struct Seen {
  meca500::ReceiptState state{};
  meca500::ReceiptReason reason{};
};
struct Sent {
  meca500::CommandKind kind{};
  int resends = 0;
  bool lived = false;      // its sender lived on until it had waited for every answer
  std::vector<Seen> seen;  // by the sender, in order
};
struct Diary {
  std::map<std::uint64_t, Sent> commands;  // by command id: all lives of one name
  int lives = 0;
};
Diary read_diary(const std::filesystem::path& path);

}  // namespace meca::bench
