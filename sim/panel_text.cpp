// Answers of the panel as text.
#include <cstdio>

#include "sim/panel.hpp"
#include "transports/image/error_codes.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::sim {
namespace {

std::string error_name(std::uint16_t code) {
  const image::ErrorInfo* info = image::find_error_code(code);
  return std::to_string(code) + (info != nullptr ? " " + std::string(info->name) : "");
}

std::string stops_text(const PanelStatus& status) {
  std::string text;
  const auto add = [&text](std::string_view words) { text += (text.empty() ? "" : ", ") + std::string(words); };
  const auto stop = [&add](StopSignal signal, std::string_view present, std::string_view resettable) {
    if (signal != StopSignal::kReset) add(signal == StopSignal::kPresent ? present : resettable);
  };
  stop(status.stops.e_stop, "E-Stop pressed", "E-Stop released and not reset");
  stop(status.stops.p_stop2, "P-Stop 2 pressed", "P-Stop 2 released and not resumed");
  stop(status.stops.connection_dropped, "connection dropped", "connection restored and not resumed");
  stop(status.stops.reboot, "", "rebooted and not reset");
  if (status.monitoring) add("monitoring only");
  return text.empty() ? "nothing pressed" : text;
}

std::string status_text(const PanelStatus& s) {
  return stops_text(s) + "; " + (s.present ? "" : "starting up, before that: ") +
         (s.error != 0 ? "error " + error_name(s.error) : "no error") + "; " +
         (s.activated ? "activated" : "not activated") + ", " + (s.homed ? "homed" : "not homed") + "; " +
         std::to_string(s.queued) + " in the queue; " + std::to_string(s.executed) + " executed, " +
         std::to_string(s.discarded) + " discarded, " + std::to_string(s.refused) +
         " refused; violations: " + std::to_string(s.violations);
}

std::string time_text(Time at) {
  std::array<char, 32> buffer{};
  const auto length =
      std::snprintf(buffer.data(), buffer.size(), "  %10.3f s  ", std::chrono::duration<double>(at).count());
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string command_text(const Command& command) {
  const image::MotionCommandInfo* info = image::find_motion_command(command.id);
  const bool variable = command.id >= image::kFirstVariable && command.id <= image::kLastVariable;
  std::string text = info != nullptr ? std::string(info->name) : "command";
  if (info == nullptr || variable) text += " " + std::to_string(command.id);
  text += "(";
  const std::size_t count = info != nullptr ? info->arguments.size() : command.arguments.size();
  for (std::size_t i = 0; i < count; ++i) {
    std::array<char, 32> number{};
    const auto length = std::snprintf(number.data(), number.size(), "%.6g", static_cast<double>(command.arguments[i]));
    text += (i == 0 ? "" : ", ") + std::string(number.data(), static_cast<std::size_t>(length));
  }
  return text + ")";
}

std::string outcome_text(const JournalEntry& entry) {
  switch (entry.outcome) {
    case Outcome::kExecuted:
      return "executed";
    case Outcome::kDiscarded:
      return "discarded";
    case Outcome::kRefused:
      return "refused: " + error_name(entry.code);
  }
  return {};
}

std::string journal_text(const PanelAnswer& answer) {
  if (answer.total == 0) return "ok: no command has come to its end yet\n";
  std::string text = "ok: the last " + std::to_string(answer.listed) + " of " + std::to_string(answer.total) +
                     " commands that have come to their end; time of the robot\n";
  for (std::size_t i = 0; i < answer.listed; ++i) {
    const JournalEntry& entry = answer.commands[i];
    text += time_text(entry.at) + command_text(entry.command) + ", MoveID " + std::to_string(entry.command.move_id) +
            ": " + outcome_text(entry) + "\n";
  }
  return text;
}

std::string violations_text(const PanelAnswer& answer) {
  if (answer.total == 0) return "ok: the host broke no rule\n";
  std::string text = "ok: the last " + std::to_string(answer.listed) + " of " + std::to_string(answer.total) +
                     " violations; time of the robot\n";
  for (std::size_t i = 0; i < answer.listed; ++i) {
    text += time_text(answer.violations[i].at) + std::string(answer.violations[i].what) + "\n";
  }
  return text;
}

std::string help_text() {
  std::string text = "ok: the words of a simulated robot\n";
  const std::string help = panel_help();
  for (std::size_t begin = 0; begin < help.size();) {
    const std::size_t end = help.find('\n', begin) + 1;
    text += "  " + help.substr(begin, end - begin);
    begin = end;
  }
  return text;
}

// As the words that make them.
std::string faults_text(const NetworkFaults& f) {
  std::string text;
  const auto add = [&text](bool on, std::string_view words) {
    if (on) text += (text.empty() ? "" : ", ") + std::string(words);
  };
  const auto with = [](const char* format, auto... numbers) {
    std::array<char, 64> buffer{};
    const auto length = std::snprintf(buffer.data(), buffer.size(), format, numbers...);
    return std::string(buffer.data(), static_cast<std::size_t>(length));
  };
  add(f.unplugged, "unplug");
  add(f.without_power, "power off");
  add(f.frozen, "freeze");
  add(f.late > Time::zero(), with("late %.6g", std::chrono::duration<double, std::milli>(f.late).count()));
  add(f.duplicate, "duplicate");
  add(f.corrupt, "corrupt");
  if (f.refuse_open) add(true, with("refuse open 0x%04x", unsigned{*f.refuse_open}));
  if (f.wrong_size) add(true, with("wrong size %u", unsigned{*f.wrong_size}));
  if (f.api_us) add(true, with("api %u", unsigned{*f.api_us}));
  add(f.no_socket_items, "no socket items");
  if (f.foreign_address) {
    const std::uint32_t a = f.foreign_address->ipv4;
    add(true, with("foreign address %u.%u.%u.%u:%u", a >> 24, a >> 16 & 0xFF, a >> 8 & 0xFF, a & 0xFF,
                   unsigned{f.foreign_address->port}));
  }
  add(f.stop_producing, "stop producing");
  add(f.stale_sequence, "stale sequence");
  add(f.frozen_count, "frozen count");
  add(f.cut, "cut");
  add(f.cut_behind, "cut behind");
  add(f.lose_next > 0, with("lose next %u", unsigned{f.lose_next}));
  add(f.lose_every > 0, with("lose every %u", unsigned{f.lose_every}));
  add(f.lose_mails, "lose mails");
  add(f.no_mailbox, "no mailbox");
  add(f.working_counter != 0, with("working counter %d", f.working_counter));
  add(f.clock_drift != 0, with("clock drift %d", int{f.clock_drift}));
  add(f.foreign, "foreign on");
  if (f.refuse_state) add(true, with("refuse state 0x%04x", unsigned{*f.refuse_state}));
  return text.empty() ? "nothing is wrong with the network" : text;
}

}  // namespace

std::string panel_error(std::string_view sentence) { return "error: " + std::string(sentence) + "\n"; }

std::string to_text(const PanelAnswer& answer) {
  switch (answer.kind) {
    case PanelAnswer::Kind::kDone:
      return "ok: " + std::string(answer.sentence) + "\n";
    case PanelAnswer::Kind::kRefused:
      return panel_error(answer.sentence);
    case PanelAnswer::Kind::kStatus:
      return "ok: " + status_text(answer.status) + "\n";
    case PanelAnswer::Kind::kJournal:
      return journal_text(answer);
    case PanelAnswer::Kind::kViolations:
      return violations_text(answer);
    case PanelAnswer::Kind::kHelp:
      return help_text();
    case PanelAnswer::Kind::kFaults:
      return "ok: " + faults_text(answer.faults) + "\n";
  }
  return {};
}

}  // namespace meca::sim
