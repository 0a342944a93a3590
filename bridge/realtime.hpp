// SCHED_FIFO, locked memory, CPU affinity: asks for what the configuration wants, checks, and says what it got.
// A refusal is a sentence with a remedy, worth a warning, never a reason not to run.
#pragma once

#include <string>
#include <vector>

#include "bridge/config.hpp"

namespace meca::bridge {

// One thing that was asked for.
struct RealtimeAnswer {
  bool granted = false;
  std::string text;
};
using RealtimeAnswers = std::vector<RealtimeAnswer>;  // empty when nothing was asked for

// Once, before the threads start: locks the memory of the process.
RealtimeAnswers make_process_realtime(const RealtimeConfig& config);

// For the calling thread: priority, CPUs, and timers without slack.
RealtimeAnswers make_thread_realtime(const RealtimeConfig& config);

}  // namespace meca::bridge
