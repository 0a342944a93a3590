// What is worth a line in the log about a loop, once for all robots that share it. A machine without output, like
// RobotLog.
#pragma once

#include <string>
#include <vector>

#include "bridge/log_line.hpp"
#include "bridge/pacer.hpp"

namespace meca::bridge {

class LoopLog {
 public:
  static constexpr std::size_t kMostNames = 4;  // "arm1, arm2, arm3, arm4 and 2 more"

  // `robots`: the names of those that the loop owns, at least one.
  explicit LoopLog(const std::vector<std::string>& robots);

  // The lines that the loop's pace is worth, in `lines` (appended); called now and then. `now` is any monotonic time.
  void look(const PaceFacts& pace, Time now, std::vector<LogLine>& lines);

 private:
  std::string robots_;
  std::uint64_t missed_cycles_ = 0;
  LogEvent missed_;
};

}  // namespace meca::bridge
