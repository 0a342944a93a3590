// meca-bridge: arguments, configuration, signals, exit code; the work is done by Bridge.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <exception>
#include <iostream>
#include <string>

#include "bridge/arguments.hpp"
#include "bridge/bridge.hpp"
#include "bridge/config.hpp"

namespace {

using meca::ExitCode;
using namespace meca::bridge;

void print_problems(const ConfigResult& result) {
  for (const ConfigError& error : result.errors) std::cerr << to_string(error) << "\n";
  for (const ConfigError& warning : result.warnings) std::cerr << "warning: " << to_string(warning) << "\n";
}

void start_log(const std::string& level) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("meca-bridge"));
  spdlog::set_pattern("%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
  spdlog::set_level(spdlog::level::from_str(level));
}

ExitCode run(const Config& config, const sigset_t& stop_signals) {
  Bridge bridge(config);
  bridge.start();
  for (const RobotConfig& robot : config.robots) spdlog::info("{}", describe(robot));
  int signal = 0;
  sigwait(&stop_signals, &signal);
  spdlog::info("{}: stopping", signal == SIGINT ? "Ctrl-C" : "asked to stop");
  bridge.stop();
  spdlog::info("stopped");
  return ExitCode::kStopped;
}

// Blocked before there are threads, so that all inherit it and only sigwait() sees a signal.
sigset_t take_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);  // a log reader that goes away must not take the robots with it
  return signals;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = parse_arguments(argc, argv);
  if (arguments.answer) return print(*arguments.answer);
  const ConfigResult loaded = load_config(arguments.config_file);
  print_problems(loaded);
  if (!loaded.config) return static_cast<int>(ExitCode::kConfiguration);
  if (arguments.check) {
    std::cout << arguments.config_file << ": good\n" << describe(*loaded.config);
    return static_cast<int>(ExitCode::kStopped);
  }
  const sigset_t stop_signals = take_signals();
  start_log(arguments.log_level.value_or(loaded.config->log.level));
  try {
    return static_cast<int>(run(*loaded.config, stop_signals));
  } catch (const std::exception& error) {
    spdlog::critical("{}", error.what());
    return static_cast<int>(ExitCode::kNetwork);
  }
}
