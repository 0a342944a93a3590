// `meca-ctl scan ethercat`: what is told of the devices in a chain. Pure; the asking is run_scan_ethercat().
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cli/json.hpp"
#include "transports/ethercat/scan.hpp"

namespace meca::cli {

struct ScannedChain {
  std::string interface;  // "eth1"
  std::vector<ethercat::ScannedDevice> devices;
  bool frames_of_others = false;  // another master's frames were seen on the cable
  std::string ring_end;           // "eth2": where our frames came back instead; empty: no ring
};

// A table with one line per device, how many of them are a Meca500, and what is wrong with any, in words.
std::string chain_text(const ScannedChain& chain);
Json to_json(const ScannedChain& chain, const ethercat::ScannedDevice& device);
// What to check when nobody answered. `looped`: our own frames came back as they were.
std::string nobody_in_chain(const std::string& interface, std::chrono::nanoseconds waited, bool looped);

}  // namespace meca::cli
