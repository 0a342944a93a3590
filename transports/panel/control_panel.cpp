#include "transports/panel/control_panel.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <variant>

#include "transports/net/unix_socket.hpp"

namespace meca::transports {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// Longer than the longest cycle a bus may have (1 s).
constexpr auto kPatience = 3s;
constexpr auto kGlance = 500us;  // only while a request is on its way

std::string name_before_robot(int domain, std::string_view topic_prefix) {
  std::string name = "sim-" + std::to_string(domain) + "-" + std::string(topic_prefix);
  std::ranges::replace(name, '/', '.');
  return name;
}
constexpr std::string_view kNameAfterRobot = ".sock";

}  // namespace

ControlPanel::ControlPanel(fs::path socket)
    : server_(
          std::move(socket), [this](std::string_view line, const std::stop_token& stop) { return answer(line, stop); },
          sim::panel_error) {}

std::string ControlPanel::answer(std::string_view line, const std::stop_token& stop) {
  const auto parsed = sim::parse_panel_line(line);
  if (const auto* complaint = std::get_if<std::string>(&parsed)) return sim::panel_error(*complaint);
  const auto deadline = Clock::now() + kPatience;
  if (port_.ask(std::get<sim::PanelRequest>(parsed))) {
    // The stepping thread must not spend its time on waking anybody, so this side looks.
    while (!stop.stop_requested() && Clock::now() < deadline) {
      if (const sim::PanelAnswer* got = port_.answer()) return sim::to_text(*got);
      std::this_thread::sleep_for(kGlance);
    }
  }
  if (stop.stop_requested()) return sim::panel_error("the simulated robot is being switched off");
  return sim::panel_error(
      "nobody steps the robot: is the process stopped, or in a debugger? What was asked may still be done later");
}

std::string control_socket_name(int domain, std::string_view topic_prefix, std::string_view robot) {
  return name_before_robot(domain, topic_prefix) + std::string(robot) + std::string(kNameAfterRobot);
}

fs::path default_control_socket(int domain, std::string_view topic_prefix, std::string_view robot) {
  std::string why;
  for (const fs::path& directory : net::control_directories()) {
    try {
      net::make_private_directory(directory);
      return directory / control_socket_name(domain, topic_prefix, robot);
    } catch (const std::runtime_error& error) {
      why += (why.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  throw std::runtime_error(why);
}

std::vector<FoundPanel> find_control_panels(int domain, std::string_view topic_prefix) {
  const std::string before = name_before_robot(domain, topic_prefix);
  std::vector<FoundPanel> found;
  for (const fs::path& directory : net::control_directories()) {
    if (!net::is_private_directory(directory)) continue;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(directory, ignored)) {
      const std::string name = entry.path().filename().string();
      const bool ours = name.starts_with(before) && name.ends_with(kNameAfterRobot) &&
                        name.size() > before.size() + kNameAfterRobot.size();
      if (!ours) continue;
      std::string robot = name.substr(before.size(), name.size() - before.size() - kNameAfterRobot.size());
      const bool longer_prefix = robot.find('.') != std::string::npos;  // no robot has a dot in its name
      if (longer_prefix || !net::is_listened_on(entry.path())) continue;
      found.push_back({std::move(robot), entry.path()});
    }
  }
  std::ranges::sort(found, {}, &FoundPanel::robot);
  return found;
}

}  // namespace meca::transports
