#include "sim/robot.hpp"

#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

TEST(Activation, TakesItsTimeAndIsBusyMeanwhile) {
  RobotOptions o;
  o.activation_time = 2s;
  Rig rig(o);
  EXPECT_FALSE(rig.step().robot_status.busy);
  rig.out.robot_control.activate = true;
  EXPECT_TRUE(rig.step().robot_status.busy);
  EXPECT_FALSE(rig.run(1990ms).robot_status.activated);
  EXPECT_TRUE(rig.run(20ms).robot_status.activated);
  EXPECT_FALSE(rig.robot.inputs().robot_status.busy);
  EXPECT_FALSE(rig.robot.inputs().robot_status.homed);
  EXPECT_FALSE(rig.robot.inputs().robot_status.brakes_engaged);
}

TEST(Motion, MoveJointsArrivesWhereItWasSent) {
  Rig rig;
  rig.make_ready();
  rig.perform(image::kMoveJoints, {30, 25, 20, 15, 10, 5});
  EXPECT_EQ(rig.error(), 0);
  const double expected[] = {30, 25, 20, 15, 10, 5};
  for (int i = 1; i <= 6; ++i) EXPECT_FLOAT_EQ(rig.joint(i), expected[i - 1]);
  EXPECT_NEAR(rig.robot.inputs().target_end_effector_pose.x, 179.6164, 1e-3);
}

}  // namespace
}  // namespace meca::sim
