// Models, what is between them and the bus, and what joins both share one thread with the sockets: after construction
// they must not allocate.
#include "tests/counted_new.hpp"
#include "tests/unit/meca_sim/cell.hpp"
#include "tests/unit/meca_sim/ethercat_cell.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using test::Cell;
using test::EthercatCell;

TEST(Allocation, IsCountedByThisProgram) {
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

TEST(EthercatAllocation, NeverHappensWhileRobotsRunLoseTheirMasterAndStartUp) {
  EthercatCell cell({.robots = 2});
  const auto before = meca::test::allocations;
  const bool ready = cell.make_ready();
  cell.command(1, 1, {30, 0, 0, 0, 0, 0});
  cell.run(1s);
  cell.faults(0).late = 2ms;
  cell.faults(1).lose_every = 7;
  ++cell.faults(1).events.emergencies;
  cell.run(100ms);
  cell.faults(0).late = {};
  cell.faults(1).lose_every = 0;
  cell.faults(1).cut = true;
  cell.run(1s);
  cell.faults(1).cut = false;
  cell.faults(0).duplicate = cell.faults(0).corrupt = true;
  cell.run(100ms);
  cell.faults(0).duplicate = cell.faults(0).corrupt = false;
  cell.faults(0).foreign = true;
  cell.faults(1).clock_drift = 100;
  cell.run(1s);
  cell.faults(0).foreign = false;
  cell.run(5s);
  cell.segment.robot(0).robot().power_cycle();
  cell.run(10s);
  const auto meanwhile = meca::test::allocations - before;
  EXPECT_EQ(meanwhile, 0u);
  EXPECT_TRUE(ready);
  EXPECT_TRUE(cell.operational(0) && cell.operational(1));
}

}  // namespace
}  // namespace meca::sim
