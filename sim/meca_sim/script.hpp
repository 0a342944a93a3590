// What is to happen to a simulated robot and its network, and when: a text file, one line an event.
//
//   # comment
//   at 2.5s unplug        since the program was ready
//   after 500ms plug      since the line before
//
// The words are those of the control socket (sim/panel.hpp).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/panel.hpp"

namespace meca::sim {

struct ScriptLine {
  Time at{};  // since the program was ready
  std::string words;
  PanelRequest request;
};

struct Script {
  std::vector<ScriptLine> lines;      // in the order of their times
  std::vector<std::string> mistakes;  // "faults.txt:3: ...", one for every bad line
};

// `name`: of the file, for the mistakes.
Script parse_script(std::string_view text, std::string_view name);

// "2.5s", "500ms", "0s": not negative, at most a year.
std::optional<Time> parse_script_time(std::string_view text);

}  // namespace meca::sim
