// The promise that queued motion goes as fast as the robot's handshake allows.
//
// The bound, in cycles of the bridge: a step sees the echo of a MoveID and puts the next command into the same cycle's
// image; the built-in robot takes that image and echoes it in the exchange that opens the next cycle. So a command
// costs one cycle, and one with report_completion two, because the bridge queues a checkpoint of its own behind it. A
// cycle that the machine kept the bridge from running has no number and is not counted.
//
// Over EtherCAT it costs twice as much: the frame that carries a command brings back the inputs from before it, its
// MoveID is echoed in the next one, and the next command leaves with the one after that.
//
// Measured: from the first to the last SENT receipt, commands against cycles.
#pragma once

#include "tests/bench/proof.hpp"
#include "tests/bench/scenarios.hpp"

namespace meca::bench {

Proof prove_throughput(const Setting& setting);
// With a robot of meca-sim at the other end of a virtual cable. Throws NotTold.
Proof prove_ethercat_throughput(const Setting& setting);

// The client of it, a process of its own: keeps commands under way for this long and prints a JSON object.
void run_throughput_client(int domain, bool moves, bool report_completion, std::chrono::seconds duration);

}  // namespace meca::bench
