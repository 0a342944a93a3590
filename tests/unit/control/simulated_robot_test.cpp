// The control machines against the simulated Meca500, which records every rule a host breaks.
#include "tests/unit/control/sim_bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

class OnEveryFirmware : public testing::TestWithParam<Layout> {};

TEST_P(OnEveryFirmware, a_cold_robot_is_activated_homed_moved_paused_resumed_and_switched_off) {
  SimBench b(GetParam());
  b.make_ready();
  const auto id = b.move(30);
  b.steps(100);
  EXPECT_FALSE(b.terminal(id));
  EXPECT_OUTCOME(b.outcome(kPauseMotion), kCompleted, Reason::kNone);
  b.steps(500);
  EXPECT_FALSE(b.terminal(id));
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
  EXPECT_NEAR(b.result->record.inputs.target_joint_set.joints[0], 30, 1e-3);
  EXPECT_OUTCOME(b.outcome(kDeactivate), kCompleted, Reason::kNone);
  b.expect_no_violation();
}

TEST_P(OnEveryFirmware, a_path_is_executed_once_and_in_order) {
  SimBench b(GetParam());
  b.make_ready();
  std::vector<std::uint64_t> ids;
  for (int i = 0; i < 20; ++i) ids.push_back(b.move(i % 2 ? -1.0 - i * 0.1 : 1.0 + i * 0.1));
  for (const auto id : ids) EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
  const auto list = b.executed();
  ASSERT_EQ(list.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(list[i].arguments[0],
              static_cast<float>(i % 2 ? -1.0 - static_cast<double>(i) * 0.1 : 1.0 + static_cast<double>(i) * 0.1));
  }
  b.expect_no_violation();
}

TEST_P(OnEveryFirmware, a_dead_owner_stops_the_arm_and_a_new_one_gets_it_going) {
  SimBench b(GetParam());
  b.make_ready();
  const auto id = b.move(90);
  b.steps(200);
  b.keep_alive = false;
  EXPECT_OUTCOME(b.outcome(id), kDiscarded, Reason::kOwnerLost);
  b.steps(1000);
  const float stopped_at = b.result->record.inputs.target_joint_set.joints[0];
  EXPECT_GT(stopped_at, 1);
  EXPECT_LT(stopped_at, 89);
  b.steps(1000);
  EXPECT_EQ(b.result->record.inputs.target_joint_set.joints[0], stopped_at);
  b.client = ClientName("somebody else");
  b.keep_alive = true;
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  b.steps(500);
  EXPECT_EQ(b.result->record.inputs.target_joint_set.joints[0], stopped_at) << "the old move is gone";
  EXPECT_OUTCOME(b.outcome(b.move(5)), kCompleted, Reason::kNone);
  b.expect_no_violation();
}

TEST_P(OnEveryFirmware, an_error_ends_commands_and_is_left_by_reset_and_resume) {
  SimBench b(GetParam());
  b.make_ready();
  const auto id = b.move(90);
  b.steps(200);
  b.model.raise_error(3005);
  EXPECT_OUTCOME(b.outcome(id), kAborted, Reason::kRobotError);
  b.steps(1000);
  EXPECT_EQ(b.result->record.inputs.robot_status.error_code, 3005);
  EXPECT_OUTCOME(b.outcome(kResetError), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.move(1)), kCompleted, Reason::kNone);
  b.expect_no_violation();
}

TEST_P(OnEveryFirmware, a_p_stop_ends_commands_and_is_left_by_resume) {
  SimBench b(GetParam());
  b.make_ready();
  const auto under_way = b.move(90), waiting = b.move(80);
  b.steps(200);
  b.model.press_p_stop2();
  EXPECT_OUTCOME(b.outcome(under_way), kAborted, Reason::kSafetyStop);
  EXPECT_OUTCOME(b.outcome(waiting), kDiscarded, Reason::kSafetyStop);
  b.steps(1000);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kRejected, Reason::kSafetyStop);
  b.model.release_p_stop2();
  b.steps(5);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.move(1)), kCompleted, Reason::kNone);
  b.expect_no_violation();
}

TEST_P(OnEveryFirmware, deactivation_overtakes_activation_without_breaking_a_rule) {
  SimBench b(GetParam());
  b.connect();
  const auto on = b.send(kActivate);
  b.steps(50);
  EXPECT_OUTCOME(b.outcome(kDeactivate), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.last(on), kAborted, Reason::kNotActivated);
  b.steps(1000);
  EXPECT_FALSE(b.result->record.inputs.robot_status.activated);
  b.expect_no_violation();
}

TEST_P(OnEveryFirmware, a_velocity_stream_moves_the_arm_and_its_end_stops_it) {
  SimBench b(GetParam());
  b.make_ready();
  for (int i = 0; i < 500; ++i) {
    b.pending.push_back(b.velocity(20));
    b.step();
  }
  const float moving_at = b.result->record.inputs.target_joint_set.joints[0];
  EXPECT_GT(moving_at, 2);
  b.steps(1000);
  const float stopped_at = b.result->record.inputs.target_joint_set.joints[0];
  b.steps(500);
  EXPECT_EQ(b.result->record.inputs.target_joint_set.joints[0], stopped_at);
  EXPECT_OUTCOME(b.outcome(b.move(0)), kCompleted, Reason::kNone);
  b.expect_no_violation();
}

TEST_P(OnEveryFirmware, an_emergency_stop_needs_its_release_and_a_new_activation) {
  SimBench b(GetParam());
  b.make_ready();
  const auto id = b.move(90);
  b.steps(200);
  b.model.press_e_stop();
  const Receipt r = b.outcome(id);
  EXPECT_TRUE(r.state == kAborted || r.state == kDiscarded) << describe(r);
  EXPECT_OUTCOME(b.outcome(kActivate), kRejected, Reason::kSafetyStop);
  b.model.release_e_stop();
  b.model.press_reset_button();
  b.steps(1000);
  EXPECT_FALSE(b.result->record.inputs.robot_status.activated);
  EXPECT_OUTCOME(b.outcome(kActivate), kCompleted, Reason::kNone);
}

// A robot that needs a cycle or two for its echo shows what a command did before it says that it has the command.
class RobotThatEchoesLate : public testing::TestWithParam<int> {
 protected:
  static sim::RobotOptions options() {
    sim::RobotOptions o = SimBench::options(Layout::kFirmware11);
    o.echo_cycles = GetParam();
    return o;
  }
};

TEST_P(RobotThatEchoesLate, is_waited_for_and_its_checkpoints_are_not_missed) {
  SimBench b(options());
  b.make_ready();
  std::vector<std::uint64_t> ids;
  for (int i = 0; i < 5; ++i) {
    ids.push_back(b.move(i));
    ids.push_back(b.send(b.motion(image::kSetJointVel, {20.0 + i})));
  }
  for (const auto id : ids) EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
  EXPECT_EQ(b.executed().size(), ids.size());
  b.expect_no_violation();
}

TEST_P(RobotThatEchoesLate, is_not_misunderstood_when_the_link_is_cut_before_the_echo) {
  for (int cut_after = 0; cut_after < 6; ++cut_after) {
    for (int length = 1; length < 5; ++length) {
      SCOPED_TRACE("cut after " + std::to_string(cut_after) + " cycles, for " + std::to_string(length));
      SimBench b(options());
      b.make_ready();
      const auto id = b.send(b.motion(image::kSetJointVel, {33}));
      b.steps(cut_after);
      b.link_up = false;
      b.steps(length);
      b.link_up = true;
      EXPECT_EQ(b.executed().size(), b.outcome(id).state == kCompleted ? 1U : 0U);
      b.expect_no_violation();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cycles, RobotThatEchoesLate, testing::Values(1, 2));

INSTANTIATE_TEST_SUITE_P(Firmware, OnEveryFirmware,
                         testing::Values(Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11),
                         [](const auto& info) {
                           return "firmware_" + std::to_string(9 + static_cast<int>(info.param));
                         });

}  // namespace
}  // namespace meca::test
