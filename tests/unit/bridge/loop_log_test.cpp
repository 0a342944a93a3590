// What is worth a line in the log about a loop.
#include "bridge/loop_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> said(LoopLog& log, std::uint64_t missed_cycles, Time now) {
  std::vector<LogLine> lines;
  log.look({.missed_cycles = missed_cycles}, now, lines);
  std::vector<std::string> texts;
  for (const auto& line : lines) texts.push_back(line.text);
  return texts;
}

TEST(LoopLog, MissedCyclesAreToldOnceForAllRobotsOfTheLoop) {
  LoopLog log({"arm1", "arm2", "arm3"});
  EXPECT_THAT(said(log, 0, 0s), IsEmpty());
  EXPECT_THAT(
      said(log, 3, 1s),
      ElementsAre("arm1, arm2, arm3: missed cycles (the machine woke the loop too late): 3, 3 since the start"));
  EXPECT_THAT(said(log, 3, 30s), IsEmpty());
}

TEST(LoopLog, MissedCyclesAgainWithinTenSecondsAreToldAfterThem) {
  LoopLog log({"arm1"});
  said(log, 1, 0s);
  EXPECT_THAT(said(log, 2, 1s), IsEmpty());
  EXPECT_THAT(said(log, 7, 9s), IsEmpty());
  EXPECT_THAT(said(log, 7, 10s),
              ElementsAre("arm1: missed cycles (the machine woke the loop too late): 6, 7 since the start"));
  EXPECT_THAT(said(log, 7, 60s), IsEmpty());
}

TEST(LoopLog, ManyRobotsAreNotAllNamed) {
  LoopLog log({"arm1", "arm2", "arm3", "arm4", "arm5", "arm6"});
  EXPECT_THAT(said(log, 1, 0s),
              ElementsAre("arm1, arm2, arm3, arm4 and 2 more: missed cycles (the machine woke the loop too late): 1, "
                          "1 since the start"));
}

}  // namespace
}  // namespace meca::bridge
