// The bench scenarios. Each gives figures of the bridge beside a yardstick measured in the same run: read the ratios,
// the absolute numbers belong to this machine and this moment.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace meca::bench {

// This machine does not permit what has to be measured.
struct NotTold : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Setting {
  std::filesystem::path bridge;  // the meca-bridge program
  int domain = 90;
  std::chrono::seconds duration{10};  // of each measurement
};

// Robot image -> CyclicState sample in another process, beside raw Fast DDS writing the same type at the same rate.
nlohmann::ordered_json measure_latency(const Setting& setting);

// CPU of the bridge for 1, 4, 16, 64 built-in robots at 1 kHz, beside as many raw Fast DDS writes.
nlohmann::ordered_json measure_cpu(const Setting& setting);

// How late the cycle thread wakes up, beside a bare clock_nanosleep loop.
nlohmann::ordered_json measure_wakeup(const Setting& setting);

// Four robots at 1 kHz: missed cycles without a reader, with one, and with one that is stopped (SIGSTOP).
nlohmann::ordered_json measure_stopped_reader(const Setting& setting);

}  // namespace meca::bench
