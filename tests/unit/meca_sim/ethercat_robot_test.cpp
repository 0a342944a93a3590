// The models behind the devices of a segment: what reaches them, when, and what they do when their master is gone.
#include <gtest/gtest.h>

#include "tests/unit/meca_sim/ethercat_cell.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using test::EthercatCell;

constexpr std::uint32_t kMoveJoints = 1, kMoveJointsVel = 21;

std::uint64_t executed(EthercatCell& cell, std::size_t robot = 0) {
  return cell.model(robot).journal().count(Outcome::kExecuted);
}
std::int64_t robot_time_us(const image::Inputs& inputs) {
  const auto& t = inputs.robot_timestamp;
  return std::int64_t{t.seconds} * 1'000'000 + t.microseconds;
}

TEST(EthercatRobot, ExchangesImagesWithItsMaster) {
  EthercatCell cell;
  ASSERT_TRUE(cell.make_ready()) << cell.master.trouble(0);
  cell.command(0, kMoveJoints, {10, 0, 0, 0, 0, 0});
  ASSERT_TRUE(cell.until([&] { return executed(cell) == 1; }));
  cell.run(20ms);
  EXPECT_FLOAT_EQ(cell.inputs().target_joint_set.joints[0], 10);
  EXPECT_EQ(cell.inputs().motion_status.move_id, 1);
  EXPECT_EQ(cell.model().violations().size(), 0u);
}

TEST(EthercatRobot, MovesItsNeighboursNot) {
  EthercatCell cell({.robots = 3});
  ASSERT_TRUE(cell.make_ready());
  cell.command(1, kMoveJoints, {10, 0, 0, 0, 0, 0});
  ASSERT_TRUE(cell.until([&] { return executed(cell, 1) == 1; }));
  cell.run(20ms);
  EXPECT_EQ(cell.inputs(0).target_joint_set.joints[0], 0);
  EXPECT_FLOAT_EQ(cell.inputs(1).target_joint_set.joints[0], 10);
  EXPECT_EQ(cell.inputs(2).target_joint_set.joints[0], 0);
}

TEST(EthercatRobot, LivesInRealTimeWithoutAMaster) {
  EthercatCell cell;
  cell.master_lives = false;
  const auto before = robot_time_us(cell.model().inputs());
  cell.run(1s);
  EXPECT_NEAR(static_cast<double>(robot_time_us(cell.model().inputs()) - before), 1e6, 2e3);
}

class AtACycle : public testing::TestWithParam<Time> {};

TEST_P(AtACycle, LivesInRealTimeAndAnswersAnImageInTheNextOne) {
  EthercatCell cell({.cycle = GetParam()});
  ASSERT_TRUE(cell.make_ready()) << cell.master.trouble(0);
  const auto before = robot_time_us(cell.inputs());
  cell.run(1s);
  EXPECT_NEAR(static_cast<double>(robot_time_us(cell.inputs()) - before), 1e6, 25e3);
  cell.command(0, kMoveJoints, {1, 0, 0, 0, 0, 0});
  cell.run(2 * GetParam());
  EXPECT_EQ(cell.inputs().motion_status.move_id, 1);
  EXPECT_EQ(cell.model().violations().size(), 0u);
}

INSTANTIATE_TEST_SUITE_P(OfItsMaster, AtACycle, testing::Values(Time(500us), Time(1ms), Time(2ms), Time(10ms)));

TEST(EthercatRobot, StopsOnItsPathWhenItsMasterIsGoneAndWaitsToBeResumed) {
  EthercatCell cell;
  ASSERT_TRUE(cell.make_ready());
  cell.command(0, kMoveJoints, {90, 0, 0, 0, 0, 0});
  ASSERT_TRUE(cell.until([&] { return cell.inputs().target_joint_set.joints[0] > 5; }, 10s));
  cell.master_lives = false;
  cell.run(1s);
  EXPECT_EQ(cell.segment.robot(0).device().counters().watchdog_expiries, 1u);
  EXPECT_EQ(cell.model().stops().connection_dropped, StopSignal::kPresent);
  const float stopped_at = cell.model().inputs().target_joint_set.joints[0];
  EXPECT_LT(stopped_at, 80);

  cell.master_lives = true;
  cell.outputs[0].motion_control.set_point = false;
  ASSERT_TRUE(cell.until([&] { return cell.inputs().safety_status.resettable.connection_dropped; }));
  cell.run(500ms);
  EXPECT_FLOAT_EQ(cell.inputs().target_joint_set.joints[0], stopped_at);
  EXPECT_TRUE(cell.inputs().motion_status.paused);
  cell.outputs[0].motion_control.resume_motion = true;
  ASSERT_TRUE(cell.until([&] { return !cell.inputs().safety_status.stop.connection_dropped; }, 1s));
  cell.run(500ms);
  EXPECT_FLOAT_EQ(cell.inputs().target_joint_set.joints[0], stopped_at) << "what was queued is gone";
}

TEST(EthercatRobot, StopsAlsoWhenItsMasterSaysGoodBye) {
  EthercatCell cell;
  ASSERT_TRUE(cell.make_ready());
  EXPECT_EQ(cell.model().stops().connection_dropped, StopSignal::kReset);
  cell.master.close(cell.now);
  ASSERT_TRUE(cell.until([&] { return cell.master.closed(); }, 1s));
  cell.run(10ms);
  EXPECT_EQ(cell.segment.robot(0).device().state(), ethercat::AlState::kInit);
  EXPECT_EQ(cell.model().stops().connection_dropped, StopSignal::kPresent);
}

TEST(EthercatRobot, FinishesItsQueueWithoutAMasterWhenItIsToldTo) {
  EthercatCell cell({.on_loss = ConnectionLoss::kContinue});
  ASSERT_TRUE(cell.make_ready());
  cell.command(0, kMoveJoints, {90, 0, 0, 0, 0, 0});
  ASSERT_TRUE(cell.until([&] { return cell.inputs().target_joint_set.joints[0] > 5; }, 10s));
  cell.master_lives = false;
  EXPECT_TRUE(cell.until([&] { return executed(cell) == 1; }, 10s));
  EXPECT_EQ(cell.model().stops().connection_dropped, StopSignal::kReset);
}

TEST(EthercatRobot, ForgetsItsMasterWhenItStartsUp) {
  EthercatCell cell;
  ASSERT_TRUE(cell.make_ready());
  cell.segment.robot(0).robot().power_cycle();
  cell.run(10ms);
  EXPECT_FALSE(cell.segment.robot(0).powered());
  EXPECT_EQ(cell.segment.robot(0).device().esc().station_address(), 0);
  ASSERT_TRUE(cell.until([&] { return cell.segment.robot(0).powered(); }, 1s));
  ASSERT_TRUE(cell.connect());
  EXPECT_EQ(cell.model().stops().connection_dropped, StopSignal::kReset) << "it has no memory of a loss";
}

TEST(EthercatRobot, LivesATenthOfASecondOfALongSilence) {
  EthercatCell cell;
  cell.run(10ms);
  const auto before = robot_time_us(cell.model().inputs());
  cell.segment.advance(cell.now + 1h);
  EXPECT_NEAR(static_cast<double>(robot_time_us(cell.model().inputs()) - before), 100e3, 2e3);
}

TEST(EthercatRobot, VelocityEndsWithItsMaster) {
  EthercatCell cell;
  ASSERT_TRUE(cell.make_ready());
  cell.outputs[0].motion_control.set_point = true;
  cell.outputs[0].motion_control.move_id = 0;
  cell.outputs[0].motion_command = {kMoveJointsVel, {10, 0, 0, 0, 0, 0}};
  ASSERT_TRUE(cell.until([&] { return cell.inputs().target_joint_set.joints[0] > 1; }, 5s));
  cell.master_lives = false;
  cell.run(1s);
  const float there = cell.model().inputs().target_joint_set.joints[0];
  cell.run(1s);
  EXPECT_FLOAT_EQ(cell.model().inputs().target_joint_set.joints[0], there);
}

TEST(EthercatRobot, WakesForItsModelAndItsDevice) {
  EthercatCell cell;
  EXPECT_LE(cell.segment.next_event(), EthercatCell::kBegin + 1ms);
  ASSERT_TRUE(cell.connect());
  for (int i = 0; i < 400; ++i) {
    cell.run(250us);
    EXPECT_GT(cell.segment.next_event(), cell.now - 250us) << "an event that is never handled keeps a thread busy";
    EXPECT_LE(cell.segment.next_event(), cell.now + 1ms);
  }
}

}  // namespace
}  // namespace meca::sim
