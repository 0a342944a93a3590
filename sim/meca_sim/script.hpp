// What is to happen to a simulated robot and its network, and when: a text file, one line an event.
//
//   # comment
//   at 2.5s unplug           since the program was ready
//   after 500ms arm2: plug   since the line before; only the robot of this name
//
// The words are those of the control socket (sim/panel.hpp).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/panel.hpp"

namespace meca::sim {

struct ScriptLine {
  Time at{};          // since the program was ready
  std::string robot;  // empty: all of them
  std::string words;
  PanelRequest request;
};

// What there is for a line to speak of; words and names of nobody are mistakes.
struct ScriptStage {
  std::optional<Fieldbus> bus;      // nothing: any
  std::vector<std::string> robots;  // empty: any
};

struct Script {
  std::vector<ScriptLine> lines;      // in the order of their times
  std::vector<std::string> mistakes;  // "faults.txt:3: ...", one for every bad line
};

// `name`: of the file, for the mistakes.
Script parse_script(std::string_view text, std::string_view name, const ScriptStage& stage = {});

// "arm2: unplug", "unplug": a line without its time; or what is wrong with it, without full stop.
std::variant<ScriptLine, std::string> parse_event(std::string_view text, const ScriptStage& stage = {});

// "2.5s", "500ms", "0s": not negative, at most a year.
std::optional<Time> parse_script_time(std::string_view text);

}  // namespace meca::sim
