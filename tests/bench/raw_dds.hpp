// The yardstick: Fast DDS without any of our code, writing the same types at the same rate over the same transport.
#pragma once

#include <chrono>

namespace meca::bench {

struct RawWriterOptions {
  int domain = 0;
  bool whole_image = true;          // CyclicState, else TargetEndEffectorPose
  int instances = 1;                // robots
  double writes_per_second = 1000;  // of all instances together, spread over 1 ms ticks
  std::chrono::seconds duration{5};
};

// Returns the number of samples written. Throws std::runtime_error.
long run_raw_writer(const RawWriterOptions& options);

}  // namespace meca::bench
