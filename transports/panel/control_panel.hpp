// The control socket of one simulated robot: what its buttons are for people and tests. Whatever steps a sim::Robot may
// have one, on any bus.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>

#include "sim/panel_port.hpp"
#include "transports/net/line_server.hpp"

namespace meca::transports {

class ControlPanel {
 public:
  // Listens from here on, in a thread of its own. Throws std::runtime_error with a sentence that names the path.
  explicit ControlPanel(std::filesystem::path socket);

  // The thread that steps the robot, before each step: does what was asked for meanwhile, one request a call. Does not
  // allocate, lock, block or throw. `network`: what is between the robot and its host, nullptr for nothing.
  void serve(sim::Robot& robot, sim::NetworkFaults* network = nullptr) noexcept { port_.serve(robot, network); }

  const std::filesystem::path& socket() const noexcept { return server_.path(); }

 private:
  std::string answer(std::string_view line, const std::stop_token& stop);

  sim::PanelPort port_;
  net::LineServer server_;  // last: its thread uses the port
};

// "sim-0-meca500.arm1.sock": the robot's place on DDS, which no two bridges share.
std::string control_socket_name(int domain, std::string_view topic_prefix, std::string_view robot);

// Where the socket of this robot belongs, its directory made. Throws std::runtime_error when there is no place for it.
std::filesystem::path default_control_socket(int domain, std::string_view topic_prefix, std::string_view robot);

struct FoundPanel {
  std::string robot;
  std::filesystem::path socket;
};
// The robots that listen now, of this user on this machine, under this prefix. In the order of their names.
std::vector<FoundPanel> find_control_panels(int domain, std::string_view topic_prefix);

}  // namespace meca::transports
