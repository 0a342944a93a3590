// The bridge from end to end over EtherNet/IP: DDS on one side, on the other the simulated robot behind the adapter, at
// an address of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

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
const std::string kHost = "127.0.8.1", kArm1 = "127.0.8.2", kArm2 = "127.0.8.3";

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
    return std::abs(s.joints()[0] - 10) < 1e-3 && std::abs(s.joints()[4] - 20) < 1e-3 &&
           s.header().quality() == meca500::Quality::GOOD;
  }));
}

TEST(EndToEndOverEthernetIp, ALostRobotIsDisconnectedInEveryTopicAndComesBackToMonitoring) {
  AdapterHost arm1(meca500_at(kArm1), quick_robot());
  Bridge bridge(over_ethernet_ip());
  bridge.start();
  Client client("tester", kDomain);
  auto joints = client.reader<meca500::TargetJointSet>("TargetJointSet");
  auto status = client.reader<meca500::BridgeStatus>("BridgeStatus");
  auto control = client.reader<meca500::ControlStatus>("ControlStatus");
  ASSERT_NO_FATAL_FAILURE(client.complete("arm1", meca500::CommandKind::TAKE_CONTROL));

  arm1.unplug();
  meca500::TargetJointSet sample;
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(
      joints, "arm1", sample, [](const auto& s) { return s.header().quality() == meca500::Quality::DISCONNECTED; }));
  meca500::BridgeStatus said;
  EXPECT_TRUE(arrives<meca500::BridgeStatus>(status, "arm1", said, [](const auto& s) {
    return s.link_detail().to_string().find("no packet from 127.0.8.2 for 640 ms") != std::string::npos;
  })) << said.link_detail().to_string();

  arm1.plug_in();
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(
      joints, "arm1", sample, [](const auto& s) { return s.header().quality() == meca500::Quality::GOOD; }));
  meca500::ControlStatus owner;
  EXPECT_TRUE(arrives<meca500::ControlStatus>(control, "arm1", owner, [](const auto& s) { return !s.owned(); }));
}

TEST(EndToEndOverEthernetIp, RobotsOfSeveralKindsLiveInOneBridge) {
  AdapterHost arm1(meca500_at(kArm1), quick_robot()), arm2(meca500_at(kArm2), quick_robot());
  Config config = over_ethernet_ip();
  config.robots.push_back(config.robots[0]);
  config.robots[1].name = "arm2";
  config.robots[1].ethernet_ip.address = kArm2;
  config.robots[1].cycle = 20ms;  // asks for packets half as often; its bus turns with the faster one
  config.robots.emplace_back();
  config.robots[2].name = "built-in";
  config.robots[2].control.lease = 2s;
  Bridge bridge(config);
  bridge.start();
  Client client("tester", kDomain);
  auto status = client.reader<meca500::BridgeStatus>("BridgeStatus");
  for (const auto* name : {"arm1", "arm2", "built-in"}) {
    ASSERT_NO_FATAL_FAILURE(client.complete(name, meca500::CommandKind::TAKE_CONTROL)) << name;
  }
  meca500::BridgeStatus said;
  EXPECT_TRUE(arrives<meca500::BridgeStatus>(status, "arm2", said, [](const auto& s) {
    return std::ranges::any_of(s.transport_counters(), [](const auto& counter) {
      return counter.name().to_string() == "api_t_to_o" && counter.value() == 20'000;
    });
  }));
  EXPECT_EQ(said.cycle_us(), 10'000U);
  EXPECT_TRUE(arrives<meca500::BridgeStatus>(status, "built-in", said, [](const auto&) { return true; }));
  EXPECT_EQ(said.transport().to_string(), "builtin");
  EXPECT_EQ(said.cycle_us(), 1'000U);
}

TEST(EndToEndOverEthernetIp, WhatTheBusCountsIsInBridgeStatus) {
  AdapterHost arm1(meca500_at(kArm1), quick_robot());
  Bridge bridge(over_ethernet_ip());
  bridge.start();
  Client client("tester", kDomain);
  auto status = client.reader<meca500::BridgeStatus>("BridgeStatus");
  meca500::BridgeStatus said;
  EXPECT_TRUE(arrives<meca500::BridgeStatus>(status, "arm1", said, [](const auto& s) {
    return std::ranges::any_of(s.transport_counters(), [](const auto& counter) {
      return counter.name().to_string() == "received_packets" && counter.value() > 10;
    });
  }));
  EXPECT_EQ(said.transport().to_string(), "ethernet_ip");
  EXPECT_EQ(said.cycle_us(), 10'000U);
}

TEST(EndToEndOverEthernetIp, ABridgeThatStopsSaysGoodByeToTheRobot) {
  AdapterHost arm1(meca500_at(kArm1), quick_robot());
  Bridge bridge(over_ethernet_ip());
  bridge.start();
  ASSERT_TRUE(eventually([&] { return arm1.counters().consumed > 3; }));
  bridge.stop();
  EXPECT_EQ(arm1.counters().closes, 1U);
  EXPECT_EQ(arm1.counters().timeouts, 0U);
}

TEST(EndToEndOverEthernetIp, ATakenPortIsASentence) {
  const net::UdpSocket first({net::parse_ipv4(kHost).value(), ethernet_ip::kIoPort}, {});
  try {
    Bridge bridge(over_ethernet_ip());
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "EtherNet/IP: UDP port 2222 of 127.0.8.1 is taken by another program on this machine; stop it, or "
                 "choose another port");
  }
}

}  // namespace
}  // namespace meca::test
