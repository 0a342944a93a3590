// A step of the robot belongs on the cycle thread: it must not allocate.
#include <string>

#include "sim/panel_port.hpp"
#include "tests/counted_new.hpp"
#include "tests/unit/sim/rig.hpp"
#include "transports/builtin/builtin.hpp"

namespace meca::sim {
namespace {

TEST(Allocation, IsCountedByThisProgram) {
  const auto before = test::allocations;
  static int* volatile sink = nullptr;  // what nobody sees the compiler may leave out
  sink = new int(1);
  delete sink;
  EXPECT_GT(test::allocations, before);
}

TEST(Allocation, NeverHappensInAStepWhateverTheRobotDoes) {
  RobotOptions options;
  options.tool = ToolType::kMegp25ls;
  options.variables = example_variables();
  Rig rig(options);
  std::uint64_t while_stepping = 0;
  const auto steps = [&](int count) {
    const auto before = test::allocations;
    for (int i = 0; i < count; ++i) rig.robot.step(rig.out, std::chrono::milliseconds(1));
    while_stepping += test::allocations - before;
  };
  const auto command = [&](std::uint32_t id, std::array<float, 6> arguments) {
    ++rig.out.motion_control.move_id;
    rig.out.motion_command = {id, arguments};
    steps(5000);
  };
  const auto configure = [&](std::uint32_t id, std::array<float, 6> arguments) {
    rig.out.motion_control.set_point = true;
    ++rig.out.motion_control.move_id;
    rig.out.motion_command = {id, arguments};
    steps(1);
  };
  configure(image::kSetToolSphere, {0, 0, 20, 10});
  configure(image::kSetWorkZoneCfg, {4, 3});
  configure(image::kSetWorkZoneLimits, {-500, -500, -10, 500, 500, 500});
  configure(image::kSetCollisionCfg, {4});
  rig.out.motion_control.set_point = false;
  rig.robot.place_obstacle(0, 300, 300, 10);
  rig.out.robot_control.activate = rig.out.robot_control.home = true;
  steps(7000);
  ASSERT_TRUE(rig.robot.inputs().robot_status.homed);
  rig.out.motion_control.set_point = true;
  command(image::kSetTorqueLimitsCfg, {1, 2});
  command(image::kMoveJoints, {10, 20, 10, 5, 30, 400});
  command(image::kMoveLinRelWrf, {-10, 5, 5, 3, 2, 1});
  command(image::kMovePose, {150, 50, 250, 0, 90, 0});
  command(image::kMoveLinVelTrf, {1, 2, 3, 0, 0, 0});
  command(image::kGripper, {0});
  command(image::kStartProgram, {3});
  command(10010, {0, 0, 0, 0, 30, 0});
  rig.out.motion_control.use_variables = true;
  command(image::kSetJointVel, {10000});
  rig.out.motion_control.use_variables = false;
  EXPECT_EQ(rig.robot.inputs().robot_status.error_code, 0);
  command(image::kMoveLin, {900, 0, 0, 0, 0, 0});  // out of reach
  EXPECT_NE(rig.robot.inputs().robot_status.error_code, 0);
  rig.out.robot_control.reset_error = true;
  steps(10);
  for (int i = 0; i < 13100; ++i) {  // more than the queue and the journal hold
    ++rig.out.motion_control.move_id;
    rig.out.motion_command = {image::kSetCheckpoint, {1}};
    steps(1);
  }
  rig.out.motion_control.clear_motion = true;
  steps(10);
  EXPECT_EQ(while_stepping, 0u);
}

TEST(Allocation, NeverHappensWhenAButtonIsPressed) {
  Rig rig(RobotOptions{});
  PanelPort port;
  const std::vector<std::string> lines{"press e-stop",     "press reset",        "release e-stop",
                                       "press reset",      "press p-stop2",      "release p-stop2",
                                       "drop connection",  "restore connection", "raise error 1007",
                                       "raise error 1012", "monitoring on",      "monitoring off",
                                       "status",           "power cycle",        "place part 3",
                                       "violations",       "journal 64",         "help",
                                       "push joint 2 10",  "remove obstacle",    "place obstacle 300 0 200 50"};
  for (const std::string& line : lines) {
    const auto parsed = parse_panel_line(line);
    const auto* request = std::get_if<PanelRequest>(&parsed);
    ASSERT_NE(request, nullptr) << std::get<std::string>(parsed);
    const auto before = test::allocations;
    EXPECT_TRUE(port.ask(*request));
    port.serve(rig.robot);
    rig.robot.step(rig.out, std::chrono::milliseconds(1));
    EXPECT_NE(port.answer(), nullptr);
    EXPECT_EQ(test::allocations, before) << line;
  }
}

TEST(Allocation, NeverHappensInAnExchangeOfTheBuiltInTransport) {
  const auto bus = transports::make_builtin({RobotOptions{}, RobotOptions{}});
  bus->open(Time(0));
  std::array<transports::Exchange, 2> exchanges{};
  const auto before = test::allocations;
  for (int i = 1; i < 1000; ++i) bus->exchange(i * std::chrono::milliseconds(1), exchanges);
  EXPECT_EQ(test::allocations, before);
}

}  // namespace
}  // namespace meca::sim
