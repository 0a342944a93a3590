// Cycle::step runs on the cycle thread: after construction it allocates nothing, whatever happens.

#include "tests/counted_new.hpp"
#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

TEST(CycleStep, allocates_nothing_through_a_whole_life) {
  Bench b;
  b.connect_ready();
  std::vector<Request> batch;
  batch.reserve(64);
  std::size_t during_steps = 0;
  std::size_t receipts = 0;
  b.robot.executes = false;
  for (int i = 0; i < 3000; ++i) {
    batch.clear();
    for (int n = 0; n < 8; ++n) batch.push_back(b.motion(image::kMoveJoints, {1, 0, 0, 0, 0, 0}, n % 2 == 0));
    batch.push_back(b.velocity(1));
    batch.push_back(LeaseRenewal{b.client, participant(1), static_cast<std::uint64_t>(i) + 1});
    if (i % 500 == 100) batch.push_back(b.request(CommandKind::kClearMotion));
    if (i % 500 == 200) batch.push_back(b.request(CommandKind::kResumeMotion));
    if (i == 2000) b.robot.raise_error(3005);
    b.link_up = i < 2500 || i > 2600;
    b.now += b.settings.cycle;
    const std::size_t before = allocations;
    b.cycle->step(batch, b.exchange, {b.now, b.unix_ns}, *b.result);
    during_steps += allocations - before;
    receipts += b.result->receipt_count;
    b.out = image::decode_outputs(b.exchange.output, {b.layout});
    b.exchange_frames();
  }
  EXPECT_EQ(during_steps, 0u);
  EXPECT_GT(receipts, 10000u);
  EXPECT_GT(allocations, 0u) << "the counter counts";
}

}  // namespace
}  // namespace meca::test
