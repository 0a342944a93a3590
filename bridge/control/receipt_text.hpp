// The sentence of a receipt, for people: what became of the command and why, with field, value and allowed range.
#pragma once

#include <string>

#include "bridge/control/messages.hpp"

namespace meca::control {

std::string describe(const Receipt& receipt);

}  // namespace meca::control
