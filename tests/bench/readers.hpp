// The reading side of the bench, a process of its own: the same for the bridge and for raw DDS.
#pragma once

#include <chrono>

namespace meca::bench {

// One-way latency of CyclicState samples, from header.receive_time_ns to take(). Prints a JSON object.
// `from_robot`: from the robot's own stamp of the image, which then has to be Unix time; an image that is published
// again counts once, and how long it took to the bridge is told as well.
void run_latency_reader(int domain, std::chrono::seconds duration, bool from_robot);

// Subscribes to every state topic with default QoS and counts. Prints a JSON object.
void run_counting_reader(int domain, std::chrono::seconds duration);

}  // namespace meca::bench
