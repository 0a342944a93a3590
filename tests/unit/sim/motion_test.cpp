// How the arm moves: speeds, lines, frames, postures, velocity mode, blending.
#include <algorithm>
#include <cmath>
#include <random>

#include "sim/inverse.hpp"
#include "sim/kinematics.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

double seconds(Time t) { return std::chrono::duration<double>(t).count(); }

PoseNumbers numbers(const image::Pose& p) { return {p.x, p.y, p.z, p.alpha, p.beta, p.gamma}; }

class Moves : public testing::Test {
 protected:
  Moves() { rig.make_ready(); }
  void go(const std::vector<double>& joints) { rig.perform(image::kMoveJoints, joints); }
  Joints joints() const {
    Joints q;
    for (int i = 0; i < 6; ++i) q[static_cast<std::size_t>(i)] = rig.joint(i + 1);
    return q;
  }
  PoseNumbers pose() const { return numbers(rig.robot.inputs().target_end_effector_pose); }
  void expect_pose(const PoseNumbers& wanted, double tolerance = 1e-3) const {
    const Transform a = to_transform(pose()), b = to_transform(wanted);
    EXPECT_NEAR(norm(a.p - b.p), 0, tolerance);
    EXPECT_NEAR(axis_angle(a.r * transpose(b.r)).degrees, 0, tolerance);
  }
  Rig rig;
};

// --- speeds (spec 6.2: public 1 kHz log of an R4 at SetJointVel 50, SetJointAcc 50, SetBlending 50)

TEST_F(Moves, SixtyDegreesOfJoint1At50PercentHaveAPlateauOf75AndRampsOf0Point2Seconds) {
  rig.send(image::kSetJointVel, {50});
  rig.send(image::kSetJointAcc, {50});
  rig.send(image::kMoveJoints, {60, 0, 0, 0, 0, 0});
  double top = 0, before = rig.joint(1);
  int below_plateau = 0, moving = 1;
  while (!rig.motion().eob) {
    rig.step();
    const double speed = (rig.joint(1) - before) / 1e-3;
    before = rig.joint(1);
    top = std::max(top, speed);
    ++moving;
    if (speed < 74.9) ++below_plateau;
  }
  EXPECT_NEAR(top, 75, 0.1);
  EXPECT_NEAR(below_plateau, 400, 25);  // milliseconds: up and down, S-curves touch the plateau softly
  EXPECT_NEAR(moving, 1000, 3);         // on its own: 60 / 75 + 0.2 s
}

TEST_F(Moves, BetweenBlendedMovesAt50PercentTheyFollowEachOtherIn0Point9Seconds) {
  // What the log shows: with SetBlending 50 half a ramp is shared, so 60 degrees take 0.900 s.
  rig.send(image::kSetJointVel, {50});
  rig.send(image::kSetJointAcc, {50});
  rig.send(image::kSetBlending, {50});
  Time reached[4]{};
  for (const double n : {1.0, 2.0, 3.0}) {
    rig.send(image::kMoveJoints, {static_cast<int>(n) % 2 ? 30.0 : -30.0, 0, 0, 0, 0, 0});
    rig.send(image::kSetCheckpoint, {n});
  }
  rig.send(image::kMoveJoints, {-30, 0, 0, 0, 0, 0});
  Time t{};
  while (!rig.motion().eob) {
    rig.step();
    t += 1ms;
    const auto n = rig.motion().checkpoint_reached;
    if (n < 4 && reached[n] == Time{}) reached[n] = t;
  }
  EXPECT_NEAR(seconds(reached[2] - reached[1]), 0.9, 0.002);
  EXPECT_NEAR(seconds(reached[3] - reached[2]), 0.9, 0.002);
}

TEST_F(Moves, AllJointsStartAndArriveTogetherOnAStraightJointSpaceLine) {
  rig.send(image::kMoveJoints, {60, 30, -40, 90, 50, -200});
  const double end[] = {60, 30, -40, 90, 50, -200};
  while (!rig.motion().eob) {
    rig.step();
    const double share = rig.joint(1) / 60;
    for (int i = 2; i <= 6; ++i) ASSERT_NEAR(rig.joint(i), share * end[i - 1], 1e-3);
  }
}

TEST_F(Moves, NoJointIsFasterThanItMay) {
  rig.send(image::kSetJointVel, {100});
  rig.send(image::kMoveJoints, {100, 50, 60, -160, 100, 400});
  Joints before = joints();
  while (!rig.motion().eob) {
    rig.step();
    const Joints now = joints();
    for (std::size_t i = 0; i < 6; ++i) ASSERT_LE(std::abs(now[i] - before[i]) / 1e-3, kTopSpeed[i] + 0.1);
    before = now;
  }
}

TEST_F(Moves, JointVelocityLimitCapsJointMoves) {
  rig.send(image::kSetJointVel, {100});
  rig.send(image::kSetJointVelLimit, {10});
  const Time t = rig.perform(image::kMoveJoints, {30, 0, 0, 0, 0, 0});
  EXPECT_NEAR(seconds(t), 30.0 / 15 + 0.125, 0.01);
}

TEST_F(Moves, TimeScalingStretchesMovesAndDelays) {
  rig.send(image::kSetTimeScaling, {50});
  EXPECT_NEAR(seconds(rig.perform(image::kDelay, {1})), 2, 0.005);
}

TEST_F(Moves, ADelayIsRestButNotTheEndOfTheBlock) {
  rig.send(image::kDelay, {0.5});
  rig.run(100ms);
  EXPECT_TRUE(rig.motion().eom);
  EXPECT_FALSE(rig.motion().eob);
  rig.run(450ms);
  EXPECT_TRUE(rig.motion().eob);
}

TEST_F(Moves, TimeBasedMovesTakeTheTimeTheyAreGiven) {
  rig.send(image::kSetMoveMode, {1});
  rig.send(image::kSetMoveDuration, {2.5});
  EXPECT_NEAR(seconds(rig.perform(image::kMoveJoints, {60, 10, 10, 0, 40, 0})), 2.5, 0.003);
  EXPECT_NEAR(seconds(rig.perform(image::kMoveLinRelWrf, {0, 0, -20, 0, 0, 0})), 2.5, 0.003);
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(Moves, RelativeJointMovesAddUp) {
  go({10, 20, 30, 40, 50, 60});
  rig.perform(image::kMoveJointsRel, {1, -2, 3, -4, 5, -6});
  const Joints wanted{11, 18, 33, 36, 55, 54};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(joints()[i], wanted[i], 1e-4);
}

// --- poses and lines

TEST_F(Moves, ThePoseShownIsForwardKinematicsOfTheJointsShown) {
  std::mt19937 random(7);
  for (int n = 0; n < 40; ++n) {
    double q[6];
    for (std::size_t i = 0; i < 6; ++i) {
      const double reach = i == 5 ? 3000 : 0.95;
      const double low = i == 5 ? -reach : kModelLimits.minimum[i] * reach;
      const double high = i == 5 ? reach : kModelLimits.maximum[i] * reach;
      q[i] = std::uniform_real_distribution<double>(low, high)(random);
    }
    rig.send(image::kMoveJoints, {q[0], q[1], q[2], q[3], q[4], q[5]});
    while (!rig.motion().eob) {
      rig.step(7ms);
      const PoseNumbers fk = to_pose(forward(joints()));
      ASSERT_LT(norm(Vec3{pose()[0] - fk[0], pose()[1] - fk[1], pose()[2] - fk[2]}), 1e-3);
      for (std::size_t i = 3; i < 6; ++i) {
        if (std::abs(std::abs(fk[4]) - 90) < 0.01) continue;  // alpha and gamma are not determined alone
        ASSERT_NEAR(std::remainder(pose()[i] - fk[i], 360.0), 0, 1e-3);
      }
      const Mat3 difference = to_transform(pose()).r * transpose(forward(joints()).r);
      ASSERT_NEAR(axis_angle(difference).degrees, 0, 1e-3);
    }
    ASSERT_EQ(rig.error(), 0);
  }
}

TEST_F(Moves, MovePoseReachesThePoseThroughTheNearestJointSet) {
  go({20, 10, 10, 10, 30, 10});
  const PoseNumbers target = to_pose(forward({25, 15, 5, 20, 40, 30}));
  rig.perform(image::kMovePose, {target[0], target[1], target[2], target[3], target[4], target[5]});
  expect_pose(target);
  const Joints wanted{25, 15, 5, 20, 40, 30};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(joints()[i], wanted[i], 1e-2);
}

TEST_F(Moves, MovePoseKeepsTheTurnOfJoint6NearByDefaultAndTakesTheOneOfSetConfTurn) {
  go({20, 10, 10, 10, 30, 730});
  const PoseNumbers target = to_pose(forward({25, 15, 5, 20, 40, 20}));
  rig.perform(image::kMovePose, {target[0], target[1], target[2], target[3], target[4], target[5]});
  EXPECT_NEAR(rig.joint(6), 740, 1e-2);
  EXPECT_EQ(rig.robot.inputs().target_configuration.turn, 2);
  rig.send(image::kSetConfTurn, {-1});
  rig.perform(image::kMovePose, {target[0], target[1], target[2], target[3], target[4], target[5]});
  EXPECT_NEAR(rig.joint(6), 20 - 360, 1e-2);
}

TEST_F(Moves, MovePoseTakesThePostureOfSetConf) {
  go({20, 10, 10, 20, 30, 10});
  const PoseNumbers target = pose();
  rig.send(image::kSetConf, {1, 1, -1});
  rig.perform(image::kMovePose, {target[0], target[1], target[2], target[3], target[4], target[5]});
  expect_pose(target);
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(rig.robot.inputs().target_configuration.wrist, -1);
  EXPECT_NEAR(rig.joint(5), -30, 1e-2);
}

TEST_F(Moves, MoveLinGoesStraightAndTurnsEvenly) {
  go({10, 10, 10, 10, 40, 10});
  const Transform from = to_transform(pose());
  const PoseNumbers step{-30, 40, -25, 10, -15, 20};
  rig.send(image::kMoveLinRelWrf, {step[0], step[1], step[2], step[3], step[4], step[5]});
  const Vec3 travel{step[0], step[1], step[2]};
  const AxisAngle whole = axis_angle(to_transform(step).r);
  double worst_line = 0, worst_turn = 0;
  while (!rig.motion().eob) {
    rig.step();
    const Transform now = to_transform(pose());
    const Vec3 done = now.p - from.p;
    const double share = (done[0] * travel[0] + done[1] * travel[1] + done[2] * travel[2]) / std::pow(norm(travel), 2);
    worst_line = std::max(worst_line, norm(done - share * travel));
    const Mat3 turned = rotation(whole.axis, share * whole.degrees) * from.r;
    worst_turn = std::max(worst_turn, axis_angle(now.r * transpose(turned)).degrees);
  }
  EXPECT_EQ(rig.error(), 0);
  EXPECT_LT(worst_line, 1e-3);  // mm
  EXPECT_LT(worst_turn, 1e-3);  // degrees
  EXPECT_NEAR(norm(to_transform(pose()).p - from.p - travel), 0, 1e-3);
}

TEST_F(Moves, MoveLinKeepsToItsSpeed) {
  go({0, 10, 10, 0, 40, 0});
  rig.send(image::kSetCartLinVel, {100});
  const Time t = rig.perform(image::kMoveLinRelWrf, {0, 0, -80, 0, 0, 0});
  EXPECT_NEAR(seconds(t), 0.8 + 0.2, 0.01);  // ramp of 0.2 s at SetCartAcc 50 (inferred)
}

TEST_F(Moves, MoveLinRelTrfMovesAlongTheToolsAxes) {
  go({0, 10, 10, 0, 40, 0});
  const Transform before = to_transform(pose());
  rig.perform(image::kMoveLinRelTrf, {0, 0, 20, 0, 0, 30});
  const Transform expected = before * to_transform({0, 0, 20, 0, 0, 30});
  expect_pose(to_pose(expected));
}

TEST_F(Moves, FramesOfToolAndWorldChangeThePoseShownAndWhereLinesGo) {
  go({0, 10, 10, 0, 40, 0});
  rig.perform(image::kSetTrf, {0, 0, 50, 0, 0, 0});
  rig.perform(image::kSetWrf, {100, 0, 0, 0, 0, 90});
  const Transform expected =
      inverse(to_transform({100, 0, 0, 0, 0, 90})) * forward(joints()) * to_transform({0, 0, 50, 0, 0, 0});
  expect_pose(to_pose(expected));
  EXPECT_EQ(rig.robot.inputs().target_trf.z, 50);
  EXPECT_EQ(rig.robot.inputs().target_wrf.gamma, 90);

  const PoseNumbers target = to_pose(to_transform({-5, 10, 15, 0, 0, 0}) * expected);
  rig.perform(image::kMoveLin, {target[0], target[1], target[2], target[3], target[4], target[5]});
  EXPECT_EQ(rig.error(), 0);
  expect_pose(target);
}

TEST_F(Moves, SetTrfWaitsForTheArmToStandStillEvenWithBlending) {
  rig.send(image::kMoveJoints, {40, 0, 0, 0, 20, 0});
  rig.send(image::kSetTrf, {0, 0, 10, 0, 0, 0});
  rig.send(image::kMoveJoints, {0, 0, 0, 0, 20, 0});
  rig.run_until([](const auto& in) { return in.target_trf.z == 10; });
  EXPECT_NEAR(rig.joint(1), 40, 0.1);
}

TEST_F(Moves, WithBlendingTheNextMoveStartsBeforeTheArmHasStopped) {
  rig.send(image::kMoveJoints, {40, 0, 0, 0, 0, 0});
  rig.send(image::kMoveJoints, {80, 0, 0, 0, 0, 0});
  double slowest = 1e9, before = rig.joint(1);
  while (rig.joint(1) < 79) {
    rig.step();
    if (rig.joint(1) > 10 && rig.joint(1) < 70) slowest = std::min(slowest, (rig.joint(1) - before) / 1e-3);
    before = rig.joint(1);
  }
  EXPECT_NEAR(slowest, 37.5, 0.1);  // 25 % of 150 deg/s, all the way through the via point
}

TEST_F(Moves, WithoutBlendingTheArmStopsAtEveryPoint) {
  rig.send(image::kSetBlending, {0});
  rig.send(image::kMoveJoints, {20, 0, 0, 0, 0, 0});
  rig.send(image::kMoveJoints, {20, 20, 0, 0, 0, 0});
  while (!rig.motion().eob) {
    rig.step();
    ASSERT_TRUE(rig.joint(2) < 1e-3 || std::abs(rig.joint(1) - 20) < 1e-4) << rig.joint(1);
  }
}

// --- velocity mode

TEST_F(Moves, VelocityStopsWhenNothingFollowsWithinTheTimeout) {
  rig.send(image::kSetVelTimeout, {0.1});
  rig.send(image::kMoveJointsVel, {20, 0, 0, 0, 0, 0});
  rig.run(90ms);
  EXPECT_FALSE(rig.motion().eom);
  const Time t = rig.run_until([](const auto& in) { return in.motion_status.eom; });
  EXPECT_LT(seconds(t), 0.05);  // 20 deg/s at 1200 deg/s^2
  EXPECT_TRUE(rig.motion().eob);
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(Moves, CyclicModeKeepsGoingAsLongAsFramesArriveAndStopsWithoutSetPoint) {
  rig.out.motion_control.set_point = true;
  rig.out.motion_command = {image::kMoveJointsVel, {20, 0, 0, 0, 0, 0}};
  rig.run(2s);
  EXPECT_FALSE(rig.motion().eom);
  EXPECT_FALSE(rig.motion().eob);
  EXPECT_NEAR(rig.joint(1), 40, 0.5);
  rig.out.motion_control.set_point = false;
  rig.run(150ms);
  EXPECT_TRUE(rig.motion().eob);
}

TEST_F(Moves, CyclicVelocityOfZeroIsNotTheEndOfTheBlock) {
  // As on the wire of a real robot (spec 1.4): MoveJointsVel repeated, EOM = 1, EOB = 0.
  rig.out.motion_control.set_point = true;
  rig.out.motion_command = {image::kMoveJointsVel, {}};
  rig.run(20ms);
  EXPECT_TRUE(rig.motion().eom);
  EXPECT_FALSE(rig.motion().eob);
  EXPECT_EQ(rig.motion().fifo_space, 13000);
}

TEST_F(Moves, WhenFramesStopTheVelocityTimeoutRunsToo) {
  rig.out.motion_control.set_point = true;
  rig.out.motion_command = {image::kMoveJointsVel, {20, 0, 0, 0, 0, 0}};
  rig.run(500ms);
  for (int i = 0; i < 150; ++i) rig.robot.step_without_outputs(1ms);
  EXPECT_TRUE(rig.motion().eom);
}

TEST_F(Moves, AnyLaterCommandCancelsVelocity) {
  rig.send(image::kSetVelTimeout, {1});
  rig.send(image::kMoveJointsVel, {20, 0, 0, 0, 0, 0});
  rig.run(100ms);
  rig.send(image::kSetCheckpoint, {21});
  rig.run(100ms);
  EXPECT_TRUE(rig.motion().eob);
  EXPECT_EQ(rig.motion().checkpoint_reached, 21u);
}

TEST_F(Moves, VelocityHaltsSlightlyBeforeAJointLimitWithoutError) {
  rig.out.motion_control.set_point = true;
  rig.out.motion_command = {image::kMoveJointsVel, {0, 0, 100, 0, 0, 0}};
  rig.run(3s);
  EXPECT_LT(rig.joint(3), 70);
  EXPECT_GT(rig.joint(3), 69.5);
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(Moves, TooMuchVelocityIsScaledDownInProportion) {
  rig.out.motion_control.set_point = true;
  rig.out.motion_command = {image::kMoveJointsVel, {450, 45, 0, 0, 0, 0}};
  rig.run(300ms);
  const double a = rig.joint(1), b = rig.joint(2);
  rig.run(100ms);
  EXPECT_NEAR((rig.joint(1) - a) / 0.1, 225, 1);  // R4: 150 % of 150 deg/s
  EXPECT_NEAR((rig.joint(2) - b) / 0.1, 22.5, 0.1);
}

TEST_F(Moves, LinearVelocityFollowsTheAxesOfWorldAndTool) {
  go({0, 10, 10, 0, 40, 0});
  for (const auto& [id, in_tool] : {std::pair{image::kMoveLinVelWrf, false}, {image::kMoveLinVelTrf, true}}) {
    const Transform before = to_transform(pose());
    rig.out.motion_control.set_point = true;
    rig.out.motion_control.move_id = 0;
    rig.out.motion_command = {id, {0, 0, -20, 0, 0, 0}};
    rig.run(700ms);
    rig.out.motion_control.set_point = false;
    rig.run(500ms);
    const Transform after = to_transform(pose());
    const Vec3 axis = in_tool ? -1.0 * column(before.r, 2) : Vec3{0, 0, -1};
    const Vec3 moved = after.p - before.p;
    const double along = moved[0] * axis[0] + moved[1] * axis[1] + moved[2] * axis[2];
    EXPECT_GT(along, 10);
    EXPECT_LT(norm(moved - along * axis), 0.05);
    EXPECT_LT(axis_angle(after.r * transpose(before.r)).degrees, 0.05);
  }
}

TEST_F(Moves, LinearVelocityStopsBeforeTheArmIsStretchedWithoutError) {
  go({0, 10, 10, 0, 40, 0});
  rig.out.motion_control.set_point = true;
  rig.out.motion_control.move_id = 0;
  rig.out.motion_command = {image::kMoveLinVelWrf, {100, 0, 0, 0, 0, 0}};
  rig.run(5s);
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(rig.robot.inputs().target_configuration.elbow, 1);
  const PoseNumbers p = pose();
  EXPECT_GT(p[0], 200);
  EXPECT_LT(p[0], 330);
}

}  // namespace
}  // namespace meca::sim
