#include "tests/bench/bridge_process.hpp"

#include <unistd.h>

#include <fstream>

namespace meca::bench {
namespace {

std::filesystem::path write_config(const std::string& yaml) {
  const auto path = std::filesystem::temp_directory_path() / ("meca-bench-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(path) << yaml;
  return path;
}

}  // namespace

BridgeProcess::BridgeProcess(const Setting& setting, const std::string& yaml)
    : config(write_config(yaml)), process({setting.bridge.string(), "--config", config.string()}) {}

BridgeProcess::~BridgeProcess() { std::filesystem::remove(config); }

std::vector<std::string> role(const char* name, const Setting& setting) {
  return {own_path(), name, "--domain", std::to_string(setting.domain)};
}

}  // namespace meca::bench
