// The command line of meca-sim: what was asked for, or the answer to give at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/meca_sim/ethernet_ip_robot.hpp"
#include "sim/meca_sim/script.hpp"

namespace meca::sim {

enum class ExitCode : int { kStopped = 0, kArguments = 2, kNetwork = 4 };

struct Arguments {
  struct Answer {
    ExitCode code;
    std::string text;
  };
  std::optional<Answer> answer;  // --help, --version, or all mistakes: print it and leave

  std::string name = "arm1";
  std::string bind = "127.0.0.1";  // an address or an interface of this machine
  RobotOptions model;
  ethernet_ip::AdapterSettings adapter;  // its addresses are not known yet
  ConnectionLoss on_loss = ConnectionLoss::kStop;
  std::string control = "auto";    // of the control socket: a path, auto or off
  std::vector<ScriptLine> script;  // --fault at 0, then those of --faults
  std::optional<Time> run_for;     // nothing: until asked to stop
  std::string log_level = "info";
};

Arguments parse_arguments(int argc, const char* const* argv);

// "arm1: simulated Meca500 R4, firmware 11.3, serial number 1"
std::string describe(const Arguments& arguments);

}  // namespace meca::sim
