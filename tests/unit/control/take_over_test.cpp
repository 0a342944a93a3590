// A configured priority may take over: announced, after a grace, and never by surprise.
#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;
using Loss = ControlState::Loss;

CycleSettings with_priorities(std::chrono::nanoseconds grace = 500ms) {
  CycleSettings s;
  ClientRules& rules = s.clients;
  rules.take_over_grace = grace;
  rules.clients[0] = {ClientName("supervisor"), false, 10, std::nullopt};
  rules.clients[1] = {ClientName("supervisor 2"), false, 10, std::nullopt};
  rules.clients[2] = {ClientName("chief"), false, 20, std::nullopt};
  rules.count = 3;
  return s;
}

// The bench's own client, "cell-plc", has no rule and with it priority 0; the others speak through here.
class TakeOver : public testing::Test {
 protected:
  explicit TakeOver(std::chrono::nanoseconds grace = 500ms) : b(with_priorities(grace)) { b.connect_ready(); }

  struct Other {
    const char* name;
    int participant;
    std::uint64_t last_id = 0, renewals = 0;
  };
  std::uint64_t send(Other& who, CommandKind kind) {
    CommandRequest r = b.request(kind);
    r.client = ClientName(who.name);
    r.participant = participant(who.participant);
    r.command_id = 1000 * static_cast<std::uint64_t>(who.participant) + ++who.last_id;
    return b.send(r);
  }
  void steps(int n, std::initializer_list<Other*> alive) {
    for (int i = 0; i < n; ++i) {
      for (Other* who : alive) {
        b.pending.push_back(LeaseRenewal{ClientName(who->name), participant(who->participant), ++who->renewals});
      }
      b.step();
    }
  }
  Receipt answer(Other& who, CommandKind kind) {
    const auto id = send(who, kind);
    b.step();
    return b.last(id);
  }
  const ControlState& control() const { return b.result->record.control; }

  Bench b;
  Other supervisor{"supervisor", 2}, second{"supervisor 2", 3}, chief{"chief", 4}, tablet{"tablet", 5};
};

TEST_F(TakeOver, is_announced_and_leaves_the_owner_its_grace) {
  b.outcome(kTakeControl);
  const auto id = send(supervisor, kTakeControl);
  b.step();
  EXPECT_EQ(b.states(id), std::vector{kAccepted});
  EXPECT_NE(describe(b.last(id)).find("'cell-plc' keeps control"), std::string::npos) << describe(b.last(id));
  EXPECT_EQ(control().contender.view(), "supervisor");
  EXPECT_EQ(control().contender_priority, 10u);
  EXPECT_EQ(control().contender_takes_over_unix_ns, b.unix_ns + 500'000'000);
  const auto announced = b.now;
  steps(490, {&supervisor});
  EXPECT_EQ(control().owner.view(), "cell-plc");
  EXPECT_OUTCOME(b.outcome(b.move(1)), kCompleted, Reason::kNone);
  while (b.states(id).size() < 2) {
    ASSERT_LE(b.now - announced, 510ms);
    steps(1, {&supervisor});
  }
  EXPECT_GE(b.now - announced, 500ms);
  EXPECT_OUTCOME(b.last(id), kCompleted, Reason::kNone);
  EXPECT_EQ(control().owner.view(), "supervisor");
  EXPECT_EQ(control().priority, 10u);
  EXPECT_EQ(control().last_owner.view(), "cell-plc");
  EXPECT_EQ(control().last_loss, Loss::kTakenOver);
  EXPECT_TRUE(control().contender.empty());
  EXPECT_EQ(control().contender_takes_over_unix_ns, 0);
}

TEST_F(TakeOver, happens_at_once_when_the_owner_releases_and_nobody_comes_between) {
  b.outcome(kTakeControl);
  const auto id = send(supervisor, kTakeControl);
  steps(10, {&supervisor});
  b.send(kReleaseControl);
  const auto sneaky = send(tablet, kActivate);  // in the same cycle
  b.step();
  EXPECT_OUTCOME(b.last(id), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.last(sneaky), kRejected, Reason::kNotOwner);
  EXPECT_EQ(control().owner.view(), "supervisor");
  EXPECT_EQ(control().last_loss, Loss::kReleased);
}

TEST_F(TakeOver, happens_at_once_when_the_owner_dies) {
  b.outcome(kTakeControl);
  const auto id = send(supervisor, kTakeControl);
  b.keep_alive = false;
  steps(110, {&supervisor});
  EXPECT_OUTCOME(b.last(id), kCompleted, Reason::kNone);
  EXPECT_EQ(control().last_loss, Loss::kLeaseExpired);
}

class TakeOverAtOnce : public TakeOver {
 protected:
  TakeOverAtOnce() : TakeOver(0ms) {}
};

TEST_F(TakeOverAtOnce, needs_no_second_cycle) {
  b.outcome(kTakeControl);
  const auto id = send(supervisor, kTakeControl);
  b.step();
  EXPECT_EQ(b.states(id), (std::vector{kAccepted, kCompleted}));
  EXPECT_EQ(control().owner.view(), "supervisor");
}

TEST_F(TakeOver, stops_what_the_owner_had_under_way_and_discards_what_it_had_not_sent) {
  b.robot.executes = false;
  const auto queued = b.move(1);
  b.steps(10);
  b.robot.echoes = false;
  b.move(2, false);
  const auto unsent = b.move(3, false);
  b.steps(3);
  send(supervisor, kTakeControl);
  steps(505, {&supervisor});
  ASSERT_EQ(control().owner.view(), "supervisor");
  EXPECT_OUTCOME(b.last(unsent), kDiscarded, Reason::kOwnerLost);
  EXPECT_TRUE(b.out.motion_control.pause_motion);
  steps(20, {&supervisor});
  EXPECT_OUTCOME(b.last(queued), kDiscarded, Reason::kOwnerLost);
  EXPECT_EQ(b.robot.queued(), 0u);
  b.robot.executes = b.robot.echoes = true;
  const auto resumed = send(supervisor, kResumeMotion);
  steps(50, {&supervisor});
  EXPECT_OUTCOME(b.last(resumed), kCompleted, Reason::kNone);
  EXPECT_TRUE(b.robot.executed.empty());
}

TEST_F(TakeOver, lets_the_owners_motion_finish_where_its_policy_says_so) {
  b.policy = LossPolicy::kFinishMotion;
  b.robot.executes = false;
  const auto queued = b.move(1);
  b.steps(10);
  send(supervisor, kTakeControl);
  steps(505, {&supervisor});
  ASSERT_EQ(control().owner.view(), "supervisor");
  EXPECT_FALSE(b.out.motion_control.pause_motion);
  b.robot.executes = true;
  steps(20, {&supervisor});
  EXPECT_OUTCOME(b.last(queued), kCompleted, Reason::kNone);
}

TEST_F(TakeOver, of_a_paused_robot_leaves_nothing_for_the_next_resume_to_run) {
  b.policy = LossPolicy::kFinishMotion;
  b.outcome(kPauseMotion);
  const auto queued = b.move(1);
  b.steps(40);
  send(supervisor, kTakeControl);
  steps(560, {&supervisor});
  EXPECT_OUTCOME(b.last(queued), kDiscarded, Reason::kOwnerLost);
  EXPECT_EQ(b.robot.queued(), 0u);
}

TEST_F(TakeOver, of_a_standing_robot_does_not_pause_it) {
  b.outcome(b.move(1));
  b.steps(20);
  send(supervisor, kTakeControl);
  steps(505, {&supervisor});
  ASSERT_EQ(control().owner.view(), "supervisor");
  EXPECT_FALSE(b.out.motion_control.pause_motion);
  EXPECT_FALSE(b.out.motion_control.set_point);
}

TEST_F(TakeOver, ends_a_velocity_stream_in_the_very_cycle) {
  b.outcome(kTakeControl);
  const auto id = send(supervisor, kTakeControl);
  for (int i = 0; i < 600 && !b.terminal(id); ++i) {
    b.pending.push_back(b.velocity(5));
    steps(1, {&supervisor});
    if (!b.terminal(id) && i > 5) {
      EXPECT_EQ(b.out.motion_command.arguments[0], 5.0f);
    }
  }
  ASSERT_TRUE(b.terminal(id));
  EXPECT_FALSE(b.out.motion_control.set_point);
  EXPECT_EQ(b.out.motion_command.arguments[0], 0.0f);
  for (int i = 0; i < 20; ++i) {
    b.pending.push_back(b.velocity(5));
    steps(1, {&supervisor});
    EXPECT_FALSE(b.out.motion_control.set_point);
  }
}

TEST_F(TakeOver, makes_the_one_taken_over_take_control_explicitly) {
  b.policy = LossPolicy::kFinishMotion;
  b.outcome(kTakeControl);
  send(supervisor, kTakeControl);
  steps(505, {&supervisor});
  send(supervisor, kReleaseControl);
  b.step();
  ASSERT_FALSE(control().owned);
  const Receipt r = b.outcome(b.move(1));
  EXPECT_OUTCOME(r, kRejected, Reason::kNotOwner);
  EXPECT_NE(describe(r).find("take control again"), std::string::npos) << describe(r);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
}

TEST_F(TakeOver, needs_take_control_and_a_refusal_says_so) {
  b.outcome(kTakeControl);
  Receipt r = answer(supervisor, kActivate);
  EXPECT_OUTCOME(r, kRejected, Reason::kNotOwner);
  EXPECT_EQ(describe(r),
            "activation refused: 'cell-plc' has control of the robot (priority 0, yours is 10); to take over, send "
            "TAKE_CONTROL");
  VelocityRequest v = b.velocity(5);
  v.client = ClientName("supervisor");
  v.participant = participant(2);
  b.pending.push_back(v);
  b.step();
  EXPECT_EQ(control().last_refusal.client.view(), "supervisor");
  EXPECT_NE(describe(control().last_refusal).find("send TAKE_CONTROL"), std::string::npos);
  steps(600, {&supervisor});
  EXPECT_EQ(control().owner.view(), "cell-plc");
  EXPECT_TRUE(control().contender.empty());
}

TEST_F(TakeOver, is_not_for_equals_nor_for_lower_ones) {
  EXPECT_OUTCOME(answer(supervisor, kTakeControl), kCompleted, Reason::kNone);
  for (Other* who : {&second, &tablet}) {
    const Receipt r = answer(*who, kTakeControl);
    EXPECT_OUTCOME(r, kRejected, Reason::kNotOwner);
    EXPECT_EQ(r.other.view(), "supervisor");
    EXPECT_NE(describe(r).find("wait until it releases control"), std::string::npos) << describe(r);
  }
  EXPECT_TRUE(control().contender.empty());
}

TEST_F(TakeOver, is_won_by_the_higher_of_two_within_the_grace_of_the_first) {
  b.outcome(kTakeControl);
  const auto first = send(supervisor, kTakeControl);
  steps(300, {&supervisor});
  const auto winner = send(chief, kTakeControl);
  b.step();
  const Receipt r = b.last(first);
  EXPECT_OUTCOME(r, kAborted, Reason::kNotOwner);
  EXPECT_NE(describe(r).find("'chief', of higher priority, takes over instead"), std::string::npos) << describe(r);
  EXPECT_EQ(control().contender.view(), "chief");
  steps(205, {&chief, &supervisor});
  EXPECT_OUTCOME(b.last(winner), kCompleted, Reason::kNone);
  EXPECT_EQ(control().owner.view(), "chief");
}

TEST_F(TakeOver, under_way_is_told_to_everybody_who_is_refused) {
  b.outcome(kTakeControl);
  send(chief, kTakeControl);
  b.step();
  for (Other* who : {&supervisor, &tablet}) {
    const Receipt r = answer(*who, kTakeControl);
    EXPECT_OUTCOME(r, kRejected, Reason::kNotOwner);
    EXPECT_EQ(r.other.view(), "cell-plc");
    EXPECT_NE(describe(r).find("a client of priority 20 is taking over"), std::string::npos) << describe(r);
  }
  for (const CommandKind kind : {kTakeControl, kActivate}) {
    const Receipt r = answer(chief, kind);
    EXPECT_OUTCOME(r, kRejected, Reason::kNotOwner);
    EXPECT_NE(describe(r).find("wait for the receipt of your TAKE_CONTROL"), std::string::npos) << describe(r);
  }
}

TEST_F(TakeOver, is_given_up_by_a_contender_that_does_not_renew) {
  b.outcome(kTakeControl);
  const auto id = send(supervisor, kTakeControl);
  b.steps(95);
  EXPECT_FALSE(b.terminal(id));
  b.steps(10);
  const Receipt r = b.last(id);
  EXPECT_OUTCOME(r, kAborted, Reason::kOwnerLost);
  EXPECT_NE(describe(r).find("did not renew its lease"), std::string::npos) << describe(r);
  EXPECT_TRUE(control().contender.empty());
  b.steps(600);
  EXPECT_EQ(control().owner.view(), "cell-plc");
}

TEST_F(TakeOver, is_given_up_by_a_contender_that_releases) {
  b.outcome(kTakeControl);
  const auto id = send(supervisor, kTakeControl);
  steps(10, {&supervisor});
  EXPECT_OUTCOME(answer(supervisor, kReleaseControl), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.last(id), kAborted, Reason::kOwnerLost);
  EXPECT_EQ(control().owner.view(), "cell-plc");
}

TEST_F(TakeOver, ends_with_the_link_with_monitoring_mode_and_with_the_bridge) {
  for (const Reason reason : {Reason::kLinkLost, Reason::kMonitoringOnly, Reason::kShutdown}) {
    b = Bench(with_priorities());
    b.connect_ready();
    b.outcome(kTakeControl);
    supervisor = {"supervisor", 2};
    const auto id = send(supervisor, kTakeControl);
    steps(10, {&supervisor});
    ASSERT_FALSE(b.terminal(id));
    if (reason == Reason::kLinkLost) b.link_up = false;
    if (reason == Reason::kMonitoringOnly) b.robot.in.robot_status.monitoring_mode = true;
    if (reason == Reason::kShutdown) b.pending.push_back(ShutdownRequest{});
    steps(5, {&supervisor});
    EXPECT_OUTCOME(b.last(id), kAborted, reason);
    EXPECT_TRUE(control().contender.empty());
    EXPECT_FALSE(control().owned);
    const Receipt r = answer(supervisor, kTakeControl);
    EXPECT_EQ(r.state, kRejected);
    steps(600, {&supervisor});
    EXPECT_FALSE(control().owned) << "nothing of it comes back by itself";
  }
}

TEST_F(TakeOver, is_not_refused_for_the_owners_many_actions) {
  b.robot.answers_actions = false;
  for (int i = 0; i < 12; ++i) b.send(kHome);
  for (int i = 0; i < 12; ++i) b.send(kResetError);
  b.step();
  EXPECT_EQ(answer(supervisor, kTakeControl).state, kAccepted);
  EXPECT_OUTCOME(b.outcome(kReleaseControl), kCompleted, Reason::kNone);
}

TEST(ClientRules, the_exact_name_wins_and_then_the_longest_beginning) {
  ClientRules rules;
  rules.clients[0] = {ClientName(""), true, 1, std::nullopt};
  rules.clients[1] = {ClientName("meca-ctl@"), true, 2, std::nullopt};
  rules.clients[2] = {ClientName("meca-ctl@desk:"), true, 3, std::nullopt};
  rules.clients[3] = {ClientName("meca-ctl@desk:1"), false, 4, std::nullopt};
  rules.count = 4;
  EXPECT_EQ(rules.priority("plc"), 1u);
  EXPECT_EQ(rules.priority("meca-ctl@shop:1"), 2u);
  EXPECT_EQ(rules.priority("meca-ctl@desk:2"), 3u);
  EXPECT_EQ(rules.priority("meca-ctl@desk:1"), 4u);
  EXPECT_EQ(ClientRules{}.priority("plc"), 0u);
}

}  // namespace
}  // namespace meca::test
