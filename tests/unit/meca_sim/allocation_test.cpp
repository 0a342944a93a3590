// Model, adapter and what joins them share one thread with the sockets: after construction they must not allocate.

#include "tests/counted_new.hpp"
#include "tests/unit/meca_sim/cell.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using test::Cell;

TEST(EthernetIpAllocation, IsCountedByThisProgram) {
  const auto before = meca::test::allocations;
  static int* volatile sink = nullptr;  // what nobody sees the compiler may leave out
  sink = new int(1);
  delete sink;
  EXPECT_GT(meca::test::allocations, before);
}

TEST(EthernetIpAllocation, NeverHappensWhileTheRobotRunsLosesItsHostAndStartsUp) {
  Cell cell;
  const auto before = meca::test::allocations;
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
  const auto meanwhile = meca::test::allocations - before;
  EXPECT_EQ(meanwhile, 0u);
  EXPECT_TRUE(ready);
  EXPECT_EQ(cell.host.counters().opens, 3u);
}

}  // namespace
}  // namespace meca::sim
