// EtherCAT on the wire: a bridge in a process of its own, its robots (ethercat_cell.hpp) in this one, on a virtual
// cable in a network of our own. Beside it, half a cycle apart, a bare loop (bare_ethernet.hpp) sends frames of the
// same sizes over the same cable at the same time, so that the machine's noise meets both. Throws NotTold where that
// network is not permitted.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/bench/scenarios.hpp"

namespace meca::bench {

// The time between two cycles on the wire at 1 ms, and from sending a frame to having it back; 1 and 8 robots.
nlohmann::ordered_json measure_ethercat_period(const Setting& setting);

// Frame at the robot -> CyclicState sample in another process, at 1 ms; beside raw Fast DDS writing the same type at
// the same rate, which has no bus to cross.
nlohmann::ordered_json measure_ethercat_latency(const Setting& setting);

// 1, 8, 16, 32 robots of one segment at 1 ms. The bridge publishes its state topics with nobody but BridgeStatus read;
// the bare loop publishes nothing.
nlohmann::ordered_json measure_ethercat_robots(const Setting& setting);

}  // namespace meca::bench
