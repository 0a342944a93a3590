// The cycle thread must not allocate: not while it starts the robots, exchanges, loses one, and comes back.
#include <gtest/gtest.h>

#include <cstdint>

#include "tests/counted_new.hpp"
#include "tests/session/segment.hpp"

namespace meca::test {
namespace {

using transports::LinkState;

class EthercatAllocation : public OnACable {};

TEST(EthercatAllocations, AreCountedByThisProgram) {
  static int* volatile sink = nullptr;  // what nobody sees the compiler may leave out
  const auto before = allocations;
  sink = new int(1);
  delete sink;
  EXPECT_GT(allocations, before);
}

TEST_F(EthercatAllocation, NeverHappensAfterOpening) {
  ChainHost host(chain_of(2));
  Segment bus(first(3));  // the third one is not there
  const auto turn_until = [&](std::size_t robot, LinkState link) {
    const auto end = net::monotonic() + kPatience;
    while (bus.exchanges[robot].link != link && net::monotonic() < end) bus.turn();
    return bus.exchanges[robot].link == link;
  };
  const auto before = allocations;
  const bool started = turn_until(0, LinkState::kUp) && turn_until(1, LinkState::kUp);
  for (int i = 0; i < 1500; ++i) bus.turn();
  const auto while_exchanging = allocations - before;
  host.with_chain([](auto& chain) { chain.cut(1); });
  const auto before_loss = allocations;
  const bool lost = turn_until(1, LinkState::kDown);
  for (int i = 0; i < 300; ++i) bus.turn();
  const auto in_a_loss = allocations - before_loss;
  host.with_chain([](auto& chain) { chain.heal(1); });
  const auto before_return = allocations;
  const bool back = turn_until(1, LinkState::kUp);
  const auto after_a_loss = allocations - before_return;
  EXPECT_TRUE(started && lost && back);
  EXPECT_EQ(while_exchanging, 0U);
  EXPECT_EQ(in_a_loss, 0U);
  EXPECT_EQ(after_a_loss, 0U);
}

}  // namespace
}  // namespace meca::test
