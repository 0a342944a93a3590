// What is worth a line in the log about one robot. A machine without output: records come in, lines go out; the
// publisher thread prints them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bridge/cycle.hpp"
#include "bridge/log_line.hpp"

namespace meca::bridge {

// Counters of what is between the robot's loop and DDS, as of now.
struct LogFacts {
  std::uint64_t records_dropped = 0, receipts_lost = 0, refused_writes = 0;
};

class RobotLog {
 public:
  explicit RobotLog(std::string robot) : robot_(std::move(robot)) {}

  // The lines that this record is worth, in `lines` (appended). `now` is any monotonic time.
  void look(const CycleRecord& record, Time now, std::vector<LogLine>& lines);
  // Counters that should stay 0; called now and then.
  void look(const LogFacts& facts, Time now, std::vector<LogLine>& lines);

 private:
  // Coming and going are events of their own: a link that goes down just after it came up is news.
  enum Event {
    kLinkUp,
    kLinkDown,
    kLinkTrouble,  // another reason why there is no link, or why it is not as it should be
    kLinkSound,    // it is again
    kFirmware,
    kMismatch,
    kOwnerCame,
    kOwnerWent,
    kContender,
    kError,
    kErrorGone,
    kSafetyStop,
    kSafetyGone,
    kDropped,
    kLost,
    kRefused,
    kEvents
  };
  void say(Event event, LogLine::Level level, std::string text, Time now, std::vector<LogLine>& lines);
  void look_at_link(const CycleRecord& record, Time now, std::vector<LogLine>& lines);
  void look_at_reserve(const CycleRecord& record, Time now, std::vector<LogLine>& lines);
  void look_at_owner(const control::ControlState& state, Time now, std::vector<LogLine>& lines);
  void say_who_went(const control::ControlState& state, Time now, std::vector<LogLine>& lines);
  void look_at_trouble(const CycleRecord& record, Time now, std::vector<LogLine>& lines);

  std::string robot_;
  std::array<LogEvent, kEvents> events_;
  bool link_up_ = false, said_up_ = false;
  transports::LinkDetail said_detail_;
  bool first_ = true;
  bool firmware_known_ = false, firmware_mismatch_ = false;
  std::uint16_t error_code_ = 0;
  bool stopped_ = false;
  bool owned_ = false;
  control::ClientName owner_, contender_;
  LogFacts facts_;
};

}  // namespace meca::bridge
