#include "bridge/realtime.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <cerrno>
#include <cstring>

namespace meca::bridge {
namespace {

std::string list(const std::vector<int>& cpus) {
  std::string text;
  for (const int cpu : cpus) text += (text.empty() ? "" : ", ") + std::to_string(cpu);
  return text;
}

std::string set_priority(int priority) {
  const sched_param wanted{.sched_priority = priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  int policy = 0;
  sched_param got{};
  pthread_getschedparam(pthread_self(), &policy, &got);
  if (error == 0 && policy == SCHED_FIFO && got.sched_priority == priority) {
    return "cycle thread runs with SCHED_FIFO priority " + std::to_string(priority);
  }
  return "cycle thread runs without real-time priority: SCHED_FIFO " + std::to_string(priority) + " was refused (" +
         std::strerror(error) + "); give the process CAP_SYS_NICE or an rtprio limit, or set realtime.priority: 0";
}

std::string set_cpus(const std::vector<int>& cpus) {
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  for (const int cpu : cpus) {
    if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(static_cast<unsigned>(cpu), &wanted);
  }
  const int error = pthread_setaffinity_np(pthread_self(), sizeof wanted, &wanted);
  cpu_set_t got;
  CPU_ZERO(&got);
  pthread_getaffinity_np(pthread_self(), sizeof got, &got);
  if (error == 0 && CPU_EQUAL(&wanted, &got)) return "cycle thread runs on CPU " + list(cpus);
  return "cycle thread runs on any CPU: " + list(cpus) + " was refused (" + std::strerror(error) +
         "); choose CPUs this process may use (taskset -p shows them)";
}

}  // namespace

std::vector<std::string> make_process_realtime(const RealtimeConfig& config) {
  if (!config.lock_memory) return {};
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {"memory is locked"};
  return {std::string("memory is not locked (") + std::strerror(errno) +
          "); give the process CAP_IPC_LOCK or a memlock limit, or set realtime.lock_memory: false"};
}

std::vector<std::string> make_thread_realtime(const RealtimeConfig& config) {
  // Without SCHED_FIFO the kernel may delay timers by 50 us to save power; nobody has to allow less.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  std::vector<std::string> lines;
  if (config.priority > 0) lines.push_back(set_priority(config.priority));
  if (!config.cpus.empty()) lines.push_back(set_cpus(config.cpus));
  return lines;
}

}  // namespace meca::bridge
