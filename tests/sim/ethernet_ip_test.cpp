// The bridge from end to end over EtherNet/IP: DDS on one side, on the other the simulated robot behind the adapter, at
// an address of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bridge/bridge.hpp"
#include "client.hpp"
#include "e2e.hpp"
#include "idl/types.hpp"
#include "tests/session/adapter_host.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::test {
namespace {

using bridge::Bridge;
using bridge::Config;

constexpr int kDomain = 52;
const std::string kHost = "127.0.8.1", kArm1 = "127.0.8.2";

// Activated and homed as soon as it is asked.
sim::RobotOptions quick_robot() {
  sim::RobotOptions out;
  out.activation_time = out.homing_time = out.deactivation_time = 1ms;
  out.noise = false;
  return out;
}

Config over_ethernet_ip() {
  bridge::RobotConfig robot;
  robot.name = "arm1";
  robot.type = bridge::TransportType::kEthernetIp;
  robot.ethernet_ip.address = kArm1;
  robot.ethernet_ip.timeout_multiplier = 64;  // the machine may be busy
  robot.cycle = 10ms;
  robot.control.lease = 2s;
  Config out;
  out.dds.domain = kDomain;
  out.dds.interfaces = {"127.0.0.1"};
  out.ethernet_ip.bind = kHost;
  out.robots = {robot};
  return out;
}

TEST(EndToEndOverEthernetIp, ARobotIsActivatedHomedAndMoved) {
  AdapterHost arm1(meca500_at(kArm1), quick_robot());
  Bridge bridge(over_ethernet_ip());
  bridge.start();
  Client client("tester", kDomain);
  auto joints = client.reader<meca500::TargetJointSet>("TargetJointSet");
  for (const auto kind :
       {meca500::CommandKind::TAKE_CONTROL, meca500::CommandKind::ACTIVATE, meca500::CommandKind::HOME}) {
    ASSERT_NO_FATAL_FAILURE(client.complete("arm1", kind));
  }
  const auto move = client.send("arm1", meca500::CommandKind::MOTION, {10, -5, 5, 0, 20, 0},
                                meca500::MotionCommandId::MOVE_JOINTS, true);
  using State = meca500::ReceiptState;
  EXPECT_EQ(client.states("arm1", move),
            (std::vector{State::ACCEPTED, State::SENT, State::ACKNOWLEDGED, State::COMPLETED}));
  meca500::TargetJointSet sample;
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(joints, "arm1", sample, [](const auto& s) {
    return std::abs(s.joints()[0] - 10) < 1e-3 && std::abs(s.joints()[4] - 20) < 1e-3;
  }));
  EXPECT_EQ(sample.header().quality(), meca500::Quality::GOOD);
}

}  // namespace
}  // namespace meca::test
