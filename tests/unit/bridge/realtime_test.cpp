// What was asked of the kernel is compared with what it gave, whatever this machine allows.
#include "bridge/realtime.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <fstream>
#include <string>
#include <thread>

namespace meca::bridge {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

struct Thread {
  RealtimeAnswers answers;
  int policy = 0, priority = 0;
  cpu_set_t cpus{};
};

// In a thread of its own, which takes its properties with it.
Thread thread_with(const RealtimeConfig& config) {
  Thread out;
  std::thread([&] {
    out.answers = make_thread_realtime(config);
    sched_param got{};
    pthread_getschedparam(pthread_self(), &out.policy, &got);
    out.priority = got.sched_priority;
    pthread_getaffinity_np(pthread_self(), sizeof out.cpus, &out.cpus);
  }).join();
  return out;
}

int a_cpu_of_ours() {
  cpu_set_t ours;
  CPU_ZERO(&ours);
  sched_getaffinity(0, sizeof ours, &ours);
  int cpu = 0;
  while (!CPU_ISSET(static_cast<unsigned>(cpu), &ours)) ++cpu;
  return cpu;
}

bool has_locked_memory() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line) && !line.starts_with("VmLck:")) {
  }
  return line.find_first_of("123456789") != std::string::npos;
}

TEST(Realtime, SaysNothingWhereNothingIsAskedFor) {
  EXPECT_THAT(make_process_realtime({}), IsEmpty());
  const Thread thread = thread_with({});
  EXPECT_THAT(thread.answers, IsEmpty());
  EXPECT_EQ(thread.policy, SCHED_OTHER);
}

TEST(Realtime, SaysWhichPriorityTheThreadHas) {
  const Thread thread = thread_with({.priority = 3});
  ASSERT_EQ(thread.answers.size(), 1u);
  EXPECT_EQ(thread.answers[0].granted, thread.policy == SCHED_FIFO && thread.priority == 3);
  if (thread.answers[0].granted) {
    EXPECT_EQ(thread.answers[0].text, "cycle thread runs with SCHED_FIFO priority 3");
  } else {
    EXPECT_THAT(thread.answers[0].text,
                StartsWith("cycle thread runs without real-time priority: SCHED_FIFO 3 was refused ("));
    EXPECT_THAT(thread.answers[0].text, HasSubstr("CAP_SYS_NICE"));
  }
}

TEST(Realtime, APriorityThatThereIsNotIsRefusedWithARemedy) {
  const Thread thread = thread_with({.priority = 100});
  ASSERT_EQ(thread.answers.size(), 1u);
  EXPECT_FALSE(thread.answers[0].granted);
  EXPECT_THAT(thread.answers[0].text, HasSubstr("SCHED_FIFO 100 was refused ("));
  EXPECT_THAT(thread.answers[0].text, EndsWith("or set realtime.priority: 0"));
  EXPECT_EQ(thread.policy, SCHED_OTHER);
}

TEST(Realtime, SaysOnWhichCpuTheThreadRuns) {
  const int cpu = a_cpu_of_ours();
  const Thread thread = thread_with({.cpus = {cpu}});
  ASSERT_EQ(thread.answers.size(), 1u);
  EXPECT_TRUE(thread.answers[0].granted);
  EXPECT_EQ(thread.answers[0].text, "cycle thread runs on CPU " + std::to_string(cpu));
  EXPECT_EQ(CPU_COUNT(&thread.cpus), 1);
  EXPECT_TRUE(CPU_ISSET(static_cast<unsigned>(cpu), &thread.cpus));
}

TEST(Realtime, ACpuThatThereIsNotIsRefusedAndTheThreadRunsWhereItRan) {
  const Thread thread = thread_with({.cpus = {1023}});
  ASSERT_EQ(thread.answers.size(), 1u);
  EXPECT_FALSE(thread.answers[0].granted);
  EXPECT_THAT(thread.answers[0].text, HasSubstr(", and 1023 was refused (Invalid argument); choose CPUs "));
}

// It once said "runs on any CPU: 0, 1023 was refused (Success)", and ran on CPU 0.
TEST(Realtime, OfTwoCpusOfWhichOneIsNotThereTheOtherIsNamed) {
  const std::string cpu = std::to_string(a_cpu_of_ours());
  for (const int missing : {1023, 100'000}) {
    const Thread thread = thread_with({.cpus = {a_cpu_of_ours(), missing}});
    ASSERT_EQ(thread.answers.size(), 1u);
    EXPECT_FALSE(thread.answers[0].granted);
    EXPECT_THAT(thread.answers[0].text, StartsWith("cycle thread runs on CPU " + cpu + ", and " + cpu + ", " +
                                                   std::to_string(missing) + " was asked for; choose CPUs "));
    EXPECT_EQ(CPU_COUNT(&thread.cpus), 1);
  }
}

TEST(Realtime, SaysWhetherMemoryIsLocked) {
  if (mlockall(MCL_CURRENT) == 0 && !has_locked_memory()) GTEST_SKIP() << "a sanitizer keeps memory from being locked";
  munlockall();
  const auto answers = make_process_realtime({.lock_memory = true});
  const bool locked = has_locked_memory();
  munlockall();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].granted, locked);
  if (answers[0].granted) {
    EXPECT_EQ(answers[0].text, "memory is locked");
  } else {
    EXPECT_THAT(answers[0].text, StartsWith("memory is not locked ("));
    EXPECT_THAT(answers[0].text, HasSubstr("CAP_IPC_LOCK"));
  }
}

}  // namespace
}  // namespace meca::bridge
