// Simulated robots at work: models, sockets, control sockets, script, in one thread.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sim/meca_sim/arguments.hpp"
#include "sim/meca_sim/network.hpp"
#include "transports/panel/control_panel.hpp"

namespace meca::sim {

class Station {
 public:
  // Opens everything, and says of each robot who and where it is. Throws std::runtime_error with a sentence when the
  // network cannot be opened; without a control socket it works all the same.
  Station(const Arguments& arguments, Narrator::Say say);

  // Until `stop` (a file descriptor) can be read from, or the time is over; then says what was counted.
  void run(int stop, std::optional<Time> run_for);

 private:
  struct Seat {
    std::string name;
    std::unique_ptr<transports::ControlPanel> panel;
  };

  void open_panel(const Arguments& arguments, Seat& seat);
  void follow_script(Time now);
  void exchange(Time now);
  void tell_trouble();
  Narrator::Say saying(const std::string& name) const;  // its name in front

  Narrator::Say say_;
  std::unique_ptr<Network> network_;
  std::vector<Seat> seats_;  // of the robots of the network, in its order
  std::vector<ScriptLine> script_;
  std::size_t next_line_ = 0;
  Time begin_{};
  std::string trouble_;
};

}  // namespace meca::sim
