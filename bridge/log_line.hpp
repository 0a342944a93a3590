// A line for the log, and the rule of how often: the first time a sentence, afterwards a number.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "transports/transport.hpp"

namespace meca::bridge {

struct LogLine {
  enum class Level : std::uint8_t { kInfo, kWarning, kError } level = Level::kInfo;
  std::string text;
};

// One kind of event.
class LogEvent {
 public:
  // The same event again within this time is only counted, and told with the next line.
  static constexpr transports::Time kQuiet = std::chrono::seconds(10);

  // Appends the line, unless it is too early for another one. `now` is any monotonic time.
  void say(LogLine::Level level, std::string text, transports::Time now, std::vector<LogLine>& lines) {
    if (is_quiet(now)) {
      ++kept_back_;
      return;
    }
    if (kept_back_ > 0) text += " (" + std::to_string(kept_back_) + " more of this kind since the last line)";
    *this = {};
    said_ = true;
    until_ = now + kQuiet;
    lines.push_back({level, std::move(text)});
  }
  bool is_quiet(transports::Time now) const { return said_ && now < until_; }

 private:
  bool said_ = false;
  transports::Time until_{};
  std::uint64_t kept_back_ = 0;
};

}  // namespace meca::bridge
