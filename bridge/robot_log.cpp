#include "bridge/robot_log.hpp"

#include <utility>

#include "bridge/mapping.hpp"
#include "transports/image/error_codes.hpp"

namespace meca::bridge {
namespace {

using Level = LogLine::Level;
using transports::LinkState;

// The safety stops the Meca500 has.
bool any_stop(const image::SafetyStatus& safety) {
  return safety.known &&
         (safety.stop.e_stop || safety.stop.p_stop2 || safety.stop.reboot || safety.stop.connection_dropped);
}

std::string error_sentence(std::uint16_t code) {
  const auto* info = image::find_error_code(code);
  const std::string number = "error " + std::to_string(code);
  if (info == nullptr) return number + ", which no document names";
  return number + " " + std::string(info->name) + ": " + std::string(info->text) + "; " +
         image::remedy_text(*info, "reset the error") + (info->resettable ? "" : "; a reset does not clear it");
}

}  // namespace

void RobotLog::say(Event event, Level level, std::string text, Time now, std::vector<LogLine>& lines) {
  events_[event].say(level, robot_ + ": " + std::move(text), now, lines);
}

void RobotLog::look(const CycleRecord& record, Time now, std::vector<LogLine>& lines) {
  if (!record.closing) look_at_link(record, now, lines);  // that the bridge stops is no news of a robot
  look_at_owner(record.control, now, lines);
  look_at_trouble(record, now, lines);
}

void RobotLog::look_at_link(const CycleRecord& record, Time now, std::vector<LogLine>& lines) {
  const bool up = record.link == LinkState::kUp;
  const bool changed = up != link_up_ || first_;
  // What was kept back is said when the quiet time is over and it is still so: the last line is the truth.
  if (changed || (up != said_up_ && !events_[up ? kLinkUp : kLinkDown].is_quiet(now))) {
    const std::string detail = record.link_detail.empty() ? "" : ": " + std::string(record.link_detail.view());
    const std::size_t before = lines.size();
    if (up) {
      say(kLinkUp, Level::kInfo, "link up" + detail, now, lines);
    } else {
      say(kLinkDown, first_ ? Level::kInfo : Level::kWarning, (first_ ? "no link yet" : "link down") + detail, now,
          lines);
      if (first_) events_[kLinkDown] = {};  // the first "link down" is news
    }
    if (lines.size() > before) {
      said_up_ = up;
      said_detail_ = record.link_detail;
    }
  } else if (record.link == LinkState::kDown && !said_up_ && !record.link_detail.empty() &&
             record.link_detail != said_detail_ && !events_[kLinkTrouble].is_quiet(now)) {
    say(kLinkTrouble, Level::kWarning, "no link: " + std::string(record.link_detail.view()), now, lines);
    said_detail_ = record.link_detail;
  }
  look_at_reserve(record, now, lines);
  first_ = false;
  link_up_ = up;
  if (record.firmware_known && !firmware_known_) {
    say(kFirmware, Level::kInfo, "firmware " + to_string(record.firmware), now, lines);
  }
  firmware_known_ = record.firmware_known;
  if (record.firmware_mismatch && !firmware_mismatch_) {
    say(kMismatch, Level::kError,
        "the robot reports firmware " + to_string(record.firmware) +
            ", the configuration says another generation; correct `firmware:` or use `auto`",
        now, lines);
  }
  firmware_mismatch_ = record.firmware_mismatch;
}

// What is not as it should be though the link is up: half of a ring, inputs that do not come.
void RobotLog::look_at_reserve(const CycleRecord& record, Time now, std::vector<LogLine>& lines) {
  if (record.link != LinkState::kUp || !said_up_ || record.link_detail == said_detail_) return;
  if (events_[kLinkTrouble].is_quiet(now)) return;
  if (!record.link_detail.empty()) {
    say(kLinkTrouble, Level::kWarning, "link up, but: " + std::string(record.link_detail.view()), now, lines);
  } else {
    say(kLinkSound, Level::kInfo, "link up, as it should be", now, lines);
  }
  said_detail_ = record.link_detail;
}

void RobotLog::look_at_owner(const control::ControlState& state, Time now, std::vector<LogLine>& lines) {
  if (state.contender != contender_ && !state.contender.empty()) {
    say(kContender, Level::kInfo,
        std::string(state.contender.view()) + " (priority " + std::to_string(state.contender_priority) +
            ") takes over from " + std::string(state.owner.view()),
        now, lines);
  }
  contender_ = state.contender;
  if (state.owned == owned_ && state.owner == owner_) return;
  if (owned_) say_who_went(state, now, lines);  // also when the next owner is there already: a take-over
  if (state.owned) say(kOwnerCame, Level::kInfo, std::string(state.owner.view()) + " has control", now, lines);
  owned_ = state.owned;
  owner_ = state.owner;
}

void RobotLog::say_who_went(const control::ControlState& state, Time now, std::vector<LogLine>& lines) {
  using Loss = control::ControlState::Loss;
  const std::string who(owner_.view());
  switch (state.last_loss) {
    case Loss::kNone:
    case Loss::kReleased:
      say(kOwnerWent, Level::kInfo, who + " released control", now, lines);
      break;
    case Loss::kLeaseExpired:
      say(kOwnerWent, Level::kWarning,
          who + " lost control: its lease was not renewed for " + std::to_string(state.lease_ms) + " ms", now, lines);
      break;
    case Loss::kLinkLost:
      say(kOwnerWent, Level::kWarning, who + " lost control: the link to the robot is gone", now, lines);
      break;
    case Loss::kShutdown:
      say(kOwnerWent, Level::kInfo, who + " lost control: the bridge is stopping", now, lines);
      break;
    case Loss::kTakenOver:
      say(kOwnerWent, Level::kWarning, who + " lost control: " + std::string(state.owner.view()) + " took over", now,
          lines);
      break;
  }
}

void RobotLog::look_at_trouble(const CycleRecord& record, Time now, std::vector<LogLine>& lines) {
  if (record.quality != Quality::kGood) return;  // old values are no news
  const std::uint16_t code = record.inputs.robot_status.error_code;
  if (code != error_code_) {
    if (code != 0) say(kError, Level::kError, error_sentence(code), now, lines);
    if (code == 0) say(kErrorGone, Level::kInfo, "the error is gone", now, lines);
    error_code_ = code;
  }
  const bool stopped = any_stop(record.inputs.safety_status);
  if (stopped != stopped_) {
    if (stopped) say(kSafetyStop, Level::kWarning, "a safety stop is active; SafetyStatus says which", now, lines);
    if (!stopped) say(kSafetyGone, Level::kInfo, "no safety stop any more", now, lines);
    stopped_ = stopped;
  }
}

void RobotLog::look(const LogFacts& facts, Time now, std::vector<LogLine>& lines) {
  const auto compare = [&](Event event, std::uint64_t LogFacts::*counter, Level level, const char* what) {
    const std::uint64_t news = facts.*counter - facts_.*counter;
    if (news == 0 || events_[event].is_quiet(now)) return;  // what comes in the quiet time is told after it
    facts_.*counter = facts.*counter;
    say(event, level,
        std::string(what) + ": " + std::to_string(news) + ", " + std::to_string(facts.*counter) + " since the start",
        now, lines);
  };
  compare(kDropped, &LogFacts::records_dropped, Level::kWarning,
          "dropped state records (the publisher came too late for them)");
  compare(kLost, &LogFacts::receipts_lost, Level::kError, "lost receipts");
  compare(kRefused, &LogFacts::refused_writes, Level::kWarning, "samples refused by DDS");
}

}  // namespace meca::bridge
