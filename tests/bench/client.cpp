#include "tests/bench/client.hpp"

#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/bench/clock.hpp"

namespace meca::bench {
namespace {

using namespace std::chrono_literals;
using meca500::CommandKind;

constexpr dds::Qos kCommands{dds::Reliability::kReliable, dds::Durability::kVolatile, 256};
constexpr dds::Qos kStream{dds::Reliability::kBestEffort, dds::Durability::kVolatile, 1};
constexpr dds::Qos kReceipts{dds::Reliability::kReliable, dds::Durability::kTransientLocal, 4096};

}  // namespace

dds::ParticipantOptions on_loopback(int domain, const std::string& name) {
  return {.domain = domain, .name = name, .interfaces = {"127.0.0.1"}, .shared_memory = false};
}

std::string dds_on_loopback(int domain) {
  return "dds:\n  domain: " + std::to_string(domain) + "\n  interfaces: [127.0.0.1]\n  shared_memory: false\n";
}

Client::Client(int domain, std::string name)
    : name_(std::move(name)),
      participant_(on_loopback(domain, name_)),
      commands_(participant_.create_writer<meca500::Command>("meca500/Command", kCommands)),
      leases_(participant_.create_writer<meca500::ControlLease>("meca500/ControlLease", kStream)),
      velocities_(participant_.create_writer<meca500::VelocityCommand>("meca500/VelocityCommand", kStream)),
      receipts_(participant_.create_reader<meca500::CommandReceipt>("meca500/CommandReceipt", kReceipts)),
      next_id_(static_cast<std::uint64_t>(unix_now_ns() / 1000)) {}

meca500::Command Client::make(CommandKind kind, std::initializer_list<double> arguments) {
  meca500::Command command;
  command.kind(kind);
  command.arguments(std::vector<double>(arguments));
  return command;
}

meca500::Command Client::make_motion(std::uint32_t id, std::initializer_list<double> arguments,
                                     bool report_completion) {
  meca500::Command command = make(CommandKind::MOTION, arguments);
  command.motion_command_id(id);
  command.report_completion(report_completion);
  return command;
}

std::uint64_t Client::send(meca500::Command command, std::uint64_t id) {
  command.robot(kRobot);
  command.client(name_);
  command.command_id(id);
  commands_.write(command);
  return id;
}

void Client::renew() {
  meca500::ControlLease lease;
  lease.robot(kRobot);
  lease.client(name_);
  lease.sequence_number(++renewals_);
  leases_.write(lease);
}

void Client::send_velocity(float joint1) {
  meca500::VelocityCommand velocity;
  velocity.robot(kRobot);
  velocity.client(name_);
  velocity.sequence_number(++velocity_number_);
  velocity.kind(meca500::VelocityKind::MOVE_JOINTS_VEL);
  velocity.velocity({joint1, 0, 0, 0, 0, 0});
  velocities_.write(velocity);
}

void Client::take_receipts(const std::function<void(const meca500::CommandReceipt&)>& each) {
  meca500::CommandReceipt receipt;
  dds::SampleInfo info;
  while (receipts_.take(receipt, info)) {
    if (info.valid_data && receipt.client().c_str() == name_) each(receipt);
  }
}

meca500::CommandReceipt Client::finish(meca500::Command command, std::uint64_t id) {
  send(std::move(command), id);
  std::optional<meca500::CommandReceipt> end;
  std::string last = "never answered";
  const auto patience = monotonic_now() + 20s;
  for (auto next_renewal = monotonic_now(); !end;) {
    const auto now = monotonic_now();
    if (now > patience) throw std::runtime_error(name_ + ": no end of a command within 20 s: " + last);
    if (now >= next_renewal) {
      renew();
      next_renewal = now + 20ms;
    }
    wait(5ms);
    take_receipts([&](const meca500::CommandReceipt& r) {
      if (r.command_id() != id) return;
      last = r.text().to_string();
      if (is_terminal(r.state())) end = r;
    });
  }
  return *end;
}

void Client::prepare_robot() {
  const auto patience = monotonic_now() + 20s;
  for (; !connected(); std::this_thread::sleep_for(5ms)) {
    if (monotonic_now() > patience) throw std::runtime_error("the bridge was not found on DDS within 20 s");
  }
  for (const auto kind : {CommandKind::TAKE_CONTROL, CommandKind::ACTIVATE, CommandKind::HOME}) {
    // Refused until there is a link, and the bridge knows the robot's firmware.
    using Reason = meca500::ReceiptReason;
    meca500::CommandReceipt end;
    do {
      end = finish(make(kind));
    } while ((end.reason() == Reason::REASON_NO_LINK || end.reason() == Reason::REASON_FIRMWARE_UNKNOWN) &&
             monotonic_now() < patience);
    if (end.state() != meca500::ReceiptState::COMPLETED) {
      throw std::runtime_error("preparing the robot: " + end.text().to_string());
    }
  }
}

}  // namespace meca::bench
