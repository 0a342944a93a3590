// meca-ctl: status, watch and commands for Meca500 robots over DDS. See `meca-ctl --help`.
#include <csignal>
#include <iostream>

#include "cli/arguments.hpp"
#include "cli/plan.hpp"
#include "cli/run.hpp"

namespace {

using namespace meca::cli;

void on_signal(int) { interrupted = true; }

ExitCode run_and_report(const Invocation& call) {
  const Report report(call.json);
  try {
    return run(call, report);
  } catch (const UsageError& error) {
    return report.error(ExitCode::kArguments, error.what());
  } catch (const NoBridge& error) {
    return report.error(ExitCode::kNoBridge, error.what());
  } catch (const meca::dds::Error& error) {
    return report.error(ExitCode::kNoBridge, error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  const auto parsed = parse_arguments({argv + 1, argv + argc});
  if (const auto* answer = std::get_if<Answer>(&parsed)) {
    (answer->code == ExitCode::kDone ? std::cout : std::cerr) << answer->text;
    return static_cast<int>(answer->code);
  }
  return static_cast<int>(run_and_report(std::get<Invocation>(parsed)));
}
