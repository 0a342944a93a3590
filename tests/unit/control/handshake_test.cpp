// The MoveID handshake as the robot's bytes see it (spec 5.2) and completion by checkpoint (spec 5.5).
#include <bit>

#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

std::uint32_t u32(const image::OutputBytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  return value;
}
std::uint16_t u16(const image::OutputBytes& bytes, std::size_t at) {
  return static_cast<std::uint16_t>(u32(bytes, at));
}

TEST(Handshake, puts_command_arguments_and_move_id_into_one_image) {
  Bench b;
  b.connect_ready();
  b.send(b.motion(image::kMovePose, {190, 0, 308, 0, 90, 0}));
  b.step();
  // Positions from spec 1.1: MoveID 4, SetPoint 6:0, MotionCommandID 8, arguments 12..35; little-endian.
  const auto& wire = b.exchange.output;
  EXPECT_EQ(u16(wire, 4), 1);
  EXPECT_EQ(std::to_integer<int>(wire[6]), 0x01);
  EXPECT_EQ(u32(wire, 8), 2u);
  EXPECT_EQ(u32(wire, 12), 0x433e0000u);  // 190.0f
  EXPECT_EQ(u32(wire, 20), 0x439a0000u);  // 308.0f
  EXPECT_EQ(u32(wire, 28), 0x42b40000u);  // 90.0f
}

TEST(Handshake, starts_with_the_number_after_the_echo_and_skips_0_at_the_wrap) {
  Bench b;
  b.robot.in.motion_status.move_id = 65533;
  b.connect_ready();
  std::vector<std::uint16_t> ids;
  for (int i = 0; i < 4; ++i) b.move(i, false);
  for (int i = 0; i < 10; ++i) {
    b.step();
    const std::uint16_t id = b.out.motion_control.move_id;
    if (b.out.motion_control.set_point && (ids.empty() || ids.back() != id)) ids.push_back(id);
  }
  EXPECT_EQ(ids, (std::vector<std::uint16_t>{65534, 65535, 1, 2}));
}

TEST(Handshake, wraps_cleanly_when_the_robot_already_stands_at_65535) {
  Bench b;
  b.robot.in.motion_status.move_id = 65535;
  b.connect_ready();
  b.move(1, false);
  b.step();
  EXPECT_EQ(b.out.motion_control.move_id, 1);
}

TEST(Handshake, holds_the_image_until_the_echo_and_then_sends_the_next_in_the_same_cycle) {
  Bench b;
  b.connect_ready();
  b.robot.echoes = false;
  const auto first = b.move(10, false), second = b.move(20, false);
  b.step();
  const auto held = b.exchange.output;
  for (int i = 0; i < 50; ++i) {
    b.step();
    ASSERT_EQ(b.exchange.output, held) << "cycle " << i;
  }
  EXPECT_EQ(b.states(second), (std::vector{kAccepted}));
  b.robot.in.motion_status.move_id = b.out.motion_control.move_id;
  b.robot.echoes = true;
  b.step();  // the echo travels
  b.step();
  EXPECT_OUTCOME(b.last(first), kCompleted, Reason::kNone);
  EXPECT_EQ(b.out.motion_command.arguments[0], 20.0f);
}

TEST(Handshake, sends_one_command_per_cycle_when_the_echo_takes_one) {
  Bench b;
  b.connect_ready();
  for (int i = 0; i < 200; ++i) b.move(i % 90, false);
  b.steps(8);
  const auto before = b.robot.executed.size() + b.robot.queued();
  b.steps(100);
  EXPECT_EQ(b.robot.executed.size() + b.robot.queued() - before, 100u);
}

TEST(Handshake, neither_loses_nor_doubles_a_command_when_frames_are_lost) {
  Bench b;
  b.connect_ready();
  for (int i = 0; i < 30; ++i) b.move(i, false);
  for (int i = 0; i < 200; ++i) {
    b.lose_output = i % 3 == 0;
    b.lose_input = i % 5 == 0;
    b.step();
  }
  ASSERT_EQ(b.robot.executed.size(), 30u);
  for (int i = 0; i < 30; ++i)
    EXPECT_EQ(b.robot.executed[static_cast<std::size_t>(i)].arguments[0], static_cast<float>(i));
}

TEST(Handshake, waits_while_the_robots_queue_is_full) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  b.step();
  b.exchange.fresh = true;
  image::Inputs full = b.robot.in;
  full.motion_status.fifo_space = 0;
  image::encode_inputs(full, {b.layout}, b.exchange.input);
  const auto id = b.move(1, false);
  b.step_bridge();
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_EQ(b.states(id), (std::vector{kAccepted}));
  b.exchange_frames();  // the robot has room again
  b.step();
  EXPECT_TRUE(b.out.motion_control.set_point);
}

TEST(Handshake, ends_a_command_that_is_never_echoed_and_everything_behind_it) {
  Bench b;
  b.connect_ready();
  b.robot.echoes = false;
  b.robot.executes = false;
  const auto lost = b.move(1, false), behind = b.move(2, false);
  EXPECT_OUTCOME(b.outcome(lost), kAborted, Reason::kTimeOut);
  EXPECT_OUTCOME(b.outcome(behind), kDiscarded, Reason::kTimeOut);
  EXPECT_FALSE(b.out.motion_control.set_point) << "withdrawn: it must not be taken late";
}

TEST(Handshake, reports_completion_when_the_checkpoint_is_reached_and_not_before) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto id = b.move(1);
  b.steps(50);
  EXPECT_EQ(b.states(id), (std::vector{kAccepted, kSent, kAcknowledged}));
  b.robot.executes = true;
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
}

TEST(Handshake, completes_all_commands_up_to_the_last_of_several_checkpoints_seen_at_once) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto a = b.move(1), c = b.move(2), d = b.move(3);
  b.steps(20);
  b.robot.in.motion_status.checkpoint_reached = 7002;
  b.steps(2);
  EXPECT_OUTCOME(b.last(a), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.last(c), kCompleted, Reason::kNone);
  EXPECT_FALSE(b.terminal(d));
}

TEST(Handshake, completes_without_a_checkpoint_once_the_robot_has_queued_it_when_nobody_asked_for_more) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  EXPECT_OUTCOME(b.outcome(b.move(1, false)), kCompleted, Reason::kNone);
  EXPECT_EQ(b.robot.queued(), 1u);
}

TEST(Handshake, lets_a_clients_own_checkpoint_through_and_proves_completion_even_when_it_hides_the_bridges) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto id = b.move(1);
  b.send(b.motion(image::kSetCheckpoint, {5}));
  b.steps(10);
  ASSERT_EQ(b.robot.queued(), 3u);
  // Both checkpoints in one robot cycle: the image shows the client's only.
  b.robot.skip_to_end();
  EXPECT_EQ(b.robot.in.motion_status.checkpoint_reached, 5u);
  b.robot.executes = true;
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
}

// Of what the robot was at, a discarded checkpoint does not tell how far it got; what was behind it was not begun.
TEST(Handshake, says_aborted_and_discarded_when_the_robot_discards_the_checkpoints) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto under_way = b.move(1), waiting = b.move(2);
  b.steps(10);
  b.robot.in.motion_status.checkpoint_discarded = 7002;
  EXPECT_OUTCOME(b.outcome(under_way), kAborted, Reason::kCleared);
  EXPECT_OUTCOME(b.outcome(waiting), kDiscarded, Reason::kCleared);
}

TEST(Handshake, ends_everything_truthfully_when_the_robot_fails) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto in_robot = b.move(1);
  b.steps(10);
  b.robot.echoes = false;
  const auto sent = b.move(2), waiting = b.move(3);
  b.steps(3);
  b.robot.raise_error(3005);
  EXPECT_OUTCOME(b.outcome(in_robot), kAborted, Reason::kRobotError);
  EXPECT_EQ(b.last(in_robot).robot_error, 3005);
  EXPECT_OUTCOME(b.outcome(sent), kAborted, Reason::kRobotError);
  EXPECT_OUTCOME(b.outcome(waiting), kDiscarded, Reason::kRobotError);
  b.steps(20);
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_FALSE(b.out.robot_control.reset_error) << "nothing is reset by itself";
}

TEST(Handshake, drops_the_queue_on_clear_and_says_so) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto in_robot = b.move(1);
  b.steps(10);
  const auto clear = b.send(kClearMotion);
  EXPECT_OUTCOME(b.outcome(clear), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(in_robot), kDiscarded, Reason::kCleared);
  EXPECT_FALSE(b.out.motion_control.clear_motion);
  EXPECT_EQ(b.robot.queued(), 0u);
}

// The frame with the checkpoint was lost and the next one carried it together with the bit that emptied the queue: the
// robot reached the checkpoint, and a move that never ran was COMPLETED.
TEST(Handshake, offers_no_command_in_an_image_that_empties_the_queue) {
  for (const CommandKind kind : {kDeactivate, kClearMotion}) {
    Bench b;
    b.connect_ready();
    b.robot.executes = false;
    const auto id = b.move(1);
    ASSERT_TRUE(b.until([&] { return b.out.motion_command.command_id == image::kMoveJoints; }));
    b.lose_output = true;  // of the checkpoint
    b.step();
    ASSERT_EQ(b.out.motion_command.command_id, image::kSetCheckpoint);
    b.robot.executes = true;
    b.robot.in.motion_status.paused = true;  // so that the move stays in the queue until it is dropped
    b.send(kind);
    b.step();
    EXPECT_FALSE(b.out.motion_control.set_point);
    b.robot.in.motion_status.paused = false;
    const Receipt r = b.outcome(id);
    EXPECT_NE(r.state, kCompleted) << describe(r);
    EXPECT_TRUE(b.robot.executed.empty());
  }
}

TEST(Handshake, ends_queued_motion_when_the_robot_is_deactivated) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const auto id = b.move(1);
  b.steps(10);
  EXPECT_OUTCOME(b.outcome(kDeactivate), kCompleted, Reason::kNone);
  const Receipt r = b.outcome(id);
  EXPECT_TRUE(r.state == kAborted || r.state == kDiscarded) << describe(r);
}

}  // namespace
}  // namespace meca::test
