// Any host, however wild: the robot's image stays plausible and its arm inside its limits.
#include <cmath>
#include <limits>
#include <random>

#include "sim/inverse.hpp"
#include "sim/kinematics.hpp"
#include "sim/zones.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

class WildHost {
 public:
  explicit WildHost(std::uint64_t seed) : random_(seed) {}

  image::Outputs outputs() {
    image::Outputs o;
    o.robot_control = {chance(0.003), chance(0.9), chance(0.9), chance(0.2), chance(0.01), chance(0.02), chance(0.1)};
    o.motion_control.set_point = chance(0.9);
    o.motion_control.move_id = chance(0.3) ? 0 : static_cast<std::uint16_t>(random_());
    o.motion_control.pause_motion = chance(0.02);
    o.motion_control.clear_motion = chance(0.01);
    o.motion_control.resume_motion = chance(0.3);
    o.motion_control.use_variables = chance(0.001);
    o.motion_command.command_id = chance(0.01)   ? static_cast<std::uint32_t>(random_())
                                  : chance(0.05) ? 150 + random_() % 7
                                                 : random_() % 61;
    for (float& a : o.motion_command.arguments) a = argument();
    if (chance(0.02)) o.motion_command = {image::kStartProgram, {static_cast<float>(1 + random_() % 4)}};
    for (auto& t : o.dynamic_data_configuration.type_ids) t = chance(0.5) ? 0 : random_() % 70;
    o.brakes_control = {chance(0.5), chance(0.5)};
    return o;
  }
  bool chance(double p) { return std::uniform_real_distribution<double>(0, 1)(random_) < p; }

 private:
  float argument() {
    const float odd[] = {0,
                         1,
                         -1,
                         std::numeric_limits<float>::max(),
                         -std::numeric_limits<float>::max(),
                         std::numeric_limits<float>::denorm_min(),
                         std::numeric_limits<float>::infinity(),
                         std::numeric_limits<float>::quiet_NaN()};
    if (chance(0.02)) return odd[random_() % std::size(odd)];
    return static_cast<float>(std::uniform_real_distribution<double>(-100, 100)(random_));
  }
  std::mt19937_64 random_;
};

void expect_plausible(const Robot& robot) {
  const image::Inputs& in = robot.inputs();
  Joints q;
  for (std::size_t i = 0; i < 6; ++i) {
    q[i] = in.target_joint_set.joints[i];
    ASSERT_TRUE(std::isfinite(q[i]));
  }
  ASSERT_TRUE(kModelLimits.contains(q)) << "joints " << testing::PrintToString(q) << " after command "
                                        << (robot.journal().size() > 0 ? robot.journal().back().command.id : 0);
  ASSERT_LE(in.motion_status.fifo_space, 13000);
  ASSERT_LT(in.robot_timestamp.microseconds, 1'000'000u);
  ASSERT_TRUE(!in.motion_status.eob || in.motion_status.eom);
  ASSERT_TRUE(!in.robot_status.homed || in.robot_status.activated);
  ASSERT_TRUE(!in.motion_status.cleared || in.motion_status.eom);
  ASSERT_TRUE(in.robot_status.activated || in.motion_status.eom);
}

TEST(WildHosts, NeverBringTheImageOutOfShape) {
  for (const auto layout : {image::Layout::kFirmware9, image::Layout::kFirmware10, image::Layout::kFirmware11}) {
    RobotOptions options = Rig::quick(layout);
    options.tool = ToolType::kMegp25ls;
    Rig rig(options);
    WildHost host(42 + static_cast<std::uint64_t>(layout));
    image::Outputs out;
    std::uint64_t moved = 0;
    float before = 0;
    for (int i = 0; i < 40'000; ++i) {
      if (host.chance(0.05)) out = host.outputs();
      if (host.chance(0.0005)) rig.robot.press_p_stop2();
      if (host.chance(0.005)) rig.robot.release_p_stop2();
      if (host.chance(0.0001)) rig.robot.press_e_stop();
      if (host.chance(0.01)) rig.robot.release_e_stop();
      if (host.chance(0.01)) rig.robot.press_reset_button();
      if (host.chance(0.001)) rig.robot.push(1 + i % 6, host.chance(0.5) ? 120 : 0);
      if (host.chance(0.001)) rig.robot.place_obstacle(150, i % 300 - 150, 250, host.chance(0.5) ? 60 : 0);
      if (host.chance(0.02)) {
        rig.robot.step_without_outputs(5ms);
      } else {
        rig.robot.step(out, host.chance(0.01) ? 90ms : 1ms);
      }
      ASSERT_NO_FATAL_FAILURE(expect_plausible(rig.robot)) << "step " << i;
      moved += rig.robot.inputs().target_joint_set.joints[0] != before ? 1 : 0;
      before = rig.robot.inputs().target_joint_set.joints[0];
    }
    EXPECT_GT(moved, 500u);  // the host was wild, not idle
    EXPECT_GT(rig.robot.journal().size(), 100u);
  }
}

TEST(Zones, HoldWhateverTheArmIsAskedToDo) {
  std::mt19937 random(5);
  const auto within = [&](double reach) { return std::uniform_real_distribution<double>(-reach, reach)(random); };
  Rig rig;
  rig.send(image::kSetToolSphere, {10, 0, 40, 25});
  rig.send(image::kSetWorkZoneCfg, {4, 3});
  rig.send(image::kSetWorkZoneLimits, {-150, -200, 40, 300, 200, 450});
  rig.send(image::kSetCollisionCfg, {4});
  rig.make_ready();
  rig.robot.place_obstacle(60, -190, 300, 45);
  rig.send(image::kSetVelTimeout, {0.8});
  const WorkZone zone{4, WorkZone::Mode::kToolAndLinks, {-150, -200, 40}, {300, 200, 450}};
  const Capsule obstacle{{60, -190, 300}, {60, -190, 300}, 45};
  int stopped = 0, undisturbed = 0;
  double before = 0, deeper = 0, deeper_by_twist = 0;  // mm
  for (int n = 0; n < 400; ++n) {
    rig.send(image::kSetJointVel, {20 + std::abs(within(130))});
    rig.send(image::kSetCartLinVel, {20 + std::abs(within(1000))});
    switch (n % 4) {
      case 0:
        for (int i = 0; i < 3; ++i) {  // these blend
          rig.send(image::kMoveJoints, {within(170), within(70), within(70), within(160), within(110), within(180)});
        }
        break;
      case 1:
        rig.send(image::kMoveLinRelWrf, {within(80), within(80), within(80), within(30), within(30), within(30)});
        break;
      case 2:
        rig.send(image::kMoveJointsVel, {within(200), within(100), within(100), within(100), within(100), 0});
        break;
      default:
        rig.send(image::kMoveLinVelTrf, {within(300), within(300), within(300), 0, 0, within(60)});
        break;
    }
    rig.run_until([](const auto& in) { return in.motion_status.eob || in.robot_status.error_code != 0; });
    bool resting = false;
    for (int i = 0; i < 3000 && !resting; ++i) resting = rig.step().motion_status.eom;
    Joints q;
    for (std::size_t i = 0; i < 6; ++i) q[i] = rig.robot.inputs().target_joint_set.joints[i];
    const ArmShape arm = arm_shape(q, {{10, 0, 40}, 25});
    const double depth = std::max({0.0, work_zone_breach(zone, arm).depth, collision(arm, obstacle).depth});
    double& worst = n % 4 == 3 ? deeper_by_twist : deeper;
    worst = std::max(worst, depth - before);
    before = depth;
    rig.error() == 3041 || rig.error() == 3049 ? ++stopped : ++undisturbed;
    if (rig.error() == 0) continue;
    rig.reset_error();
    rig.resume();
    ASSERT_EQ(rig.error(), 0);
  }
  EXPECT_LT(deeper, 0.05);
  EXPECT_LT(deeper_by_twist, 5);  // close to a singularity a Cartesian velocity is not steady
  EXPECT_GT(stopped, 100);
  EXPECT_GT(undisturbed, 50);
}

TEST(Lines, NeverMakeAJointJumpAndEndWhereTheyWereSentOrDoNotStart) {
  std::mt19937 random(99);
  const auto within = [&](double reach) { return std::uniform_real_distribution<double>(-reach, reach)(random); };
  Rig rig;
  rig.make_ready();
  rig.send(image::kSetJointVel, {100});
  int finished = 0, refused = 0;
  for (int n = 0; n < 120; ++n) {
    // Half of them start at, or close to, the wrist singularity.
    const double wrist = n % 4 == 0 ? 0 : n % 2 == 0 ? within(3) : within(90);
    rig.perform(image::kMoveJoints,
                {within(90), within(40), within(40), n % 8 == 0 ? 0 : within(60), wrist, within(90)});
    ASSERT_EQ(rig.error(), 0);
    const image::Inputs before = rig.robot.inputs();
    const double turned = n % 3 == 0 ? 0 : 40;
    const std::vector<double> travel{within(60),     within(60),     within(60),
                                     within(turned), within(turned), within(turned)};
    rig.send(n % 2 == 0 ? image::kMoveLinRelWrf : image::kMoveLinRelTrf, travel);
    image::TargetJointSet last = before.target_joint_set;
    while (!rig.motion().eob) {
      rig.step();
      for (std::size_t i = 0; i < 6; ++i) {
        const double now = rig.robot.inputs().target_joint_set.joints[i];
        ASSERT_LT(std::abs(now - last.joints[i]), 5) << "joint " << i + 1 << ", line " << n;
      }
      last = rig.robot.inputs().target_joint_set;
    }
    if (rig.error() != 0) {
      ++refused;
      ASSERT_EQ(last, before.target_joint_set) << "line " << n;
      rig.reset_error();
      rig.resume();
      continue;
    }
    ++finished;
    const auto& p = rig.robot.inputs().target_end_effector_pose;
    const auto& b = before.target_end_effector_pose;
    const double moved = std::hypot(p.x - b.x, p.y - b.y, p.z - b.z);
    ASSERT_NEAR(moved, std::hypot(travel[0], travel[1], travel[2]), 2e-3) << "line " << n;
  }
  EXPECT_GT(finished, 40);
  EXPECT_GT(refused, 8);
}

}  // namespace
}  // namespace meca::sim
