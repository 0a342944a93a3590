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

// "0, 2-5"
std::string list(const cpu_set_t& cpus) {
  const auto has = [&cpus](int cpu) { return cpu < CPU_SETSIZE && CPU_ISSET(static_cast<unsigned>(cpu), &cpus); };
  std::string text;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!has(cpu)) continue;
    const int first = cpu;
    while (has(cpu + 1)) ++cpu;
    text += (text.empty() ? "" : ", ") + std::to_string(first) + (cpu > first ? "-" + std::to_string(cpu) : "");
  }
  return text;
}

RealtimeAnswer set_priority(int priority) {
  const sched_param wanted{.sched_priority = priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  int policy = 0;
  sched_param got{};
  pthread_getschedparam(pthread_self(), &policy, &got);
  if (error == 0 && policy == SCHED_FIFO && got.sched_priority == priority) {
    return {true, "cycle thread runs with SCHED_FIFO priority " + std::to_string(priority)};
  }
  return {false, "cycle thread runs without real-time priority: SCHED_FIFO " + std::to_string(priority) +
                     " was refused (" + std::strerror(error) +
                     "); give the process CAP_SYS_NICE or an rtprio limit, or set realtime.priority: 0"};
}

// The kernel takes a set of which some CPUs are there, and leaves out the others.
RealtimeAnswer set_cpus(const std::vector<int>& cpus) {
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  bool all = true;
  for (const int cpu : cpus) {
    all = all && cpu >= 0 && cpu < CPU_SETSIZE;
    if (all) CPU_SET(static_cast<unsigned>(cpu), &wanted);
  }
  const int error = pthread_setaffinity_np(pthread_self(), sizeof wanted, &wanted);
  cpu_set_t got;
  CPU_ZERO(&got);
  pthread_getaffinity_np(pthread_self(), sizeof got, &got);
  const std::string runs = "cycle thread runs on CPU " + list(got);
  if (error == 0 && all && CPU_EQUAL(&wanted, &got)) return {true, runs};
  return {false, runs + ", and " + list(cpus) +
                     (error != 0 ? " was refused (" + std::string(std::strerror(error)) + ")" : " was asked for") +
                     "; choose CPUs this process may use (taskset -p shows them)"};
}

}  // namespace

RealtimeAnswers make_process_realtime(const RealtimeConfig& config) {
  if (!config.lock_memory) return {};
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {{true, "memory is locked"}};
  return {{false, std::string("memory is not locked (") + std::strerror(errno) +
                      "); give the process CAP_IPC_LOCK or a memlock limit, or set realtime.lock_memory: false"}};
}

RealtimeAnswers make_thread_realtime(const RealtimeConfig& config) {
  // Without SCHED_FIFO the kernel may delay timers by 50 us to save power; nobody has to allow less.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  RealtimeAnswers answers;
  if (config.priority > 0) answers.push_back(set_priority(config.priority));
  if (!config.cpus.empty()) answers.push_back(set_cpus(config.cpus));
  return answers;
}

}  // namespace meca::bridge
