#include "cli/client.hpp"

#include <algorithm>
#include <utility>

#include "cli/names.hpp"

namespace meca::cli {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr auto kRenewal = 25ms;  // four times per default lease
constexpr auto kResend = 300ms;  // a command without any receipt
constexpr auto kReleaseTimeout = 500ms;
constexpr int kReceiptDepth = 256;

// Ids count up, and go on counting up when the same client name comes back in another process (a container where we
// always are process 1, or --client): so they start at the time of day.
std::uint64_t first_command_id() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

bool is_enough(const meca500::CommandReceipt& receipt, const CommandPlan& plan, WaitFor until) {
  if (is_terminal(receipt.state())) return true;
  return until == WaitFor::kAcknowledged && plan.kind == meca500::CommandKind::MOTION &&
         receipt.state() == meca500::ReceiptState::ACKNOWLEDGED;
}

}  // namespace

Client::Client(Bus& bus, Observer& observer, std::string robot)
    : bus_(bus), observer_(observer), robot_(std::move(robot)), next_id_(first_command_id()) {
  receipts_ = bus.latest<meca500::CommandReceipt>("CommandReceipt", kReceiptDepth);
  commands_ = bus.writer<meca500::Command>("Command");
  leases_ = bus.writer<meca500::ControlLease>("ControlLease");
  velocities_ = bus.writer<meca500::VelocityCommand>("VelocityCommand");
}

meca500::Command Client::make_command(const CommandPlan& plan, WaitFor until) {
  meca500::Command command;
  command.robot(robot_);
  command.client(bus_.client());
  command.command_id(next_id_++);
  command.kind(plan.kind);
  command.motion_command_id(plan.motion_command_id);
  command.arguments(plan.arguments);
  command.use_variables(plan.use_variables);
  command.report_completion(plan.kind == meca500::CommandKind::MOTION && until == WaitFor::kEnd);
  command.on_loss(meca500::LossPolicy::FINISH_MOTION);
  return command;
}

const RobotView* Client::view() const {
  const auto found = observer_.robots().find(robot_);
  return found != observer_.robots().end() ? &found->second : nullptr;
}

std::optional<meca500::CommandReceipt> Client::next_receipt(std::uint64_t command_id, std::optional<Taker>& taker) {
  meca500::CommandReceipt receipt;
  dds::SampleInfo info;
  while (receipts_.take(receipt, info)) {
    const bool ours = info.valid_data && receipt.command_id() == command_id && receipt.robot().c_str() == robot_ &&
                      receipt.client().c_str() == bus_.client();
    if (!ours) continue;
    if (!taker) taker = {info.participant, view() != nullptr ? view()->bridge_samples : 0};
    return receipt;
  }
  return std::nullopt;
}

bool Client::is_gone(const Taker& bridge) const {
  if (commands_.matched() == 0) return true;
  return view() != nullptr && view()->bridge_samples > bridge.statuses && view()->bridge_writer != bridge.participant;
}

bool Client::link_up() const {
  return view() == nullptr || !view()->bridge || view()->bridge->link() == meca500::LinkState::LINK_UP;
}

Outcome Client::execute(const CommandPlan& plan, WaitFor until, nanoseconds timeout, const Progress& progress) {
  const meca500::Command command = make_command(plan, until);
  const auto start = Clock::now();
  auto last_sent = start - kResend;
  bool link_was_up = true;
  std::optional<Taker> taker;
  Outcome outcome;
  while (Clock::now() - start < timeout) {
    if (interrupted) {
      outcome.ended = Ended::kInterrupted;
      return outcome;
    }
    if (!outcome.last && Clock::now() - last_sent >= kResend && commands_.matched() > 0) {
      commands_.write(command);
      last_sent = Clock::now();
    }
    hold(kRenewal);
    while (const auto receipt = next_receipt(command.command_id(), taker)) {
      if (outcome.last && outcome.last->state() == receipt->state()) continue;  // the answer to a repetition
      accepted_ = accepted_ || receipt->state() != meca500::ReceiptState::REJECTED;
      outcome.last = *receipt;
      progress.receipt(*receipt);
      if (!is_enough(*receipt, plan, until)) continue;
      outcome.ended = Ended::kReached;
      return outcome;
    }
    if (taker && is_gone(*taker)) {
      outcome.ended = Ended::kBridgeGone;
      return outcome;
    }
    const bool waits_for_robot = outcome.last && plan.kind == meca500::CommandKind::MOTION;
    if (waits_for_robot && link_up() != link_was_up) {
      link_was_up = !link_was_up;
      progress.link(link_was_up);
    }
  }
  return outcome;
}

void Client::hold(nanoseconds wait) {
  const auto now = Clock::now();
  if (accepted_ && now - last_renewal_ >= kRenewal) {
    meca500::ControlLease lease;
    lease.robot(robot_);
    lease.client(bus_.client());
    lease.sequence_number(++lease_number_);
    leases_.write(lease);
    last_renewal_ = now;
  }
  observer_.pump(std::min<nanoseconds>(wait, kRenewal));
}

void Client::send_velocity(const VelocityPlan& plan) {
  meca500::VelocityCommand command;
  command.robot(robot_);
  command.client(bus_.client());
  command.sequence_number(++velocity_number_);
  command.kind(plan.kind);
  command.velocity(plan.velocity);
  velocities_.write(command);
}

const meca500::ControlStatus* Client::control() const {
  return view() != nullptr && view()->control ? &*view()->control : nullptr;
}

bool Client::owns() const {
  const auto* status = control();
  return status != nullptr && status->owned() && status->owner().c_str() == bus_.client();
}

bool Client::may_own() const { return accepted_ || owns(); }

void Client::release() {
  if (!may_own()) return;
  const bool was_interrupted = interrupted.exchange(false);  // giving back is what an interrupted client does last
  CommandPlan plan;
  plan.kind = meca500::CommandKind::RELEASE_CONTROL;
  execute(plan, WaitFor::kEnd, kReleaseTimeout, {.receipt = [](const auto&) {}, .link = [](bool) {}});
  accepted_ = false;
  if (was_interrupted) interrupted = true;
}

}  // namespace meca::cli
