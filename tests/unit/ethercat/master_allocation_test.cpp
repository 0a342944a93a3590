// The master runs on the cycle thread: after construction it must not allocate, whatever happens. That allocations are
// counted in this program is tested with the device.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/allocations.hpp"
#include "tests/unit/ethercat/master_segment.hpp"

namespace meca::ethercat::test {
namespace {

class Counted {
 public:
  explicit Counted(Segment& segment) {
    segment.around_master = [this](bool into) {
      if (into)
        before_ = meca::test::allocations;
      else
        inside_ += meca::test::allocations - before_;
    };
  }
  std::uint64_t inside() const { return inside_; }

 private:
  std::uint64_t before_ = 0, inside_ = 0;
};

void live(Segment& segment) {
  ASSERT_TRUE(segment.start());
  segment.run(2s);
  segment.chain().cut(2);
  segment.run(2s);
  segment.chain().heal(2);
  segment.run(50ms);
  segment.device(1).power_cycle(segment.now());
  segment.run(50ms);
  segment.device(0).raise_al_error(0x001B, segment.now());
  segment.fate = [](std::size_t frame) { return Fate{.lost = frame % 17 == 0, .doubled = frame % 13 == 0}; };
  segment.run(5s);
  segment.fate = {};
  segment.chain().cut(0);
  segment.run(500ms);
  segment.chain().heal(0);
  ASSERT_TRUE(segment.start());
  segment.master().close(segment.now());
  segment.run(1s);
  EXPECT_TRUE(segment.master().closed());
}

TEST(MasterAllocation, NeverHappensInALineWithClocks) {
  MasterSettings settings = settings_for(3);
  settings.dc = true;
  Segment segment(settings);
  Counted counted(segment);
  live(segment);
  EXPECT_EQ(counted.inside(), 0u);
}

TEST(MasterAllocation, NeverHappensInARing) {
  MasterSettings settings = settings_for(3);
  settings.redundant = true;
  Segment segment(settings);
  Counted counted(segment);
  live(segment);
  EXPECT_EQ(counted.inside(), 0u);
}

}  // namespace
}  // namespace meca::ethercat::test
