// Cable redundancy: a ring on two ports of the master.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/ethercat/master_segment.hpp"

namespace meca::ethercat::test {
namespace {

using Port = Master::Port;

MasterSettings ring_of(std::size_t robots) {
  MasterSettings out = settings_for(robots);
  out.redundant = true;
  return out;
}

TEST(MasterRedundancy, AWholeRingRunsAndIsNotOpen) {
  Segment segment(ring_of(3));
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  EXPECT_FALSE(segment.master().ring_open());
  EXPECT_EQ(segment.master().counters().unexpected_frames, 0u);
  EXPECT_EQ(segment.master().counters().lost_frames, 0u);
}

class CutAt : public testing::TestWithParam<std::size_t> {};

TEST_P(CutAt, NoRobotLeavesOpOrMissesACycleAndTheRingIsOpenUntilItIsHealed) {
  const std::size_t cut = GetParam();
  Segment segment(ring_of(3));
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  segment.run(10ms);
  segment.chain().cut(cut);
  if (cut == 0) segment.set_link(Port::kPrimary, false);
  if (cut == 3) segment.set_link(Port::kSecondary, false);
  const auto images = segment.master().counters(2).images;
  segment.run(1s);
  EXPECT_TRUE(segment.all_operational()) << segment.master().trouble(0);
  EXPECT_TRUE(segment.master().ring_open());
  EXPECT_EQ(segment.master().counters(2).images, images + 1000);
  segment.chain().heal(cut);
  segment.set_link(Port::kPrimary, true);
  segment.set_link(Port::kSecondary, true);
  segment.run(500ms);
  EXPECT_FALSE(segment.master().ring_open());
  EXPECT_TRUE(segment.all_operational());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(segment.master().counters(i).losses, 0u);
    EXPECT_EQ(segment.master().counters(i).working_counter_misses, 0u);
    EXPECT_EQ(segment.device(i).counters().watchdog_expiries, 0u);
  }
}
INSTANTIATE_TEST_SUITE_P(Cables, CutAt, testing::Values(0, 1, 2, 3));

TEST(MasterRedundancy, AnOpenRingIsToldWithThePlaceToLookAt) {
  for (const auto& [cut, place] : {std::pair<std::size_t, const char*>{0, "before the first device"},
                                   {1, "behind position 0"},
                                   {2, "behind position 1"},
                                   {3, "behind position 2"}}) {
    Segment segment(ring_of(3));
    ASSERT_TRUE(segment.start());
    EXPECT_EQ(segment.master().trouble(0), "");
    segment.chain().cut(cut);
    if (cut == 0) segment.set_link(Port::kPrimary, false);
    if (cut == 3) segment.set_link(Port::kSecondary, false);
    segment.run(100ms);
    EXPECT_EQ(segment.master().trouble(1),
              "the ring is open " + std::string(place) + "; the next cut takes robots away; check the cable there");
  }
}

TEST(MasterRedundancy, ARobotWithoutPowerIsLookedForBehindTheOneBeforeIt) {
  Segment segment(ring_of(3));
  ASSERT_TRUE(segment.start());
  segment.chain().set_powered(1, false);
  segment.run(1s);
  EXPECT_EQ(segment.master().trouble(1),
            "position 1 is not there: 2 devices answer; check cable and power behind position 0");
}

TEST(MasterRedundancy, ACutThatNoCarrierTellsOfIsSurvivedToo) {
  for (const std::size_t cut : {0, 3}) {
    Segment segment(ring_of(3));
    ASSERT_TRUE(segment.start());
    segment.chain().cut(cut);
    segment.run(1s);
    EXPECT_TRUE(segment.all_operational()) << segment.master().trouble(0);
    EXPECT_EQ(segment.master().counters(0).losses, 0u);
  }
}

TEST(MasterRedundancy, AnEndThatBringsNothingBackMakesImagesNoOlderThanTheyAre) {
  Segment segment(ring_of(3));
  ASSERT_TRUE(segment.start());
  segment.chain().cut(3);  // the last cable leads elsewhere now, and has carrier there
  std::uint8_t cycle = 0;
  segment.every_cycle = [&cycle](Segment& of) {
    image::InputBytes input{};
    input.fill(static_cast<std::byte>(++cycle));
    for (std::size_t i = 0; i < 3; ++i) of.device(i).set_input(input);
  };
  segment.run(199ms);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(segment.master().input(i)[0], static_cast<std::byte>(cycle));
}

// No port is taken for deaf any longer than it is: half of a ring would be taken for all of it.
TEST(MasterRedundancy, AnEndThatWasSilentIsWaitedForAgainAsSoonAsItSpeaks) {
  Segment segment(ring_of(3));
  ASSERT_TRUE(segment.start());
  for (const std::size_t silent : {0, 3}) {
    segment.chain().cut(silent);
    segment.run(500ms);
    EXPECT_TRUE(segment.master().ring_open());
    segment.chain().heal(silent);
    segment.run(2ms);
    segment.chain().cut(1);
    segment.run(500ms);
    EXPECT_TRUE(segment.master().ring_open());
    segment.chain().heal(1);
    segment.run(2ms);
  }
  segment.run(100ms);
  EXPECT_FALSE(segment.master().ring_open());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(segment.master().counters(i).losses, 0u);
}

TEST(MasterRedundancy, StartedWithAnOpenRingTheRobotsBeforeTheBreakRunAndTheOthersWhenItIsWhole) {
  Segment segment(ring_of(3));
  segment.chain().cut(2);
  segment.run(5s);
  EXPECT_TRUE(segment.master().station(0).operational()) << segment.master().trouble(0);
  EXPECT_TRUE(segment.master().station(1).operational());
  EXPECT_FALSE(segment.master().station(2).operational());
  EXPECT_TRUE(segment.master().ring_open());
  segment.chain().heal(2);
  segment.run(1s);
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
  segment.run(5s, [&] { return segment.all_operational(); });
  EXPECT_TRUE(segment.all_operational()) << segment.master().trouble(2);
}

// It was once "being looked through" for as long as that cable was out.
TEST(MasterRedundancy, StartedWithoutItsFirstCableItSaysThatRobotsAreLookedForFromThere) {
  for (const bool told : {true, false}) {
    Segment segment(ring_of(3));
    segment.chain().cut(0);
    if (told) segment.set_link(Port::kPrimary, false);
    segment.run(2s);
    EXPECT_EQ(segment.master().trouble(1),
              "the ring is open before the first device, and robots are looked for from there; check the cable there");
    segment.chain().heal(0);
    segment.set_link(Port::kPrimary, true);
    ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
    EXPECT_EQ(segment.master().trouble(1), "");
  }
}

TEST(MasterRedundancy, ARobotPowerCycledBeforeTheBreakOfAnOpenRingComesBack) {
  Segment segment(ring_of(3));
  ASSERT_TRUE(segment.start());
  segment.chain().cut(2);
  segment.run(100ms);
  segment.device(0).power_cycle(segment.now());
  segment.run(50ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  EXPECT_EQ(segment.master().counters(1).losses, 0u);
  EXPECT_EQ(segment.master().counters(2).losses, 0u);
}

// The scan cannot go by positions here: nobody waits for it.
TEST(MasterRedundancy, WithoutThePrimaryCableRobotsStillRecoverAndANewOneComesWithIt) {
  for (const bool told : {true, false}) {
    Segment segment(ring_of(3));
    ASSERT_TRUE(segment.start());
    segment.chain().cut(0);
    if (told) segment.set_link(Port::kPrimary, false);
    segment.run(50ms);
    segment.device(0).power_cycle(segment.now());
    segment.device(2).raise_al_error(0x001B, segment.now());
    segment.run(3s);
    EXPECT_TRUE(segment.master().station(1).operational());
    EXPECT_TRUE(segment.master().station(2).operational()) << segment.master().trouble(2);
    EXPECT_FALSE(segment.device(0).operational());
    segment.chain().heal(0);
    segment.set_link(Port::kPrimary, true);
    segment.run(50ms);
    ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
    EXPECT_EQ(segment.master().counters(1).losses, 0u);
  }
}

TEST(MasterRedundancy, OneCopyLostIsCountedAndTheOtherTaken) {
  Segment segment(ring_of(2));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  segment.fate = [](std::size_t frame) { return Fate{.lost = frame % 10 == 3}; };
  segment.run(1s);
  EXPECT_TRUE(segment.all_operational());
  EXPECT_GT(segment.master().counters().lost_frames, 0u);
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
}

TEST(MasterRedundancy, CloseInAnOpenRingReachesAll) {
  Segment segment(ring_of(3));
  ASSERT_TRUE(segment.start());
  segment.chain().cut(1);
  segment.run(20ms);
  segment.master().close(segment.now());
  EXPECT_TRUE(segment.run(2s, [&] { return segment.master().closed(); }));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(segment.device(i).state(), AlState::kInit);
}

}  // namespace
}  // namespace meca::ethercat::test
