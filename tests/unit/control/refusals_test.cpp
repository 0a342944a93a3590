// Checked before it is sent: every reason for a refusal, with the numbers and the sentence that go with it.
#include <limits>

#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Refusal, names_joint_value_and_range) {
  Bench b;
  b.connect_ready();
  const Receipt r = b.outcome(b.send(b.motion(image::kMoveJoints, {0, 120, 0, 0, 0, 0})));
  EXPECT_OUTCOME(r, kRejected, Reason::kArgumentRange);
  EXPECT_EQ(r.argument, 1);
  EXPECT_EQ(r.value, 120);
  EXPECT_EQ(r.minimum, -70);
  EXPECT_EQ(r.maximum, 90);
  EXPECT_EQ(describe(r), "MoveJoints refused: argument 2 (q2) is 120 deg; joint 2 allows -70 to 90 deg");
  EXPECT_FALSE(b.out.motion_control.set_point);
}

TEST(Refusal, catches_numbers_that_are_none_or_do_not_fit) {
  Bench b;
  b.connect_ready();
  for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 1e300, -1e300}) {
    for (const std::uint32_t id : {image::kMoveJoints, image::kMovePose, image::kMoveLinRelTrf}) {
      EXPECT_OUTCOME(b.outcome(b.send(b.motion(id, {0, 0, 0, 0, bad, 0}))), kRejected, Reason::kArgumentRange);
      EXPECT_EQ(b.receipts.back().argument, 4);
    }
  }
}

TEST(Refusal, counts_arguments) {
  Bench b;
  b.connect_ready();
  const Receipt r = b.outcome(b.send(b.motion(image::kMoveJoints, {1, 2, 3})));
  EXPECT_OUTCOME(r, kRejected, Reason::kArgumentCount);
  EXPECT_EQ(describe(r),
            "MoveJoints refused: MoveJoints got 3 arguments and takes 6 arguments: q1, q2, q3, q4, q5, q6");
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kSetBlending, {1, 2}))), kRejected, Reason::kArgumentCount);
  EXPECT_OUTCOME(b.outcome(kActivate, {1}), kRejected, Reason::kArgumentCount);
  EXPECT_OUTCOME(b.outcome(kSimMode), kRejected, Reason::kArgumentCount);
}

TEST(Refusal, wants_whole_numbers_where_the_robot_does) {
  Bench b;
  b.connect_ready();
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kSetConf, {1, 0.5, 1}))), kRejected, Reason::kArgumentRange);
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kSetBlending, {100.5}))), kRejected, Reason::kArgumentRange);
  EXPECT_OUTCOME(b.outcome(kDynamicData, {4, 1}), kRejected, Reason::kArgumentRange);
  EXPECT_OUTCOME(b.outcome(kDynamicData, {0.5, 1}), kRejected, Reason::kArgumentRange);
  EXPECT_OUTCOME(b.outcome(kDynamicData, {0, -1}), kRejected, Reason::kArgumentRange);
  EXPECT_OUTCOME(b.outcome(kRecoveryMode, {2}), kRejected, Reason::kArgumentRange);
}

TEST(Refusal, keeps_the_bridges_own_checkpoints_out_of_reach) {
  Bench b;
  b.connect_ready();
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kSetCheckpoint, {7000}))), kCompleted, Reason::kNone);
  const Receipt r = b.outcome(b.send(b.motion(image::kSetCheckpoint, {7001})));
  EXPECT_OUTCOME(r, kRejected, Reason::kArgumentRange);
  EXPECT_EQ(r.maximum, 7000);
  EXPECT_NE(describe(r).find("the bridge's own"), std::string::npos) << describe(r);
}

TEST(Refusal, knows_which_commands_this_robot_and_this_firmware_have) {
  Bench eleven;
  eleven.connect_ready();
  Receipt r = eleven.outcome(eleven.send(eleven.motion(34, {1, 2, 3})));
  EXPECT_OUTCOME(r, kRejected, Reason::kUnknownCommand);
  EXPECT_NE(describe(r).find("other robots"), std::string::npos) << describe(r);
  r = eleven.outcome(eleven.send(eleven.motion(image::kMoveJointsVel, {1, 2, 3, 4, 5, 6})));
  EXPECT_OUTCOME(r, kRejected, Reason::kUnknownCommand);
  EXPECT_NE(describe(r).find("VelocityCommand"), std::string::npos) << describe(r);
  EXPECT_OUTCOME(eleven.outcome(eleven.send(eleven.motion(9999, {}))), kRejected, Reason::kUnknownCommand);
  EXPECT_OUTCOME(eleven.outcome(eleven.send(eleven.motion(image::kSetPayload, {0.1, 0, 0, 0}))), kCompleted,
                 Reason::kNone);

  Bench nine({}, Layout::kFirmware9);
  nine.connect_ready();
  EXPECT_OUTCOME(nine.outcome(nine.send(nine.motion(image::kSetPayload, {0.1, 0, 0, 0}))), kRejected,
                 Reason::kUnknownCommand);
  CommandRequest variables = nine.motion(image::kMoveJoints, {10000, 10000, 10000, 10000, 10000, 10000});
  variables.use_variables = true;
  EXPECT_OUTCOME(nine.outcome(nine.send(variables)), kRejected, Reason::kUnknownCommand);
}

TEST(Refusal, takes_cyclic_ids_as_arguments_when_variables_are_used) {
  Bench b;
  b.connect_ready();
  CommandRequest r = b.motion(image::kMoveJoints, {10000, 10001, 10002, 10003, 10004, 19999});
  r.use_variables = true;
  b.send(r);
  b.step();
  EXPECT_TRUE(b.out.motion_control.use_variables);
  CommandRequest bad = b.motion(image::kMoveJoints, {10000, 10001, 10002, 10003, 10004, 20000});
  bad.use_variables = true;
  EXPECT_OUTCOME(b.outcome(b.send(bad)), kRejected, Reason::kArgumentRange);
}

TEST(Refusal, follows_the_robots_state) {
  Bench b;
  b.connect();
  EXPECT_OUTCOME(b.outcome(b.move(1)), kRejected, Reason::kNotActivated);
  EXPECT_OUTCOME(b.outcome(kHome), kRejected, Reason::kNotActivated);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kRejected, Reason::kNotActivated);
  b.robot.in.robot_status.activated = true;
  b.steps(2);
  EXPECT_OUTCOME(b.outcome(b.move(1)), kRejected, Reason::kNotHomed);
  EXPECT_OUTCOME(b.outcome(kSimMode, {1}), kRejected, Reason::kWrongState);
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kSetJointLimitsCfg, {1}))), kRejected, Reason::kWrongState);
  EXPECT_OUTCOME(b.outcome(kBrakes, {1}), kRejected, Reason::kNotAllowed);
  b.robot.in.robot_status.homed = true;
  b.robot.raise_error(1012);
  b.steps(2);
  const Receipt r = b.outcome(b.move(1));
  EXPECT_OUTCOME(r, kRejected, Reason::kRobotError);
  EXPECT_EQ(r.robot_error, 1012);
  EXPECT_NE(describe(r).find("1012"), std::string::npos);
}

TEST(Refusal, does_not_move_a_robot_in_a_safety_stop) {
  Bench b;
  b.connect_ready();
  b.robot.in.safety_status.stop.p_stop2 = b.robot.in.motion_status.p_stop2 = true;
  b.steps(2);
  EXPECT_OUTCOME(b.outcome(b.move(1)), kRejected, Reason::kSafetyStop);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kRejected, Reason::kSafetyStop);
  b.robot.in.safety_status.resettable.p_stop2 = true;
  b.robot.in.motion_status.paused = true;
  b.steps(2);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_FALSE(b.robot.in.safety_status.stop.p_stop2);
}

TEST(Refusal, says_that_there_is_no_link) {
  Bench b;
  EXPECT_OUTCOME(b.outcome(kActivate), kRejected, Reason::kNoLink);
}

TEST(Refusal, bounds_its_queues) {
  Bench b;
  b.connect_ready();
  b.robot.echoes = false;
  b.keep_alive = false;  // commands renew
  for (std::size_t i = 0; i < 300; ++i) b.move(1, false);
  while (!b.pending.empty()) b.step();
  std::size_t full = 0;
  for (const Receipt& r : b.receipts) full += r.reason == Reason::kQueueFull;
  EXPECT_GT(full, 0u);
  EXPECT_LT(full, 60u);
}

TEST(Refusal, knows_no_such_kind_of_command) {
  Bench b;
  b.connect();
  CommandRequest r = b.request(kActivate);
  r.kind = static_cast<CommandKind>(200);
  EXPECT_OUTCOME(b.outcome(b.send(r)), kRejected, Reason::kUnknownCommand);
}

TEST(Refusal, answers_a_resent_command_with_the_receipt_it_has_and_does_not_do_it_twice) {
  Bench b;
  b.connect_ready();
  const CommandRequest r = b.motion(image::kMoveJoints, {30, 0, 0, 0, 0, 0});
  b.send(r);
  EXPECT_OUTCOME(b.outcome(r.command_id), kCompleted, Reason::kNone);
  const auto before = b.robot.executed.size();
  b.send(r);
  b.steps(20);
  EXPECT_EQ(b.states(r.command_id), (std::vector{kAccepted, kSent, kAcknowledged, kCompleted, kCompleted}));
  EXPECT_EQ(b.robot.executed.size(), before);
}

TEST(Refusal, answers_a_resent_command_while_it_is_under_way_with_where_it_is) {
  Bench b;
  b.connect_ready();
  b.robot.executes = false;
  const CommandRequest r = b.motion(image::kMoveJoints, {30, 0, 0, 0, 0, 0}, true);
  b.send(r);
  b.steps(10);
  b.send(r);
  b.step();
  EXPECT_EQ(b.states(r.command_id), (std::vector{kAccepted, kSent, kAcknowledged, kAcknowledged}));
}

TEST(Refusal, does_not_take_an_id_for_two_commands_nor_one_from_the_past) {
  Bench b;
  b.connect_ready();
  CommandRequest r = b.motion(image::kMoveJoints, {30, 0, 0, 0, 0, 0});
  b.outcome(b.send(r));
  r.arguments[0] = 31;
  b.send(r);
  b.steps(5);
  EXPECT_OUTCOME(b.receipts.back(), kRejected, Reason::kDuplicate);
  b.last_id += 1000;
  b.outcome(kTakeControl);
  CommandRequest old = b.request(kTakeControl);
  old.command_id = 500;
  b.send(old);
  b.steps(5);
  EXPECT_OUTCOME(b.receipts.back(), kRejected, Reason::kDuplicate);
}

TEST(Refusal, remembers_each_client_apart) {
  Bench b;
  b.connect();
  b.outcome(kTakeControl);
  for (int who = 2; who < 60; ++who) {
    CommandRequest r = b.request(kTakeControl);
    r.client = ClientName("client " + std::to_string(who));
    r.participant = participant(who);
    r.command_id = 1;
    b.pending.push_back(r);
    b.step();
    EXPECT_OUTCOME(b.receipts.back(), kRejected, Reason::kNotOwner);
    EXPECT_EQ(b.receipts.back().client.view(), r.client.view());
  }
}

}  // namespace
}  // namespace meca::test
