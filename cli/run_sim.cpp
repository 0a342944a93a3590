// `meca-ctl sim`: the buttons of a simulated robot on this machine. No DDS: a Unix socket that only this user can open.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/plan.hpp"
#include "cli/run.hpp"
#include "sim/panel.hpp"
#include "transports/net/line_client.hpp"
#include "transports/panel/control_panel.hpp"

namespace meca::cli {
namespace {

using transports::FoundPanel;

std::string names_of(const std::vector<FoundPanel>& panels) {
  std::string names;
  for (const auto& panel : panels) names += (names.empty() ? "" : ", ") + panel.robot;
  return names;
}

std::string nobody_listens(const Invocation& call, const std::vector<FoundPanel>& panels) {
  const std::string others = panels.empty() ? "" : "; there " + std::string(panels.size() == 1 ? "is " : "are ");
  return "no simulated robot " + (call.robot.empty() ? "" : "'" + call.robot + "' ") + "on this machine in domain " +
         std::to_string(call.domain) + " under '" + call.prefix + "'" + others + names_of(panels) +
         "; is the bridge, or meca-sim, running here, as this user?";
}

// Throws NoBridge or UsageError with a sentence when there is not exactly one that is meant.
FoundPanel choose(const Invocation& call) {
  if (!call.socket.empty()) return {call.robot.empty() ? "robot" : call.robot, call.socket};
  const auto panels = transports::find_control_panels(call.domain, call.prefix);
  if (!call.robot.empty()) {
    const auto found = std::ranges::find(panels, call.robot, &FoundPanel::robot);
    if (found == panels.end()) throw NoBridge(nobody_listens(call, panels));
    return *found;
  }
  if (panels.empty()) throw NoBridge(nobody_listens(call, panels));
  if (panels.size() > 1) {
    throw UsageError("there are several robots, " + names_of(panels) + ": say which with --robot NAME");
  }
  return panels.front();
}

// "ok: sentence\n  line\n" -> its lines, without "ok: ".
std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

ExitCode show(const FoundPanel& panel, std::string_view answer, const Report& report) {
  constexpr std::string_view kOk = "ok: ", kError = "error: ";
  const bool ok = answer.starts_with(kOk);
  if (ok) answer.remove_prefix(kOk.size());
  if (answer.starts_with(kError)) answer.remove_prefix(kError.size());
  const auto lines = lines_of(answer);
  if (!ok) return report.error(ExitCode::kRefused, panel.robot + ": " + (lines.empty() ? "no answer" : lines.front()));
  report.text(panel.robot + ": " + std::string(answer));
  report.object({{"robot", panel.robot}, {"answer", lines}});
  return ExitCode::kDone;
}

}  // namespace

ExitCode run_sim(const Invocation& call, const Report& report) {
  if (call.sim_line.empty() || call.sim_line == "help") {  // needs no robot
    report.text("What to say behind 'meca-ctl sim':\n" + sim::panel_help());
    report.object({{"words", lines_of(sim::panel_help())}});
    return ExitCode::kDone;
  }
  const FoundPanel panel = choose(call);
  auto client = net::LineClient::connect(panel.socket);
  if (!client)
    throw NoBridge("nobody listens at '" + panel.socket.string() +
                   "'; is the bridge, or meca-sim, running here, as this user?");
  const auto timeout = std::chrono::ceil<std::chrono::milliseconds>(discovery_timeout(call));
  const auto answer = client->ask(call.sim_line, timeout);
  if (!answer) {
    return report.error(ExitCode::kTimeOut, panel.robot + ": no answer from '" + panel.socket.string() +
                                                "'; is the bridge stopped, or in a debugger?");
  }
  return show(panel, *answer, report);
}

}  // namespace meca::cli
