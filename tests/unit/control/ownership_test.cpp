// One owner at a time, bound to its name and participant; and what happens to the robot when the owner is gone.
#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;
using Loss = ControlState::Loss;

CommandRequest from(Bench& b, const char* client, int who, CommandKind kind, std::uint64_t id) {
  CommandRequest r = b.request(kind);
  r.client = ClientName(client);
  r.participant = participant(who);
  r.command_id = id;
  return r;
}
const ControlState& control(const Bench& b) { return b.result->record.control; }

TEST(Ownership, is_taken_by_the_first_command_and_shown) {
  Bench b;
  b.connect();
  EXPECT_FALSE(control(b).owned);
  b.send(kActivate);
  b.step();
  EXPECT_TRUE(control(b).owned);
  EXPECT_EQ(control(b).owner.view(), "cell-plc");
  EXPECT_EQ(control(b).owner_participant, participant(1));
  EXPECT_EQ(control(b).lease_ms, 100u);
  EXPECT_EQ(control(b).since_unix_ns, b.unix_ns);
}

TEST(Ownership, is_not_taken_by_a_command_that_is_refused) {
  Bench b;
  b.connect();
  EXPECT_OUTCOME(b.outcome(kHome), kRejected, Reason::kNotActivated);
  EXPECT_FALSE(control(b).owned);
}

TEST(Ownership, refuses_everybody_else_and_names_the_owner) {
  Bench b;
  b.connect();
  b.outcome(kTakeControl);
  b.pending.push_back(from(b, "joystick", 2, kTakeControl, 1));
  b.step();
  const Receipt r = b.receipts.back();
  EXPECT_OUTCOME(r, kRejected, Reason::kNotOwner);
  EXPECT_EQ(r.other.view(), "cell-plc");
  EXPECT_NE(describe(r).find("'cell-plc'"), std::string::npos) << describe(r);
  EXPECT_EQ(control(b).last_refusal.client.view(), "joystick");
  EXPECT_EQ(control(b).owner.view(), "cell-plc");
}

TEST(Ownership, shows_when_the_owner_gave_its_last_sign_of_life_and_still_after_its_end) {
  Bench b;
  b.connect();
  EXPECT_EQ(control(b).last_renewal_unix_ns, 0);
  b.keep_alive = false;
  b.outcome(kTakeControl);
  EXPECT_EQ(control(b).last_renewal_unix_ns, b.unix_ns) << "taking control is one";
  b.steps(20);
  b.pending.push_back(LeaseRenewal{b.client, participant(1), 1});
  b.step();
  const auto renewed = b.unix_ns;
  EXPECT_EQ(control(b).last_renewal_unix_ns, renewed);
  b.pending.push_back(from(b, "joystick", 2, kActivate, 1));
  b.steps(20);
  EXPECT_EQ(control(b).last_renewal_unix_ns, renewed) << "nobody else renews it";
  ASSERT_TRUE(b.until([&] { return !control(b).owned; }));
  EXPECT_EQ(control(b).last_renewal_unix_ns, renewed);
}

TEST(Ownership, is_bound_to_the_participant_and_not_to_the_name_alone) {
  Bench b;
  b.connect();
  b.outcome(kTakeControl);
  b.pending.push_back(from(b, "cell-plc", 2, kActivate, 1));
  b.step();
  EXPECT_OUTCOME(b.receipts.back(), kRejected, Reason::kNotOwner);
  EXPECT_FALSE(b.out.robot_control.activate);
}

TEST(Ownership, ends_with_a_release_and_leaves_a_standing_robot_alone) {
  Bench b;
  b.connect_ready();
  b.outcome(b.move(1));
  b.steps(10);
  EXPECT_TRUE(b.out.motion_control.set_point);
  EXPECT_OUTCOME(b.outcome(kReleaseControl), kCompleted, Reason::kNone);
  EXPECT_FALSE(control(b).owned);
  EXPECT_EQ(control(b).last_loss, Loss::kReleased);
  EXPECT_EQ(control(b).last_owner.view(), "cell-plc");
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_FALSE(b.out.motion_control.pause_motion);
}

TEST(Ownership, lasts_as_long_as_the_application_renews) {
  Bench b;
  b.connect();
  b.outcome(kTakeControl);
  b.steps(1000);
  EXPECT_TRUE(control(b).owned);
}

TEST(Ownership, is_not_renewed_by_a_renewal_that_was_seen_before) {
  Bench b;
  b.connect();
  b.outcome(kTakeControl);
  b.keep_alive = false;
  for (int i = 0; i < 110; ++i) {
    b.pending.push_back(LeaseRenewal{b.client, participant(1), 1});
    b.step();
  }
  EXPECT_FALSE(control(b).owned);
}

TEST(Ownership, is_renewed_by_commands_and_by_the_velocity_stream) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  b.keep_alive = false;
  for (int i = 0; i < 5; ++i) {
    b.steps(90);
    b.send(kTakeControl);
  }
  for (int i = 0; i < 5; ++i) {
    b.steps(90);
    b.pending.push_back(b.velocity(1));
  }
  EXPECT_TRUE(control(b).owned);
}

// Behaviour.md: the stop image is on the wire within lease + 2 cycles.
TEST(OwnerLoss, puts_the_stop_image_on_the_wire_within_the_lease_and_two_cycles) {
  for (int phase = 0; phase < 20; ++phase) {
    Bench b;
    b.connect_ready();
    b.robot.executes = false;
    const auto id = b.move(1);
    b.steps(5 + phase);
    b.keep_alive = false;
    const auto last_sign_of_life = b.now;
    while (!b.out.motion_control.pause_motion) {
      ASSERT_LE(b.now - last_sign_of_life, 200ms);
      b.step();
    }
    EXPECT_LE(b.now - last_sign_of_life, 102ms);
    EXPECT_FALSE(b.out.motion_control.set_point);
    EXPECT_FALSE(b.out.motion_control.clear_motion) << "the stop image itself is Pause and SetPoint 0";
    EXPECT_OUTCOME(b.outcome(id), kDiscarded, Reason::kOwnerLost);
    EXPECT_EQ(b.robot.queued(), 0u);
    b.steps(50);
    EXPECT_FALSE(b.out.motion_control.clear_motion);
    EXPECT_TRUE(b.out.motion_control.pause_motion) << "nobody resumes but a client";
    EXPECT_EQ(control(b).last_loss, Loss::kLeaseExpired);
  }
}

TEST(OwnerLoss, lets_queued_motion_finish_when_the_owner_asked_for_it) {
  Bench b;
  b.policy = LossPolicy::kFinishMotion;
  b.connect_ready();
  b.robot.executes = false;
  const auto id = b.move(1);
  b.steps(5);
  b.keep_alive = false;
  b.steps(150);
  EXPECT_FALSE(control(b).owned);
  EXPECT_FALSE(b.out.motion_control.pause_motion);
  EXPECT_FALSE(b.out.motion_control.set_point);
  b.robot.executes = true;
  EXPECT_OUTCOME(b.outcome(id), kCompleted, Reason::kNone);
}

// Nothing moves in a paused robot that could finish, and the next owner's Resume must not run a dead client's motion.
TEST(OwnerLoss, in_a_paused_robot_stops_motion_that_might_have_finished) {
  for (const Layout layout : {Layout::kFirmware9, Layout::kFirmware11}) {
    Bench b({}, layout);
    b.policy = LossPolicy::kFinishMotion;
    b.connect_ready();
    b.outcome(kPauseMotion);
    const auto id = b.move(1);
    b.steps(40);
    ASSERT_EQ(b.robot.queued(), 2u) << "the move and the bridge's checkpoint";
    b.keep_alive = false;
    EXPECT_OUTCOME(b.outcome(id), kDiscarded, Reason::kOwnerLost);
    b.client = ClientName("somebody else");
    b.keep_alive = true;
    EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
    b.steps(50);
    EXPECT_TRUE(b.robot.executed.empty());
  }
}

TEST(OwnerLoss, in_a_robot_that_is_about_to_pause_counts_as_paused) {
  Bench b;
  b.policy = LossPolicy::kFinishMotion;
  b.connect_ready();
  b.robot.executes = false;
  const auto id = b.move(1);
  b.steps(5);
  b.robot.answers_actions = false;  // Pause is on the wire and not confirmed
  b.send(kPauseMotion);
  b.keep_alive = false;
  b.steps(150);
  b.robot.answers_actions = true;
  EXPECT_OUTCOME(b.outcome(id), kDiscarded, Reason::kOwnerLost);
}

TEST(OwnerLoss, with_the_link_stops_a_paused_robots_motion_when_the_link_is_back) {
  Bench b;
  b.policy = LossPolicy::kFinishMotion;
  b.connect_ready();
  b.outcome(kPauseMotion);
  b.move(1);
  b.steps(5);
  b.link_up = false;
  b.steps(10);
  b.connect();
  b.steps(50);
  EXPECT_EQ(b.robot.queued(), 0u);
}

// A person pauses, gives control back, and somebody goes on later: that is what FINISH_MOTION asks for.
TEST(OwnerLoss, by_release_leaves_motion_that_may_finish_in_a_paused_robot) {
  for (const CommandKind next : {kResumeMotion, kClearMotion}) {
    Bench b;
    b.policy = LossPolicy::kFinishMotion;
    b.connect_ready();
    b.outcome(kPauseMotion);
    const auto id = b.move(1);
    b.steps(40);
    b.outcome(kReleaseControl);
    b.steps(500);
    EXPECT_FALSE(b.terminal(id)) << "the robot still has it";
    b.client = ClientName("somebody else");
    EXPECT_OUTCOME(b.outcome(next), kCompleted, Reason::kNone);
    EXPECT_EQ(b.outcome(id).state, next == kResumeMotion ? kCompleted : kDiscarded);
  }
}

struct PolicyCase {
  LossRule robot;
  std::optional<LossRule> client;
  LossPolicy asked, expected;
};

TEST(OwnerLoss, follows_the_client_the_robots_rule_or_the_rule_for_this_client) {
  using enum LossRule;
  using enum LossPolicy;
  const PolicyCase cases[] = {
      {kClient, {}, kStopMotion, kStopMotion},        {kClient, {}, kFinishMotion, kFinishMotion},
      {kStop, {}, kFinishMotion, kStopMotion},        {kFinish, {}, kStopMotion, kFinishMotion},
      {kClient, kStop, kFinishMotion, kStopMotion},   {kStop, kFinish, kStopMotion, kFinishMotion},
      {kStop, kClient, kFinishMotion, kFinishMotion}, {kFinish, kStop, kFinishMotion, kStopMotion},
  };
  for (const PolicyCase& c : cases) {
    CycleSettings settings;
    settings.clients.on_loss = c.robot;
    settings.clients.clients[0] = {ClientName("cell-"), true, 0, c.client};
    settings.clients.count = 1;
    Bench b(settings);
    b.policy = c.asked;
    b.connect_ready();
    b.robot.executes = false;
    const auto id = b.move(1);
    b.steps(5);
    EXPECT_EQ(control(b).on_loss, c.expected) << "ControlStatus shows what will happen";
    b.keep_alive = false;
    b.steps(150);
    EXPECT_EQ(b.out.motion_control.pause_motion, c.expected == kStopMotion);
    b.robot.executes = true;
    EXPECT_EQ(b.outcome(id).state, c.expected == kStopMotion ? kDiscarded : kCompleted);
  }
}

TEST(OwnerLoss, of_several_clients_is_remembered_until_each_takes_control_again) {
  Bench b;
  b.connect();
  b.keep_alive = false;
  const char* names[] = {"one", "two", "three"};
  for (int i = 0; i < 3; ++i) {
    b.pending.push_back(from(b, names[i], 2 + i, kTakeControl, 1));
    b.steps(150);
    ASSERT_EQ(control(b).last_owner.view(), names[i]);
  }
  for (int i = 0; i < 3; ++i) {
    b.pending.push_back(from(b, names[i], 2 + i, kActivate, 2));
    b.step();
    EXPECT_OUTCOME(b.receipts.back(), kRejected, Reason::kNotOwner);
  }
  EXPECT_FALSE(control(b).owned);
}

TEST(OwnerLoss, discards_what_was_not_sent_yet_even_when_motion_may_finish) {
  Bench b;
  b.policy = LossPolicy::kFinishMotion;
  b.connect_ready();
  b.robot.echoes = false;
  b.move(1, false);
  const auto waiting = b.move(2, false);
  b.steps(3);
  b.keep_alive = false;
  EXPECT_OUTCOME(b.outcome(waiting), kDiscarded, Reason::kOwnerLost);
}

TEST(OwnerLoss, keeps_the_robot_stopped_until_a_new_owner_resumes_it_explicitly) {
  Bench b;
  b.connect_ready();
  b.move(1);
  b.steps(10);
  b.keep_alive = false;
  b.steps(200);
  ASSERT_TRUE(b.out.motion_control.pause_motion);
  b.client = ClientName("night-shift");
  b.keep_alive = true;
  b.outcome(kTakeControl);
  EXPECT_OUTCOME(b.outcome(b.move(5)), kRejected, Reason::kPaused);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_FALSE(b.out.motion_control.pause_motion);
  EXPECT_OUTCOME(b.outcome(b.move(5)), kCompleted, Reason::kNone);
  EXPECT_TRUE(b.robot.violations.empty());
}

TEST(OwnerLoss, makes_the_client_that_was_cut_off_take_control_explicitly) {
  Bench b;
  b.connect_ready();
  b.outcome(kTakeControl);
  b.keep_alive = false;
  b.steps(200);
  const Receipt r = b.outcome(kResumeMotion);
  EXPECT_OUTCOME(r, kRejected, Reason::kNotOwner);
  EXPECT_NE(describe(r).find("take control again"), std::string::npos) << describe(r);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  b.keep_alive = true;
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
}

TEST(OwnerLoss, on_firmware_9_clears_the_queue_before_it_lets_go_of_pause) {
  Bench b({}, Layout::kFirmware9);
  b.connect_ready();
  b.robot.executes = false;
  b.move(1, false);
  b.steps(10);
  b.keep_alive = false;
  b.steps(200);
  ASSERT_TRUE(b.out.motion_control.pause_motion);
  // Somebody queued behind our back: letting go of Pause alone would run it.
  b.robot.sneak_in({99, 1, {45, 0, 0, 0, 0, 0}});
  b.keep_alive = true;
  b.outcome(kTakeControl);
  b.robot.executes = true;
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_TRUE(b.robot.executed.empty());
}

TEST(OwnerLoss, stops_a_moving_robot_on_release_unless_motion_may_finish) {
  for (const LossPolicy policy : {LossPolicy::kStopMotion, LossPolicy::kFinishMotion}) {
    Bench b;
    b.policy = policy;
    b.connect_ready();
    b.robot.executes = false;
    const auto id = b.move(1);
    b.steps(10);
    EXPECT_OUTCOME(b.outcome(kReleaseControl), kCompleted, Reason::kNone);
    EXPECT_EQ(b.out.motion_control.pause_motion, policy == LossPolicy::kStopMotion);
    b.robot.executes = true;
    const Receipt r = b.outcome(id);
    EXPECT_EQ(r.state, policy == LossPolicy::kStopMotion ? kDiscarded : kCompleted) << describe(r);
  }
}

}  // namespace
}  // namespace meca::test
