// Variables over a cyclic protocol: written by command, read as dynamic data, used as arguments (firmware 11;
// spec 5.8).
#include "sim/variables.hpp"

#include <limits>
#include <stdexcept>

#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using Six = std::array<float, 6>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

RobotOptions with_variables(image::Layout layout = image::Layout::kFirmware11) {
  RobotOptions o = Rig::quick(layout);
  o.variables = {{.cyclic_id = 19999, .size = 6, .values = {1, 2, 3, 4, 5, 6}},
                 {.cyclic_id = 10000, .size = 1, .values = {50}},
                 {.cyclic_id = 10001, .size = 1, .values = {0}},
                 {.cyclic_id = 10002, .size = 2, .values = {30, 40}}};
  return o;
}

class RobotVariables : public testing::Test {
 protected:
  Six read(std::uint32_t id) {
    rig.out.dynamic_data_configuration.type_ids[3] = id;
    rig.run(2ms);
    return rig.robot.inputs().dynamic_data[3].values;
  }
  // The command with its arguments taken from variables.
  std::uint16_t code_of(std::uint32_t id, const std::vector<double>& variables) {
    rig.out.motion_control.use_variables = true;
    rig.perform(id, variables);
    rig.out.motion_control.use_variables = false;
    return rig.error();
  }
  Rig rig{with_variables()};
};

TEST_F(RobotVariables, AreReadAsDynamicDataOfTheirNumber) {
  EXPECT_EQ(read(10000), (Six{50}));
  EXPECT_EQ(read(10002), (Six{30, 40}));
  EXPECT_EQ(read(19999), (Six{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(read(10003), Six{}) << "there is none";
}

TEST_F(RobotVariables, AreWrittenAtOnceInAnyStateOfTheRobot) {
  rig.send(10000, {7});
  EXPECT_EQ(read(10000), (Six{7}));
  rig.make_ready();
  rig.send(image::kDelay, {60});
  rig.send(10000, {8});
  EXPECT_EQ(read(10000), (Six{8})) << "not behind what is in the queue";
  EXPECT_EQ(rig.robot.journal().back().command.id, 10000u);
  EXPECT_EQ(rig.robot.journal().back().outcome, Outcome::kExecuted);
}

TEST_F(RobotVariables, TakeAsManyValuesAsTheyHave) {
  rig.send(10002, {1, 2, 3, kNan});
  EXPECT_EQ(rig.error(), 0);
  EXPECT_EQ(read(10002), (Six{1, 2}));
}

TEST_F(RobotVariables, RefuseValuesThatAreNotFiniteWith1003) {
  rig.send(10002, {1, kNan});
  EXPECT_EQ(rig.error(), 1003);
  EXPECT_EQ(read(10002), (Six{30, 40}));
}

TEST_F(RobotVariables, ThatDoNotExistAreNotWrittenWith1554) {
  rig.send(10003, {1});
  EXPECT_EQ(rig.error(), 1554);
}

TEST_F(RobotVariables, GiveTheirValuesToTheArgumentsOfACommand) {
  rig.make_ready();
  rig.send(10001, {12});
  EXPECT_EQ(code_of(image::kMoveJoints, {10001, 10001, 10001, 10001, 10001, 10000}), 0);
  EXPECT_NEAR(rig.joint(1), 12, 1e-4);
  EXPECT_NEAR(rig.joint(6), 50, 1e-4);
  EXPECT_EQ(rig.robot.journal().back().command.arguments, (Six{12, 12, 12, 12, 12, 50})) << "the journal has values";
}

TEST_F(RobotVariables, AreTakenWhenTheCommandArrivesAndNotWhenItsTurnComes) {
  rig.make_ready();
  rig.send(image::kDelay, {0.1});
  rig.out.motion_control.use_variables = true;
  rig.send(image::kMoveJointsRel, {10000, 10001, 10001, 10001, 10001, 10001});
  rig.out.motion_control.use_variables = false;
  rig.send(10000, {-50});
  rig.run(5s);
  EXPECT_NEAR(rig.joint(1), 50, 1e-4);
}

TEST_F(RobotVariables, ThatAreArraysGiveTheirFirstElement) {
  rig.make_ready();
  EXPECT_EQ(code_of(image::kSetCheckpoint, {10002}), 0);
  EXPECT_EQ(rig.motion().checkpoint_reached, 30);
}

TEST_F(RobotVariables, AreHeldToTheRangesOfTheCommand) {
  rig.make_ready();
  EXPECT_EQ(code_of(image::kSetJointVel, {10001}), 1003) << "0 is no velocity";
}

TEST_F(RobotVariables, ThatDoNotExistAreNoArgumentsWith1551) {
  rig.make_ready();
  for (const double id : {10003.0, 9999.0, 20000.0, 10000.5, -1.0, kNan, 1e30}) {
    EXPECT_EQ(code_of(image::kSetJointVel, {id}), 1551) << id;
    rig.reset_error();
    rig.resume();
  }
}

TEST_F(RobotVariables, AreNeededOnlyForArgumentsThatTheCommandHas) {
  rig.make_ready();
  EXPECT_EQ(code_of(image::kSetJointVel, {10000, 3, 3, 3, 3, 3}), 0);
  rig.out.robot_control.deactivate = true;
  rig.run(10ms);
  EXPECT_EQ(code_of(image::kClearHoming, {3}), 0);
}

TEST_F(RobotVariables, AreCopiedFromEachOther) {
  EXPECT_EQ(code_of(10002, {10000, 10001, 3}), 0);
  EXPECT_EQ(read(10002), (Six{50, 0}));
}

TEST_F(RobotVariables, SteerAVelocityInCyclicMode) {
  rig.make_ready();
  rig.send(10001, {10});
  rig.out.motion_control.move_id = 0;
  rig.out.motion_control.use_variables = true;
  rig.out.motion_command = {image::kMoveJointsVel, {10001, 10001, 10001, 10001, 10001, 10001}};
  rig.run(1s);
  EXPECT_GT(rig.joint(1), 8);
  EXPECT_EQ(rig.error(), 0);
}

TEST(VariablesOfOlderFirmware, DoNotExist) {
  for (const auto layout : {image::Layout::kFirmware9, image::Layout::kFirmware10}) {
    Rig rig(with_variables(layout));
    rig.out.dynamic_data_configuration.type_ids[3] = 10000;
    rig.step();
    rig.send(10000, {1});
    EXPECT_EQ(rig.robot.inputs().dynamic_data[3].type_id, 10000u);
    EXPECT_EQ(rig.error(), 1001);
    EXPECT_EQ(rig.robot.inputs().dynamic_data[3].values, Six{});
    rig.reset_error();
    rig.make_ready();
    rig.resume();
    rig.out.motion_control.use_variables = true;
    rig.perform(image::kSetCheckpoint, {17});
    EXPECT_EQ(rig.motion().checkpoint_reached, 17) << "the bit has no meaning there";
  }
}

TEST(VariablesOfNoRobot, AreAnErrorAtTheDoor) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Variable& bad : {Variable{9999, 1, {}}, Variable{20000, 1, {}}, Variable{10001, 0, {}},
                              Variable{10001, 7, {}}, Variable{10001, 1, {nan}}, Variable{10000, 1, {}}}) {
    RobotOptions o = Rig::quick();
    o.variables = {{.cyclic_id = 10000, .size = 1, .values = {}}, bad};
    EXPECT_THROW(Robot{o}, std::invalid_argument) << bad.cyclic_id;
  }
}

TEST(VariablesOfTheBuiltInRobot, AreTheDocumentedOnes) {
  const Variables v(example_variables());
  EXPECT_EQ(v.values(10000), (Six{50}));
  ASSERT_NE(v.find(10001), nullptr);
  ASSERT_NE(v.find(10010), nullptr);
  EXPECT_EQ(v.find(10010)->size, 6u);
}

}  // namespace
}  // namespace meca::sim
