// EtherCAT as a transport: one bus for all robots of a segment, on one network interface, or two when the cable is a
// ring. The frame leaves when exchange() is called at the cycle's deadline, with the outputs of the steps before; while
// the loop waits here, the reply is taken as soon as it is there, and what is not cyclic is sent in between.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "transports/ethercat/master.hpp"
#include "transports/transport.hpp"

namespace meca::ethercat {

struct BusOptions {
  std::string interface;            // "eth1"
  std::string redundant_interface;  // where the ring comes back; empty: a line
  Time cycle = std::chrono::milliseconds(1);
  bool dc = false;
  Time dc_shift{};                                 // of SYNC0 against the multiples of the cycle
  Time watchdog = std::chrono::milliseconds(100);  // of the robots' outputs, in steps of 100 us
  bool separate = false;                           // LRD and LWR in place of LRW
};

// At most transports::kMostCounters counters; config/ethercat.yaml says what each one means. open() throws where an
// interface cannot be used (transports/net/raw_ethernet.hpp); an interface without a cable, or switched off, is waited
// for.
std::unique_ptr<transports::Transport> make_transport(std::vector<RobotPlace> robots, BusOptions options);

}  // namespace meca::ethercat
