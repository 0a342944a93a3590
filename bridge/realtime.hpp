// SCHED_FIFO, locked memory, CPU affinity: asks for what the configuration wants, checks, and says what it got.
// A refusal is a sentence with a remedy, never a reason not to run.
#pragma once

#include <string>
#include <vector>

#include "bridge/config.hpp"

namespace meca::bridge {

// Once, before the threads start: locks the memory of the process.
std::vector<std::string> make_process_realtime(const RealtimeConfig& config);

// For the calling thread: priority, CPUs, and timers without slack. Lines are worth a warning when something was
// refused; empty when nothing was asked for.
std::vector<std::string> make_thread_realtime(const RealtimeConfig& config);

}  // namespace meca::bridge
