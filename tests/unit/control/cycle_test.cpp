// One robot's cycle from requests to bytes: the walk from a cold robot to a finished move, and what the bytes say
// meanwhile.
#include <random>

#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

TEST(Cycle, activates_homes_and_moves_a_cold_robot) {
  Bench b;
  b.connect();
  EXPECT_OUTCOME(b.outcome(kActivate), kCompleted, Reason::kNone);
  EXPECT_TRUE(b.robot.in.robot_status.activated);
  EXPECT_FALSE(b.out.robot_control.activate) << "the bit falls once the status bit confirms";
  EXPECT_OUTCOME(b.outcome(kHome), kCompleted, Reason::kNone);
  const auto id = b.move(30);
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
  EXPECT_EQ(b.states(id), (std::vector{kAccepted, kSent, kAcknowledged, kCompleted}));
  ASSERT_EQ(b.robot.executed.size(), 2u);
  EXPECT_EQ(b.robot.executed[0].command, 1u);
  EXPECT_EQ(b.robot.executed[0].arguments[0], 30.0f);
  EXPECT_EQ(b.robot.executed[1].command, 17u) << "the bridge's own checkpoint proves completion";
  EXPECT_EQ(b.robot.executed[1].arguments[0], 7001.0f);
  EXPECT_TRUE(b.robot.violations.empty()) << b.robot.violations.front();
}

TEST(Cycle, sends_nothing_before_it_has_seen_the_robot) {
  Bench b;
  b.link_up = true;
  b.exchange.link = LinkState::kUp;
  b.step_bridge();
  EXPECT_FALSE(b.exchange.output_valid);
  b.exchange_frames();
  b.step_bridge();
  EXPECT_TRUE(b.exchange.output_valid);
}

// What is not to command is sent all the same where a bus has no idle (EtherCAT).
TEST(Cycle, asks_nothing_of_a_robot_that_it_has_not_seen_since_the_link_went_down) {
  for (const CommandKind under_way : {kActivate, kHome, kResetError, kResumeMotion, kMotion}) {
    SCOPED_TRACE(static_cast<int>(under_way));
    Bench b;
    b.connect();
    b.robot.answers_actions = b.robot.echoes = b.robot.executes = false;
    b.robot.in.robot_status.activated = under_way != kActivate;
    b.robot.in.robot_status.homed = under_way == kMotion || under_way == kResumeMotion;
    b.robot.in.robot_status.error_code = under_way == kResetError ? 3005 : 0;
    b.robot.in.motion_status.paused = under_way == kResumeMotion;
    b.steps(5);
    under_way == kMotion ? b.move(30) : b.send(under_way);
    const auto asks = [&] {
      const image::RobotControl& r = b.out.robot_control;
      const image::MotionControl& m = b.out.motion_control;
      return r.activate || r.home || r.reset_error || r.deactivate || m.resume_motion || m.clear_motion || m.set_point;
    };
    ASSERT_TRUE(b.until(asks, 100));
    b.link_up = false;
    b.steps(2);
    EXPECT_FALSE(b.exchange.output_valid);
    EXPECT_FALSE(asks());
    b.exchange.link = LinkState::kUp;
    b.step_bridge();
    EXPECT_FALSE(asks()) << "the link is back, and no image yet";
  }
}

// It goes on by itself where Pause does not stand; which firmware it is, EtherCAT knows before the first image.
TEST(Cycle, holds_a_firmware_9_robot_that_it_has_not_seen_yet) {
  for (const std::uint16_t major : {9, 10, 11}) {
    Bench b({}, static_cast<Layout>(major - 9));
    b.exchange.identity = {major, 3, 0, 1};
    b.step_bridge();
    EXPECT_EQ(b.out.motion_control.pause_motion, major == 9) << major;
    b.link_up = true;
    b.steps(3);
    EXPECT_FALSE(b.out.motion_control.pause_motion) << "it stands still and is off: nothing to hold";
  }
}

TEST(Cycle, starts_the_image_from_what_the_robot_shows) {
  Bench b;
  b.robot.ready();
  b.robot.in.motion_status.move_id = 4711;
  b.robot.in.motion_status.paused = true;
  b.robot.in.robot_status.recovery_mode = true;
  b.link_up = true;
  b.step();
  // The tiny robot's first step had no image to take the mode from.
  b.robot.in.robot_status.recovery_mode = true;
  image::encode_inputs(b.robot.in, {b.layout}, b.exchange.input);
  b.step_bridge();
  EXPECT_EQ(b.out.motion_control.move_id, 4711);
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_TRUE(b.out.motion_control.pause_motion) << "dropping Pause would start a 9.x robot";
  EXPECT_TRUE(b.out.robot_control.recovery_mode);
  EXPECT_FALSE(b.out.motion_control.resume_motion);
}

TEST(Cycle, says_unknown_until_the_firmware_is_known_and_claims_no_safety_status) {
  Bench b;
  b.robot.knows_firmware = false;
  b.link_up = true;
  b.steps(5);
  EXPECT_EQ(b.result->record.quality, Quality::kUnknown);
  EXPECT_FALSE(b.result->record.inputs.safety_status.known);
  EXPECT_EQ(b.out.dynamic_data_configuration.type_ids, (std::array<std::uint32_t, 4>{1, 0, 0, 0}))
      << "product and serial number are known by now, the version is asked for as long as it takes";
  EXPECT_OUTCOME(b.outcome(kActivate), kRejected, Reason::kFirmwareUnknown);
  b.robot.knows_firmware = true;
  b.steps(3);
  EXPECT_EQ(b.result->record.quality, Quality::kGood);
  EXPECT_TRUE(b.result->record.inputs.safety_status.known);
  EXPECT_EQ(b.result->record.firmware.major, 11);
  EXPECT_EQ(b.result->record.product_type, 4u);
  EXPECT_EQ(b.result->record.serial_number, 4711u);
  b.steps(100);  // the joint limits are asked for, and this robot does not tell them
  EXPECT_EQ(b.out.dynamic_data_configuration.type_ids, (std::array<std::uint32_t, 4>{0, 0, 0, 0}))
      << "borrowed slots are given back";
}

// Found by cycle_fuzz: the last image's safety section stayed "known" after the link and with it the firmware was lost.
TEST(Cycle, claims_no_safety_status_from_before_a_lost_link) {
  Bench b;
  b.connect();
  ASSERT_TRUE(b.result->record.inputs.safety_status.known);
  b.link_up = false;
  b.steps(2);
  EXPECT_FALSE(b.result->record.firmware_known);
  EXPECT_FALSE(b.result->record.inputs.safety_status.known);
}

TEST(Cycle, calls_old_values_stale_and_then_disconnected) {
  Bench b;
  b.connect();
  b.lose_input = true;
  b.step();
  b.exchange.fresh = false;
  b.now += 3ms;
  b.step_bridge();
  EXPECT_EQ(b.result->record.quality, Quality::kStale);
  b.link_up = false;
  b.steps(2);
  EXPECT_EQ(b.result->record.quality, Quality::kDisconnected);
  EXPECT_EQ(b.result->record.counters.link_losses, 1u);
}

TEST(Cycle, names_a_firmware_that_is_not_the_configured_one_and_refuses_control) {
  CycleSettings s;
  s.firmware = {10, 2, 0, 0};
  Bench b(s);
  b.link_up = true;
  b.steps(10);
  EXPECT_TRUE(b.result->record.firmware_mismatch);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kRejected, Reason::kFirmwareUnknown);
}

TEST(Cycle, never_commands_a_robot_that_it_may_only_monitor) {
  CycleSettings s;
  s.monitoring_only = true;
  Bench b(s);
  b.link_up = true;
  b.steps(10);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kRejected, Reason::kMonitoringOnly);
  EXPECT_FALSE(b.exchange.output_valid);
  EXPECT_TRUE(b.result->record.control.monitoring_only);
}

// A transport checks that an image came; what is in it is the robot's business, and a broken robot's too.
TEST(Cycle, survives_images_of_arbitrary_bytes_and_never_sets_a_reserved_bit) {
  Bench b;
  b.connect_ready();
  std::mt19937 random(7);
  for (int i = 0; i < 5000; ++i) {
    if (i % 3 == 0) b.move(1);
    if (i % 7 == 0) b.pending.push_back(b.velocity(1));
    if (i % 97 == 0) b.send(static_cast<CommandKind>(random() % 14));
    b.step_bridge();
    for (std::byte& byte : b.exchange.input) byte = static_cast<std::byte>(random() & (i % 2 ? 0xff : 0x03));
    b.exchange.fresh = random() % 8 != 0;
    b.exchange.link = random() % 500 ? LinkState::kUp : LinkState::kDown;
    ASSERT_EQ(std::to_integer<int>(b.exchange.output[0]) & 0xc0, 0);
    ASSERT_EQ(std::to_integer<int>(b.exchange.output[6]) & 0xe0, 0);
    ASSERT_FALSE(describe(b.receipts.empty() ? Receipt{} : b.receipts.back()).empty());
  }
  EXPECT_GT(b.result->record.counters.link_losses, 0u);
}

}  // namespace
}  // namespace meca::test
