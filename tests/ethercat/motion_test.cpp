// Three robots in one EtherCAT segment as their user meets them: from cold to a place, on every firmware, and good-bye.
#include <gmock/gmock.h>

#include "tests/ethercat/cell.hpp"

namespace meca::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class OnFirmware : public EthercatCell, public testing::WithParamInterface<std::string> {};

TEST_P(OnFirmware, ThreeRobotsAreActivatedHomedAndMovedWithMecaCtl) {
  Simulator& sim = start_robots(3, {"--firmware", GetParam()});
  BridgeProcess& bridge = start_bridge(3);
  for (const char* robot : {"arm1", "arm2", "arm3"}) {
    make_ready(robot);
    EXPECT_THAT(bridge.status(robot)["bridge_status"]["firmware"].get<std::string>(), StartsWith(GetParam() + "."));
    move(robot);
    EXPECT_TRUE(bridge.until(
        [](const auto& now) {
          const auto& joints = now["target_joint_set"]["joints"];
          return std::abs(joints[0].template get<double>() + 10) < 1e-3 &&
                 std::abs(joints[4].template get<double>() - 20) < 1e-3;
        },
        robot));
    EXPECT_TRUE(bridge.until([](const auto& now) { return now["bridge_status"]["ready"] == true; }, robot));
    EXPECT_EQ(sim.say("violations", robot), "ok: the host broke no rule");
    EXPECT_EQ(losses(robot), 0);
  }
  EXPECT_EQ(bridge.stop(), 0) << bridge.log();
  EXPECT_EQ(sim.stop(), 0);
  for (const char* robot : {"arm1", "arm2", "arm3"}) {
    EXPECT_THAT(sim.log(), HasSubstr(std::string(robot) + ": it left OP and is in INIT"));
    EXPECT_THAT(sim.log(), HasSubstr(std::string(robot) + ": stopped; OP reached: 1; "));
  }
}

INSTANTIATE_TEST_SUITE_P(OverEthercat, OnFirmware, testing::Values("9.3", "10.2", "11.3"), [](const auto& info) {
  std::string name = info.param;
  name.replace(name.find('.'), 1, "_");
  return name;
});

using ManyRobots = EthercatCell;

TEST_F(ManyRobots, EightInOneSegmentMoveTogether) {
  Simulator& sim = start_robots(8);
  BridgeProcess& bridge = start_bridge(8);
  for (int i = 1; i <= 8; ++i) make_ready("arm" + std::to_string(i));
  std::vector<std::unique_ptr<Process>> movers;
  for (int i = 1; i <= 8; ++i) {
    movers.push_back(bridge.ctl_beside(
        {"--robot", "arm" + std::to_string(i), "--wait", "move-joints", "--", "-10", "5", "5", "0", "20", "0"}));
  }
  for (const auto& mover : movers) EXPECT_EQ(mover->wait(), 0) << mover->output();
  for (int i = 1; i <= 8; ++i) {
    EXPECT_EQ(sim.say("violations", "arm" + std::to_string(i)), "ok: the host broke no rule");
  }
}

using OnNeighbours = EthercatCell;

TEST_F(OnNeighbours, AnotherMakersDeviceBetweenThemIsLeftAloneAndNamed) {
  start_robots(3, {"--foreign", "arm2"});
  BridgeProcess& bridge = start_bridge(3);
  EXPECT_TRUE(bridge.until_told("vendor 0x00000002, product 0x044C2C52", "arm2")) << bridge.status("arm2");
  make_ready("arm3");
  move("arm3");
  EXPECT_TRUE(bridge.until_up("arm1"));
}

}  // namespace
}  // namespace meca::test
