#include "bridge/arguments.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>

namespace meca::bridge {
namespace {

constexpr const char* kAbout = "meca-bridge: Mecademic Meca500 robots on DDS, every cyclic section as a typed topic.";

constexpr const char* kExamples = R"(Examples:
  meca-bridge --config config/builtin.yaml            one simulated robot, no hardware: the place to start
  meca-bridge --config config/cell.yaml               four of them at 1 kHz
  meca-bridge --check --config cell.yaml              every mistake in the file at once; starts nothing
  meca-bridge --config cell.yaml --log-level debug

Every key of the configuration is explained in config/reference.yaml. Robots are watched and moved with meca-ctl.

Exit codes: 0 asked to stop (SIGINT, SIGTERM)   2 arguments   3 configuration   4 network or DDS could not be opened
The bridge is no safety function: emergency stop and protective stop stay hard-wired.)";

// A configuration without its option.
std::string configuration_hint(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const bool yaml = argument.ends_with(".yaml") || argument.ends_with(".yml");
    const bool value = i > 1 && std::string_view(argv[i - 1]).starts_with("-");
    if (yaml && !value && !argument.starts_with("-")) return "; did you mean '--config " + std::string(argument) + "'?";
  }
  return {};
}

std::string transport_details(const RobotConfig& robot) {
  switch (robot.type) {
    case TransportType::kBuiltin:
      return "simulated Meca500 " + robot.builtin.product + ", firmware " + robot.builtin.firmware +
             ", serial number " + std::to_string(robot.builtin.serial_number);
    case TransportType::kEthernetIp:
      return robot.ethernet_ip.address + ":" + std::to_string(robot.ethernet_ip.tcp_port) + ", RPI " +
             to_string(robot.ethernet_ip.rpi) + ", watchdog " +
             to_string(robot.ethernet_ip.rpi * robot.ethernet_ip.timeout_multiplier) +
             (robot.ethernet_ip.multicast ? ", multicast" : "");
    case TransportType::kEthercat:
      return robot.ethercat.interface + (robot.ethercat.alias
                                             ? ", alias " + std::to_string(*robot.ethercat.alias)
                                             : ", position " + std::to_string(robot.ethercat.position));
    case TransportType::kProfinet:
      return robot.profinet.interface + ", station " + robot.profinet.station_name;
  }
  return {};
}

}  // namespace

Arguments parse_arguments(int argc, const char* const* argv) {
  CLI::App app(kAbout, "meca-bridge");
  app.footer(kExamples);
  Arguments arguments;
  std::string level;
  app.add_option("--config", arguments.config_file, std::string("the configuration; default ") + kDefaultConfigFile)
      ->type_name("FILE");
  app.add_flag("--check", arguments.check, "only read the configuration and say what it would run");
  app.add_option("--log-level", level, "trace, debug, info, warn, error or off; wins over the configuration")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->type_name("LEVEL");
  arguments.answer = parse_command_line(app, MECA_VERSION, argc, argv, configuration_hint(argc, argv));
  if (arguments.answer) return arguments;
  if (!level.empty()) arguments.log_level = level;
  if (arguments.config_file.empty()) {
    std::error_code ignored;
    if (!std::filesystem::exists(kDefaultConfigFile, ignored)) {
      arguments.answer =
          mistake("meca-bridge", std::string("meca-bridge: no --config FILE given, and there is no ") +
                                     kDefaultConfigFile + "; to try it out: --config config/builtin.yaml\n");
    }
    arguments.config_file = kDefaultConfigFile;
  }
  return arguments;
}

std::string describe(const RobotConfig& robot) {
  return robot.name + ": " + std::string(to_string(robot.type)) + " (" + transport_details(robot) + "), cycle " +
         to_string(robot.cycle) + ", " + (robot.control.enabled ? "control on" : "monitoring only");
}

std::string describe(const Config& config) {
  std::string text =
      "DDS domain " + std::to_string(config.dds.domain) + ", topics " + config.dds.topic_prefix + "..., interfaces ";
  for (const std::string& address : config.dds.interfaces) text += address + " ";
  if (config.dds.interfaces.empty()) text += "all ";
  text += config.dds.shared_memory ? "over UDP and shared memory\n" : "over UDP\n";
  for (const RobotConfig& robot : config.robots) text += describe(robot) + "\n";
  return text;
}

}  // namespace meca::bridge
