// A name that one process of this machine can have at a time, or of this container where its network is its own. The
// kernel frees it however the process ends.
#pragma once

#include <optional>
#include <string_view>

#include "transports/net/file.hpp"

namespace meca::net {

// Empty: somebody has it already. `name`: at most 100 bytes. Throws std::runtime_error when it cannot be found out.
std::optional<File> claim(std::string_view name);

}  // namespace meca::net
