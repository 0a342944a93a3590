// A DDS participant that knows nothing but the IDL: commands out, receipts and state in.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bridge/dds.hpp"
#include "e2e.hpp"
#include "idl/types.hpp"

namespace meca::test {

// A client with a writer for commands and readers for what it wants to see.
class Client {
 public:
  // Receipts are read TRANSIENT_LOCAL: the bridge may find this reader only after it has answered the first command.
  explicit Client(const std::string& name, int domain = kBridgeDomain)
      : name_(name), participant_(local(domain, name)) {
    commands_ = participant_.create_writer<meca500::Command>("meca500/Command", {.depth = 0, .max_samples = 64});
    leases_ = participant_.create_writer<meca500::ControlLease>("meca500/ControlLease",
                                                                {.reliability = dds::Reliability::kBestEffort});
    receipts_ = participant_.create_reader<meca500::CommandReceipt>(
        "meca500/CommandReceipt", {.durability = dds::Durability::kTransientLocal, .depth = 256});
    bridge_ = reader<meca500::BridgeStatus>("BridgeStatus");
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
      return !seen_[id].empty() && seen_[id].back().state() >= meca500::ReceiptState::COMPLETED;
    });
    EXPECT_TRUE(ended) << "no terminal receipt for command " << id;
    return seen_[id];
  }

  std::vector<meca500::ReceiptState> states(const std::string& robot, std::uint64_t id) {
    std::vector<meca500::ReceiptState> states;
    for (const auto& receipt : receipts(robot, id)) states.push_back(receipt.state());
    return states;
  }

  // Sends an action, once the bridge knows the robot's firmware, and waits until it is COMPLETED.
  void complete(const std::string& robot, meca500::CommandKind kind) {
    ASSERT_TRUE(eventually([&] {
      meca500::BridgeStatus status;
      dds::SampleInfo info;
      while (bridge_.take(status, info)) {
        if (info.valid_data && status.firmware_known()) known_.insert(status.robot().to_string());
      }
      return known_.count(robot) == 1;
    })) << "the bridge does not get to know "
        << robot;
    const auto id = send(robot, kind);
    const auto all = receipts(robot, id);
    ASSERT_FALSE(all.empty());
    ASSERT_EQ(all.back().state(), meca500::ReceiptState::COMPLETED) << all.back().text().to_string();
  }

  dds::Participant& participant() { return participant_; }

 private:
  std::string name_;
  dds::Participant participant_;
  dds::Writer<meca500::Command> commands_;
  dds::Writer<meca500::ControlLease> leases_;
  dds::Reader<meca500::CommandReceipt> receipts_;
  dds::Reader<meca500::BridgeStatus> bridge_;
  std::set<std::string> known_;
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

}  // namespace meca::test
