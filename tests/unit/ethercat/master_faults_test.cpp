// What goes wrong on the wire and in robots, and that the others do not notice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/ethercat/master_segment.hpp"

namespace meca::ethercat::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// Every robot but `but` takes fresh inputs in every cycle from now on.
void expect_no_missed_cycle(Segment& segment, std::size_t robots, std::size_t but) {
  for (std::size_t i = 0; i < robots; ++i) segment.master().take_fresh(i);
  segment.every_cycle = [=, first = true](Segment& s) mutable {
    for (std::size_t i = 0; i < robots; ++i) {
      if (i == but) continue;
      const bool fresh = s.master().take_fresh(i);
      if (!first) {
        EXPECT_TRUE(fresh) << "robot " << i << " at " << s.now().count();
      }
    }
    first = false;
  };
}

TEST(MasterFaults, ASingleLostFrameIsCountedAndNothingElse) {
  Segment segment(settings_for(2));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  segment.fate = [once = true](std::size_t) mutable { return Fate{.lost = std::exchange(once, false)}; };
  segment.run(500ms);
  EXPECT_EQ(segment.master().counters().lost_frames, 1u);
  EXPECT_TRUE(segment.all_operational());
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
  EXPECT_EQ(segment.master().counters().scans, 1u);
}

TEST(MasterFaults, DoubledFramesAreDroppedAndCounted) {
  Segment segment(settings_for(2));
  segment.fate = [](std::size_t) { return Fate{.doubled = true}; };
  ASSERT_TRUE(segment.start());
  EXPECT_GT(segment.master().counters().unexpected_frames, 0u);
  EXPECT_EQ(segment.master().counters().unexpected_frames, segment.master().counters().received_frames);
  EXPECT_EQ(segment.master().counters(0).images, segment.master().counters(1).images);
}

TEST(MasterFaults, FramesHeldUpBeyondTheCycleAreLateAndStillUsed) {
  Segment segment(settings_for(1));
  segment.fate = [](std::size_t) { return Fate{.held_up = 1500us}; };
  ASSERT_TRUE(segment.start());
  EXPECT_GT(segment.master().counters().late_frames, 0u);
  const auto images = segment.master().counters(0).images;
  segment.run(100ms);
  EXPECT_EQ(segment.master().counters(0).images, images + 100);
}

TEST(MasterFaults, FramesHeldUpBeyondTheTimeoutAreLostAndThenUnexpected) {
  Segment segment(settings_for(1));
  ASSERT_TRUE(segment.start());
  segment.run(20ms);
  segment.fate = [once = true](std::size_t) mutable {
    return Fate{.held_up = std::exchange(once, false) ? 22ms : Time{}};
  };
  segment.run(40ms);
  EXPECT_EQ(segment.master().counters().lost_frames, 1u);
  EXPECT_EQ(segment.master().counters().unexpected_frames, 1u);
}

TEST(MasterFaults, AnImageThatWasOvertakenByANewerOneIsNotTaken) {
  Segment segment(settings_for(1));
  ASSERT_TRUE(segment.start());
  segment.run(20ms);
  std::uint8_t cycle = 0;
  segment.every_cycle = [&cycle](Segment& of) {
    image::InputBytes input{};
    input[0] = static_cast<std::byte>(++cycle);
    of.device(0).set_input(input);
  };
  segment.run(2ms);
  segment.fate = [once = true](std::size_t) mutable {
    return Fate{.held_up = std::exchange(once, false) ? 2500us : Time{}};
  };
  for (int i = 0; i < 6; ++i) {
    const std::byte before = segment.master().input(0)[0];
    segment.run(1ms);
    EXPECT_GE(segment.master().input(0)[0], before);
  }
  EXPECT_EQ(segment.master().counters().late_frames, 1u);
  EXPECT_EQ(segment.master().counters().unexpected_frames, 0u);
}

TEST(MasterFaults, AnImageThatArrivesAfterItsRobotWasLostIsNoFreshOne) {
  Segment segment(settings_for(1));
  ASSERT_TRUE(segment.start());
  segment.fate = [](std::size_t) { return Fate{.held_up = 5ms}; };
  segment.run(2ms);
  segment.set_link(Master::Port::kPrimary, false);
  segment.master().take_fresh(0);
  const auto received = segment.master().counters().received_frames;
  segment.run(10ms);
  EXPECT_GT(segment.master().counters().received_frames, received);
  EXPECT_FALSE(segment.master().take_fresh(0));
}

TEST(MasterFaults, ACableThatIsOutForOneCycleCostsOneImageAndNoScan) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  segment.chain().cut(2);
  segment.run(1ms);
  segment.chain().heal(2);
  segment.run(500ms);
  EXPECT_EQ(segment.master().counters().scans, 1u);
  EXPECT_EQ(segment.master().counters(2).losses, 0u);
  EXPECT_EQ(segment.master().counters(2).working_counter_misses, 1u);
}

TEST(MasterFaults, ForeignAndBrokenFramesChangeNothing) {
  Segment segment(settings_for(1));
  ASSERT_TRUE(segment.start());
  std::array<std::byte, kLongestFrame> buffer;
  FrameWriter writer(buffer, MacAddress{std::byte{0x02}});
  writer.add(Command::kBrd, 0x77, address_of(0, reg::kAlStatus), 2);
  const Bytes foreign = writer.finish();
  const auto before = segment.master().counters();
  segment.master().received(Master::Port::kPrimary, foreign, segment.now());
  segment.master().received(Master::Port::kPrimary, foreign.first(20), segment.now());
  segment.master().received(Master::Port::kPrimary, {}, segment.now());
  EXPECT_EQ(segment.master().counters().unexpected_frames, before.unexpected_frames + 1);
  EXPECT_EQ(segment.master().counters().malformed_frames, before.malformed_frames + 2);
  EXPECT_EQ(segment.master().counters().received_frames, before.received_frames);
}

TEST(MasterFaults, AWrongWorkingCounterOfOneRobotLeavesTheOthersAlone) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  segment.device(1).faults().working_counter = -1;
  segment.run(2ms);
  segment.master().take_fresh(1);
  expect_no_missed_cycle(segment, 3, 1);
  segment.run(200ms);
  EXPECT_FALSE(segment.master().take_fresh(1));
  EXPECT_GE(segment.master().counters(1).working_counter_misses, 200u);
  EXPECT_EQ(segment.master().counters(0).working_counter_misses, 0u);
  EXPECT_THAT(segment.master().trouble(1), StartsWith("takes outputs but gives no inputs (working counter 2 "));
  segment.every_cycle = {};
  segment.device(1).faults().working_counter = 0;
  segment.run(10ms);
  EXPECT_TRUE(segment.master().take_fresh(1));
  EXPECT_EQ(segment.master().trouble(1), "");
}

TEST(MasterFaults, AWrongWorkingCounterIsToldWithWhatItMeans) {
  constexpr std::pair<int, const char*> kAdded[] = {
      {-1, "takes outputs but gives no inputs (working counter 2 where 3 is right); restart it if it stays so"},
      {-2,
       "gives inputs but takes no outputs (working counter 1 where 3 is right), so its inputs are not taken; restart "
       "it if it stays so"},
      {-3,
       "takes no part in the process data (working counter 0), so its inputs are not taken; restart it if it stays "
       "so"},
      {+1, "is counted more than once in the process data, so its inputs are not taken; another device answers for it"},
  };
  for (const auto& [added, words] : kAdded) {
    Segment segment(settings_for(1));
    ASSERT_TRUE(segment.start());
    segment.device(0).faults().working_counter = added;
    segment.run(50ms);
    EXPECT_EQ(segment.master().trouble(0), words);
    segment.device(0).raise_al_error(0x001A, segment.now());  // a later trouble is the one to be told
    segment.run(5ms);
    EXPECT_THAT(segment.master().trouble(0), StartsWith("the robot at position 0 went to SAFEOP with an error: "));
  }
}

TEST(MasterFaults, AnAlErrorOfOneRobotIsAcknowledgedAndItClimbsAgain) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  expect_no_missed_cycle(segment, 3, 1);
  segment.device(1).raise_al_error(0x001B, segment.now());
  segment.run(50ms);
  segment.run(5s, [&] { return segment.all_operational(); });
  EXPECT_TRUE(segment.all_operational()) << segment.master().trouble(1);
  EXPECT_EQ(segment.master().counters(1).losses, 1u);
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
  EXPECT_EQ(segment.master().counters().scans, 1u);
}

// The OR of all states and the working counter are the same before and after: it is asked ten times a second.
TEST(MasterFaults, ARobotThatLeavesOpUnderTheErrorOfAnotherIsSeen) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.device(0).faults().refuse_state = 0x001B;
  segment.device(0).raise_al_error(0x001B, segment.now());
  ASSERT_TRUE(segment.run(1s, [&] { return segment.master().station(0).phase() == Station::Phase::kPausing; }));
  segment.run(10ms);
  segment.device(1).esc().set_al_status(static_cast<std::uint16_t>(AlState::kSafeop), 0);
  segment.run(150ms);
  EXPECT_EQ(segment.master().counters(1).losses, 1u);
  EXPECT_EQ(segment.master().counters(2).losses, 0u);
}

TEST(MasterFaults, AfterAPauseOfTheMasterTheWatchdogHasTrippedAndAllComeBack) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  segment.pause(300ms);
  EXPECT_EQ(segment.device(0).state(), AlState::kSafeop);
  segment.run(30ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(segment.device(i).counters().watchdog_expiries, 1u);
}

// It once took its own pause for a pulled cable, and brought all robots up again from INIT.
TEST(MasterFaults, APauseOfTheMasterIsNotTakenForSilenceOfTheRobots) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  const auto mails = segment.device(2).counters().mails;
  segment.pause(300ms);
  segment.every_cycle = [](Segment& s) { EXPECT_THAT(s.master().trouble(2), Not(HasSubstr("no device answers"))); };
  segment.run(30ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  EXPECT_EQ(segment.master().counters().scans, 1u);
  EXPECT_EQ(segment.device(2).counters().mails, mails);  // not configured anew
}

TEST(MasterFaults, ACutCableTakesTheRobotsBehindItAndGivesThemBack) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  segment.chain().cut(2);
  segment.run(2s);
  EXPECT_TRUE(segment.master().station(1).operational());
  EXPECT_EQ(segment.master().station(2).phase(), Station::Phase::kAbsent);
  EXPECT_EQ(segment.master().trouble(2),
            "position 2 is not there: 2 devices answer; check cable and power behind position 1");
  expect_no_missed_cycle(segment, 3, 2);
  segment.chain().heal(2);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(2);
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
  EXPECT_EQ(segment.master().counters(2).losses, 1u);
}

TEST(MasterFaults, APowerCycledRobotGetsItsAddressAgainAndItsNeighboursMissNothing) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.run(10ms);
  expect_no_missed_cycle(segment, 3, 1);
  segment.device(1).power_cycle(segment.now());
  segment.run(50ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
  EXPECT_EQ(segment.device(1).esc().station_address(), 0x1002);
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
  EXPECT_EQ(segment.master().counters(2).losses, 0u);
}

TEST(MasterFaults, ARobotThatLosesPowerForAWhileCutsTheChainAndAllComeBack) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.chain().set_powered(1, false);
  segment.run(1s);
  EXPECT_TRUE(segment.master().station(0).operational());
  EXPECT_THAT(segment.master().trouble(1), HasSubstr("1 device answers; check cable and power behind position 0"));
  segment.device(1).power_cycle(segment.now());
  segment.chain().set_powered(1, true);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
}

TEST(MasterFaults, NoCarrierIsSaidAtOnceAndTheRobotsComeBackWithIt) {
  Segment segment(settings_for(2));
  ASSERT_TRUE(segment.start());
  segment.set_link(Master::Port::kPrimary, false);
  EXPECT_EQ(segment.master().trouble(0), "no carrier");
  EXPECT_FALSE(segment.master().station(0).operational());
  segment.run(500ms);
  const auto sent = segment.master().counters().sent_frames;
  segment.run(10ms);
  EXPECT_EQ(segment.master().counters().sent_frames, sent);
  segment.set_link(Master::Port::kPrimary, true);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
}

// It once showed the last second with a cable for as long as there was none.
TEST(MasterFaults, WithoutCarrierThereAreNoRoundTrips) {
  Segment segment(settings_for(1));
  ASSERT_TRUE(segment.start());
  segment.fate = [](std::size_t) { return Fate{.held_up = 300us}; };
  segment.run(3s);
  EXPECT_EQ(segment.master().round_trip().facts().p50, 300);
  segment.set_link(Master::Port::kPrimary, false);
  segment.run(3s);
  EXPECT_EQ(segment.master().round_trip().facts().p50, 0);
  EXPECT_EQ(segment.master().round_trip().facts().max, 0);
}

TEST(MasterFaults, TheCableOfTheMasterPulledIsSilenceAndHealsToo) {
  Segment segment(settings_for(2));
  ASSERT_TRUE(segment.start());
  segment.chain().cut(0);
  segment.run(300ms);
  EXPECT_EQ(segment.master().trouble(1), "no device answers; check the cable to the first robot and its power");
  EXPECT_FALSE(segment.master().station(1).operational());
  segment.chain().heal(0);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
}

TEST(MasterFaults, TheDevicesOwnErrorCountersAreSummedUp) {
  Segment segment(settings_for(2));
  ASSERT_TRUE(segment.start());
  segment.run(1500ms);
  for (int i = 0; i < 100; ++i) segment.device(0).esc().count_invalid_frame(0);
  segment.run(1500ms);
  EXPECT_EQ(segment.master().counters(0).invalid_frames[0], 100u);
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 100; ++i) segment.device(0).esc().count_invalid_frame(0);
    segment.run(1500ms);
  }
  EXPECT_EQ(segment.master().counters(0).invalid_frames[0], 400u) << "they stop at 255 and are cleared before";
}

TEST(MasterFaults, CloseBringsAllToInitAndProcessDataGoesOnUntilThen) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.master().close(segment.now());
  EXPECT_TRUE(segment.run(2s, [&] { return segment.master().closed(); }));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(segment.device(i).state(), AlState::kInit);
    EXPECT_EQ(segment.device(i).counters().watchdog_expiries, 0u);
    EXPECT_EQ(segment.master().counters(i).losses, 0u);
  }
}

TEST(MasterFaults, CloseWithRobotsThatWereNeverFoundIsDoneAtOnce) {
  Segment segment(settings_for(2), std::vector<DeviceSettings>(1));
  segment.run(1s);
  segment.master().close(segment.now());
  EXPECT_TRUE(segment.run(2s, [&] { return segment.master().closed(); }));
  EXPECT_EQ(segment.device(0).state(), AlState::kInit);
}

}  // namespace
}  // namespace meca::ethercat::test
