// The tool on the flange: gripper and pneumatic module (commands 18, 19, 20, 30, 31, 32; dynamic data 16, 23, 52, 53).
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using Six = std::array<float, 6>;

RobotOptions with(ToolType tool) {
  RobotOptions o = Rig::quick();
  o.tool = tool;
  return o;
}

class ToolRig : public testing::Test {
 protected:
  explicit ToolRig(ToolType tool = ToolType::kMegp25ls) : rig(with(tool)) {
    rig.out.dynamic_data_configuration.type_ids = {16, 23, 52, 53};
    rig.run(2ms);  // a request takes effect one cycle later
  }
  Six values(std::size_t slot) const { return rig.robot.inputs().dynamic_data[slot].values; }
  Six settings() const { return values(1); }
  Six status() const { return values(2); }
  Six state() const { return values(3); }
  float opening() const { return state()[5]; }
  void switch_off() {
    rig.out.robot_control.deactivate = true;
    rig.run(10ms);
    rig.out.robot_control.deactivate = false;
  }
  void expect_refused(std::uint32_t id, const std::vector<double>& arguments, std::uint16_t code) {
    rig.perform(id, arguments);
    EXPECT_EQ(rig.error(), code) << id;
    rig.reset_error();
    rig.resume();
  }
  Rig rig;
};

class NoTool : public ToolRig {
 protected:
  NoTool() : ToolRig(ToolType::kNone) {}
};
class ShortGripper : public ToolRig {
 protected:
  ShortGripper() : ToolRig(ToolType::kMegp25e) {}
};
using LongGripper = ToolRig;
class Valves : public ToolRig {
 protected:
  Valves() : ToolRig(ToolType::kMpm500) {}
};

TEST_F(NoTool, ReportsNoneAndRefusesEveryToolCommand) {
  rig.make_ready();
  EXPECT_EQ(values(0), Six{});
  EXPECT_EQ(status(), Six{});
  EXPECT_EQ(state(), Six{});
  for (const std::uint32_t id : {image::kGripper, image::kSetGripperVel, image::kSetGripperForce,
                                 image::kSetGripperRange, image::kMoveGripper}) {
    expect_refused(id, {id == image::kGripper ? 1.0 : 10.0, 20}, 1038);
  }
  expect_refused(image::kSetValveState, {1, 1}, 1041);
  EXPECT_FALSE(rig.robot.place_part(3));
}

TEST_F(ShortGripper, ReportsItsTypeAndIsHomedWithTheRobot) {
  EXPECT_EQ(status(), (Six{10, 0}));
  rig.activate();
  rig.perform(image::kGripper, {0});
  EXPECT_EQ(rig.error(), 1006);
  rig.reset_error();
  rig.home();
  rig.resume();
  EXPECT_EQ(status(), (Six{10, 1}));
  EXPECT_EQ(state(), (Six{0, 1, 0, 1, 0, 6})) << "open after homing";
  EXPECT_NE(values(0), Six{});
}

TEST_F(ShortGripper, HasNoValves) {
  rig.make_ready();
  expect_refused(image::kSetValveState, {1, 1}, 1041);
}

TEST_F(LongGripper, StartsWithTheDefaultsOfAnActivation) {
  rig.make_ready();
  EXPECT_EQ(settings(), (Six{40, 40, 0, 48}));
  rig.perform(image::kSetGripperForce, {55});
  rig.perform(image::kSetGripperVel, {66});
  rig.perform(image::kSetGripperRange, {10, 30});
  rig.step();
  EXPECT_EQ(settings(), (Six{55, 66, 10, 30}));
  switch_off();
  rig.activate();
  EXPECT_EQ(settings(), (Six{40, 40, 0, 48}));
}

TEST_F(LongGripper, MovesAt50MillimetresPerSecondAt100Percent) {
  rig.make_ready();
  rig.perform(image::kSetGripperVel, {100});
  rig.send(image::kGripper, {0});
  const float start = opening();
  rig.run(500ms);
  EXPECT_NEAR(start - opening(), 25, 1e-3);
  EXPECT_EQ(state()[1], 0) << "not there yet";
  rig.run(500ms);
  EXPECT_EQ(state(), (Six{0, 1, 1, 0, 0, 0})) << "closed";
}

TEST_F(LongGripper, OpensAndClosesWithinTheRangeThatIsSet) {
  rig.make_ready();
  rig.perform(image::kSetGripperRange, {10, 30});
  rig.perform(image::kGripper, {1});
  rig.run(2s);
  EXPECT_EQ(state(), (Six{0, 1, 0, 1, 0, 30}));
  rig.perform(image::kGripper, {0});
  rig.run(2s);
  EXPECT_EQ(state(), (Six{0, 1, 1, 0, 0, 10}));
  rig.perform(image::kSetGripperRange, {0, 0});
  rig.perform(image::kGripper, {1});
  rig.run(3s);
  EXPECT_EQ(opening(), 48);
}

TEST_F(LongGripper, GoesToAnOpeningInMillimetres) {
  rig.make_ready();
  rig.perform(image::kMoveGripper, {12.5});
  rig.run(2s);
  EXPECT_EQ(state(), (Six{0, 1, 0, 0, 0, 12.5}));
}

TEST_F(LongGripper, RefusesWhatIsOutOfRangeWith1003) {
  rig.make_ready();
  expect_refused(image::kMoveGripper, {48.5}, 1003);
  expect_refused(image::kSetGripperRange, {0, 48.5}, 1003);
  expect_refused(image::kSetGripperRange, {20, 20}, 1003);
  expect_refused(image::kSetGripperVel, {4.9}, 1003);
  expect_refused(image::kSetGripperForce, {101}, 1003);
  expect_refused(image::kGripper, {0.5}, 1003);
  rig.perform(image::kSetGripperRange, {10, 30});
  expect_refused(image::kMoveGripper, {9}, 1003);
  EXPECT_EQ(opening(), 48) << "it has never moved";
}

TEST_F(LongGripper, ClosesOnAPartAndHoldsItWithTheForceThatIsSet) {
  rig.make_ready();
  ASSERT_TRUE(rig.robot.place_part(20));
  rig.perform(image::kSetGripperForce, {70});
  rig.perform(image::kGripper, {0});
  rig.run(1s);
  EXPECT_EQ(state()[0], 0) << "on the way";
  rig.run(2s);
  EXPECT_EQ(state(), (Six{1, 0, 0, 0, 70, 20}));
  rig.perform(image::kGripper, {1});
  rig.run(20ms);
  EXPECT_EQ(state()[0], 0) << "released";
  EXPECT_EQ(state()[4], 0);
}

TEST_F(LongGripper, ClosesFurtherWhenThePartIsLost) {
  rig.make_ready();
  ASSERT_TRUE(rig.robot.place_part(20));
  rig.perform(image::kGripper, {0});
  rig.run(3s);
  ASSERT_EQ(state()[0], 1);
  ASSERT_TRUE(rig.robot.place_part(0));
  rig.run(3s);
  EXPECT_EQ(state(), (Six{0, 1, 1, 0, 0, 0}));
  EXPECT_FALSE(rig.robot.place_part(20)) << "no room between closed fingers";
}

TEST_F(LongGripper, PressesNoLongerWithoutMotorsAndStaysWhereItIs) {
  rig.make_ready();
  rig.robot.place_part(20);
  rig.perform(image::kGripper, {0});
  rig.run(3s);
  ASSERT_EQ(state()[0], 1);
  switch_off();
  EXPECT_EQ(state()[0], 0);
  EXPECT_EQ(opening(), 20);
  rig.activate();
  rig.run(1s);
  EXPECT_EQ(opening(), 20) << "an activation moves nothing";
  EXPECT_EQ(status()[1], 1) << "homing is kept, as the robot's";
}

TEST_F(LongGripper, NeedsHomingAgainAfterClearHoming) {
  rig.make_ready();
  switch_off();
  rig.perform(image::kClearHoming);
  rig.step();
  EXPECT_EQ(status()[1], 0);
}

// ---------------------------------------------------------------- beside the motion (spec 6.3)

// When, in seconds after the move was sent, the fingers began to move and the arm came to rest.
struct Times {
  double fingers = 0, rest = 0;
};
Times times_of(Rig& rig, std::uint32_t move, const std::vector<double>& arguments) {
  rig.send(move, arguments);
  rig.send(image::kGripper, {0});
  Times t;
  for (int ms = 2; !rig.motion().eob && ms < 20'000; ++ms) {
    rig.step();
    if (t.fingers == 0 && rig.robot.inputs().dynamic_data[3].values[5] < 48) t.fingers = ms / 1000.0;
    t.rest = ms / 1000.0;
  }
  return t;
}

TEST_F(LongGripper, StartsWhereTheMoveBeforeItSlowsDown) {
  rig.make_ready();
  for (const auto& [move, arguments] : {std::pair{image::kMoveJoints, std::vector<double>{60, 0, 0, 0, 20, 0}},
                                        std::pair{image::kMoveLinRelWrf, std::vector<double>{0, 0, -40, 0, 0, 0}}}) {
    const Times t = times_of(rig, move, arguments);
    const double ramp = move == image::kMoveJoints ? 0.1 * 100 / 80 : 0.1 * 100 / 50;
    EXPECT_NEAR(t.rest - t.fingers, ramp, 0.003) << move;
    rig.perform(image::kGripper, {1});
    rig.run(3s);
  }
}

TEST_F(LongGripper, StartsWhereTheMoveBeforeItBlendsWithTheOneBehindIt) {
  rig.make_ready();
  rig.perform(image::kSetBlending, {50});
  rig.send(image::kMoveJoints, {60, 0, 0, 0, 0, 0});
  rig.send(image::kGripper, {0});
  rig.send(image::kMoveJoints, {60, 30, 0, 0, 0, 0});
  while (opening() == 48 && !rig.motion().eob) rig.step();
  EXPECT_LT(opening(), 48);
  EXPECT_LT(rig.joint(1), 60);
  const double left = 60 - rig.joint(1);
  rig.run(3ms);
  EXPECT_GT(rig.joint(2), 0) << "the following motion starts immediately";
  EXPECT_LT(left, 1.5) << "not before the blend, which is the second half of the ramp";
}

TEST_F(LongGripper, HoldsUpNothingBehindIt) {
  rig.make_ready();
  rig.perform(image::kSetGripperVel, {5});
  rig.send(image::kGripper, {0});
  rig.send(image::kSetCheckpoint, {7});
  rig.run(5ms);
  EXPECT_EQ(rig.motion().checkpoint_reached, 7);
  EXPECT_TRUE(rig.motion().eob) << "the queue is empty and the arm at rest";
  EXPECT_GT(opening(), 47) << "while the fingers have hardly begun";
}

TEST_F(LongGripper, DoesNotStartWhileMotionIsPaused) {
  rig.make_ready();
  rig.send(image::kMoveJoints, {1, 0, 0, 0, 0, 0});
  rig.send(image::kGripper, {0});
  rig.out.motion_control.pause_motion = true;
  rig.run(2s);
  EXPECT_EQ(opening(), 48);
  rig.out.motion_control.pause_motion = false;
  rig.resume();
  rig.run(5s);
  EXPECT_EQ(opening(), 0);
}

TEST_F(LongGripper, IsExecutedInTheOrderOfTheQueue) {
  rig.make_ready();
  const auto before = rig.robot.journal().size();
  const std::uint32_t ids[] = {image::kMoveJoints,    image::kSetGripperVel, image::kGripper,
                               image::kSetCheckpoint, image::kMoveJoints,    image::kMoveGripper};
  for (const std::uint32_t id : ids) {
    const double argument = id == image::kSetGripperVel ? 50 : id == image::kGripper ? 0 : 1;
    rig.send(id, {argument, 0, 0, 0, 0, 0});
  }
  rig.run(5s);
  ASSERT_EQ(rig.robot.journal().size() - before, std::size(ids));
  for (std::size_t i = 0; i < std::size(ids); ++i) EXPECT_EQ(rig.robot.journal()[before + i].command.id, ids[i]) << i;
}

// ---------------------------------------------------------------- pneumatic module

TEST_F(Valves, OpenCloseAndKeepTheirState) {
  rig.make_ready();
  EXPECT_EQ(status(), (Six{20, 0}));
  EXPECT_EQ(state(), Six{});
  rig.perform(image::kSetValveState, {1, -1});
  rig.step();
  EXPECT_EQ(state(), (Six{1, 0}));
  rig.perform(image::kSetValveState, {-1, 1});
  rig.step();
  EXPECT_EQ(state(), (Six{1, 1}));
  rig.perform(image::kSetValveState, {0, -1});
  rig.step();
  EXPECT_EQ(state(), (Six{0, 1}));
  expect_refused(image::kSetValveState, {2, 0}, 1003);
  EXPECT_EQ(state(), (Six{0, 1}));
}

TEST_F(Valves, AreNoGripper) {
  rig.make_ready();
  expect_refused(image::kGripper, {1}, 1038);
  EXPECT_FALSE(rig.robot.place_part(3));
}

TEST_F(Valves, SwitchWhereTheMoveBeforeThemSlowsDown) {
  rig.make_ready();
  rig.send(image::kMoveJoints, {60, 0, 0, 0, 0, 0});
  rig.send(image::kSetValveState, {1, 1});
  while (state()[0] == 0 && !rig.motion().eob) rig.step();
  EXPECT_EQ(state(), (Six{1, 1}));
  EXPECT_FALSE(rig.motion().eom);
  EXPECT_NEAR(rig.joint(1), 60, 3);
}

}  // namespace
}  // namespace meca::sim
