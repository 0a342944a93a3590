// A robot that boots under the bridge, and programs that run on it: nothing moves unasked, every command ends.
#include "tests/unit/control/sim_bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

void come_back(SimBench& b) {
  ASSERT_TRUE(b.until([&] { return b.result->record.quality == Quality::kDisconnected; }));
  ASSERT_TRUE(b.until([&] { return b.result->record.quality == Quality::kGood; }));
}

// For a while after the boot: nothing goes out that could move the arm or take a step towards it.
void expect_peace(SimBench& b) {
  const auto commands = b.model.journal().size();
  for (int i = 0; i < 500; ++i) {
    b.step();
    ASSERT_FALSE(b.out.motion_control.set_point);
    ASSERT_FALSE(b.out.motion_control.resume_motion);
    ASSERT_FALSE(b.out.robot_control.activate);
    ASSERT_FALSE(b.out.robot_control.home);
    ASSERT_FALSE(b.out.robot_control.reset_error);
    ASSERT_FALSE(b.result->record.inputs.robot_status.activated);
  }
  EXPECT_EQ(b.model.journal().size(), commands);
  EXPECT_FALSE(b.result->record.control.owned);
}

void get_going(SimBench& b) {
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kActivate), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kHome), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.move(3)), kCompleted, Reason::kNone);
  EXPECT_NEAR(b.result->record.inputs.target_joint_set.joints[0], 3, 1e-3);
  b.expect_no_violation();
}

TEST(RebootOfARobot, is_acknowledged_cuts_the_link_and_needs_everything_anew) {
  SimBench b;
  b.make_ready();
  EXPECT_OUTCOME(b.outcome(b.move(10)), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kDeactivate), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kRebootRobot, {}))), kCompleted, Reason::kNone);
  come_back(b);
  EXPECT_EQ(b.result->record.inputs.motion_status.move_id, 0);
  expect_peace(b);
  get_going(b);
}

TEST(RebootOfARobot, clears_an_error_that_cannot_be_reset_and_is_all_that_is_taken_in_one) {
  SimBench b;
  b.connect();
  b.model.raise_error(3006);
  b.steps(10);
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kSetTimeScaling, {50}))), kRejected, Reason::kRobotError);
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kRebootRobot, {}))), kCompleted, Reason::kNone);
  come_back(b);
  EXPECT_EQ(b.result->record.inputs.robot_status.error_code, 0);
  get_going(b);
}

TEST(RebootOfARobot, is_open_to_who_comes_after_an_owner_that_died_in_such_an_error) {
  SimBench b;
  b.make_ready();
  b.move(60);
  b.steps(20);
  b.keep_alive = false;
  b.steps(300);  // the lease is over, the stop is done
  b.model.raise_error(3006);
  b.steps(10);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  b.keep_alive = true;
  EXPECT_OUTCOME(b.outcome(kDeactivate), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kRebootRobot, {}))), kCompleted, Reason::kNone);
  come_back(b);
  get_going(b);
}

TEST(PowerCycleOfARobot, clears_an_error_that_cannot_be_reset) {
  SimBench b;
  b.connect();
  b.model.raise_error(3006);
  b.steps(10);
  b.model.power_cycle();
  come_back(b);
  EXPECT_EQ(b.result->record.inputs.robot_status.error_code, 0);
  expect_peace(b);
  get_going(b);
}

class PowerCycle : public testing::TestWithParam<Layout> {};

TEST_P(PowerCycle, in_the_middle_of_a_path_ends_every_command_and_moves_nothing_afterwards) {
  SimBench b(GetParam());
  b.make_ready();
  std::vector<std::uint64_t> ids;
  for (int i = 0; i < 40; ++i) ids.push_back(b.move(i % 2 == 0 ? 40 : -40));
  b.steps(1000);
  const float at = b.result->record.inputs.target_joint_set.joints[0];
  b.model.power_cycle();
  ids.push_back(b.move(1));  // meets no link
  come_back(b);
  for (const auto id : ids) {
    const Receipt r = b.outcome(id);
    EXPECT_TRUE(r.state == kCompleted || r.state == kDiscarded || r.state == kAborted || r.state == kRejected)
        << describe(r);
    EXPECT_TRUE(r.state != kCompleted || id == ids.front()) << "only the first can have been done";
  }
  expect_peace(b);
  EXPECT_NEAR(b.result->record.inputs.target_joint_set.joints[0], at, 0.2);
  get_going(b);
}

TEST_P(PowerCycle, of_a_robot_that_is_off_is_survived_too) {
  SimBench b(GetParam());
  b.connect();
  for (int i = 0; i < 3; ++i) {
    b.model.power_cycle();
    come_back(b);
  }
  expect_peace(b);
  get_going(b);
}

INSTANTIATE_TEST_SUITE_P(Firmware, PowerCycle,
                         testing::Values(Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11),
                         [](const auto& info) {
                           return "firmware_" + std::to_string(9 + static_cast<int>(info.param));
                         });

TEST(RebootStop, keeps_the_robot_off_until_its_reset_button_is_pressed) {
  sim::RobotOptions o = SimBench::options(Layout::kFirmware11);
  o.reboot_stop = true;
  SimBench b(o);
  b.model.press_reset_button();
  b.make_ready();
  b.model.power_cycle();
  come_back(b);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kActivate), kRejected, Reason::kSafetyStop);
  b.model.press_reset_button();
  b.steps(5);
  get_going(b);
}

TEST(OfflineProgram, is_completed_when_it_has_ended_and_counts_as_one_command) {
  SimBench b;
  b.make_ready();
  const auto id = b.send(b.motion(image::kStartProgram, {1}, true));
  b.steps(300);
  EXPECT_EQ(b.result->record.inputs.motion_status.offline_program_id, 1);
  EXPECT_FALSE(b.terminal(id));
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
  EXPECT_EQ(b.result->record.inputs.motion_status.offline_program_id, 0);
  const auto list = b.executed();
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].id, image::kStartProgram);
  b.expect_no_violation();
}

}  // namespace
}  // namespace meca::test
