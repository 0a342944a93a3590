// What a fieldbus counts and measures, in words. Pure functions.
#pragma once

#include <string>

#include "idl/types.hpp"

namespace meca::cli {

// States and counts, without what never happened: "OP; images 81234, lost frames 2, DC difference -12 ns".
std::string bus_counts_text(const meca500::BridgeStatus& status);

// What is measured as several figures: "round trip 55 us (p50), 120 (p99), 390 (max); wake-up 3 us (p50), ...".
std::string bus_timing_text(const meca500::BridgeStatus& status);

}  // namespace meca::cli
