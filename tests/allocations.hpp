// How many allocations this thread has made, where a source of the program counts them (tests/counted_new.hpp).
#pragma once

#include <cstdint>

namespace meca::test {
inline thread_local std::uint64_t allocations = 0;
}
