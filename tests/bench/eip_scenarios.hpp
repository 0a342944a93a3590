// EtherNet/IP on the wire: a bridge in a process of its own, its robots (eip_cell.hpp) on loopback addresses in this
// one.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/bench/scenarios.hpp"

namespace meca::bench {

// The time between two O->T packets of one robot at 10 ms and at 2 ms, as the kernel got them, beside a bare sender in
// a process of its own at the same time.
nlohmann::ordered_json measure_eip_period(const Setting& setting);

// T->O packet, stamped just before it is sent -> CyclicState sample in another process, at 10 ms and at 2 ms; beside
// raw Fast DDS writing the same type at the same rate, which has no bus to cross.
nlohmann::ordered_json measure_eip_latency(const Setting& setting);

// 1, 8, 32 robots of one bridge at 10 ms, beside a bare sender of as many packets. The bridge publishes its state
// topics with nobody but BridgeStatus read; the bare sender neither receives nor publishes.
nlohmann::ordered_json measure_eip_robots(const Setting& setting);

}  // namespace meca::bench
