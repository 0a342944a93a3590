// Faults of a segment, and what the bridge's master makes of each: what it sees, who else is touched, and that
// everything works again once the fault is over.
#include "sim/meca_sim/ethercat_segment.hpp"

#include <gmock/gmock.h>

#include "tests/unit/meca_sim/ethercat_cell.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using test::EthercatCell;
using testing::HasSubstr;

std::string trouble(const EthercatCell& cell, std::size_t robot) { return std::string(cell.master.trouble(robot)); }

// Nobody but those that are named may have left OP.
void expect_losses(EthercatCell& cell, std::vector<std::uint64_t> losses) {
  for (std::size_t i = 0; i < losses.size(); ++i) {
    EXPECT_EQ(cell.segment.robot(i).device().counters().watchdog_expiries, losses[i]) << "robot " << i;
  }
}

TEST(EthercatSegment, EndsAtACutCableUntilItIsHealed) {
  EthercatCell cell({.robots = 3});
  ASSERT_TRUE(cell.connect());
  cell.faults(1).cut = true;
  ASSERT_TRUE(cell.until([&] { return !cell.operational(1) && !cell.operational(2); }, 1s));
  cell.run(500ms);
  EXPECT_TRUE(cell.operational(0));
  EXPECT_THAT(trouble(cell, 1), HasSubstr("1 device answers"));
  cell.faults(1).cut = false;
  ASSERT_TRUE(cell.connect()) << trouble(cell, 1);
  expect_losses(cell, {0, 1, 1});
}

TEST(EthercatSegment, LosesThoseBehindAnUnpluggedRobotInALine) {
  EthercatCell cell({.robots = 3});
  ASSERT_TRUE(cell.connect());
  cell.faults(1).unplugged = true;
  ASSERT_TRUE(cell.until([&] { return !cell.operational(1) && !cell.operational(2); }, 1s));
  EXPECT_TRUE(cell.operational(0));
  cell.faults(1).unplugged = false;
  EXPECT_TRUE(cell.connect()) << trouble(cell, 1);
}

TEST(EthercatSegment, LosesNobodyAtACutCableOfARing) {
  EthercatCell cell({.robots = 3, .ring = true});
  ASSERT_TRUE(cell.connect());
  for (std::size_t k = 0; k < 3; ++k) {
    cell.faults(k).cut = true;
    cell.run(500ms);
    cell.faults(k).cut = false;
    cell.run(500ms);
    EXPECT_TRUE(cell.operational(0) && cell.operational(1) && cell.operational(2)) << "cable before robot " << k;
  }
  expect_losses(cell, {0, 0, 0});
}

TEST(EthercatSegment, LosesNobodyWhenTheCableBackToTheMasterIsCut) {
  EthercatCell cell({.robots = 2, .ring = true});
  ASSERT_TRUE(cell.connect());
  cell.faults(1).cut_behind = true;
  cell.run(500ms);
  EXPECT_TRUE(cell.master.ring_open());
  EXPECT_TRUE(cell.operational(0) && cell.operational(1));
  cell.faults(1).cut_behind = false;
  cell.run(500ms);
  EXPECT_FALSE(cell.master.ring_open());
  expect_losses(cell, {0, 0});
}

TEST(EthercatSegment, EndsBehindARobotWhoseCableBehindIsCut) {
  EthercatCell cell({.robots = 2});
  ASSERT_TRUE(cell.connect());
  cell.faults(0).cut_behind = true;
  ASSERT_TRUE(cell.until([&] { return !cell.operational(1); }, 1s));
  EXPECT_TRUE(cell.operational(0));
  cell.faults(0).cut_behind = false;
  EXPECT_TRUE(cell.connect()) << trouble(cell, 1);
}

TEST(EthercatSegment, LosesOnlyTheRobotThatIsUnpluggedFromARing) {
  EthercatCell cell({.robots = 3, .ring = true});
  ASSERT_TRUE(cell.connect());
  cell.faults(1).unplugged = true;
  ASSERT_TRUE(cell.until([&] { return !cell.operational(1); }, 1s));
  cell.run(500ms);
  EXPECT_TRUE(cell.operational(0) && cell.operational(2));
  cell.faults(1).unplugged = false;
  EXPECT_TRUE(cell.connect()) << trouble(cell, 1);
  expect_losses(cell, {0, 1, 0});
}

TEST(EthercatSegment, KnowsOfACableWithoutCarrier) {
  EthercatCell cell({.robots = 2, .ring = true});
  ASSERT_TRUE(cell.connect());
  cell.segment.set_carrier(EthercatSegment::Side::kSecondary, false);
  cell.run(500ms);
  EXPECT_TRUE(cell.operational(0) && cell.operational(1)) << "frames turn round at the open end";
  cell.segment.set_carrier(EthercatSegment::Side::kSecondary, true);
  cell.run(500ms);
  expect_losses(cell, {0, 0});
}

TEST(EthercatSegment, EndsAtARobotWithoutPowerWhichStartsUpAfterwards) {
  EthercatCell cell({.robots = 3});
  ASSERT_TRUE(cell.make_ready());
  cell.faults(1).without_power = true;
  ASSERT_TRUE(cell.until([&] { return !cell.operational(1) && !cell.operational(2); }, 1s));
  cell.run(2s);
  EXPECT_FALSE(cell.segment.robot(1).powered()) << "longer than it takes to start up";
  EXPECT_TRUE(cell.operational(0));
  for (auto& outputs : cell.outputs) outputs.robot_control = {};
  cell.faults(1).without_power = false;
  ASSERT_TRUE(cell.connect()) << trouble(cell, 1);
  cell.run(20ms);
  EXPECT_FALSE(cell.inputs(1).robot_status.activated);
  EXPECT_TRUE(cell.inputs(0).robot_status.homed || !cell.inputs(0).robot_status.activated);
}

TEST(EthercatSegment, LosesFramesAsItIsTold) {
  EthercatCell cell({.robots = 2});
  ASSERT_TRUE(cell.connect());
  const auto lost = [&] { return cell.master.counters().lost_frames; };
  ASSERT_EQ(lost(), 0u);
  cell.faults(0).lose_next = 3;
  cell.run(100ms);
  EXPECT_EQ(lost(), 3u);
  EXPECT_EQ(cell.faults(0).lose_next, 0u);
  cell.faults(1).lose_every = 100;
  cell.run(1s);
  EXPECT_GE(lost(), 3u + 9u) << "a thousand cyclic frames and some of service; the last is still waited for";
  cell.faults(1).lose_every = 0;
  cell.run(10ms);
  const auto before = lost();
  cell.run(1s);
  EXPECT_EQ(lost(), before);
  EXPECT_TRUE(cell.operational(0) && cell.operational(1)) << "what a lost frame may cost is a cycle";
}

TEST(EthercatSegment, HoldsFramesBackWithoutLosingThem) {
  EthercatCell cell;
  ASSERT_TRUE(cell.connect());
  const auto before = cell.master.counters();
  cell.faults().late = 1500us;
  cell.run(1s);
  cell.faults().late = {};
  cell.run(100ms);
  EXPECT_GT(cell.master.counters().late_frames, before.late_frames + 900);
  EXPECT_EQ(cell.master.counters().lost_frames, before.lost_frames);
  EXPECT_EQ(cell.master.counters().unexpected_frames, before.unexpected_frames);
  EXPECT_TRUE(cell.operational(0));
}

TEST(EthercatSegment, SendsFramesTwiceOfWhichTheSecondIsDropped) {
  EthercatCell cell;
  ASSERT_TRUE(cell.connect());
  const auto before = cell.master.counters();
  const std::uint64_t images = cell.master.counters(0).images;
  cell.faults().duplicate = true;
  cell.run(100ms);
  cell.faults().duplicate = false;
  cell.run(100ms);
  EXPECT_GE(cell.master.counters().unexpected_frames, before.unexpected_frames + 100);
  EXPECT_EQ(cell.master.counters().lost_frames, before.lost_frames);
  EXPECT_NEAR(static_cast<double>(cell.master.counters(0).images - images), 200, 2) << "each image once";
  EXPECT_TRUE(cell.operational(0));
}

TEST(EthercatSegment, SendsHalfFramesThatAreNoReplies) {
  EthercatCell cell;
  ASSERT_TRUE(cell.connect());
  const auto before = cell.master.counters();
  cell.faults().corrupt = true;
  cell.run(20ms);
  EXPECT_GE(cell.master.counters().malformed_frames, before.malformed_frames + 19);
  cell.faults().corrupt = false;
  EXPECT_TRUE(cell.connect()) << trouble(cell, 0);
}

TEST(EthercatSegment, HasAForeignDeviceInThePlaceOfARobotThatStartsUpWhenItIsBack) {
  EthercatCell cell({.robots = 3});
  ASSERT_TRUE(cell.make_ready());
  cell.faults(1).foreign = true;
  ASSERT_TRUE(cell.until([&] { return trouble(cell, 1).find("vendor 0x00000002") != std::string::npos; }, 5s))
      << trouble(cell, 1);
  cell.run(2s);
  EXPECT_TRUE(cell.operational(0) && cell.operational(2)) << "those behind it are reached through it";
  for (auto& outputs : cell.outputs) outputs.robot_control = {};
  cell.faults(1).foreign = false;
  cell.run(10ms);
  EXPECT_FALSE(cell.segment.robot(1).powered()) << "it starts up";
  ASSERT_TRUE(cell.connect()) << trouble(cell, 1);
  EXPECT_FALSE(cell.model(1).inputs().robot_status.activated);
  EXPECT_EQ(cell.model(1).stops().connection_dropped, StopSignal::kReset) << "it has no memory of a loss";
}

TEST(EthercatSegment, OfADriftingClockShowsTheDifferenceUntilItIsOver) {
  EthercatCell cell({.robots = 3, .dc = true});
  ASSERT_TRUE(cell.connect());
  const auto difference = [&](std::size_t i) { return cell.master.counters(i).dc_difference_ns; };
  cell.run(1s);
  ASSERT_LT(std::abs(difference(1)), 100);
  cell.faults(1).clock_drift = 1000;
  cell.run(1s);
  EXPECT_GT(difference(1), 500) << "more than its loop takes up";
  EXPECT_LT(std::abs(difference(2)), 100);
  cell.faults(1).clock_drift = 0;
  cell.run(1s);
  EXPECT_LT(std::abs(difference(1)), 100);
  cell.faults(0).clock_drift = 1000;
  cell.run(1s);
  EXPECT_LT(difference(1), -500) << "all others are behind their reference";
  EXPECT_LT(difference(2), -500);
  expect_losses(cell, {0, 0, 0});
}

TEST(EthercatSegment, OfFrozenRobotsGoesOnWithOldInputs) {
  EthercatCell cell({.robots = 2});
  ASSERT_TRUE(cell.make_ready());
  cell.faults(0).frozen = true;
  cell.run(10ms);
  const auto before = cell.inputs(0).robot_timestamp, neighbour = cell.inputs(1).robot_timestamp;
  cell.command(0, 1, {10, 0, 0, 0, 0, 0});
  cell.run(1s);
  EXPECT_EQ(cell.inputs(0).robot_timestamp, before);
  EXPECT_NE(cell.inputs(1).robot_timestamp, neighbour);
  EXPECT_EQ(cell.model(0).journal().count(Outcome::kExecuted), 0u);
  EXPECT_TRUE(cell.operational(0));
  cell.faults(0).frozen = false;
  EXPECT_TRUE(cell.until([&] { return cell.model(0).journal().count(Outcome::kExecuted) == 1; }, 5s));
}

TEST(EthercatSegment, MiscountsTheProcessDataOfOneRobot) {
  EthercatCell cell({.robots = 2});
  ASSERT_TRUE(cell.make_ready());
  const auto images = [&](std::size_t i) { return cell.master.counters(i).images; };
  cell.faults(0).working_counter = -1;
  cell.run(10ms);
  const std::uint64_t before = images(0), neighbour = images(1);
  cell.run(50ms);
  EXPECT_EQ(images(0), before) << "inputs of a wrong count are not taken";
  EXPECT_GE(images(1), neighbour + 49);
  EXPECT_GT(cell.master.counters(0).working_counter_misses, 40u);
  cell.faults(0).working_counter = 0;
  EXPECT_TRUE(cell.until([&] { return images(0) > before + 10; }));
}

TEST(EthercatSegment, RefusesStatesWithACodeThatTheMasterNames) {
  EthercatCell cell;
  cell.faults().refuse_state = 0x0025;
  ASSERT_TRUE(cell.until([&] { return trouble(cell, 0).find("0x0025") != std::string::npos; })) << trouble(cell, 0);
  EXPECT_FALSE(cell.operational(0));
  cell.faults().refuse_state.reset();
  EXPECT_TRUE(cell.connect()) << trouble(cell, 0);
}

TEST(EthercatSegment, RaisesAnAlErrorFromWhichTheMasterRecovers) {
  EthercatCell cell({.robots = 2});
  ASSERT_TRUE(cell.connect());
  ++cell.faults(1).events.al_errors;
  cell.faults(1).events.al_error = 0x001A;
  ASSERT_TRUE(cell.until([&] { return cell.segment.robot(1).device().state() == ethercat::AlState::kSafeop; }, 1s));
  EXPECT_EQ(cell.model(1).stops().connection_dropped, StopSignal::kPresent);
  ASSERT_TRUE(cell.until([&] { return cell.master.counters(1).losses == 1; }, 1s));
  EXPECT_TRUE(cell.connect()) << trouble(cell, 1);
  EXPECT_EQ(cell.master.counters(0).losses, 0u);
}

TEST(EthercatSegment, SendsAnEmergency) {
  EthercatCell cell;
  ASSERT_TRUE(cell.connect());
  ++cell.faults().events.emergencies;
  cell.faults().events.emergency = 0xFF00;
  EXPECT_TRUE(cell.until([&] { return cell.master.station(0).counters().emergencies == 1; }, 2s));
  EXPECT_TRUE(cell.operational(0));
}

TEST(EthercatSegment, WithAMailboxThatLosesItsMailsIsAskedForThemAgain) {
  EthercatCell cell;
  cell.faults().lose_mails = true;
  cell.run(1s);
  EXPECT_FALSE(cell.operational(0));
  cell.faults().lose_mails = false;
  EXPECT_TRUE(cell.connect()) << trouble(cell, 0);
}

TEST(EthercatSegment, WithADeadMailboxNeverComesToOp) {
  EthercatCell cell;
  cell.faults().no_mailbox = true;
  cell.run(10s);
  EXPECT_FALSE(cell.operational(0));
  EXPECT_THAT(trouble(cell, 0), HasSubstr("does not answer an SDO"));
  cell.faults().no_mailbox = false;
  EXPECT_TRUE(cell.connect()) << trouble(cell, 0);
}

TEST(EthercatSegment, AnswersNothingToWhatIsNoFrameOfEthercat) {
  EthercatCell cell;
  std::array<std::byte, 60> arp{};
  arp[12] = std::byte{0x08};
  arp[13] = std::byte{0x06};
  EXPECT_FALSE(cell.segment.process(EthercatSegment::Side::kPrimary, arp, cell.now));
  std::vector<std::byte> jumbo(2000);
  jumbo[12] = std::byte{0x88};
  jumbo[13] = std::byte{0xA4};
  EXPECT_FALSE(cell.segment.process(EthercatSegment::Side::kPrimary, jumbo, cell.now));
}

}  // namespace
}  // namespace meca::sim
