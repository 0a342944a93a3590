#include "sim/meca_sim/script.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace meca::sim {
namespace {

constexpr std::string_view kBlanks = " \t\r";

// Takes the first word off the text.
std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

// For a complaint: what is no printable ASCII becomes '?', as it may do anything to a terminal.
std::string in_quotes(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c >= ' ' && c <= '~' ? c : '?';
  return out + "'";
}

std::string in_seconds(Time at) {
  std::array<char, 32> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), std::chrono::duration<double>(at).count()).ptr;
  return std::string(buffer.data(), end) + "s";
}

// The line, or the complaint about it. `previous`: when the line before happens.
std::variant<ScriptLine, std::string> parse_line(std::string_view text, Time previous, const ScriptStage& stage) {
  const std::string_view when = take_word(text);
  if (when != "at" && when != "after") {
    return "found " + in_quotes(when) + "; a line begins with 'at TIME' or 'after TIME', e.g. 'at 2.5s unplug'";
  }
  const std::string_view time = take_word(text);
  const auto parsed_time = parse_script_time(time);
  if (!parsed_time) {
    return "found " + in_quotes(time) + " behind '" + std::string(when) + "'; expected a time in s or ms, e.g. 2.5s";
  }
  const Time at = when == "at" ? *parsed_time : previous + *parsed_time;
  if (at < previous) {
    return "at " + in_seconds(at) + " is before the line above, at " + in_seconds(previous) +
           "; lines stand in the order of their times";
  }
  if (trimmed(text).empty()) return "nothing is said behind the time; add words, e.g. 'unplug'";
  auto event = parse_event(text, stage);
  if (auto* line = std::get_if<ScriptLine>(&event)) line->at = at;
  return event;
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::optional<Time> parse_script_time(std::string_view text) {
  constexpr double kYear = 365.0 * 24 * 3600;
  double value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit = text.substr(static_cast<std::size_t>(rest - text.data()));
  if (error != std::errc{} || (unit != "s" && unit != "ms")) return std::nullopt;
  const double seconds = unit == "s" ? value : value / 1000;
  if (!(seconds >= 0 && seconds <= kYear)) return std::nullopt;
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds));
}

std::variant<ScriptLine, std::string> parse_event(std::string_view text, const ScriptStage& stage) {
  ScriptLine line;
  std::string_view rest = text;
  if (const std::string_view first = take_word(rest); first.size() > 1 && first.ends_with(':')) {
    line.robot = first.substr(0, first.size() - 1);
    text = rest;
    if (!stage.robots.empty() && std::ranges::find(stage.robots, line.robot) == stage.robots.end()) {
      return "there is no robot " + in_quotes(line.robot) + "; there is " + list_of(stage.robots);
    }
  }
  line.words = trimmed(text);
  auto request = parse_panel_line(line.words);
  if (auto* complaint = std::get_if<std::string>(&request)) return std::move(*complaint);
  line.request = std::get<PanelRequest>(request);
  const std::string_view complaint = stage.bus ? misplaced(line.request, *stage.bus) : "";
  if (!complaint.empty()) return in_quotes(line.words) + ": " + std::string(complaint);
  return line;
}

Script parse_script(std::string_view text, std::string_view name, const ScriptStage& stage) {
  Script script;
  Time previous{};
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view said = trimmed(line.substr(0, line.find('#')));
    if (said.empty()) continue;
    auto parsed = parse_line(said, previous, stage);
    if (const auto* complaint = std::get_if<std::string>(&parsed)) {
      script.mistakes.push_back(std::string(name) + ":" + std::to_string(number) + ": " + *complaint);
      continue;
    }
    script.lines.push_back(std::move(std::get<ScriptLine>(parsed)));
    previous = script.lines.back().at;
  }
  return script;
}

}  // namespace meca::sim
