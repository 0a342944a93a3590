// The actions: bit up, confirmation, bit down, receipt (spec 5.1, 5.4, 5.6); and every one of them without an answer.
#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

TEST(Actions, hold_the_bit_until_the_status_confirms_and_then_drop_it) {
  Bench b;
  b.connect();
  const auto id = b.send(kActivate);
  b.step();
  EXPECT_TRUE(b.out.robot_control.activate);
  b.step();
  EXPECT_EQ(b.states(id), (std::vector{kAccepted, kSent}));
  ASSERT_TRUE(b.until([&] { return b.terminal(id); }));
  EXPECT_TRUE(b.robot.in.robot_status.activated);
  EXPECT_FALSE(b.out.robot_control.activate);
}

TEST(Actions, are_done_at_once_and_without_touching_the_wire_when_the_robot_is_there_already) {
  Bench b;
  b.connect_ready();
  b.step();
  const auto before = b.exchange.output;
  for (const CommandKind kind : {kActivate, kHome, kResetError, kResumeMotion}) {
    const auto id = b.send(kind);
    b.step();
    EXPECT_EQ(b.states(id), (std::vector{kCompleted})) << static_cast<int>(kind);
    EXPECT_EQ(b.exchange.output, before);
  }
  const auto off = b.send(kSimMode, {0});
  b.step();
  EXPECT_OUTCOME(b.last(off), kCompleted, Reason::kNone);
}

TEST(Actions, run_one_after_the_other_in_the_order_they_came) {
  Bench b;
  b.connect();
  const auto activate = b.send(kActivate), home = b.send(kHome);
  b.step();
  EXPECT_TRUE(b.out.robot_control.activate);
  EXPECT_FALSE(b.out.robot_control.home);
  // Homing was asked for before the robot was active: it is judged when its turn comes.
  EXPECT_OUTCOME(b.outcome(activate), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(home), kCompleted, Reason::kNone);
  EXPECT_TRUE(b.robot.in.robot_status.homed);
}

TEST(Actions, pause_and_resume_with_a_rising_edge_after_the_levels_are_low) {
  Bench b;
  b.connect_ready();
  EXPECT_OUTCOME(b.outcome(kPauseMotion), kCompleted, Reason::kNone);
  EXPECT_TRUE(b.out.motion_control.pause_motion) << "the level stays until somebody resumes";
  const auto id = b.send(kResumeMotion);
  b.step();
  EXPECT_FALSE(b.out.motion_control.pause_motion);
  EXPECT_FALSE(b.out.motion_control.resume_motion) << "the level goes out first, alone";
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
  EXPECT_FALSE(b.out.motion_control.resume_motion);
  EXPECT_FALSE(b.robot.in.motion_status.paused);
  EXPECT_TRUE(b.robot.violations.empty());
}

TEST(Actions, on_firmware_9_resume_lets_go_of_a_pause_of_the_owner_and_keeps_its_queue) {
  Bench b({}, Layout::kFirmware9);
  b.connect_ready();
  b.robot.executes = false;
  b.move(1, false);
  b.steps(5);
  EXPECT_OUTCOME(b.outcome(kPauseMotion), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_EQ(b.robot.queued(), 1u);
  EXPECT_FALSE(b.robot.in.motion_status.paused);
}

TEST(Actions, on_firmware_9_resume_resets_a_p_stop_that_can_be_reset) {
  Bench b({}, Layout::kFirmware9);
  b.connect_ready();
  b.robot.in.motion_status.p_stop2 = b.robot.in.motion_status.p_stop2_resettable = true;
  b.robot.in.motion_status.paused = true;
  b.step();
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_FALSE(b.robot.in.motion_status.p_stop2);
}

TEST(Actions, reset_an_error_and_leave_the_robot_paused) {
  Bench b;
  b.connect_ready();
  b.robot.raise_error(1011);
  b.step();
  EXPECT_OUTCOME(b.outcome(kResetError), kCompleted, Reason::kNone);
  EXPECT_EQ(b.robot.in.robot_status.error_code, 0);
  EXPECT_TRUE(b.robot.in.motion_status.paused);
  EXPECT_FALSE(b.out.motion_control.resume_motion);
}

TEST(Actions, keep_the_level_of_simulation_and_recovery_mode) {
  Bench b;
  b.connect();
  EXPECT_OUTCOME(b.outcome(kSimMode, {1}), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kRecoveryMode, {1}), kCompleted, Reason::kNone);
  EXPECT_TRUE(b.out.robot_control.sim_mode);
  EXPECT_TRUE(b.out.robot_control.recovery_mode);
  EXPECT_OUTCOME(b.outcome(kSimMode, {0}), kCompleted, Reason::kNone);
  EXPECT_FALSE(b.out.robot_control.sim_mode);
}

TEST(Actions, release_brakes_only_when_allowed_and_asked_twice) {
  CycleSettings s;
  s.allow_brakes = true;
  Bench b(s);
  b.connect();
  EXPECT_OUTCOME(b.outcome(kBrakes, {0}), kRejected, Reason::kNotAllowed);
  EXPECT_NE(describe(b.receipts.back()).find("within 5 s"), std::string::npos) << describe(b.receipts.back());
  EXPECT_FALSE(b.out.brakes_control.brakes_control_allowed);
  EXPECT_OUTCOME(b.outcome(kBrakes, {0}), kCompleted, Reason::kNone);
  EXPECT_TRUE(b.out.brakes_control.brakes_control_allowed);
  EXPECT_FALSE(b.robot.in.robot_status.brakes_engaged);
  EXPECT_OUTCOME(b.outcome(kBrakes, {1}), kCompleted, Reason::kNone);
  EXPECT_FALSE(b.out.brakes_control.brakes_control_allowed);
  // A confirmation that comes too late is a first request again.
  EXPECT_OUTCOME(b.outcome(kBrakes, {0}), kRejected, Reason::kNotAllowed);
  b.steps(5001);
  EXPECT_OUTCOME(b.outcome(kBrakes, {0}), kRejected, Reason::kNotAllowed);
}

TEST(Actions, engage_the_brakes_again_when_the_owner_that_released_them_is_gone) {
  CycleSettings s;
  s.allow_brakes = true;
  Bench b(s);
  b.connect();
  b.outcome(kBrakes, {0});
  b.outcome(kBrakes, {0});
  ASSERT_FALSE(b.robot.in.robot_status.brakes_engaged);
  b.keep_alive = false;
  b.steps(110);
  EXPECT_TRUE(b.robot.in.robot_status.brakes_engaged);
  EXPECT_FALSE(b.out.brakes_control.brakes_control_allowed);
}

TEST(Actions, show_a_dynamic_data_type_and_give_up_on_one_the_robot_does_not_have) {
  Bench b;
  b.connect();
  EXPECT_OUTCOME(b.outcome(kDynamicData, {3, 42}), kCompleted, Reason::kNone);
  EXPECT_EQ(b.result->record.inputs.dynamic_data[3].type_id, 42u);
  EXPECT_EQ(b.out.dynamic_data_configuration.type_ids[3], 42u);
  b.robot.knows_firmware = false;  // type 1 is not shown
  EXPECT_OUTCOME(b.outcome(kDynamicData, {3, 1}), kAborted, Reason::kTimeOut);
  EXPECT_EQ(b.out.dynamic_data_configuration.type_ids[3], 42u) << "the slot is as it was";
}

TEST(Actions, set_the_robots_clock_for_a_moment_and_then_leave_it_alone) {
  Bench b;
  b.connect();
  const auto id = b.send(kSetHostTime);
  b.step();
  EXPECT_EQ(b.out.host_time.seconds, 1'800'000'000u);
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
  EXPECT_EQ(b.out.host_time.seconds, 0u);
}

TEST(Actions, let_deactivate_overtake_an_activation_and_never_activate_afterwards) {
  Bench b;
  b.connect();
  b.robot.busy_cycles = 100;
  const auto activate = b.send(kActivate), home = b.send(kHome);
  b.steps(10);
  const auto off = b.send(kDeactivate);
  EXPECT_OUTCOME(b.outcome(activate), kAborted, Reason::kNotActivated);
  EXPECT_OUTCOME(b.outcome(home), kDiscarded, Reason::kNotActivated);
  EXPECT_OUTCOME(b.outcome(off), kCompleted, Reason::kNone);
  b.steps(500);
  EXPECT_FALSE(b.robot.in.robot_status.activated);
}

TEST(Actions, rest_between_deactivation_and_activation) {
  Bench b;
  b.connect_ready();
  b.outcome(kDeactivate);
  const auto id = b.send(kActivate);
  int cycles = 0;
  while (!b.out.robot_control.activate && cycles < 1000) b.step(), ++cycles;
  EXPECT_GE(cycles, 99);
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
}

TEST(Actions, end_with_the_robots_error_when_one_comes_up_meanwhile) {
  Bench b;
  b.connect();
  b.robot.answers_actions = false;
  const auto id = b.send(kActivate);
  b.steps(3);
  b.robot.raise_error(1013);
  EXPECT_OUTCOME(b.outcome(id), kAborted, Reason::kRobotError);
  EXPECT_EQ(b.last(id).robot_error, 1013);
}

struct Unanswered {
  const char* name;
  CommandKind kind;
  std::vector<double> arguments;
  void (*prepare)(TinyRobot&);
};

class ActionWithoutAnswer : public testing::TestWithParam<Unanswered> {};

TEST_P(ActionWithoutAnswer, ends_by_time_out_and_drops_its_bit) {
  CycleSettings s;
  s.allow_brakes = true;
  s.action_timeout = 2s;
  Bench b(s);
  GetParam().prepare(b.robot);
  b.connect();
  b.robot.answers_actions = false;
  CommandRequest r = b.request(GetParam().kind);
  r.argument_count = static_cast<std::uint8_t>(GetParam().arguments.size());
  std::copy(GetParam().arguments.begin(), GetParam().arguments.end(), r.arguments.begin());
  const auto started = b.now;
  EXPECT_OUTCOME(b.outcome(b.send(r)), kAborted, Reason::kTimeOut);
  EXPECT_GE(b.now - started, 2s);
  b.step();
  const image::RobotControl& c = b.out.robot_control;
  EXPECT_FALSE(c.activate || c.deactivate || c.home || c.reset_error || c.sim_mode || c.recovery_mode);
  EXPECT_FALSE(b.out.motion_control.resume_motion || b.out.motion_control.clear_motion);
}

void leave(TinyRobot&) {}
void make_ready(TinyRobot& r) { r.ready(); }
void make_activated(TinyRobot& r) { r.in.robot_status.activated = true; }
void make_paused(TinyRobot& r) {
  r.ready();
  r.in.motion_status.paused = true;
}
void make_failed(TinyRobot& r) { r.in.robot_status.error_code = 1007; }

INSTANTIATE_TEST_SUITE_P(Every, ActionWithoutAnswer,
                         testing::Values(Unanswered{"activate", kActivate, {}, leave},
                                         Unanswered{"deactivate", kDeactivate, {}, make_ready},
                                         Unanswered{"home", kHome, {}, make_activated},
                                         Unanswered{"reset_error", kResetError, {}, make_failed},
                                         Unanswered{"pause", kPauseMotion, {}, make_ready},
                                         Unanswered{"resume", kResumeMotion, {}, make_paused},
                                         Unanswered{"clear", kClearMotion, {}, make_ready},
                                         Unanswered{"sim_mode", kSimMode, {1}, leave},
                                         Unanswered{"recovery_mode", kRecoveryMode, {1}, leave}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Actions, of_engaging_brakes_end_by_time_out_too) {
  CycleSettings s;
  s.allow_brakes = true;
  s.action_timeout = 2s;
  Bench b(s);
  b.connect();
  b.outcome(kBrakes, {0});
  b.robot.answers_actions = false;
  EXPECT_OUTCOME(b.outcome(kBrakes, {0}), kAborted, Reason::kTimeOut);
  EXPECT_TRUE(b.out.brakes_control.brakes_engaged) << "a release that did not come true is taken back";
}

}  // namespace
}  // namespace meca::test
