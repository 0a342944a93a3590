// Every error code the model raises, provoked (codes: spec 3.1).
#include "sim/inverse.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using image::Layout;

class Refusal : public testing::Test {
 protected:
  Rig rig;
  std::uint16_t code_of(std::uint32_t id, const std::vector<double>& arguments = {}) {
    rig.perform(id, arguments);
    return rig.error();
  }
};

TEST_F(Refusal, OfCommandsBeforeActivationIs1005) {
  EXPECT_EQ(code_of(image::kMoveJoints, {0, 0, 0, 0, 0, 0}), 1005);
  rig.reset_error();
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(code_of(image::kSetJointVel, {50}), 1005);
}

TEST_F(Refusal, OfMovesBeforeHomingIs1006) {
  rig.activate();
  EXPECT_EQ(code_of(image::kSetJointVel, {50}), 0);
  EXPECT_EQ(code_of(image::kMoveJoints, {0, 0, 0, 0, 0, 0}), 1006);
}

TEST_F(Refusal, OfVelocityBeforeHomingIs1006Too) {
  rig.activate();
  EXPECT_EQ(code_of(image::kMoveJointsVel, {1, 0, 0, 0, 0, 0}), 1006);
}

TEST_F(Refusal, OfUnknownAndForeignCommandsIs1001) {
  rig.make_ready();
  for (const std::uint32_t id : {52u, 59u, 101u, 157u, 1000u, 9999u, 20000u, 0xFFFFFFFFu, 34u, 45u}) {
    EXPECT_EQ(code_of(id), 1001) << id;
    rig.reset_error();
    rig.resume();
  }
}

TEST_F(Refusal, OfCommandsNewerThanTheFirmwareIs1001) {
  for (const auto& [layout, id, code] : {std::tuple{Layout::kFirmware9, image::kSetTimeScaling, 1001},
                                         {Layout::kFirmware10, image::kSetTimeScaling, 0},
                                         {Layout::kFirmware10, image::kSetPayload, 1001},
                                         {Layout::kFirmware11, image::kSetPayload, 0}}) {
    Rig other(Rig::quick(layout));
    other.make_ready();
    other.perform(id, {1, 0, 0, 0});
    EXPECT_EQ(other.error(), code) << id;
  }
}

TEST_F(Refusal, OfBadArgumentsIs1003) {
  rig.make_ready();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<std::uint32_t, std::vector<double>> bad[] = {
      {image::kSetJointVel, {0}},
      {image::kSetJointVel, {151}},
      {image::kSetBlending, {100.5}},
      {image::kSetCheckpoint, {0}},
      {image::kSetCheckpoint, {8001}},
      {image::kSetCheckpoint, {1.5}},
      {image::kSetConf, {1, 0, 1}},
      {image::kSetConfTurn, {101}},
      {image::kSetVelTimeout, {1.1}},
      {image::kDelay, {-1}},
      {image::kMoveJoints, {nan, 0, 0, 0, 0, 0}},
      {image::kMovePose, {0, 0, 0, 0, 0, nan}},
      {image::kMoveJointsVel, {0, 0, nan, 0, 0, 0}},
  };
  for (const auto& [id, arguments] : bad) {
    EXPECT_EQ(code_of(id, arguments), 1003) << id;
    rig.reset_error();
    rig.resume();
  }
}

TEST_F(Refusal, OfMoreThanTopSpeedIs1003OnAnR3AndNotOnAnR4) {
  Rig r3(Rig::quick(Layout::kFirmware11, Product::kMeca500R3));
  r3.make_ready();
  r3.perform(image::kSetJointVel, {101});
  EXPECT_EQ(r3.error(), 1003);
  rig.make_ready();
  EXPECT_EQ(code_of(image::kSetJointVel, {150}), 0);
}

TEST_F(Refusal, OfJointsOverTheirLimitIs1007) {
  rig.make_ready();
  const double over[6] = {175.1, 90.1, 70.1, 170.1, 115.1, 36001};
  for (std::size_t i = 0; i < 6; ++i) {
    double q[6] = {};
    q[i] = over[i];
    EXPECT_EQ(code_of(image::kMoveJoints, {q[0], q[1], q[2], q[3], q[4], q[5]}), 1007) << "joint " << i + 1;
    rig.reset_error();
    rig.resume();
  }
  EXPECT_EQ(code_of(image::kMoveJoints, {175, 90, 70, 170, 115, 100}), 0);
  EXPECT_EQ(code_of(image::kMoveJointsRel, {1, 0, 0, 0, 0, 0}), 1007);
}

TEST_F(Refusal, OfPosesOutOfReachIs1016) {
  rig.make_ready();
  EXPECT_EQ(code_of(image::kMovePose, {600, 0, 300, 0, 90, 0}), 1016);
  rig.reset_error();
  rig.resume();
  EXPECT_EQ(code_of(image::kMoveLin, {600, 0, 308, 0, 90, 0}), 1016);
}

TEST_F(Refusal, OfAPoseThatOnlyJointsOverTheirLimitsReachIs1007) {
  rig.make_ready();
  // A tool that looks back into the arm: reachable by geometry, joint 5 would need more than 115 degrees.
  const PoseNumbers p = to_pose(forward({0, 20, 30, 0, 140, 0}));
  rig.send(image::kSetConf, {1, 1, 1});
  EXPECT_EQ(code_of(image::kMovePose, {p[0], p[1], p[2], p[3], p[4], p[5]}), 1007);
}

TEST_F(Refusal, OfALineThatCannotBeCompletedComesBeforeTheArmMoves) {
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 20, 0});
  const double before = rig.joint(2);
  rig.send(image::kMoveLinRelWrf, {400, 0, 0, 0, 0, 0});
  rig.run(100ms);
  EXPECT_EQ(rig.error(), 1016);
  EXPECT_EQ(rig.joint(2), before);
}

TEST_F(Refusal, OfALineOverAJointLimitIs1007) {
  rig.make_ready();
  rig.perform(image::kMoveJoints, {170, 20, 20, 0, 40, 0});
  // Sideways from 170 degrees: joint 1 would have to pass 175.
  EXPECT_EQ(code_of(image::kMoveLinRelWrf, {0, -60, 0, 0, 0, 0}), 1007);
}

TEST_F(Refusal, OfALinePastTheWristSingularityIs1012) {
  rig.make_ready();
  // The wrist bends back past the stretched position, beside the plane in which it could pass exactly (joint 6 is
  // turned by 8 degrees): joint 4 would have to turn by half a turn in no time.
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 12, 8});
  EXPECT_EQ(code_of(image::kMoveLinRelTrf, {0, 0, 0, 0, -60, 0}), 1012);
}

TEST_F(Refusal, DoesNotMeetALineExactlyThroughTheWristSingularity) {
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 12, 0});
  EXPECT_EQ(code_of(image::kMoveLinRelTrf, {0, 0, 0, 0, -60, 0}), 0);
  EXPECT_LT(rig.joint(5), -5);
  EXPECT_NEAR(rig.joint(4), 0, 1e-3);
}

TEST_F(Refusal, MeetsALineThroughTheWristSingularityWhenThePostureIsFixed) {
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 12, 0});
  rig.send(image::kSetConf, {1, 1, 1});
  EXPECT_EQ(code_of(image::kMoveLinRelTrf, {0, 0, 0, 0, -60, 0}), 1012);
}

TEST_F(Refusal, OfALineThatStartsInAnotherPostureIs1033) {
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 20, 0});
  rig.send(image::kSetConf, {1, 1, -1});
  EXPECT_EQ(code_of(image::kMoveLinRelWrf, {0, 0, -10, 0, 0, 0}), 1033);
}

TEST_F(Refusal, OfALineThatStartsInAnotherTurnIs1033) {
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 20, 0});
  rig.send(image::kSetConfTurn, {1});
  EXPECT_EQ(code_of(image::kMoveLinRelWrf, {0, 0, -10, 0, 0, 0}), 1033);
}

TEST_F(Refusal, OfTooShortAMoveDurationIs3051WhenItsSeveritySaysSo) {
  rig.make_ready();
  rig.send(image::kSetMoveMode, {1});
  rig.send(image::kSetMoveDuration, {0.1});
  EXPECT_EQ(code_of(image::kMoveJoints, {90, 0, 0, 0, 0, 0}), 0);  // a warning by default
  rig.send(image::kSetMoveDurationCfg, {4});
  EXPECT_EQ(code_of(image::kMoveJoints, {0, 0, 0, 0, 0, 0}), 3051);
}

TEST_F(Refusal, WhileInErrorIs1011InTheJournalAndTheFirstErrorStays) {
  rig.make_ready();
  EXPECT_EQ(code_of(52), 1001);
  rig.send(image::kSetJointVel, {50});
  EXPECT_EQ(rig.error(), 1001);
  EXPECT_EQ(rig.robot.journal().back().outcome, Outcome::kRefused);
  EXPECT_EQ(rig.robot.journal().back().code, 1011);
}

TEST_F(Refusal, OfConfigurationWhileActivatedIs1026) {
  rig.make_ready();
  EXPECT_EQ(code_of(image::kSetJointLimitsCfg, {1}), 1026);
}

TEST_F(Refusal, OfEquipmentThatIsNotThereSaysSo) {
  rig.make_ready();
  const std::pair<std::uint32_t, std::uint16_t> missing[] = {
      {image::kGripper, 1038}, {image::kMoveGripper, 1038}, {image::kSetValveState, 1041}, {10000, 1554}, {19999, 1554},
  };
  for (const auto& [id, code] : missing) {
    EXPECT_EQ(code_of(id, {1, 1, 1, 1, 1, 1}), code) << id;
    rig.reset_error();
    rig.resume();
  }
}

TEST_F(Refusal, OfVariablesAsArgumentsIs1551WhereTheFirmwareKnowsThem) {
  rig.make_ready();
  rig.out.motion_control.use_variables = true;
  EXPECT_EQ(code_of(image::kSetJointVel, {10001}), 1551);
}

TEST_F(Refusal, InCyclicModeDoesNotFloodTheJournal) {
  rig.out.motion_control.set_point = true;
  rig.out.motion_command = {image::kMoveJointsVel, {1, 0, 0, 0, 0, 0}};
  rig.run(1s);
  EXPECT_EQ(rig.error(), 1005);
  EXPECT_EQ(rig.robot.journal().size(), 1u);
}

TEST(JointLimits, OfTheUserHoldOnlyWhileEnabledAndNotInRecoveryMode) {
  Rig rig;
  rig.send(image::kSetJointLimits, {1, -30, 30});
  rig.send(image::kSetJointLimitsCfg, {1});
  EXPECT_EQ(rig.error(), 0);
  rig.make_ready();
  rig.perform(image::kMoveJoints, {31, 0, 0, 0, 0, 0});
  EXPECT_EQ(rig.error(), 1007);
  rig.reset_error();
  rig.out.robot_control.recovery_mode = true;
  rig.resume();
  rig.perform(image::kMoveJoints, {31, 0, 0, 0, 0, 0});
  EXPECT_EQ(rig.error(), 0);
}

TEST(JointLimits, NarrowerThan25DegreesAreRefused) {
  Rig rig;
  rig.send(image::kSetJointLimits, {1, -10, 14});
  EXPECT_EQ(rig.error(), 1003);
}

}  // namespace
}  // namespace meca::sim
