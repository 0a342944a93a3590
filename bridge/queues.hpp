// The only places where two threads of the bridge meet.
#pragma once

#include "transports/spsc_queue.hpp"

namespace meca::bridge {

using transports::SpscQueue;

}  // namespace meca::bridge
