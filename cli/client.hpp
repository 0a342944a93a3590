// Commands one robot through the bridge: sends, follows the receipts, renews the lease, gives control back.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "cli/bus.hpp"
#include "cli/observer.hpp"

namespace meca::cli {

enum class WaitFor : std::uint8_t {
  kAcknowledged,  // motion: the robot has it in its queue; everything else: the end
  kEnd,           // a terminal receipt; motion: executed
};

enum class Ended : std::uint8_t { kReached, kTimeOut, kInterrupted, kBridgeGone };

struct Outcome {
  Ended ended = Ended::kTimeOut;
  std::optional<meca500::CommandReceipt> last;  // empty: the bridge never answered
};

class Client {
 public:
  Client(Bus& bus, Observer& observer, std::string robot);

  struct Progress {
    std::function<void(const meca500::CommandReceipt&)> receipt;
    std::function<void(bool up)> link;  // lost, or back, while a motion command that was taken has no end yet
  };

  // Sends the command (again and again with the same id, until the first receipt: a bridge executes an id once) and
  // follows its receipts, and the link of the robot. Motion goes on when this client is gone; a person who wants it to
  // stop says so.
  Outcome execute(const CommandPlan& plan, WaitFor until, std::chrono::nanoseconds timeout, const Progress& progress);

  // Has the bridge accepted a command of ours, or does it say that we own the robot?
  bool may_own() const;
  bool owns() const;  // as ControlStatus has it
  // Gives control back when we may have it; does not wait long for the answer.
  void release();

  // Keeps control for one round of waiting: renews the lease when it is time, takes what has arrived.
  void hold(std::chrono::nanoseconds wait);

  // One sample of the velocity stream; it renews the lease as well.
  void send_velocity(const VelocityPlan& plan);

  const std::string& robot() const { return robot_; }
  const meca500::ControlStatus* control() const;

 private:
  meca500::Command make_command(const CommandPlan& plan, WaitFor until);
  // The bridge that took the command, and how many BridgeStatus samples had come by then.
  struct Taker {
    dds::ParticipantId participant{};
    std::uint64_t statuses = 0;
  };
  // Sets `taker`, when it is still empty, with the first receipt.
  std::optional<meca500::CommandReceipt> next_receipt(std::uint64_t command_id, std::optional<Taker>& taker);
  const RobotView* view() const;  // null: nothing has come yet
  bool link_up() const;           // as BridgeStatus has it; true when there is none
  // The bridge has left without a word, or another one, which knows nothing of our command, speaks for the robot.
  bool is_gone(const Taker& bridge) const;

  Bus& bus_;
  Observer& observer_;
  std::string robot_;
  dds::Writer<meca500::Command> commands_;
  dds::Writer<meca500::ControlLease> leases_;
  dds::Writer<meca500::VelocityCommand> velocities_;
  dds::Reader<meca500::CommandReceipt> receipts_;
  std::uint64_t next_id_;
  std::uint64_t lease_number_ = 0;
  std::uint64_t velocity_number_ = 0;
  bool accepted_ = false;
  Clock::time_point last_renewal_{};
};

}  // namespace meca::cli
