// Counts the allocations of each thread, for tests of what must not allocate. Replaces the global operator new, so one
// source of a test program includes it, and only one.
#pragma once

#include <cstdlib>
#include <new>

#include "tests/allocations.hpp"

// Not inlined, where GCC would see a free() that does not match the new it knows. The array forms end here too. The
// nothrow form would as well, but AddressSanitizer brings one of its own, and googletest 1.16 uses it: freeing that
// here would be a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++meca::test::allocations;
  if (void* p = std::malloc(size != 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++meca::test::allocations;
  return std::malloc(size != 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
