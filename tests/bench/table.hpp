// Figures of one scenario as a table for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace meca::bench {

// An object of objects (one row per key) or an array of objects (one row each); the columns are the inner keys.
std::string table(const std::string& title, const nlohmann::ordered_json& figures);

}  // namespace meca::bench
