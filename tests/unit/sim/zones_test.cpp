// Work zone (152, 153), collisions (154), tool sphere (155), calibration (156); dynamic data 17, 18, 19, 30, 36,
// 37, 38.
#include "sim/zones.hpp"

#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using Six = std::array<float, 6>;

constexpr double kSilent = 0, kWarning = 1, kError = 4;  // severities
constexpr double kFlange = 1, kTool = 2, kTheLot = 3;    // SetWorkZoneCfg, mode
constexpr double kTolerance = 0.01;                      // mm that the model lets pass at a border
const std::vector<double> kStart{0, 10, 10, 0, 40, 0};

class Watching : public testing::Test {
 protected:
  void go_to_start() {
    rig.make_ready();
    rig.perform(image::kMoveJoints, kStart);
    ASSERT_EQ(rig.error(), 0);
  }
  // Down to `floor` mm with the flange, and as wide as nothing can reach.
  void floor_at(double floor, double severity, double mode = kFlange) {
    rig.send(image::kSetWorkZoneCfg, {severity, mode});
    rig.send(image::kSetWorkZoneLimits, {-900, -900, floor, 900, 900, 900});
    ASSERT_EQ(rig.error(), 0);
  }
  void reset_and_resume() {
    rig.reset_error();
    rig.resume();
    ASSERT_EQ(rig.error(), 0);
    ASSERT_FALSE(rig.motion().paused);
  }
  void reactivate() {
    rig.out.robot_control.deactivate = true;
    rig.run(10ms);
    rig.out.robot_control.deactivate = false;
    rig.activate();
  }
  Six values(std::uint32_t type) {
    rig.out.dynamic_data_configuration.type_ids[2] = type;
    rig.run(2ms);
    return rig.robot.inputs().dynamic_data[2].values;
  }
  double height() const { return rig.robot.inputs().target_end_effector_pose.z; }
  bool in_zone() const { return !rig.robot.inputs().robot_status.work_zone_status; }
  bool collides() const { return rig.robot.inputs().robot_status.collision_status; }
  Rig rig;
};

using AWorkZone = Watching;
using ACollision = Watching;
using AConfiguration = Watching;

TEST_F(AConfiguration, IsShownAndSurvivesActivation) {
  EXPECT_EQ(values(17), (Six{0, 1}));
  EXPECT_EQ(values(18), (Six{-10000, -10000, -10000, 10000, 10000, 10000}));
  EXPECT_EQ(values(19), Six{});
  EXPECT_EQ(values(30), (Six{1, 1}));
  EXPECT_EQ(values(36), Six{});
  rig.send(image::kSetJointLimits, {1, -90, 90});
  rig.send(image::kSetJointLimitsCfg, {1});
  rig.send(image::kSetWorkZoneCfg, {4, 3});
  rig.send(image::kSetWorkZoneLimits, {-300, -301, -1, 302, 303, 600});
  rig.send(image::kSetCollisionCfg, {1});
  rig.send(image::kSetToolSphere, {1, 2, 30, 4});
  rig.send(image::kSetCalibrationCfg, {0});
  ASSERT_EQ(rig.error(), 0);
  rig.make_ready();
  reactivate();
  EXPECT_EQ(values(14)[0], -90);
  EXPECT_EQ(values(17), (Six{4, 3}));
  EXPECT_EQ(values(18), (Six{-300, -301, -1, 302, 303, 600}));
  EXPECT_EQ(values(19), (Six{1, 2, 30, 4}));
  EXPECT_EQ(values(30), (Six{0, 1}));
  EXPECT_EQ(values(36), (Six{1}));
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(AConfiguration, NeedsADeactivatedRobotOfFirmware11) {
  rig.activate();
  const std::pair<std::uint32_t, std::vector<double>> commands[] = {{image::kSetWorkZoneCfg, {4, 1}},
                                                                    {image::kSetWorkZoneLimits, {-1, -1, -1, 1, 1, 1}},
                                                                    {image::kSetCollisionCfg, {4}},
                                                                    {image::kSetToolSphere, {0, 0, 10, 10}},
                                                                    {image::kSetCalibrationCfg, {1}}};
  for (const auto& [id, arguments] : commands) {
    rig.send(id, arguments);
    EXPECT_EQ(rig.error(), 1026) << id;
    rig.reset_error();
  }
  rig = Rig(Rig::quick(image::Layout::kFirmware10));
  for (const auto& [id, arguments] : commands) {
    rig.send(id, arguments);
    EXPECT_EQ(rig.error(), 1001) << id;
    rig.reset_error();
  }
}

TEST_F(AConfiguration, ZoneWithoutAnInsideIs1003AndChangesNothing) {
  rig.send(image::kSetWorkZoneLimits, {-300, -300, 0, 300, 300, 600});
  rig.send(image::kSetWorkZoneLimits, {-300, 300, 0, 300, 300, 600});
  EXPECT_EQ(rig.error(), 1003);
  EXPECT_EQ(values(18), (Six{-300, -300, 0, 300, 300, 600}));
}

TEST_F(AConfiguration, SixZerosGiveBackTheFactorysZone) {
  rig.send(image::kSetWorkZoneLimits, {-300, -300, 0, 300, 300, 600});
  rig.send(image::kSetWorkZoneLimits, {0, 0, 0, 0, 0, 0});
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(values(18), (Six{-10000, -10000, -10000, 10000, 10000, 10000}));
}

TEST_F(AWorkZone, WithSeverity0IsNotWatched) {
  floor_at(290, kSilent);
  go_to_start();
  rig.perform(image::kMoveLinRelWrf, {0, 0, -80, 0, 0, 0});
  EXPECT_EQ(rig.error(), 0);
  EXPECT_TRUE(in_zone());
  EXPECT_EQ(values(38), Six{});
}

TEST_F(AWorkZone, WithSeverity1ShowsTheBreachAsLongAsItLasts) {
  floor_at(150, kWarning);
  go_to_start();
  const double start = height();
  ASSERT_GT(start, 155);
  rig.send(image::kMoveLinRelWrf, {0, 0, 120 - start, 0, 0, 0});
  rig.run_until([](const auto& in) { return in.robot_status.work_zone_status; });
  EXPECT_GE(height(), 150);       // it is seen coming
  EXPECT_LT(height(), 150 + 25);  // at 150 mm/s and a ramp of 0.2 s
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  EXPECT_NEAR(height(), 120, 1e-3);
  EXPECT_EQ(values(38), (Six{1, 1, 0}));
  rig.perform(image::kMoveLinRelWrf, {0, 0, 50, 0, 0, 0});
  EXPECT_TRUE(in_zone());
  EXPECT_EQ(values(38), Six{});
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(AWorkZone, WithSeverity4StopsTheArmOnItsPathBeforeTheBorder) {
  floor_at(150, kError);
  go_to_start();
  const image::Pose start = rig.robot.inputs().target_end_effector_pose;
  rig.send(image::kMoveLinRelWrf, {0, 0, 100 - start.z, 0, 0, 0});
  rig.send(image::kSetCheckpoint, {4});
  rig.run_until([](const auto& in) { return in.robot_status.error_code != 0; });
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3049);
  EXPECT_FALSE(in_zone());
  EXPECT_EQ(values(38), (Six{1, 1, 0}));
  EXPECT_TRUE(rig.motion().eom);
  EXPECT_TRUE(rig.motion().cleared);
  EXPECT_EQ(rig.motion().checkpoint_discarded, 4);
  EXPECT_GE(height(), 150);
  EXPECT_LT(height(), 150.5);
  EXPECT_NEAR(rig.robot.inputs().target_end_effector_pose.x, start.x, 1e-3);
}

TEST_F(AWorkZone, LetsTheArmLeaveAfterResetAndResumeButNotGoOn) {
  floor_at(150, kError);
  go_to_start();
  rig.perform(image::kMoveLinRelWrf, {0, 0, -200, 0, 0, 0});
  rig.run(500ms);
  ASSERT_EQ(rig.error(), 3049);
  rig.reset_error();
  EXPECT_FALSE(in_zone());  // ResumeMotion clears the event, ResetError only the error
  rig.resume();
  EXPECT_TRUE(in_zone());
  const double stopped = height();
  rig.perform(image::kMoveLinRelWrf, {0, 0, -30, 0, 0, 0});
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3049);
  EXPECT_NEAR(height(), stopped, 0.1);
  reset_and_resume();
  rig.perform(image::kMoveLinRelWrf, {0, 0, 30, 0, 0, 0});
  EXPECT_EQ(rig.error(), 0);
  EXPECT_NEAR(height(), stopped, 32);
  EXPECT_GT(height(), stopped + 25);
}

TEST_F(AWorkZone, HoldsForJointMovesBlendedMovesAndVelocitiesAtAnySpeedAndStep) {
  for (const Time dt : {1ms, 2ms, 7ms}) {
    for (const double speed : {5.0, 25.0, 150.0}) {
      for (const int kind : {0, 1, 2, 3}) {
        rig = Rig();
        floor_at(150, kError);
        go_to_start();
        rig.perform(image::kSetJointVel, {speed});
        rig.perform(image::kSetVelTimeout, {1});
        if (kind == 0) rig.send(image::kMoveJoints, {40, 80, 20, 0, 60, 0});
        if (kind == 1) {
          rig.send(image::kMoveJoints, {10, 20, 10, 0, 40, 0});
          rig.send(image::kMoveJoints, {20, 80, 20, 0, 60, 0});
        }
        if (kind >= 2) rig.out.motion_control.move_id = 0;
        if (kind == 2) rig.out.motion_command = {image::kMoveJointsVel, {0, static_cast<float>(speed), 0, 0, 0, 0}};
        if (kind == 3) rig.out.motion_command = {image::kMoveLinVelWrf, {0, 0, static_cast<float>(-speed), 0, 0, 0}};
        rig.run_until([](const auto& in) { return in.robot_status.error_code != 0; }, 60s, dt);
        rig.run(1s, dt);
        EXPECT_EQ(rig.error(), 3049);
        EXPECT_TRUE(rig.motion().eom);
        EXPECT_GE(height(), 150 - kTolerance) << "kind " << kind << ", speed " << speed << ", step " << dt.count();
        EXPECT_LT(height(), 170) << "kind " << kind << ", speed " << speed << ", step " << dt.count();
      }
    }
  }
}

TEST_F(AWorkZone, ThatDoesNotHoldTheArmIsAnErrorAtActivationThatTheArmCanLeave) {
  go_to_start();
  const double start = height();
  rig.out.robot_control.deactivate = true;
  rig.run(10ms);
  rig.out.robot_control.deactivate = false;
  floor_at(start + 20, kError);
  rig.activate();
  EXPECT_EQ(rig.error(), 3049);
  reset_and_resume();
  rig.perform(image::kMoveLinRelWrf, {0, 0, -5, 0, 0, 0});  // deeper
  EXPECT_EQ(rig.error(), 3049);
  rig.run(500ms);
  reset_and_resume();
  rig.perform(image::kMoveLinRelWrf, {0, 0, 10, 0, 0, 0});  // out of it, half the way
  EXPECT_EQ(rig.error(), 0);
  rig.perform(image::kMoveLinRelWrf, {0, 0, -5, 0, 0, 0});  // and back
  EXPECT_EQ(rig.error(), 3049);
  rig.run(500ms);
  reset_and_resume();
  rig.perform(image::kMoveLinRelWrf, {0, 0, 20, 0, 0, 0});
  EXPECT_EQ(rig.error(), 0);
  EXPECT_TRUE(in_zone());
}

TEST_F(AWorkZone, HoldsInRecoveryModeToo) {
  floor_at(150, kError);
  go_to_start();
  rig.out.robot_control.recovery_mode = true;
  rig.perform(image::kMoveLinRelWrf, {0, 0, -200, 0, 0, 0});
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3049);
  EXPECT_GE(height(), 150 - kTolerance);
}

TEST_F(AWorkZone, OfMode2IsForTheToolSphere) {
  rig.send(image::kSetToolSphere, {0, 0, 40, 10});
  floor_at(150, kError, kTool);
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 90, 0});  // the tool points down
  ASSERT_EQ(rig.error(), 0);
  rig.perform(image::kMoveLinRelWrf, {0, 0, -60, 0, 0, 0});
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3049);
  EXPECT_GE(height(), 150 + 50);
  EXPECT_LT(height(), 150 + 51);
  EXPECT_EQ(values(38), (Six{1, 2, 0}));
}

TEST_F(AWorkZone, OfMode2IsForTheFlangeWhenThereIsNoToolSphere) {
  floor_at(190, kError, kTool);
  go_to_start();
  rig.perform(image::kMoveLinRelWrf, {0, 0, -200, 0, 0, 0});
  rig.run(500ms);
  EXPECT_EQ(values(38), (Six{1, 1, 0}));
}

TEST_F(AWorkZone, OfMode3IsForTheLinksAsWell) {
  rig.send(image::kSetWorkZoneCfg, {kError, kTheLot});
  rig.send(image::kSetWorkZoneLimits, {-100, -900, 0, 900, 900, 900});
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, -60, 0, 0, 0, 0});  // the elbow goes back, the flange stays in front for a while
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3049);
  EXPECT_EQ(values(38), (Six{1, 0, 3}));
  EXPECT_GT(rig.robot.inputs().target_end_effector_pose.x, 0);
}

TEST_F(ACollision, WithSeverity0IsNotWatched) {
  go_to_start();
  rig.robot.place_obstacle(150, 0, 250, 50);
  rig.run(10ms);
  EXPECT_FALSE(collides());
  rig.perform(image::kMoveJoints, {0, 90, 70, 0, 0, 0});  // into its own base
  EXPECT_EQ(rig.error(), 0);
  EXPECT_FALSE(collides());
}

TEST_F(ACollision, WithItselfStopsTheArmBeforeItWithSeverity4) {
  rig.send(image::kSetCollisionCfg, {kError});
  go_to_start();
  rig.send(image::kMoveJoints, {0, 90, 70, 0, 0, 0});
  rig.run_until([](const auto& in) { return in.motion_status.eob; });
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3041);
  EXPECT_TRUE(collides());
  const Six status = values(37);
  EXPECT_EQ(status[0], 1);
  EXPECT_EQ(status[1], 0);
  EXPECT_EQ(status[3], 0);
  EXPECT_LT(status[2], status[4]);  // the base or link 1 with one of the forearm
  Joints q;
  for (int i = 0; i < 6; ++i) q[static_cast<std::size_t>(i)] = rig.joint(i + 1);
  const Breach b = collision(arm_shape(q, {}), std::nullopt);
  EXPECT_LE(b.depth, 0);
  EXPECT_GT(b.depth, -2);
  reset_and_resume();
  EXPECT_FALSE(collides());
  rig.perform(image::kMoveJoints, kStart);
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(ACollision, WithAnObstacleIsSeenComing) {
  rig.send(image::kSetCollisionCfg, {kError});
  go_to_start();
  rig.robot.place_obstacle(0, 190, 250, 40);
  rig.perform(image::kMoveJoints, {90, 10, 10, 0, 40, 0});
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3041);
  EXPECT_EQ(values(37)[3], 3);  // with the environment
  EXPECT_GT(rig.joint(1), 20);
  EXPECT_LT(rig.joint(1), 80);
  rig.robot.place_obstacle(0, 0, 0, 0);
  EXPECT_TRUE(rig.run(10ms).robot_status.collision_status);  // until resumed
  reset_and_resume();
  EXPECT_EQ(values(37), Six{});
  rig.perform(image::kMoveJoints, {90, 10, 10, 0, 40, 0});
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(ACollision, WithSomethingThatIsPutOntoTheArmIsNoticedAtOnce) {
  rig.send(image::kSetCollisionCfg, {kError});
  go_to_start();
  rig.robot.place_obstacle(0, 0, 200, 10);
  rig.step();
  EXPECT_EQ(rig.error(), 3041);
  EXPECT_EQ(values(37), (Six{1, 0, 2, 3, 0}));
}

TEST_F(ACollision, WithSeverity1DoesNotStopTheArm) {
  rig.send(image::kSetCollisionCfg, {kWarning});
  go_to_start();
  rig.robot.place_obstacle(0, 190, 250, 40);
  bool seen = false;
  rig.send(image::kMoveJoints, {170, 10, 10, 0, 40, 0});
  while (!rig.motion().eob) seen = rig.step().robot_status.collision_status || seen;
  EXPECT_TRUE(seen);
  EXPECT_FALSE(collides());  // past it
  EXPECT_NEAR(rig.joint(1), 170, 1e-4);
  EXPECT_EQ(rig.error(), 0);
}

TEST_F(ACollision, OfTheToolSphereWithTheBaseNamesThemBoth) {
  rig.send(image::kSetToolSphere, {0, 0, 90, 20});
  rig.send(image::kSetCollisionCfg, {kError});
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, 10, 60, 0, 20, 0});
  rig.perform(image::kMoveJoints, {0, 30, 60, 0, 70, 0});  // the tool swings in towards the base
  rig.run(500ms);
  EXPECT_EQ(rig.error(), 3041);
  EXPECT_EQ(values(37), (Six{1, 2, 0, 0, 0}));
}

}  // namespace
}  // namespace meca::sim
