// The bridge from end to end: a Bridge on built-in robots, and a DDS participant that knows nothing but the IDL.
#include "bridge/bridge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bridge/topics.hpp"
#include "client.hpp"
#include "e2e.hpp"
#include "idl/types.hpp"
#include "transports/image/dynamic_data_types.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::test {
namespace {

using bridge::Bridge;
using bridge::Config;
using bridge::RobotConfig;
using meca500::ReceiptState;

// A robot that is activated and homed as soon as it is asked, and holds still.
RobotConfig robot(const std::string& name) {
  RobotConfig config;
  config.name = name;
  config.builtin.instant_homing = true;
  config.builtin.noise = false;
  config.cycle = 2ms;
  config.control.lease = 2s;  // the machine may be busy; the short lease has a test of its own
  return config;
}

Config cell(std::vector<RobotConfig> robots) {
  Config config;
  config.dds.domain = kBridgeDomain;
  config.dds.interfaces = {"127.0.0.1"};
  config.robots = std::move(robots);
  return config;
}

TEST(EndToEnd, ActivateHomeAndMoveJointsAreReceiptedInOrderAndTheJointsArrive) {
  Bridge bridge(cell({robot("arm1")}));
  bridge.start();
  Client client("tester");
  auto joints = client.reader<meca500::TargetJointSet>("TargetJointSet");

  client.complete("arm1", meca500::CommandKind::TAKE_CONTROL);
  client.complete("arm1", meca500::CommandKind::ACTIVATE);
  client.complete("arm1", meca500::CommandKind::HOME);
  const auto move = client.send("arm1", meca500::CommandKind::MOTION, {10, -5, 5, 0, 20, 0},
                                meca500::MotionCommandId::MOVE_JOINTS, true);
  EXPECT_EQ(client.states("arm1", move), (std::vector{ReceiptState::ACCEPTED, ReceiptState::SENT,
                                                      ReceiptState::ACKNOWLEDGED, ReceiptState::COMPLETED}));
  meca500::TargetJointSet sample;
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(joints, "arm1", sample, [](const auto& s) {
    return std::abs(s.joints()[0] - 10) < 1e-3 && std::abs(s.joints()[4] - 20) < 1e-3;
  })) << sample.joints()[0];
  EXPECT_EQ(sample.header().quality(), meca500::Quality::GOOD);
}

// Reads one topic and says whether a good sample of the robot has come.
template <typename T>
void expect_late_sample(Client& client, const std::string& topic, const std::string& robot) {
  auto reader = client.reader<T>(topic);
  T sample;
  EXPECT_TRUE(arrives<T>(reader, robot, sample, [](const T&) { return true; })) << topic;
}

TEST(EndToEnd, ALateJoinerGetsEveryPublishedTopic) {
  auto config = cell({robot("arm1")});
  config.dds.topics["CyclicState"] = {.rate = bridge::RateKind::kPeriod, .period = 100ms};
  Bridge bridge(config);
  bridge.start();
  Client early("early");
  early.complete("arm1", meca500::CommandKind::TAKE_CONTROL);  // long enough for everything to have been said once

  Client late("late");
  int topics = 0;
  const auto see = [&]<typename T>(const std::string& topic, T*) {
    expect_late_sample<T>(late, topic, "arm1");
    ++topics;
  };
#define SEE(Type) see(#Type, static_cast<meca500::Type*>(nullptr))
  SEE(RobotStatus), SEE(MotionStatus), SEE(TargetJointSet), SEE(TargetEndEffectorPose), SEE(TargetConfiguration);
  SEE(TargetWrf), SEE(TargetTrf), SEE(RobotTimestamp), SEE(SafetyStatus), SEE(DynamicData), SEE(CyclicState);
  SEE(RobotControl), SEE(MotionControl), SEE(MotionCommand), SEE(HostTime), SEE(BrakesControl);
  SEE(DynamicDataConfiguration), SEE(BridgeStatus), SEE(ControlStatus), SEE(CommandReceipt);
#undef SEE
  const auto published = std::count_if(bridge::kTopics.begin(), bridge::kTopics.end(), [](const auto& topic) {
    return topic.direction == bridge::Direction::kPublished;
  });
  EXPECT_EQ(topics, published);  // a new topic has to be added here
}

TEST(EndToEnd, DynamicDataOfEveryKnownTypeComesByNameThoughNobodyAskedForIt) {
  Bridge bridge(cell({robot("arm1")}));
  bridge.start();
  Client client("tester");
  auto reader = client.reader<meca500::DynamicData>("DynamicData");
  std::vector<std::uint32_t> known;
  for (const auto& type : image::dynamic_data_types()) {
    if (type.on_meca500 && !type.values.empty() && type.id < image::kFirstVariable) known.push_back(type.id);
  }
  ASSERT_GT(known.size(), 20U);
  std::map<std::uint32_t, meca500::DynamicData> types;
  EXPECT_TRUE(eventually([&] {
    meca500::DynamicData sample;
    dds::SampleInfo info;
    while (reader.take(sample, info)) {
      if (info.valid_data) types[sample.type_id()] = sample;
    }
    return std::all_of(known.begin(), known.end(), [&](std::uint32_t id) { return types.contains(id); });
  })) << types.size()
      << " of " << known.size();
  const auto& firmware = types[meca500::DynamicDataType::FIRMWARE_VERSION];
  ASSERT_GE(firmware.values().size(), 2U);
  EXPECT_EQ(firmware.values()[0].name().to_string(), "major version");
  EXPECT_EQ(firmware.values()[0].value(), 11);
  EXPECT_EQ(firmware.values()[1].value(), 3);
}

TEST(EndToEnd, ACommandForAnUnknownRobotIsRejectedUnderItsNameAndNamesTheKnownOnes) {
  Bridge bridge(cell({robot("arm1"), robot("arm2")}));
  bridge.start();
  Client client("tester");
  const auto id = client.send("arm3", meca500::CommandKind::TAKE_CONTROL);
  const auto receipts = client.receipts("arm3", id);
  ASSERT_EQ(receipts.size(), 1U);
  EXPECT_EQ(receipts[0].robot().to_string(), "arm3");
  EXPECT_EQ(receipts[0].state(), ReceiptState::REJECTED);
  EXPECT_EQ(receipts[0].text().to_string(), "no robot 'arm3' here; this bridge has arm1, arm2");
}

TEST(EndToEnd, TwoRobotsDoNotMix) {
  auto other = robot("arm2");
  other.cycle = 4ms;  // a thread of its own
  Bridge bridge(cell({robot("arm1"), other}));
  bridge.start();
  Client client("tester");
  auto joints = client.reader<meca500::TargetJointSet>("TargetJointSet");
  auto status = client.reader<meca500::RobotStatus>("RobotStatus");
  for (const auto kind :
       {meca500::CommandKind::TAKE_CONTROL, meca500::CommandKind::ACTIVATE, meca500::CommandKind::HOME}) {
    client.complete("arm2", kind);
  }
  const auto move = client.send("arm2", meca500::CommandKind::MOTION, {15, 0, 0, 0, 0, 0},
                                meca500::MotionCommandId::MOVE_JOINTS, true);
  EXPECT_EQ(client.states("arm2", move).back(), ReceiptState::COMPLETED);
  meca500::TargetJointSet sample;
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(joints, "arm2", sample,
                                               [](const auto& s) { return std::abs(s.joints()[0] - 15) < 1e-3; }));
  const auto cycle = sample.header().cycle();
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(joints, "arm1", sample, [](const auto&) { return true; }));
  EXPECT_EQ(sample.joints()[0], 0);
  EXPECT_GT(cycle, 0U);
  meca500::RobotStatus robot_status;
  ASSERT_TRUE(arrives<meca500::RobotStatus>(status, "arm1", robot_status, [](const auto&) { return true; }));
  EXPECT_FALSE(robot_status.activated());
}

TEST(EndToEnd, WhenTheOwnerIsGoneTheRobotIsPausedAndControlIsFree) {
  auto config = robot("arm1");
  config.control.lease = 500ms;
  Bridge bridge(cell({config}));
  bridge.start();
  Client watcher("watcher");
  auto control = watcher.reader<meca500::ControlStatus>("ControlStatus");
  auto outputs = watcher.reader<meca500::MotionControl>("MotionControl");
  meca500::ControlStatus status;
  {
    Client owner("owner");
    for (const auto kind :
         {meca500::CommandKind::TAKE_CONTROL, meca500::CommandKind::ACTIVATE, meca500::CommandKind::HOME}) {
      owner.complete("arm1", kind);
    }
    owner.send("arm1", meca500::CommandKind::MOTION, {100, 0, 0, 0, 0, 0}, meca500::MotionCommandId::MOVE_JOINTS);
    ASSERT_TRUE(arrives<meca500::ControlStatus>(
        control, "arm1", status, [](const auto& s) { return s.owner().to_string() == "owner"; },
        [&] { owner.renew("arm1"); }));
  }  // the process of the owner is gone: nobody renews the lease
  meca500::MotionControl sent;
  EXPECT_TRUE(arrives<meca500::MotionControl>(outputs, "arm1", sent,
                                              [](const auto& s) { return s.pause_motion() && !s.set_point(); }));
  EXPECT_TRUE(arrives<meca500::ControlStatus>(control, "arm1", status, [](const auto& s) { return !s.owned(); }));
  EXPECT_EQ(status.last_owner().to_string(), "owner");
  EXPECT_EQ(status.last_loss().to_string(), "lease expired");
}

TEST(EndToEnd, ASecondClientIsRefusedAndToldWhoHasControl) {
  Bridge bridge(cell({robot("arm1")}));
  bridge.start();
  Client owner("owner"), other("other");
  owner.complete("arm1", meca500::CommandKind::TAKE_CONTROL);
  const auto id = other.send("arm1", meca500::CommandKind::ACTIVATE);
  const auto receipts = other.receipts("arm1", id);
  ASSERT_FALSE(receipts.empty());
  EXPECT_EQ(receipts.back().state(), ReceiptState::REJECTED);
  EXPECT_EQ(receipts.back().reason(), meca500::ReceiptReason::REASON_NOT_OWNER);
  EXPECT_THAT(receipts.back().text().to_string(), testing::HasSubstr("owner"));
}

TEST(EndToEnd, AfterStopNoSampleIsGoodAnyMore) {
  Bridge bridge(cell({robot("arm1")}));
  bridge.start();
  Client client("tester");
  auto joints = client.reader<meca500::TargetJointSet>("TargetJointSet");
  auto status = client.reader<meca500::BridgeStatus>("BridgeStatus");
  meca500::TargetJointSet sample;
  ASSERT_TRUE(arrives<meca500::TargetJointSet>(
      joints, "arm1", sample, [](const auto& s) { return s.header().quality() == meca500::Quality::GOOD; }));
  bridge.stop();
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(
      joints, "arm1", sample, [](const auto& s) { return s.header().quality() == meca500::Quality::DISCONNECTED; }));
  meca500::BridgeStatus said;
  EXPECT_TRUE(arrives<meca500::BridgeStatus>(status, "arm1", said,
                                             [](const auto& s) { return s.link() == meca500::LinkState::LINK_DOWN; }));
  EXPECT_EQ(said.link_detail().to_string(), "the bridge has stopped");
}

// From cold to a place and back, with a pause in between, on every firmware generation a Meca500 may have.
class EndToEndOnFirmware : public testing::TestWithParam<const char*> {};

TEST_P(EndToEndOnFirmware, ARobotIsFoundOutCommandedPausedAndSwitchedOff) {
  const std::string firmware = GetParam();
  auto config = robot("arm1");
  config.builtin.firmware = firmware;
  Bridge bridge(cell({config}));
  bridge.start();
  Client client("tester");
  auto said = client.reader<meca500::BridgeStatus>("BridgeStatus");
  auto safety = client.reader<meca500::SafetyStatus>("SafetyStatus");
  auto motion = client.reader<meca500::MotionStatus>("MotionStatus");
  auto joints = client.reader<meca500::TargetJointSet>("TargetJointSet");
  meca500::BridgeStatus status;
  ASSERT_TRUE(arrives<meca500::BridgeStatus>(said, "arm1", status, [](const auto& s) { return s.firmware_known(); }));
  EXPECT_EQ(status.firmware().to_string().substr(0, firmware.size()), firmware);
  meca500::SafetyStatus stops;
  const bool has_safety_section = firmware[0] != '9';
  EXPECT_TRUE(arrives<meca500::SafetyStatus>(safety, "arm1", stops, [&](const auto& s) {
    return s.header().quality() == meca500::Quality::GOOD && s.known() == has_safety_section;
  }));

  const auto renew = [&] { client.renew("arm1"); };
  for (const auto kind :
       {meca500::CommandKind::TAKE_CONTROL, meca500::CommandKind::ACTIVATE, meca500::CommandKind::HOME}) {
    ASSERT_NO_FATAL_FAILURE(client.complete("arm1", kind));
  }
  const auto move = client.send("arm1", meca500::CommandKind::MOTION, {30, 0, 0, 0, 0, 0},
                                meca500::MotionCommandId::MOVE_JOINTS, true);
  ASSERT_NO_FATAL_FAILURE(client.complete("arm1", meca500::CommandKind::PAUSE_MOTION));
  meca500::MotionStatus queue;
  EXPECT_TRUE(arrives<meca500::MotionStatus>(
      motion, "arm1", queue, [](const auto& s) { return s.paused() && s.eom(); }, renew));
  ASSERT_NO_FATAL_FAILURE(client.complete("arm1", meca500::CommandKind::RESUME_MOTION));
  EXPECT_EQ(client.states("arm1", move).back(), ReceiptState::COMPLETED);
  meca500::TargetJointSet sample;
  EXPECT_TRUE(arrives<meca500::TargetJointSet>(
      joints, "arm1", sample, [](const auto& s) { return std::abs(s.joints()[0] - 30) < 1e-3; }, renew));
  ASSERT_NO_FATAL_FAILURE(client.complete("arm1", meca500::CommandKind::CLEAR_MOTION));
  ASSERT_NO_FATAL_FAILURE(client.complete("arm1", meca500::CommandKind::DEACTIVATE));
}

INSTANTIATE_TEST_SUITE_P(Generation, EndToEndOnFirmware, testing::Values("9.3", "10.2", "11.3"), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '.', '_');
  return name;
});

TEST(EndToEnd, ATransportThatIsNotBuiltYetSaysSo) {
  auto config = robot("arm1");
  config.type = bridge::TransportType::kProfinet;
  try {
    Bridge bridge(cell({config}));
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(
        error.what(),
        "arm1: transport type 'profinet' is not built yet; this version has 'builtin', 'ethernet_ip' and 'ethercat'");
  }
}

}  // namespace
}  // namespace meca::test
