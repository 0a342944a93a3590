// What a simulated robot does when its connection ends, on any bus.
#pragma once

#include <cstdint>

namespace meca::sim {

// EtherNet/IP: by time-out or Forward Close. EtherCAT: by leaving OP, whoever wants it. inferred: no document says what
// a Meca500 does then (spec 4.1, 4.2).
enum class ConnectionLoss : std::uint8_t {
  kStop,      // it ramps down, and the safety stop "connection dropped" stays until a host is back and resumes motion
  kContinue,  // it finishes what is in its queue
};

}  // namespace meca::sim
