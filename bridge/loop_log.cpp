#include "bridge/loop_log.hpp"

#include <algorithm>

namespace meca::bridge {

LoopLog::LoopLog(const std::vector<std::string>& robots) {
  const std::size_t named = std::min(robots.size(), kMostNames);
  for (std::size_t i = 0; i < named; ++i) robots_ += (i == 0 ? "" : ", ") + robots[i];
  if (named < robots.size()) robots_ += " and " + std::to_string(robots.size() - named) + " more";
}

void LoopLog::look(const PaceFacts& pace, Time now, std::vector<LogLine>& lines) {
  const std::uint64_t news = pace.missed_cycles - missed_cycles_;
  if (news == 0 || missed_.is_quiet(now)) return;  // what comes in the quiet time is told after it
  missed_cycles_ = pace.missed_cycles;
  missed_.say(LogLine::Level::kWarning,
              robots_ + ": missed cycles (the machine woke the loop too late): " + std::to_string(news) + ", " +
                  std::to_string(pace.missed_cycles) + " since the start",
              now, lines);
}

}  // namespace meca::bridge
