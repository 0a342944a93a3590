// A bridge in a process of its own, and what the scenarios share around it.
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
std::vector<std::string> role(const char* name, const Setting& setting, std::chrono::seconds duration);

// CPUs that the process keeps busy, over the duration.
double cpu_share(const Process& process, std::chrono::seconds duration);

// 0 when the yardstick is.
double ratio(const nlohmann::ordered_json& ours, const nlohmann::ordered_json& yardstick);

}  // namespace meca::bench
