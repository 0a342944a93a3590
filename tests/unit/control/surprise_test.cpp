// No surprise motion: after a lost link, a safety stop, a restart or a shutdown nothing moves without a fresh command.
#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;
using Loss = ControlState::Loss;

TEST(LostLink, drops_control_and_sends_nothing_old_when_it_is_back) {
  Bench b;
  b.connect_ready();
  b.robot.echoes = false;
  b.robot.executes = false;
  b.move(1);
  const auto waiting = b.move(2);
  b.steps(3);
  b.link_up = false;
  EXPECT_OUTCOME(b.outcome(waiting), kDiscarded, Reason::kLinkLost);
  EXPECT_FALSE(b.result->record.control.owned);
  EXPECT_EQ(b.result->record.control.last_loss, Loss::kLinkLost);
  b.robot.echoes = true;
  b.link_up = true;
  const auto executed = b.robot.executed.size();
  for (int i = 0; i < 300; ++i) {
    b.step();
    EXPECT_FALSE(b.out.motion_control.set_point);
    EXPECT_FALSE(b.out.motion_control.resume_motion);
    EXPECT_FALSE(b.out.robot_control.reset_error);
  }
  EXPECT_EQ(b.robot.executed.size(), executed);
}

TEST(LostLink, resolves_a_command_without_an_echo_by_the_echo_after_reconnection) {
  for (const bool taken : {true, false}) {
    Bench b;
    b.policy = LossPolicy::kFinishMotion;
    b.connect_ready();
    b.robot.echoes = false;
    const auto id = b.move(1, false);
    b.step();
    b.link_up = false;
    b.steps(100);
    EXPECT_FALSE(b.terminal(id)) << "nobody can know yet";
    if (taken) b.robot.in.motion_status.move_id = 1;
    b.link_up = true;
    const Receipt r = b.outcome(id);
    EXPECT_OUTCOME(r, taken ? kCompleted : kAborted, taken ? Reason::kNone : Reason::kLinkLost);
  }
}

TEST(LostLink, does_not_wait_for_ever_for_the_truth) {
  Bench b;
  b.connect_ready();
  b.robot.echoes = false;
  const auto id = b.move(1);
  b.steps(2);
  b.link_up = false;
  b.steps(30'000);  // as idl/control.idl says, in cycles of 1 ms
  EXPECT_FALSE(b.terminal(id));
  b.steps(10);
  EXPECT_TRUE(b.terminal(id));
  EXPECT_OUTCOME(b.outcome(id), kAborted, Reason::kLinkLost);
}

TEST(LostLink, stops_what_the_robot_is_still_doing_when_it_is_back) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto under_way = b.move(1), waiting = b.move(2);
  b.steps(10);
  b.link_up = false;
  b.steps(50);
  b.link_up = true;
  EXPECT_OUTCOME(b.outcome(under_way), kAborted, Reason::kLinkLost);
  EXPECT_OUTCOME(b.outcome(waiting), kDiscarded, Reason::kLinkLost);
  EXPECT_TRUE(b.out.motion_control.pause_motion);
}

TEST(LostLink, of_images_alone_puts_the_stop_image_out_for_a_robot_that_may_still_hear) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  b.move(1);
  b.steps(10);
  for (int i = 0; i < 150; ++i) {
    b.lose_input = true;
    b.step();
  }
  EXPECT_EQ(b.result->record.quality, Quality::kStale);
  EXPECT_FALSE(b.result->record.control.owned);
  EXPECT_TRUE(b.exchange.output_valid);
  EXPECT_TRUE(b.out.motion_control.pause_motion);
  EXPECT_FALSE(b.out.motion_control.set_point);
}

TEST(LostLink, makes_every_level_start_from_the_robot_again) {
  Bench b;
  b.connect();
  b.outcome(kSimMode, {1});
  b.link_up = false;
  b.steps(5);
  b.link_up = true;
  b.steps(5);
  EXPECT_TRUE(b.out.robot_control.sim_mode) << "dropping it would switch simulation off by reconnecting";
  EXPECT_TRUE(b.robot.in.robot_status.sim_activated);
}

TEST(LostLink, continues_the_numbering_from_the_echo) {
  Bench b;
  b.connect_ready();
  b.outcome(b.move(1, false));
  b.steps(10);
  b.link_up = false;
  b.steps(5);
  b.robot.in.motion_status.move_id = 500;
  b.link_up = true;
  b.steps(20);
  b.outcome(kTakeControl);
  b.move(2, false);
  b.step();
  EXPECT_EQ(b.out.motion_control.move_id, 501);
}

TEST(SafetyStop, empties_the_queue_and_waits_for_an_explicit_resume) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto under_way = b.move(1), waiting = b.move(2);
  b.steps(10);
  b.robot.in.safety_status.stop.p_stop2 = b.robot.in.motion_status.p_stop2 = true;
  b.robot.in.motion_status.paused = true;
  EXPECT_OUTCOME(b.outcome(under_way), kAborted, Reason::kSafetyStop);
  EXPECT_OUTCOME(b.outcome(waiting), kDiscarded, Reason::kSafetyStop);
  b.robot.in.safety_status.resettable.p_stop2 = true;
  for (int i = 0; i < 300; ++i) {
    b.step();
    EXPECT_FALSE(b.out.motion_control.resume_motion);
  }
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.move(2, false)), kCompleted, Reason::kNone);
}

// Activate was refused because of the stop, Resume because the robot was not activated: there was no way out.
TEST(SafetyStop, of_a_deactivated_robot_is_left_by_activating_and_then_resuming) {
  for (const Layout layout : {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11}) {
    Bench b({}, layout);
    image::Inputs& in = b.robot.in;
    in.motion_status.p_stop2 = in.safety_status.stop.p_stop2 = true;
    in.safety_status.resettable.p_stop2 = true;
    in.motion_status.p_stop2_resettable = layout == Layout::kFirmware9;
    b.connect();
    EXPECT_OUTCOME(b.outcome(kActivate), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(kHome), kRejected, Reason::kSafetyStop);
    EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(kHome), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(b.move(1)), kCompleted, Reason::kNone);
  }
}

TEST(MonitoringMode, of_the_robot_ends_control_and_the_bridge_falls_silent) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  b.robot.in.robot_status.monitoring_mode = true;
  b.steps(3);
  EXPECT_FALSE(b.exchange.output_valid);
  EXPECT_FALSE(b.result->record.control.owned);
  EXPECT_TRUE(b.result->record.control.monitoring_only);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kRejected, Reason::kMonitoringOnly);
  b.robot.in.robot_status.monitoring_mode = false;
  b.steps(3);
  EXPECT_TRUE(b.exchange.output_valid);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
}

// Found by the random faults: Resume lowers its levels first, and what came before its edge was resumed over.
TEST(Resume, under_way_ends_when_its_owner_releases_control) {
  Bench b;
  b.connect_ready();
  b.policy = LossPolicy::kFinishMotion;
  b.outcome(kPauseMotion);
  const auto resume = b.send(kResumeMotion);
  b.step();
  b.send(kReleaseControl);
  for (int i = 0; i < 50; ++i) {
    b.step();
    EXPECT_FALSE(b.out.motion_control.resume_motion);
  }
  EXPECT_OUTCOME(b.last(resume), kAborted, Reason::kOwnerLost);
}

TEST(Resume, under_way_ends_when_a_p_stop_is_pressed) {
  Bench b;
  b.connect_ready();
  b.outcome(kPauseMotion);
  const auto resume = b.send(kResumeMotion);
  b.step();
  b.robot.in.safety_status.stop.p_stop2 = b.robot.in.motion_status.p_stop2 = true;
  for (int i = 0; i < 50; ++i) {
    b.step();
    EXPECT_FALSE(b.out.motion_control.resume_motion && i > 0);
  }
  EXPECT_OUTCOME(b.last(resume), kAborted, Reason::kSafetyStop);
}

TEST(SafetyStop, discards_an_activation_that_waits_behind_a_deactivation) {
  Bench b;
  b.connect_ready();
  b.outcome(kDeactivate);
  const auto activation = b.send(kActivate);  // waits: the drives rest between the two
  b.steps(5);
  ASSERT_FALSE(b.out.robot_control.activate);
  b.robot.in.safety_status.stop.p_stop2 = b.robot.in.motion_status.p_stop2 = true;
  for (int i = 0; i < 500; ++i) {
    b.step();
    EXPECT_FALSE(b.out.robot_control.activate);
  }
  EXPECT_OUTCOME(b.last(activation), kDiscarded, Reason::kSafetyStop);
}

TEST(Shutdown, puts_the_stop_image_out_and_ends_every_command) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto in_robot = b.move(1);
  b.steps(10);
  const auto waiting = b.move(2);
  b.pending.push_back(ShutdownRequest{});
  b.step();
  EXPECT_TRUE(b.out.motion_control.pause_motion);
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_FALSE(b.out.motion_control.clear_motion);
  EXPECT_OUTCOME(b.last(waiting), kDiscarded, Reason::kShutdown);
  EXPECT_FALSE(b.cycle->finished());
  EXPECT_OUTCOME(b.outcome(in_robot), kDiscarded, Reason::kShutdown);
  EXPECT_TRUE(b.until([&] { return b.cycle->finished(); }));
  EXPECT_EQ(b.robot.queued(), 0u) << "whoever resumes the robot later must not start it";
  EXPECT_EQ(b.result->record.control.last_loss, Loss::kShutdown);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kRejected, Reason::kShutdown);
}

TEST(Restart, of_the_bridge_leaves_a_firmware_9_robot_paused) {
  Bench b({}, Layout::kFirmware9);
  b.robot.ready();
  image::Outputs of_the_last_life;
  of_the_last_life.motion_control.pause_motion = true;
  b.robot.step(of_the_last_life);
  b.robot.sneak_in({99, 1, {45, 0, 0, 0, 0, 0}});
  b.link_up = true;
  b.steps(100);
  EXPECT_TRUE(b.out.motion_control.pause_motion);
  EXPECT_TRUE(b.robot.executed.empty());
}

}  // namespace
}  // namespace meca::test
