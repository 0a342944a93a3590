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
#include "e2e.hpp"
#include "idl/types.hpp"

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

// A client with a writer for commands and readers for what it wants to see.
class Client {
 public:
  // Receipts are read TRANSIENT_LOCAL: the bridge may find this reader only after it has answered the first command.
  explicit Client(const std::string& name) : name_(name), participant_(local(kBridgeDomain, name)) {
    commands_ = participant_.create_writer<meca500::Command>("meca500/Command", {.depth = 0, .max_samples = 64});
    leases_ = participant_.create_writer<meca500::ControlLease>("meca500/ControlLease",
                                                                {.reliability = dds::Reliability::kBestEffort});
    receipts_ = participant_.create_reader<meca500::CommandReceipt>(
        "meca500/CommandReceipt", {.durability = dds::Durability::kTransientLocal, .depth = 256});
    EXPECT_TRUE(
        eventually([&] { return commands_.matched() == 1 && leases_.matched() == 1 && receipts_.matched() == 1; }));
  }

  template <typename T>
  dds::Reader<T> reader(const std::string& topic) {
    return participant_.create_reader<T>("meca500/" + topic, {.durability = dds::Durability::kTransientLocal});
  }

  std::uint64_t send(const std::string& robot, meca500::CommandKind kind, std::vector<double> arguments = {},
                     std::uint32_t motion_command = 0, bool report_completion = false) {
    meca500::Command command;
    command.robot(robot);
    command.client(name_);
    command.command_id(++last_id_);
    command.kind(kind);
    command.motion_command_id(motion_command);
    command.arguments(arguments);
    command.report_completion(report_completion);
    EXPECT_TRUE(commands_.write(command));
    return last_id_;
  }

  void renew(const std::string& robot) {
    meca500::ControlLease lease;
    lease.robot(robot);
    lease.client(name_);
    lease.sequence_number(++last_lease_);
    leases_.write(lease);
  }

  // All receipts of one command, up to the terminal one; renews the lease of the robot while it waits.
  std::vector<meca500::CommandReceipt> receipts(const std::string& robot, std::uint64_t id) {
    const bool ended = eventually([&] {
      renew(robot);
      meca500::CommandReceipt receipt;
      dds::SampleInfo info;
      while (receipts_.take(receipt, info)) {
        if (info.valid_data && receipt.client().to_string() == name_) seen_[receipt.command_id()].push_back(receipt);
      }
      return !seen_[id].empty() && seen_[id].back().state() >= ReceiptState::COMPLETED;
    });
    EXPECT_TRUE(ended) << "no terminal receipt for command " << id;
    return seen_[id];
  }

  std::vector<ReceiptState> states(const std::string& robot, std::uint64_t id) {
    std::vector<ReceiptState> states;
    for (const auto& receipt : receipts(robot, id)) states.push_back(receipt.state());
    return states;
  }

  // Sends an action and waits until it is COMPLETED.
  void complete(const std::string& robot, meca500::CommandKind kind) {
    const auto id = send(robot, kind);
    const auto all = receipts(robot, id);
    ASSERT_FALSE(all.empty());
    ASSERT_EQ(all.back().state(), ReceiptState::COMPLETED) << all.back().text().to_string();
  }

  dds::Participant& participant() { return participant_; }

 private:
  std::string name_;
  dds::Participant participant_;
  dds::Writer<meca500::Command> commands_;
  dds::Writer<meca500::ControlLease> leases_;
  dds::Reader<meca500::CommandReceipt> receipts_;
  std::map<std::uint64_t, std::vector<meca500::CommandReceipt>> seen_;
  std::uint64_t last_id_ = 0, last_lease_ = 0;
};

// Takes samples of one robot until one satisfies the condition; `result` is that one.
template <typename T>
bool arrives(
    dds::Reader<T>& reader, const std::string& robot, T& result, const std::function<bool(const T&)>& condition,
    const std::function<void()>& meanwhile = [] {}) {
  return eventually([&] {
    meanwhile();
    dds::SampleInfo info;
    while (reader.take(result, info)) {
      if (info.valid_data && result.robot().to_string() == robot && condition(result)) return true;
    }
    return false;
  });
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

}  // namespace
}  // namespace meca::test
