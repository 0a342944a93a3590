// The verbs of meca-ctl: each takes the checked command line, prints, and returns the exit code.
// Any may throw dds::Error, NoBridge or UsageError; main turns them into a sentence and an exit code.
#pragma once

#include "cli/bus.hpp"
#include "cli/invocation.hpp"
#include "cli/observer.hpp"
#include "cli/report.hpp"

namespace meca::cli {

ExitCode run_command(const Invocation& call, const Report& report);
ExitCode run_velocity(const Invocation& call, const Report& report);
ExitCode run_take(const Invocation& call, const Report& report);

ExitCode run_status(const Invocation& call, const Report& report);
ExitCode run_health(const Invocation& call, const Report& report);
ExitCode run_receipts(const Invocation& call, const Report& report);
ExitCode run_watch(const Invocation& call, const Report& report);
ExitCode run_topics(const Invocation& call, const Report& report);
ExitCode run_sim(const Invocation& call, const Report& report);
ExitCode run_scan(const Invocation& call, const Report& report);
ExitCode run_scan_ethercat(const Invocation& call, const Report& report);
ExitCode run_decode(const Invocation& call, const Report& report);
ExitCode run_errors(const Invocation& call, const Report& report);

// Picks the verb.
ExitCode run(const Invocation& call, const Report& report);

inline std::chrono::nanoseconds seconds_of(double seconds) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}
// For sections that a bridge may have switched off.
inline constexpr std::chrono::milliseconds kPatience{1500};

inline std::chrono::nanoseconds discovery_timeout(const Invocation& call) {
  return seconds_of(call.timeout_s.value_or(5));
}
inline std::chrono::nanoseconds answer_timeout(const Invocation& call) {
  return seconds_of(call.timeout_s.value_or(60));
}

// The robots a view is about: the one named, or all.
Views chosen(const Views& robots, const std::string& wanted);

}  // namespace meca::cli
