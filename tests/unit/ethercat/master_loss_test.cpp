// Replies that are lost, at a regular beat and at random: robots come to OP on one way, however long it takes, for what
// was lost is asked for again and no step but that one is repeated.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/unit/ethercat/master_segment.hpp"

namespace meca::ethercat::test {
namespace {

using Phase = Station::Phase;

// Robots that began their way a second time, or were given up.
class Setbacks {
 public:
  explicit Setbacks(std::size_t robots) : seen_(robots, Phase::kAbsent) {}
  void look(Segment& segment) {
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const Phase phase = segment.master().station(i).phase();
      if (phase < seen_[i]) ++count_;
      seen_[i] = phase;
    }
  }
  int count() const { return count_; }

 private:
  std::vector<Phase> seen_;
  int count_ = 0;
};

void expect_op_on_one_way(const MasterSettings& settings, const std::function<Fate(std::size_t)>& fate) {
  const std::size_t robots = settings.robots.size();
  Segment segment(settings);
  segment.fate = fate;
  Setbacks setbacks(robots);
  segment.every_cycle = [&](Segment& s) { setbacks.look(s); };
  ASSERT_TRUE(segment.start(60s)) << segment.master().trouble(0);
  segment.run(2s);
  EXPECT_TRUE(segment.all_operational());
  EXPECT_EQ(setbacks.count(), 0);
  for (std::size_t i = 0; i < robots; ++i) EXPECT_EQ(segment.master().counters(i).losses, 0u);
  EXPECT_GT(segment.master().counters().lost_frames, 0u);
}

std::function<Fate(std::size_t)> every(unsigned beat, unsigned phase) {
  return [=](std::size_t reply) { return Fate{.lost = reply % beat == phase % beat}; };
}

std::function<Fate(std::size_t)> at_random(unsigned percent) {
  return [=, random = std::mt19937(1)](std::size_t) mutable { return Fate{.lost = random() % 100 < percent}; };
}

MasterSettings with_cycle(Time cycle) {
  MasterSettings out = settings_for(3);
  out.cycle = cycle;
  return out;
}

constexpr unsigned kBeats[] = {2, 3, 4, 5, 7, 10, 15, 50};

// Once it was every third time the answer of a mailbox, which was asked for again and lost again, for ever. And once
// every second reply was that of a cycle's frame, so that the chain was thought to be silent.
class LostAtABeat : public testing::TestWithParam<unsigned> {};

TEST_P(LostAtABeat, RobotsStillComeToOpAndStayThereWhereverItBegins) {
  for (unsigned phase = 0; phase < std::min(GetParam(), 5u); ++phase) {
    SCOPED_TRACE(phase);
    expect_op_on_one_way(settings_for(3), every(GetParam(), phase));
  }
}
INSTANTIATE_TEST_SUITE_P(Every, LostAtABeat, testing::ValuesIn(kBeats));

// The frames of the cycles count in the beat, so that each cycle makes another one of it.
class LostAtABeatOf : public testing::TestWithParam<int> {};

TEST_P(LostAtABeatOf, RobotsComeToOp) {
  for (const unsigned beat : {2u, 3u, 4u, 5u}) {
    SCOPED_TRACE(beat);
    expect_op_on_one_way(with_cycle(std::chrono::milliseconds(GetParam())), every(beat, 0));
  }
}
INSTANTIATE_TEST_SUITE_P(CyclesOfMilliseconds, LostAtABeatOf, testing::Values(2, 4, 10));

TEST(MasterLoss, AtABeatDoesNotKeepClocksFromRunningTogether) {
  MasterSettings settings = settings_for(3);
  settings.dc = true;
  for (const unsigned beat : {2u, 3u, 4u, 5u}) {
    SCOPED_TRACE(beat);
    expect_op_on_one_way(settings, every(beat, 1));
  }
}

TEST(MasterLoss, AtRandomDoesNotKeepRobotsFromOperating) {
  for (const unsigned percent : {1u, 20u, 33u, 50u}) {
    SCOPED_TRACE(percent);
    expect_op_on_one_way(settings_for(3), at_random(percent));
  }
}

// Of a whole ring one copy of each frame has been through all devices and the other through none. Where the first was
// lost, the second was once taken for the answer of devices that do nothing, and a mail was never asked for again.
// Not every second: that keeps time with the two copies of a frame, and where it takes the one that was counted, no
// device ever answers.
TEST(MasterLoss, OfCopiesInARingDoesNotKeepRobotsFromOperating) {
  MasterSettings settings = settings_for(3);
  settings.redundant = true;
  for (const unsigned beat : {3u, 4u, 5u}) {
    SCOPED_TRACE(beat);
    expect_op_on_one_way(settings, every(beat, 0));
  }
  expect_op_on_one_way(settings, at_random(20));
}

}  // namespace
}  // namespace meca::ethercat::test
