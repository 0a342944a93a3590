// The model behind the adapter: what reaches it, when, and what it does when its host is gone.
#include "sim/meca_sim/ethernet_ip_robot.hpp"

#include <gtest/gtest.h>

#include "tests/unit/meca_sim/cell.hpp"

namespace meca::sim {
namespace {

using namespace std::chrono_literals;
using test::Cell;

constexpr std::uint32_t kMoveJoints = 1, kMoveJointsVel = 21;

std::uint64_t executed(const Cell& cell) { return cell.robot.robot().journal().count(Outcome::kExecuted); }

TEST(EthernetIpRobot, ExchangesImagesWithItsHost) {
  Cell cell;
  ASSERT_TRUE(cell.make_ready());
  cell.command(kMoveJoints, {10, 0, 0, 0, 0, 0});
  ASSERT_TRUE(cell.until([&] { return executed(cell) == 1; }));
  cell.run(20ms);
  EXPECT_FLOAT_EQ(cell.inputs().target_joint_set.joints[0], 10);
  EXPECT_EQ(cell.inputs().motion_status.move_id, 1);
  EXPECT_EQ(cell.robot.robot().violations().size(), 0u);
}

TEST(EthernetIpRobot, LivesInRealTimeWithoutAHost) {
  Cell cell;
  const auto before = cell.robot.robot().inputs().robot_timestamp;
  cell.run(1s);
  const auto after = cell.robot.robot().inputs().robot_timestamp;
  const auto micros = [](const auto& t) { return std::int64_t{t.seconds} * 1'000'000 + t.microseconds; };
  EXPECT_NEAR(static_cast<double>(micros(after) - micros(before)), 1e6, 1e3);
}

TEST(EthernetIpRobot, DoesNotApplyIdleOutputs) {
  Cell cell;
  cell.run_bit = false;
  cell.outputs.robot_control.activate = true;
  ASSERT_TRUE(cell.connect());
  cell.run(200ms);
  EXPECT_FALSE(cell.inputs().robot_status.activated);
  EXPECT_GT(cell.robot.adapter().counters().idle, 10u);
  cell.run_bit = true;
  EXPECT_TRUE(cell.until([&] { return cell.inputs().robot_status.activated; }, 1s));
}

TEST(EthernetIpRobot, TakesEveryImageOfABunch) {
  Cell cell;
  ASSERT_TRUE(cell.make_ready());
  // Three commands within one millisecond, as after a hiccup of the network: the host's own packets, made by hand.
  for (int i = 0; i < 3; ++i) {
    cell.command(kMoveJoints, {static_cast<float>(i + 1), 0, 0, 0, 0, 0});
    image::OutputBytes bytes{};
    image::encode_outputs(cell.outputs, {}, bytes);
    const auto datagram = cell.host.produce(bytes, true, *cell.host.next_send());
    ASSERT_TRUE(datagram);
    cell.robot.io_received({Cell::kHost, 2222}, datagram->bytes, cell.now);
  }
  EXPECT_TRUE(cell.until([&] { return executed(cell) == 3; }, 10s));
}

TEST(EthernetIpRobot, StopsOnItsPathWhenItsHostIsGoneAndWaitsToBeResumed) {
  Cell cell;
  ASSERT_TRUE(cell.make_ready());
  cell.command(kMoveJoints, {90, 0, 0, 0, 0, 0});
  ASSERT_TRUE(cell.until([&] { return cell.inputs().target_joint_set.joints[0] > 5; }, 10s));
  cell.host_lives = false;
  ASSERT_TRUE(cell.until([&] { return cell.robot.adapter().counters().timeouts == 1; }, 1s));
  cell.run(500ms);
  EXPECT_EQ(cell.robot.robot().stops().connection_dropped, StopSignal::kPresent);
  const float stopped_at = cell.robot.robot().inputs().target_joint_set.joints[0];
  EXPECT_LT(stopped_at, 80);

  cell.host_lives = true;
  cell.outputs.motion_control.set_point = false;
  ASSERT_TRUE(cell.until([&] { return cell.inputs().safety_status.resettable.connection_dropped; }));
  cell.run(500ms);
  EXPECT_FLOAT_EQ(cell.inputs().target_joint_set.joints[0], stopped_at);
  EXPECT_TRUE(cell.inputs().motion_status.paused);
  cell.outputs.motion_control.resume_motion = true;
  ASSERT_TRUE(cell.until([&] { return !cell.inputs().safety_status.stop.connection_dropped; }, 1s));
  cell.run(500ms);
  EXPECT_FLOAT_EQ(cell.inputs().target_joint_set.joints[0], stopped_at) << "what was queued is gone";
}

TEST(EthernetIpRobot, StopsAlsoWhenItsHostSaysGoodBye) {
  Cell cell;
  ASSERT_TRUE(cell.make_ready());
  EXPECT_EQ(cell.robot.robot().stops().connection_dropped, StopSignal::kReset);
  cell.host.close(cell.now);
  ASSERT_TRUE(cell.until([&] { return cell.robot.adapter().counters().closes == 1; }, 1s));
  cell.run(1ms);
  EXPECT_EQ(cell.robot.robot().stops().connection_dropped, StopSignal::kPresent);
}

TEST(EthernetIpRobot, FinishesItsQueueWithoutAHostWhenItIsToldTo) {
  Cell cell(ConnectionLoss::kContinue);
  ASSERT_TRUE(cell.make_ready());
  cell.command(kMoveJoints, {90, 0, 0, 0, 0, 0});
  ASSERT_TRUE(cell.until([&] { return cell.inputs().target_joint_set.joints[0] > 5; }, 10s));
  cell.host_lives = false;
  EXPECT_TRUE(cell.until([&] { return executed(cell) == 1; }, 10s));
  EXPECT_EQ(cell.robot.robot().stops().connection_dropped, StopSignal::kReset);
}

TEST(EthernetIpRobot, ForgetsItsHostWhenItStartsUp) {
  Cell cell;
  ASSERT_TRUE(cell.make_ready());
  cell.robot.robot().power_cycle();
  cell.run(10ms);
  EXPECT_FALSE(cell.robot.present());
  EXPECT_FALSE(cell.robot.adapter().connected());
  EXPECT_EQ(cell.robot.adapter().originator(), 0u);
  ASSERT_TRUE(cell.until([&] { return cell.robot.present(); }, 1s));
  ASSERT_TRUE(cell.until([&] { return cell.host.counters().opens == 2 && cell.host.running(); }));
  EXPECT_EQ(cell.robot.robot().stops().connection_dropped, StopSignal::kReset) << "it has no memory of a loss";
  EXPECT_EQ(cell.robot.adapter().originator(), Cell::kHost);
}

TEST(EthernetIpRobot, WithoutPowerIsAwayAndStartsUpWhenItHasItAgain) {
  Cell cell;
  ASSERT_TRUE(cell.make_ready());
  cell.robot.faults().without_power = true;
  cell.run(10s);
  EXPECT_FALSE(cell.robot.present());
  cell.robot.faults().without_power = false;
  ASSERT_TRUE(cell.until([&] { return cell.robot.present(); }, 1s));
  EXPECT_FALSE(cell.robot.robot().inputs().robot_status.activated);
  EXPECT_TRUE(cell.connect());
}

TEST(EthernetIpRobot, UnpluggedHearsAndSaysNothing) {
  Cell cell;
  ASSERT_TRUE(cell.connect());
  cell.robot.faults().unplugged = true;
  cell.run(10ms);
  const auto before = cell.robot.adapter().counters().consumed;
  const auto received = cell.host.counters().received;
  cell.run(100ms);
  EXPECT_EQ(cell.robot.adapter().counters().consumed, before);
  EXPECT_EQ(cell.host.counters().received, received);
  ASSERT_TRUE(cell.until([&] { return cell.host.counters().watchdog_trips == 1; }));
  cell.run(10s);
  EXPECT_FALSE(cell.host.running());
  cell.robot.faults().unplugged = false;
  EXPECT_TRUE(cell.connect());
}

TEST(EthernetIpRobot, FrozenStillTakesConnectionsButHandlesNoIo) {
  Cell cell;
  ASSERT_TRUE(cell.connect());
  cell.robot.faults().frozen = true;
  ASSERT_TRUE(cell.until([&] { return cell.host.counters().opens == 2; }));
  cell.run(1s);
  EXPECT_FALSE(cell.host.running());
  cell.robot.faults().frozen = false;
  EXPECT_TRUE(cell.connect());
}

TEST(EthernetIpRobot, WakesForItsModelAndForItsPackets) {
  Cell cell;
  EXPECT_EQ(cell.robot.next_event(), Cell::kBegin + 1ms);
  ASSERT_TRUE(cell.connect());
  for (int i = 0; i < 400; ++i) {
    cell.run(250us);
    EXPECT_GE(cell.robot.next_event(), cell.now - 250us) << "an event that is never handled keeps a thread busy";
    EXPECT_LE(cell.robot.next_event(), cell.now + 1ms);
  }
}

TEST(EthernetIpRobot, LivesATenthOfASecondOfALongSilence) {
  Cell cell;
  cell.run(10ms);
  const auto micros = [&] {
    const auto& t = cell.robot.robot().inputs().robot_timestamp;
    return std::int64_t{t.seconds} * 1'000'000 + t.microseconds;
  };
  const auto before = micros();
  cell.robot.advance(cell.now + 1h);
  EXPECT_NEAR(static_cast<double>(micros() - before), 100e3, 2e3);
}

TEST(EthernetIpRobot, VelocityEndsWithItsHost) {
  Cell cell;
  ASSERT_TRUE(cell.make_ready());
  cell.outputs.motion_control.set_point = true;
  cell.outputs.motion_control.move_id = 0;
  cell.outputs.motion_command = {kMoveJointsVel, {10, 0, 0, 0, 0, 0}};
  ASSERT_TRUE(cell.until([&] { return cell.inputs().target_joint_set.joints[0] > 1; }, 5s));
  cell.host_lives = false;
  cell.run(1s);
  const float there = cell.robot.robot().inputs().target_joint_set.joints[0];
  cell.run(1s);
  EXPECT_FLOAT_EQ(cell.robot.robot().inputs().target_joint_set.joints[0], there);
}

}  // namespace
}  // namespace meca::sim
