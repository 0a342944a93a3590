// A simulated robot at work: model, sockets, control socket, script, in one thread.
#pragma once

#include <memory>
#include <optional>

#include "sim/meca_sim/arguments.hpp"
#include "sim/meca_sim/ethernet_ip_sockets.hpp"
#include "sim/meca_sim/narrator.hpp"
#include "transports/panel/control_panel.hpp"

namespace meca::sim {

// `bind`: an address of this machine or the name of an interface. Throws std::runtime_error with a sentence.
net::Interface find_own_interface(const std::string& bind);

class Station {
 public:
  // Opens everything. Throws std::runtime_error with a sentence when the network cannot be opened; without a control
  // socket it works all the same.
  Station(const Arguments& arguments, Narrator::Say say);

  // Until `stop` (a file descriptor) can be read from, or the time is over.
  void run(int stop, std::optional<Time> run_for);
  std::string summary() const { return narrator_.summary(); }
  net::Interface own() const { return own_; }

 private:
  void open_panel(const Arguments& arguments);
  void follow_script(Time now);

  Narrator::Say say_;
  net::Interface own_;
  EthernetIpRobot robot_;
  EthernetIpSockets sockets_;
  Narrator narrator_;
  std::unique_ptr<transports::ControlPanel> panel_;
  std::vector<ScriptLine> script_;
  std::size_t next_line_ = 0;
  Time begin_;
  std::string trouble_;
};

}  // namespace meca::sim
