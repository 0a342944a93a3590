// meca-sim: arguments, signals, log, exit code; the work is done by Station.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/signalfd.h>

#include <csignal>
#include <exception>

#include "sim/meca_sim/station.hpp"

namespace {

using meca::ExitCode;
using namespace meca::sim;

// A file that can be read once the program is asked to stop. Blocked before there are threads, so that all inherit it.
meca::net::File take_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);  // a log reader that goes away must not take the robot with it
  return meca::net::File(::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
}

void start_log(const std::string& level) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("meca-sim"));
  spdlog::set_pattern("%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
  spdlog::set_level(spdlog::level::from_str(level));
}

void run(const Arguments& arguments, int stop) {
  Station station(arguments, [](Narrator::Level level, const std::string& text) {
    spdlog::log(level == Narrator::Level::kInfo ? spdlog::level::info : spdlog::level::warn, "{}", text);
  });
  station.run(stop, arguments.run_for);
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = parse_arguments(argc, argv);
  if (arguments.answer) return print(*arguments.answer);
  const auto stop = take_signals();
  start_log(arguments.log_level);
  try {
    run(arguments, stop.get());
    return static_cast<int>(ExitCode::kStopped);
  } catch (const std::exception& error) {
    spdlog::critical("{}: {}", arguments.names.front(), error.what());
    return static_cast<int>(ExitCode::kNetwork);
  }
}
