#include "tests/bench/bridge_process.hpp"

#include <unistd.h>

#include <fstream>
#include <thread>

#include "tests/bench/clock.hpp"

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

std::vector<std::string> role(const char* name, const Setting& setting, std::chrono::seconds duration) {
  auto command = role(name, setting);
  command.insert(command.end(), {"--seconds", std::to_string(duration.count())});
  return command;
}

double cpu_share(const Process& process, std::chrono::seconds duration) {
  const double before = process.cpu_seconds();
  const auto begin = monotonic_now();
  std::this_thread::sleep_for(duration);
  const std::chrono::duration<double> elapsed = monotonic_now() - begin;
  return (process.cpu_seconds() - before) / elapsed.count();
}

double ratio(const nlohmann::ordered_json& ours, const nlohmann::ordered_json& yardstick) {
  const double base = yardstick.get<double>();
  return base > 0 ? ours.get<double>() / base : 0;
}

}  // namespace meca::bench
