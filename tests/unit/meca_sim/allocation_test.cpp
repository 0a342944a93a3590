// Model, adapter and what joins them share one thread with the sockets: after construction they must not allocate.
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/unit/meca_sim/cell.hpp"

namespace {
std::atomic<std::uint64_t> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size != 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
}  // namespace

// Replaces the global ones for this test program; the array forms end here too. The nothrow form would as well, but
// AddressSanitizer brings one of its own, and googletest 1.16 uses it: freeing that here would be a mismatch.
void* operator new(std::size_t size) { return counted(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size != 0 ? size : 1);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using test::Cell;

TEST(EthernetIpAllocation, IsCountedByThisProgram) {
  const auto before = allocations.load();
  delete new int(1);
  EXPECT_GT(allocations.load(), before);
}

TEST(EthernetIpAllocation, NeverHappensWhileTheRobotRunsLosesItsHostAndStartsUp) {
  Cell cell;
  const auto before = allocations.load();
  const bool ready = cell.make_ready();
  cell.command(1, {30, 0, 0, 0, 0, 0});
  cell.run(1s);
  cell.robot.faults().duplicate = cell.robot.faults().stale_sequence = true;
  cell.run(100ms);
  cell.robot.faults() = {};
  cell.host_lives = false;
  cell.run(1s);
  cell.host_lives = true;
  cell.run(5s);
  cell.robot.robot().power_cycle();
  cell.run(5s);
  const auto meanwhile = allocations.load() - before;
  EXPECT_EQ(meanwhile, 0u);
  EXPECT_TRUE(ready);
  EXPECT_EQ(cell.host.counters().opens, 3u);
}

}  // namespace
}  // namespace meca::sim
