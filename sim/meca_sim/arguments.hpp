// The command line of meca-sim: what was asked for, or the answer to give at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "sim/meca_sim/connection_loss.hpp"
#include "sim/meca_sim/script.hpp"
#include "transports/ethercat/device.hpp"
#include "transports/ethernet_ip/adapter.hpp"

namespace meca::sim {

struct Arguments {
  std::optional<Answer> answer;  // --help, --version, or all mistakes: print it and leave

  Fieldbus bus = Fieldbus::kEthernetIp;
  std::vector<std::string> names{"arm1"};  // of the robots, at least one
  RobotOptions model;                      // of the first one; model_of() has those of all
  ConnectionLoss on_loss = ConnectionLoss::kStop;

  // EtherNet/IP
  std::string bind = "127.0.0.1";        // an address or an interface of this machine
  ethernet_ip::AdapterSettings adapter;  // its addresses are not known yet

  // EtherCAT
  std::string interface, redundant_interface;  // the second one: empty for a line
  ethercat::DeviceSettings device;             // of the first robot; device_of() has those of all
  std::vector<std::string> foreign;            // robots that are another maker's devices

  std::string control = "auto";    // of the control sockets: a path, auto or off
  std::vector<ScriptLine> script;  // --fault at 0, then those of --faults
  std::optional<Time> run_for;     // nothing: until asked to stop
  std::string log_level = "info";
};

Arguments parse_arguments(int argc, const char* const* argv);

// Of robot `index`: serial numbers and aliases count on, noises and clocks are its own.
RobotOptions model_of(const Arguments& arguments, std::size_t index);
ethercat::DeviceSettings device_of(const Arguments& arguments, std::size_t index);

// "arm1: simulated Meca500 R4, firmware 11.3, serial number 1"
std::string describe(const Arguments& arguments, std::size_t index = 0);

}  // namespace meca::sim
