// The cycle thread must not allocate: not while it connects, exchanges, loses the robot, and comes back.
#include <gtest/gtest.h>

#include <cstdint>

#include "tests/counted_new.hpp"
#include "tests/session/turner.hpp"

namespace meca::test {
namespace {

using transports::LinkState;

TEST(EthernetIpAllocation, IsCountedByThisProgram) {
  static int* volatile sink = nullptr;  // what nobody sees the compiler may leave out
  const auto before = allocations;
  sink = new int(1);
  delete sink;
  EXPECT_GT(allocations, before);
}

TEST(EthernetIpAllocation, NeverHappensAfterOpening) {
  AdapterHost arm1(kArm1);
  Turner bus({robot(kArm1), robot(kArm2)});  // the second one is not there
  const auto turn_until = [&](LinkState link) {
    const Time end = net::monotonic() + kPatience;
    while (bus.exchanges[0].link != link && net::monotonic() < end) bus.turn();
    return bus.exchanges[0].link == link;
  };
  const auto before = allocations;
  const bool up = turn_until(LinkState::kUp);
  for (int i = 0; i < 20; ++i) bus.turn();
  const auto while_exchanging = allocations - before;
  arm1.unplug();
  const auto before_loss = allocations;
  const bool down = turn_until(LinkState::kDown);
  for (int i = 0; i < 50; ++i) bus.turn();
  const auto in_a_loss = allocations - before_loss;
  arm1.plug_in();
  const auto before_return = allocations;
  const bool back = turn_until(LinkState::kUp);
  const auto after_a_loss = allocations - before_return;
  EXPECT_TRUE(up && down && back);
  EXPECT_EQ(while_exchanging, 0U);
  EXPECT_EQ(in_a_loss, 0U);
  EXPECT_EQ(after_a_loss, 0U);
}

}  // namespace
}  // namespace meca::test
