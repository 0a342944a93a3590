// A bridge on built-in robots in a process of its own.
#pragma once

#include <filesystem>
#include <string>

#include "tests/bench/process.hpp"
#include "tests/bench/scenarios.hpp"

namespace meca::bench {

struct BridgeProcess {
  // `yaml`: the whole configuration. Throws std::runtime_error.
  BridgeProcess(const Setting& setting, const std::string& yaml);
  ~BridgeProcess();
  BridgeProcess(const BridgeProcess&) = delete;
  BridgeProcess& operator=(const BridgeProcess&) = delete;

  std::filesystem::path config;
  Process process;
};

// The command line of this program in one of its hidden roles.
std::vector<std::string> role(const char* name, const Setting& setting);

}  // namespace meca::bench
