#include <nlohmann/json.hpp>

#include "cli/client.hpp"
#include "cli/format.hpp"
#include "cli/names.hpp"
#include "cli/run.hpp"

namespace meca::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kStreamPeriod = 10ms;  // five samples per default velocity lease of the bridge
constexpr auto kSoon = 1s;            // what a running bridge answers at once

// The bridge ends what a lost link left open when the robot is back, or after 30 s (idl/control.idl, REASON_LINK_LOST).
// Nobody shall sit before a silent terminal so long.
std::string link_text(const std::string& command, bool up) {
  return command + (up ? ": the link to the robot is back"
                       : ": the link to the robot is lost; waiting up to 30 s to hear what became of the command");
}

Client::Progress printer(const Report& report, const std::string& robot, const std::string& title) {
  return {.receipt =
              [&report, title](const meca500::CommandReceipt& receipt) {
                report.object(to_json(receipt));
                report.text(receipt_text(receipt, title));
              },
          .link = [&report, command = robot + ": " + title](bool up) { report.text(link_text(command, up)); }};
}

ExitCode no_answer(const Outcome& outcome, const Invocation& call, const Report& report, const std::string& title) {
  const std::string after = fixed(call.timeout_s.value_or(60), 0, 1) + " s";
  if (!outcome.last) {
    return report.error(ExitCode::kTimeOut,
                        title + ": the bridge did not answer within " + after +
                            "; is it still running ('meca-ctl health'), and does it take commands?");
  }
  return report.error(ExitCode::kTimeOut, title + ": not finished after " + after + ", last it was " +
                                              std::string(name(outcome.last->state())) +
                                              "; it goes on, 'meca-ctl status' shows how, --timeout waits longer");
}

ExitCode exit_code_of(const Outcome& outcome, const Invocation& call, const Report& report, const std::string& title) {
  switch (outcome.ended) {
    case Ended::kInterrupted:
      return report.error(ExitCode::kInterrupted,
                          title + ": interrupted; what the robot has queued goes on, 'meca-ctl pause' stops it");
    case Ended::kTimeOut:
      return no_answer(outcome, call, report, title);
    case Ended::kBridgeGone:
      return report.error(ExitCode::kNoBridge,
                          title + ": the bridge that took it is gone, or was started again; last it was " +
                              std::string(name(outcome.last->state())) +
                              ", what became of it is not known; look where the arm is before sending it again");
    case Ended::kReached:
      break;
  }
  const auto state = outcome.last->state();
  const bool refused = is_terminal(state) && state != meca500::ReceiptState::COMPLETED;
  return refused ? ExitCode::kRefused : ExitCode::kDone;
}

// Finds the bridge and the robot, then leaves the rest to `talk`, and gives control back whatever happens.
template <typename Talk>
ExitCode with_client(const Invocation& call, Talk talk) {
  Bus bus(call);
  Observer observer(bus, Interest::kControl);
  observer.discover(call.robot, discovery_timeout(call));
  if (interrupted) return ExitCode::kInterrupted;
  Client client(bus, observer, observer.choose(call.robot));
  const ExitCode code = talk(client, observer);
  client.release();
  return code;
}

CommandPlan take_plan() {
  CommandPlan plan;
  plan.title = "take";
  return plan;
}

// Has control when it returns kDone.
ExitCode take_control(Client& client, const Invocation& call, const Report& report) {
  const auto plan = take_plan();
  const auto outcome =
      client.execute(plan, WaitFor::kEnd, answer_timeout(call), printer(report, client.robot(), plan.title));
  return exit_code_of(outcome, call, report, plan.title);
}

std::string lost_control(const Client& client) {
  const auto* status = client.control();
  std::string text = client.robot() + ": control is lost";
  if (status == nullptr) return text;
  if (status->last_loss().size() != 0) text += " (" + std::string(status->last_loss().c_str()) + ")";
  if (status->owned()) text += "; it is with " + std::string(status->owner().c_str()) + " now";
  return text;
}

// Waits for ControlStatus to follow the receipt, so that its absence later means a loss.
bool wait_until_owner(Client& client) {
  const auto start = Clock::now();
  while (!client.owns() && Clock::now() - start < kSoon && !interrupted) client.hold(kStreamPeriod);
  return client.owns();
}

// True when the whole time was served with control.
bool stream(Client& client, const VelocityPlan& plan, std::chrono::nanoseconds duration) {
  const auto start = Clock::now();
  auto next = start;
  while (!interrupted && client.owns() && Clock::now() - start < duration) {
    client.send_velocity(plan);
    next += kStreamPeriod;
    while (Clock::now() < next && !interrupted) client.hold(next - Clock::now());
  }
  return client.owns();
}

ExitCode move_for_a_while(Client& client, const Observer& observer, const Invocation& call, const Report& report) {
  const RobotView& view = observer.robots().at(client.robot());
  if (!wait_until_owner(client)) return report.error(ExitCode::kRefused, lost_control(client));
  if (view.bridge && !view.bridge->ready()) {
    const std::string us = client.control()->owner().c_str();
    return report.error(ExitCode::kRefused, client.robot() + " would not move: " + readiness(view, us));
  }
  const bool kept = stream(client, call.velocity, seconds_of(*call.duration_s));
  VelocityPlan stop = call.velocity;
  stop.velocity = {};
  client.send_velocity(stop);
  if (!kept) return report.error(ExitCode::kRefused, lost_control(client) + "; the velocity stream has stopped");
  if (interrupted) return report.error(ExitCode::kInterrupted, "velocity: interrupted, the robot stops");
  report.text(client.robot() + ": velocity: done");
  report.object({{"robot", client.robot()}, {"velocity", "done"}});
  return ExitCode::kDone;
}

}  // namespace

ExitCode run_command(const Invocation& call, const Report& report) {
  return with_client(call, [&](Client& client, const Observer&) {
    const auto until = call.wait ? WaitFor::kEnd : WaitFor::kAcknowledged;
    const auto outcome =
        client.execute(call.command, until, answer_timeout(call), printer(report, client.robot(), call.command.title));
    return exit_code_of(outcome, call, report, call.command.title);
  });
}

ExitCode run_velocity(const Invocation& call, const Report& report) {
  return with_client(call, [&](Client& client, const Observer& observer) {
    const ExitCode taken = take_control(client, call, report);
    return taken == ExitCode::kDone ? move_for_a_while(client, observer, call, report) : taken;
  });
}

ExitCode run_take(const Invocation& call, const Report& report) {
  return with_client(call, [&](Client& client, const Observer&) {
    const ExitCode taken = take_control(client, call, report);
    if (taken != ExitCode::kDone) return taken;
    if (!wait_until_owner(client)) return report.error(ExitCode::kRefused, lost_control(client));
    report.text("Holding " + client.robot() + (call.duration_s ? "." : " until Ctrl-C."));
    const auto start = Clock::now();
    while (!interrupted && (!call.duration_s || Clock::now() - start < seconds_of(*call.duration_s))) {
      client.hold(kStreamPeriod);
      if (!client.owns()) return report.error(ExitCode::kRefused, lost_control(client));
    }
    return ExitCode::kDone;  // Ctrl-C is how a person ends this
  });
}

}  // namespace meca::cli
