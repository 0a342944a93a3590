// A robot over EtherNet/IP as its user meets it: from cold to a place, on every firmware.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ethernet_ip/programs.hpp"

namespace meca::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class OnFirmware : public testing::TestWithParam<std::string> {};

TEST_P(OnFirmware, ARobotIsActivatedHomedAndMovedWithMecaCtl) {
  const SimProgram arm1(arm1_address(), {"--firmware", GetParam()});
  BridgeProgram bridge({robot("arm1", arm1_address())});
  ASSERT_TRUE(bridge.until_up());
  EXPECT_THAT(bridge.status()["bridge_status"]["firmware"].get<std::string>(), StartsWith(GetParam() + "."));
  EXPECT_EQ(bridge.ctl({"activate"}).exit_code, 0);
  EXPECT_EQ(bridge.ctl({"home"}).exit_code, 0);
  const Result move = bridge.ctl({"--wait", "move-joints", "--", "-10", "5", "5", "0", "20", "0"});
  EXPECT_EQ(move.exit_code, 0) << move.output;
  EXPECT_THAT(move.output, HasSubstr("arm1: move-joints: completed"));
  EXPECT_TRUE(bridge.until([](const auto& now) {
    const auto& joints = now["target_joint_set"]["joints"];
    return std::abs(joints[0].template get<double>() + 10) < 1e-3 &&
           std::abs(joints[4].template get<double>() - 20) < 1e-3;
  }));
  EXPECT_TRUE(bridge.until([](const auto& now) { return now["bridge_status"]["ready"] == true; }));
  EXPECT_EQ(arm1.say("violations"), "ok: the host broke no rule");
  EXPECT_EQ(bridge.stop(), 0) << bridge.log();
}

INSTANTIATE_TEST_SUITE_P(OverEthernetIp, OnFirmware, testing::Values("9.3", "10.2", "11.3"), [](const auto& info) {
  std::string name = info.param;
  name.replace(name.find('.'), 1, "_");
  return name;
});

}  // namespace
}  // namespace meca::test
