// The bridge from end to end over EtherCAT at 1 kHz: DDS on one side, on the other simulated robots behind the devices
// of a chain, on a virtual cable in a network namespace.
#include <gmock/gmock.h>
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
#include "tests/network_namespace.hpp"
#include "tests/session/chain_host.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::test {
namespace {

using bridge::Bridge;
using bridge::Config;
using testing::HasSubstr;

constexpr int kDomain = 53;
constexpr std::size_t kRobots = 3;

ChainOptions three_robots() {
  ChainOptions out;
  out.interface = "robot1";
  out.robots.assign(kRobots, {});
  sim::RobotOptions model;  // activated and homed as soon as it is asked
  model.activation_time = model.homing_time = model.deactivation_time = 1ms;
  model.noise = false;
  out.model = model;
  return out;
}

Config over_ethercat() {
  Config out;
  out.dds.domain = kDomain;
  out.dds.interfaces = {"127.0.0.1"};
  for (std::size_t i = 0; i < kRobots; ++i) {
    bridge::RobotConfig robot;
    robot.name = "arm" + std::to_string(i + 1);
    robot.type = bridge::TransportType::kEthercat;
    robot.ethercat.interface = "eth1";
    robot.ethercat.position = static_cast<std::uint16_t>(i);
    robot.control.lease = 2s;
    out.robots.push_back(robot);
  }
  out.ethercat.emplace_back();
  out.ethercat[0].interface = "eth1";
  out.ethercat[0].watchdog = 1s;  // the machine may be busy
  return out;
}

class EndToEndOverEthercat : public testing::Test {
 protected:
  void SetUp() override {
    if (!network.usable()) GTEST_SKIP() << kNoNamespace;
    network.cable("eth1", "robot1");
  }

  NetworkNamespace network;
};

TEST_F(EndToEndOverEthercat, ThreeRobotsAreActivatedHomedAndMoved) {
  ChainHost host(three_robots());
  Bridge bridge(over_ethercat());
  bridge.start();
  Client client("tester", kDomain);
  auto joints = client.reader<meca500::TargetJointSet>("TargetJointSet");
  for (const auto* arm : {"arm1", "arm2", "arm3"}) {
    for (const auto kind :
         {meca500::CommandKind::TAKE_CONTROL, meca500::CommandKind::ACTIVATE, meca500::CommandKind::HOME}) {
      ASSERT_NO_FATAL_FAILURE(client.complete(arm, kind)) << arm;
    }
  }
  using State = meca500::ReceiptState;
  for (const auto* arm : {"arm1", "arm3"}) {
    const double first_joint = arm[3] == '1' ? 10 : -15;
    const auto move = client.send(arm, meca500::CommandKind::MOTION, {first_joint, -5, 5, 0, 20, 0},
                                  meca500::MotionCommandId::MOVE_JOINTS, true);
    EXPECT_EQ(client.states(arm, move),
              (std::vector{State::ACCEPTED, State::SENT, State::ACKNOWLEDGED, State::COMPLETED}))
        << arm;
    meca500::TargetJointSet sample;
    EXPECT_TRUE(arrives<meca500::TargetJointSet>(joints, arm, sample, [&](const auto& s) {
      return std::abs(s.joints()[0] - first_joint) < 1e-3 && s.header().quality() == meca500::Quality::GOOD;
    })) << arm;
  }
}

TEST_F(EndToEndOverEthercat, ALostRobotIsDisconnectedInItsTopicsAndComesBackToMonitoringWhileTheOthersGoOn) {
  ChainHost host(three_robots());
  Bridge bridge(over_ethercat());
  bridge.start();
  Client client("tester", kDomain);
  auto joints = client.reader<meca500::TargetJointSet>("TargetJointSet");
  auto status = client.reader<meca500::BridgeStatus>("BridgeStatus");
  auto control = client.reader<meca500::ControlStatus>("ControlStatus");
  ASSERT_NO_FATAL_FAILURE(client.complete("arm3", meca500::CommandKind::TAKE_CONTROL));

  host.with_chain([](auto& chain) { chain.cut(2); });
  meca500::TargetJointSet sample;
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(
      joints, "arm3", sample, [](const auto& s) { return s.header().quality() == meca500::Quality::DISCONNECTED; }));
  meca500::BridgeStatus said;
  EXPECT_TRUE(arrives<meca500::BridgeStatus>(status, "arm3", said, [](const auto& s) {
    return s.link_detail().to_string().find("position 2 is not there") != std::string::npos;
  })) << said.link_detail().to_string();
  ASSERT_NO_FATAL_FAILURE(client.complete("arm1", meca500::CommandKind::TAKE_CONTROL));

  host.with_chain([](auto& chain) { chain.heal(2); });
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(
      joints, "arm3", sample, [](const auto& s) { return s.header().quality() == meca500::Quality::GOOD; }));
  meca500::ControlStatus owner;
  EXPECT_TRUE(arrives<meca500::ControlStatus>(control, "arm3", owner, [](const auto& s) { return !s.owned(); }));
}

TEST_F(EndToEndOverEthercat, WhatTheBusCountsIsInBridgeStatus) {
  ChainHost host(three_robots());
  Bridge bridge(over_ethercat());
  bridge.start();
  Client client("tester", kDomain);
  auto status = client.reader<meca500::BridgeStatus>("BridgeStatus");
  const auto counts = [](const meca500::BridgeStatus& s, std::string_view name, std::int64_t least) {
    return std::ranges::any_of(s.transport_counters(), [&](const auto& counter) {
      return counter.name().to_string() == name && counter.value() >= least;
    });
  };
  meca500::BridgeStatus said;
  EXPECT_TRUE(arrives<meca500::BridgeStatus>(status, "arm2", said, [&](const auto& s) {
    return counts(s, "images", 100) && counts(s, "al_state", 8) && counts(s, "round_trip_max", 1);
  }));
  EXPECT_EQ(said.transport().to_string(), "ethercat");
  EXPECT_EQ(said.cycle_us(), 1'000U);
}

TEST_F(EndToEndOverEthercat, ABridgeThatStopsLeavesTheRobotsInInit) {
  ChainHost host(three_robots());
  Bridge bridge(over_ethercat());
  bridge.start();
  for (std::size_t i = 0; i < kRobots; ++i) {
    ASSERT_TRUE(eventually([&] { return host.state(i) == ethercat::AlState::kOp; })) << i;
  }
  bridge.stop();
  for (std::size_t i = 0; i < kRobots; ++i) {
    EXPECT_EQ(host.state(i), ethercat::AlState::kInit) << i;
    EXPECT_EQ(host.with(i, [](auto& device) { return device.counters().watchdog_expiries; }), 0U) << i;
  }
}

TEST_F(EndToEndOverEthercat, AMissingInterfaceIsASentence) {
  Config config = over_ethercat();
  config.ethercat[0].interface = "eth7";
  for (auto& robot : config.robots) robot.ethercat.interface = "eth7";
  try {
    Bridge bridge(config);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("EtherCAT: there is no network interface 'eth7' on this machine; it has "));
  }
}

}  // namespace
}  // namespace meca::test
