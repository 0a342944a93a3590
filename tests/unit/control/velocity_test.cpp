// The velocity stream and its own short lease (spec 5.3, behaviour.md).
#include <limits>

#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

void stream(Bench& b, float w, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    b.pending.push_back(b.velocity(w));
    b.step();
  }
}

TEST(Velocity, is_sent_in_cyclic_mode_while_it_is_fresh) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  stream(b, 12, 5);
  EXPECT_TRUE(b.out.motion_control.set_point);
  EXPECT_EQ(b.out.motion_control.move_id, 0);
  EXPECT_EQ(b.out.motion_command.command_id, 21u);
  EXPECT_EQ(b.out.motion_command.arguments[0], 12.0f);
  EXPECT_EQ(b.robot.velocity[0], 12.0f);
}

TEST(Velocity, is_zero_with_set_point_dropped_in_the_very_step_in_which_it_goes_stale) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  stream(b, 12, 5);
  const auto last_sample = b.now;
  while (b.out.motion_control.set_point) {
    ASSERT_LE(b.now - last_sample, 100ms);
    b.step();
  }
  EXPECT_LE(b.now - last_sample, 51ms);
  EXPECT_EQ(b.out.motion_command.command_id, 21u);
  EXPECT_EQ(b.out.motion_command.arguments, (std::array<float, 6>{}));
  EXPECT_EQ(b.robot.velocity[0], 0.0f);
  b.steps(10);
  EXPECT_FALSE(b.out.motion_control.set_point);
}

TEST(Velocity, of_anybody_but_the_owner_moves_nothing_and_takes_nothing) {
  Bench b;
  b.connect_ready();
  stream(b, 12, 5);
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_FALSE(b.result->record.control.owned) << "a stream that never stops would set a robot moving by itself";
  EXPECT_EQ(b.result->record.control.last_refusal.reason, Reason::kNotOwner);
}

TEST(Velocity, takes_the_newest_sample_and_ignores_older_ones_and_nonsense) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  stream(b, 12, 3);
  VelocityRequest old = b.velocity(99);
  old.sequence_number = 1;
  b.pending.push_back(old);
  VelocityRequest nonsense = b.velocity(0);
  nonsense.velocity[3] = std::numeric_limits<float>::quiet_NaN();
  b.pending.push_back(nonsense);
  b.step();
  EXPECT_EQ(b.out.motion_command.arguments[0], 12.0f);
}

TEST(Velocity, gives_way_to_queued_motion_and_comes_back_after_it) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  stream(b, 12, 5);
  const auto id = b.move(30);
  b.pending.push_back(b.velocity(12));
  b.step();
  EXPECT_NE(b.out.motion_control.move_id, 0);
  EXPECT_EQ(b.out.motion_command.command_id, 1u);
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
  stream(b, 12, 5);
  EXPECT_EQ(b.out.motion_control.move_id, 0);
  EXPECT_TRUE(b.out.motion_control.set_point);
  EXPECT_TRUE(b.robot.violations.empty()) << b.robot.violations.front();
}

TEST(Velocity, is_silent_while_the_robot_is_being_deactivated) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  stream(b, 12, 5);
  b.send(kDeactivate);
  stream(b, 12, 1);
  ASSERT_TRUE(b.out.robot_control.deactivate);
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_EQ(b.out.motion_command.arguments[0], 0.0f);
}

TEST(Velocity, stops_with_the_owner) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  stream(b, 12, 5);
  b.outcome(kReleaseControl);
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_EQ(b.out.motion_command.arguments[0], 0.0f);
}

TEST(Velocity, stops_with_an_error_a_pause_and_a_safety_stop) {
  for (int what = 0; what < 3; ++what) {
    Bench b;
    b.connect_ready();
    b.outcome(kTakeControl);
    stream(b, 12, 5);
    if (what == 0) b.robot.raise_error(3005);
    if (what == 1) b.robot.in.motion_status.paused = true;
    if (what == 2) b.robot.in.safety_status.stop.p_stop2 = true;
    stream(b, 12, 2);
    EXPECT_FALSE(b.out.motion_control.set_point) << what;
    EXPECT_EQ(b.out.motion_command.arguments[0], 0.0f);
  }
}

}  // namespace
}  // namespace meca::test
