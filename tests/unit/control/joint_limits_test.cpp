// The joint limits that hold are the robot's own, read live; until they are read, those of the model.
#include "bridge/control/joint_limits.hpp"

#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;
using Slots = std::array<std::uint32_t, image::kDynamicSlots>;

// Types 14 and 15: three minima, three maxima each; firmware 9 gives pairs.
const std::vector<float> kNarrow{-100, -50, -90, 100, 60, 50, -90, -80, -1000, 90, 80, 1000};
const std::vector<float> kNarrowPairs{-100, 100, -50, 60, -90, 50, -90, 90, -80, 80, -1000, 1000};

Receipt move_joint_2(Bench& b, double q2) {
  return b.outcome(b.send(b.motion(image::kMoveJoints, {0, q2, 0, 0, 0, 0})));
}

TEST(JointLimits, are_read_from_the_robot_without_anybody_asking) {
  for (const Layout layout : {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11}) {
    Bench b({}, layout);
    b.robot.joint_limits = layout == Layout::kFirmware9 ? kNarrowPairs : kNarrow;
    b.connect_ready();
    const Receipt r = move_joint_2(b, 70);
    EXPECT_OUTCOME(r, kRejected, Reason::kArgumentRange);
    EXPECT_EQ(describe(r), "MoveJoints refused: argument 2 (q2) is 70 deg; joint 2 allows -50 to 60 deg");
    EXPECT_OUTCOME(move_joint_2(b, 60), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kMoveJoints, {0, 0, 0, 0, 0, 2000}))), kRejected,
                   Reason::kArgumentRange);
  }
}

TEST(JointLimits, are_those_of_the_model_for_a_robot_that_does_not_tell) {
  Bench b;
  b.connect_ready();
  EXPECT_EQ(move_joint_2(b, 91).maximum, 90);
  EXPECT_OUTCOME(move_joint_2(b, 90), kCompleted, Reason::kNone);
}

TEST(JointLimits, that_cannot_be_are_not_believed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float odd : {nan, std::numeric_limits<float>::infinity(), 40000.0f, -95.0f}) {
    Bench b;
    b.robot.joint_limits = kNarrow;
    b.robot.joint_limits[5] = odd;  // of joint 3, whose minimum is -90
    b.connect_ready();
    EXPECT_EQ(move_joint_2(b, 95).maximum, 90) << "nor are their neighbours in the same slot";
    EXPECT_EQ(b.outcome(b.send(b.motion(image::kMoveJoints, {0, 0, 0, 95, 0, 0}))).maximum, 90)
        << "those of joints 4 to 6 are";
  }
}

TEST(JointLimits, in_the_order_of_another_firmware_are_not_believed) {
  Bench b;
  b.robot.joint_limits = kNarrowPairs;  // read as minima and maxima: joint 2 from 100 to -90
  b.connect_ready();
  EXPECT_EQ(move_joint_2(b, 95).maximum, 90);
}

TEST(JointLimits, at_the_limit_as_the_robot_tells_it_are_kept) {
  Bench b;
  b.robot.joint_limits = kNarrow;
  b.robot.joint_limits[4] = 60.1f;  // as a double a little less
  b.connect_ready();
  EXPECT_OUTCOME(move_joint_2(b, 60.1), kCompleted, Reason::kNone);
}

TEST(JointLimits, are_read_again_after_an_activation) {
  Bench b;
  b.robot.joint_limits = kNarrow;
  b.connect();
  b.robot.joint_limits[4] = 30;  // changed while deactivated
  b.outcome(kActivate);
  b.outcome(kHome);
  b.steps(10);
  EXPECT_EQ(move_joint_2(b, 50).maximum, 30);
}

TEST(JointLimits, are_read_again_after_a_reconnection) {
  Bench b;
  b.robot.joint_limits = kNarrow;
  b.connect_ready();
  b.link_up = false;
  b.steps(10);
  b.robot.joint_limits[4] = 30;
  b.connect();
  EXPECT_EQ(move_joint_2(b, 50).maximum, 30);
}

TEST(JointLimits, set_by_the_user_do_not_count_in_recovery_mode) {
  Bench b;
  b.robot.joint_limits = kNarrow;
  b.connect_ready();
  EXPECT_OUTCOME(b.outcome(kRecoveryMode, {1}), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(move_joint_2(b, 70), kCompleted, Reason::kNone);
  EXPECT_EQ(move_joint_2(b, 95).maximum, 90);
  EXPECT_OUTCOME(b.outcome(kRecoveryMode, {0}), kCompleted, Reason::kNone);
  EXPECT_EQ(move_joint_2(b, 70).maximum, 60);
}

TEST(JointLimits, may_also_come_from_what_the_robot_was_configured_with) {
  Bench b;
  b.connect_ready();
  JointLimits limits;
  image::Inputs in = b.robot.in;
  const View view{in, Layout::kFirmware11, true, b.now, b.unix_ns};
  in.dynamic_data[0] = {61, {-100, -50, -90, 100, 60, 50}};
  limits.observe(view);
  EXPECT_EQ(limits.range(1).maximum, 90) << "configured, and not known to be enabled";
  in.dynamic_data[1] = {11, {1}};
  limits.observe(view);
  EXPECT_EQ(limits.range(1).maximum, 60);
  EXPECT_EQ(limits.model(1).maximum, 90);
  in.dynamic_data[2] = {12, {-170, -65, -130, 170, 85, 65}};
  in.dynamic_data[0] = {};
  limits.forget();
  limits.observe(view);
  EXPECT_EQ(limits.range(1).maximum, 85);
  in.dynamic_data[3] = {14, {-100, -50, -90, 100, 55, 50}};
  limits.observe(view);
  EXPECT_EQ(limits.range(1).maximum, 55);
}

// --------------------------------------------------------------- the slot they are read in

struct SlotCase {
  Slots wanted;
  std::size_t borrowed;
};

TEST(JointLimits, are_read_in_the_last_automatic_slot_or_in_a_borrowed_one_that_is_given_back) {
  const SlotCase cases[] = {{{0, 0, 0, 0}, 3}, {{0, 0, 40, 41}, 1}, {{40, 41, 42, 0}, 3}, {{40, 41, 42, 43}, 3}};
  for (const SlotCase& c : cases) {
    CycleSettings settings;
    settings.dynamic_data = c.wanted;
    Bench b(settings);
    b.robot.joint_limits = kNarrow;
    b.robot.ready();
    b.link_up = true;
    std::vector<std::uint32_t> asked;
    for (int i = 0; i < 50; ++i) {
      b.step();
      for (std::size_t slot = 0; slot < 4; ++slot) {
        const std::uint32_t type = b.out.dynamic_data_configuration.type_ids[slot];
        if (type != 14 && type != 15) continue;
        EXPECT_EQ(slot, c.borrowed);
        if (asked.empty() || asked.back() != type) asked.push_back(type);
      }
    }
    EXPECT_EQ(asked, (std::vector<std::uint32_t>{14, 15}));
    EXPECT_EQ(b.out.dynamic_data_configuration.type_ids, c.wanted);
    EXPECT_EQ(move_joint_2(b, 70).maximum, 60);
  }
}

TEST(JointLimits, of_a_robot_that_does_not_tell_are_asked_for_only_so_long) {
  CycleSettings settings;
  settings.dynamic_data = {40, 41, 42, 43};
  Bench b(settings);
  b.robot.ready();
  b.link_up = true;
  int borrowed = 0;
  for (int i = 0; i < 500; ++i) {
    b.step();
    const Slots& types = b.out.dynamic_data_configuration.type_ids;
    borrowed += types[3] == 14 || types[3] == 15;
  }
  EXPECT_GT(borrowed, 10);
  EXPECT_LT(borrowed, 100);
  EXPECT_EQ(b.out.dynamic_data_configuration.type_ids, settings.dynamic_data);
}

TEST(JointLimits, are_read_although_a_client_claims_the_slot_meanwhile) {
  Bench b;
  b.robot.joint_limits = kNarrow;
  b.connect();
  b.outcome(kActivate);
  EXPECT_OUTCOME(b.outcome(kDynamicData, {3, 42}), kCompleted, Reason::kNone);
  b.outcome(kHome);
  b.steps(10);
  EXPECT_EQ(b.out.dynamic_data_configuration.type_ids, (Slots{0, 0, 0, 42}));
  EXPECT_EQ(move_joint_2(b, 70).maximum, 60);
}

TEST(JointLimits, are_read_from_the_simulated_robot_on_every_firmware) {
  for (const Layout layout : {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11}) {
    sim::RobotOptions options;
    options.layout = layout;
    options.noise = false;
    sim::Robot model(options);
    Bench b({}, layout);
    b.sim = &model;
    JointLimits seen;
    b.link_up = true;
    for (int i = 0; i < 100; ++i) {
      b.step();
      seen.observe({b.result->record.inputs, layout, true, b.now, b.unix_ns});
    }
    for (std::size_t joint = 0; joint < 6; ++joint) {
      EXPECT_EQ(seen.range(joint).minimum, seen.model(joint).minimum);
      EXPECT_EQ(seen.range(joint).maximum, seen.model(joint).maximum);
    }
  }
}

// --------------------------------------------------------------- steps

Receipt step_joint_2(Bench& b, double dq2) {
  return b.outcome(b.send(b.motion(image::kMoveJointsRel, {0, dq2, 0, 0, 0, 0})));
}

TEST(JointLimits, hold_for_steps_from_where_the_arm_stands) {
  Bench b;
  b.robot.joint_limits = kNarrow;
  b.connect_ready();
  b.robot.in.target_joint_set.joints = {0, 40, 0, 0, 0, 0};
  b.steps(10);
  const Receipt r = step_joint_2(b, 25);
  EXPECT_OUTCOME(r, kRejected, Reason::kArgumentRange);
  EXPECT_EQ(describe(r),
            "MoveJointsRel refused: argument 2 (dq2) is 25 deg; joint 2 allows -90 to 20 deg from where it stands");
  EXPECT_OUTCOME(step_joint_2(b, 20), kCompleted, Reason::kNone);
}

TEST(JointLimits, of_steps_are_the_robots_to_check_while_the_arm_may_move) {
  Bench b;
  b.robot.joint_limits = kNarrow;
  b.connect_ready();
  b.robot.in.target_joint_set.joints = {0, 40, 0, 0, 0, 0};
  b.robot.executes = false;
  b.move(1);
  b.steps(10);
  const auto id = b.send(b.motion(image::kMoveJointsRel, {0, 25, 0, 0, 0, 0}));
  b.steps(10);
  EXPECT_NE(b.last(id).state, kRejected) << "where the arm stands then is not known now";
}

TEST(JointLimits, let_a_joint_that_is_outside_step_back) {
  Bench b;
  b.robot.joint_limits = kNarrow;
  b.connect_ready();
  b.robot.in.target_joint_set.joints = {0, 70, 0, 0, 0, 0};
  b.steps(10);
  EXPECT_OUTCOME(step_joint_2(b, -5), kCompleted, Reason::kNone);
  b.steps(10);
  EXPECT_OUTCOME(step_joint_2(b, 1), kRejected, Reason::kArgumentRange);
}

}  // namespace
}  // namespace meca::test
