// The command line of meca-bridge: what was asked for, or the answer to give at once.
#pragma once

#include <optional>
#include <string>

#include "bridge/config.hpp"
#include "cli/command_line.hpp"

namespace meca::bridge {

inline constexpr const char* kDefaultConfigFile = "/etc/meca500/bridge.yaml";

struct Arguments {
  std::optional<Answer> answer;  // --help, --version, or a mistake: print it and leave
  std::string config_file;
  bool check = false;
  std::optional<std::string> log_level;
};

Arguments parse_arguments(int argc, const char* const* argv);

// "arm1: builtin (Meca500 R4, firmware 11.3, serial number 1), cycle 1ms, control on"
std::string describe(const RobotConfig& robot);
// What a configuration would run: DDS, threads, a line per robot.
std::string describe(const Config& config);

}  // namespace meca::bridge
