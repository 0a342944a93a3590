#include "bridge/control/controller.hpp"

namespace meca::control {
namespace {

// How long what a lost link left open waits to be resolved by the robot's echo and checkpoints. Nothing that the bridge
// sees ends it earlier: a robot may keep its queue for as long as the cable is out, and finish it (inferred). People
// and idl/control.idl are told this number.
constexpr Time kResolvePatience = std::chrono::seconds(30);

// Refusals that say "not you, not here, not now", as opposed to "not this command".
bool refuses_control(Reason reason) noexcept {
  return reason == Reason::kNotOwner || reason == Reason::kMonitoringOnly || reason == Reason::kNoLink ||
         reason == Reason::kFirmwareUnknown || reason == Reason::kShutdown;
}

// What ControlStatus shows of a refusal.
Receipt refused(const ClientName& client, std::uint64_t command_id, CommandKind kind, std::uint32_t motion_command_id,
                const Refusal& refusal) noexcept {
  const Detail& detail = refusal.detail;
  Receipt r;
  r.client = client;
  r.command_id = command_id;
  r.state = ReceiptState::kRejected;
  r.reason = refusal.reason;
  r.kind = kind;
  r.motion_command_id = motion_command_id;
  r.value = detail.value;
  r.minimum = detail.minimum;
  r.maximum = detail.maximum;
  r.other = detail.other;
  r.hint = detail.hint;
  return r;
}

bool is_off(const View& view) noexcept { return !view.in.robot_status.activated && !view.in.robot_status.busy; }

}  // namespace

Controller::Controller(const ControllerSettings& s) noexcept
    : settings_(s),
      arbiter_(s.lease, s.clients),
      actions_(ledger_, {s.action_timeout, s.allow_brakes, s.dynamic_data}),
      sequencer_(ledger_, s.acknowledge_timeout),
      velocity_(s.velocity_lease),
      stop_(s.action_timeout),
      monitoring_only_(s.monitoring_only) {
  arbiter_.set_monitoring_only(s.monitoring_only);
}

void Controller::step(std::span<const Request> requests, const View& view, LinkFacts link) noexcept {
  follow_link(view, link);
  if (link.firmware_known) limits_.observe(view);
  if (seeded_) follow_robot(view);
  for (const Request& request : requests) {
    if (const auto* command = std::get_if<CommandRequest>(&request)) {
      arbiter_.renew(command->client, command->participant, view.now, view.unix_ns);
      handle(*command, view, link);
    } else if (const auto* velocity = std::get_if<VelocityRequest>(&request)) {
      handle(*velocity, view);
    } else if (const auto* renewal = std::get_if<LeaseRenewal>(&request)) {
      arbiter_.renew(*renewal, view.now, view.unix_ns);
    } else {
      shut_down(view);
    }
  }
  if (arbiter_.expired(view.now)) lose_owner(ControlState::Loss::kLeaseExpired, view);
  follow_contender(view);
  if (seeded_) advance(view);
}

// ---------------------------------------------------------------- what the link and the robot did

void Controller::follow_link(const View& view, LinkFacts link) noexcept {
  if (!link.usable) {
    if (had_link_) {
      had_link_ = seeded_ = false;
      link_lost_at_ = view.now;
      const bool busy = robot_may_move(view) || stop_.active();
      stop_on_return_ = busy && (!arbiter_.owned() || loss_stops(view)) && !finishing_;
      arbiter_.drop(ControlState::Loss::kLinkLost, true);
      end_contest(Reason::kLinkLost);
      sequencer_.link_lost();
      actions_.end_all(Reason::kLinkLost);
      velocity_.reset();
      stop_.cancel();
      limits_.forget();
      finishing_ = false;
      blind_ = true;
      if (shut_down_) sequencer_.end_all(ReceiptState::kAborted, Reason::kShutdown);
      if (stop_on_return_) actions_.hold_pause(Reason::kLinkLost);
    } else if (!sequencer_.idle() && view.now - link_lost_at_ > kResolvePatience) {
      sequencer_.give_up_unresolved();
    }
    blind_ = blind_ && link.up;
    return;
  }
  if (!had_link_ && view.fresh) {
    had_link_ = seeded_ = true;
    blind_ = false;
    actions_.seed(view);
    sequencer_.seed(view);
    in_safety_stop_ = safety_stop(view.in);
    stop_present_ = unresettable_stop(view.in, view.layout);
    in_error_ = view.in.robot_status.error_code != 0;
    if (stop_on_return_ && view.in.robot_status.activated) {
      stop(Reason::kLinkLost, view.now);
    } else if (!view.in.robot_status.activated) {
      sequencer_.give_up_unresolved();  // it was off in between: its queue is gone, and with it every proof
    }
    stop_on_return_ = false;
  }
}

void Controller::follow_robot(const View& view) noexcept {
  const image::RobotStatus& status = view.in.robot_status;
  sequencer_.observe(view);
  if (!view.fresh) return;
  follow_monitoring_mode(view);
  if (status.error_code != 0) {
    // The robot has cleared its queue itself (spec 5.6).
    if (!in_error_) {
      if (!sequencer_.idle()) sequencer_.end_all(ReceiptState::kAborted, Reason::kRobotError, status.error_code);
      actions_.discard_queued(Reason::kRobotError);
    }
    if (sequencer_.handshake_idle()) sequencer_.disarm();  // but for a reboot, which is asked for in an error
    velocity_.stop();
  }
  in_error_ = status.error_code != 0;
  const bool stopped = safety_stop(view.in);
  const bool present = unresettable_stop(view.in, view.layout);  // pressed again before it was reset: a stop anew
  if ((stopped && !in_safety_stop_) || (present && !stop_present_)) {
    velocity_.stop();
    actions_.discard_queued(Reason::kSafetyStop);
    actions_.end_resume(Reason::kSafetyStop);
    if (robot_may_move(view)) stop(Reason::kSafetyStop, view.now);
  }
  in_safety_stop_ = stopped;
  stop_present_ = present;
  if (!status.activated) {
    sequencer_.end_motion(Reason::kNotActivated);
    velocity_.stop();
  }
}

// Another connection may take the robot over (spec 5.11). When it gives it back, we start as after a reconnection.
void Controller::follow_monitoring_mode(const View& view) noexcept {
  const bool was = monitoring_only_;
  monitoring_only_ = settings_.monitoring_only || view.in.robot_status.monitoring_mode;
  arbiter_.set_monitoring_only(monitoring_only_);
  if (monitoring_only_ && !was) {
    arbiter_.drop(ControlState::Loss::kLinkLost, true);
    end_contest(Reason::kMonitoringOnly);
    sequencer_.end_all(ReceiptState::kAborted, Reason::kMonitoringOnly);
    actions_.end_all(Reason::kMonitoringOnly);
    velocity_.reset();
    stop_.cancel();
  } else if (was && !monitoring_only_) {
    actions_.seed(view);
    sequencer_.seed(view);
  }
}

// Until somebody resumes, but not while the motors are off: what such a robot takes moves nothing, and one whose error
// only a reboot clears can never be resumed.
bool Controller::held_by_stop(const View& view) const noexcept {
  return stop_.active() || (actions_.pause_held_by_stop() && !is_off(view));
}

bool Controller::robot_may_move(const View& view) const noexcept {
  if (is_off(view)) return false;
  return !sequencer_.idle() || sequencer_.robot_may_be_busy() || velocity_.active() ||
         (view.in.robot_status.activated && !view.in.motion_status.eob);
}

// ---------------------------------------------------------------- what clients ask

std::optional<Refusal> Controller::refusal_of_control(const CommandRequest& request, LinkFacts link) const noexcept {
  if (shut_down_) return Refusal{Reason::kShutdown};
  if (monitoring_only_) return Refusal{Reason::kMonitoringOnly};
  if (!link.usable || !seeded_) return Refusal{Reason::kNoLink};
  if (!link.firmware_known) return Refusal{Reason::kFirmwareUnknown};
  switch (arbiter_.claim(request.client, request.participant)) {
    case Claim::kOwner:
    case Claim::kFree:
      return std::nullopt;
    case Claim::kForeign:
      if (request.kind == CommandKind::kTakeControl && arbiter_.may_take_over(request.client)) return std::nullopt;
      return Refusal{Reason::kNotOwner, arbiter_.explain(request.client, request.participant)};
    case Claim::kMustTake:
      if (request.kind == CommandKind::kTakeControl) return std::nullopt;
      return Refusal{Reason::kNotOwner};
  }
  return std::nullopt;
}

std::optional<Refusal> Controller::refusal_of_command(const CommandRequest& request, const Ticket& ticket,
                                                      const View& view, LinkFacts link) noexcept {
  const bool about_control = request.kind == CommandKind::kTakeControl || request.kind == CommandKind::kReleaseControl;
  if (about_control) return check_action_arguments(request);  // never for want of room among the owner's actions
  if (request.kind != CommandKind::kMotion) return actions_.check(request, ticket, view);
  RobotFacts robot{.layout = view.layout, .product_type = link.product_type, .limits = limits_};
  if (!robot_may_move(view) && view.in.motion_status.eom) robot.standing_at = view.in.target_joint_set.joints;
  if (const auto refusal = check_motion_arguments(request, robot)) return refusal;
  if (const auto refusal = check_motion_state(request, view)) return refusal;
  if (actions_.deactivating()) return Refusal{Reason::kNotActivated};
  if (held_by_stop(view)) return Refusal{Reason::kPaused};
  if (sequencer_.full()) return Refusal{Reason::kQueueFull};
  return std::nullopt;
}

void Controller::reject(const CommandRequest& request, const Ticket& ticket, const Refusal& refusal) noexcept {
  ledger_.report(ticket, ReceiptState::kRejected, refusal.reason, refusal.detail);
  if (!refuses_control(refusal.reason)) return;
  arbiter_.remember_refusal(
      refused(request.client, request.command_id, request.kind, request.motion_command_id, refusal));
}

void Controller::handle(const CommandRequest& request, const View& view, LinkFacts link) noexcept {
  const auto ticket = ledger_.admit(request);
  if (!ticket) return;
  if (request.kind == CommandKind::kReleaseControl && !arbiter_.owned()) {
    return ledger_.report(*ticket, ReceiptState::kCompleted);  // nothing to give back
  }
  if (request.kind == CommandKind::kReleaseControl && arbiter_.is_contender(request.client, request.participant)) {
    end_contest(Reason::kOwnerLost);
    return ledger_.report(*ticket, ReceiptState::kCompleted);
  }
  if (const auto refusal = refusal_of_control(request, link)) return reject(request, *ticket, *refusal);
  if (const auto refusal = refusal_of_command(request, *ticket, view, link)) return reject(request, *ticket, *refusal);
  execute(request, *ticket, view);
}

void Controller::execute(const CommandRequest& request, const Ticket& ticket, const View& view) noexcept {
  if (arbiter_.claim(request.client, request.participant) == Claim::kForeign) return contend(request, ticket, view);
  if (!arbiter_.owned()) {
    arbiter_.take(request.client, request.participant, request.on_loss, view.now, view.unix_ns);
    velocity_.reset();
    finishing_ = false;
  }
  arbiter_.set_policy(request.on_loss);
  switch (request.kind) {
    case CommandKind::kTakeControl:
      return ledger_.report(ticket, ReceiptState::kCompleted);
    case CommandKind::kReleaseControl:
      release(view);
      return ledger_.report(ticket, ReceiptState::kCompleted);
    case CommandKind::kMotion: {
      Motion motion;
      motion.ticket = ticket;
      motion.command_class = image::find_motion_command(request.motion_command_id)->command_class;
      for (std::size_t i = 0; i < request.argument_count; ++i) {
        motion.arguments[i] = static_cast<float>(request.arguments[i]);
      }
      motion.use_variables = request.use_variables;
      motion.report_completion = request.report_completion;
      ledger_.report(ticket, ReceiptState::kAccepted);
      sequencer_.accept(motion);
      return;
    }
    case CommandKind::kActivate:
    case CommandKind::kDeactivate:
    case CommandKind::kHome:
    case CommandKind::kResetError:
    case CommandKind::kPauseMotion:
    case CommandKind::kResumeMotion:
    case CommandKind::kClearMotion:
    case CommandKind::kSimMode:
    case CommandKind::kRecoveryMode:
    case CommandKind::kBrakes:
    case CommandKind::kDynamicData:
    case CommandKind::kSetHostTime:
      return actions_.accept(request, ticket, view, sequencer_.idle() && !robot_may_move(view));
  }
}

void Controller::handle(const VelocityRequest& request, const View& view) noexcept {
  const Claim claim = arbiter_.claim(request.client, request.participant);
  if (claim == Claim::kOwner && !shut_down_) {
    if (velocity_.accept(request, view.now)) {
      arbiter_.renew(request.client, request.participant, view.now, view.unix_ns);
    }
    return;
  }
  // A stream has no receipts; ControlStatus names who was refused. A stream never takes control: after an accident it
  // would set the robot moving again by itself.
  const Refusal refusal = shut_down_
                              ? Refusal{Reason::kShutdown}
                              : Refusal{Reason::kNotOwner, arbiter_.explain(request.client, request.participant)};
  arbiter_.remember_refusal(refused(request.client, 0, CommandKind::kMotion, velocity_command(request.kind), refusal));
}

// ---------------------------------------------------------------- how control ends

void Controller::stop(Reason reason, Time now) noexcept {
  sequencer_.discard_unsent(reason);
  sequencer_.disarm();
  sequencer_.set_dropping(true);
  velocity_.stop();
  actions_.hold_pause(reason);
  stop_.start(reason, now);
  finishing_ = false;
}

// The queue is cleared too: whoever resumes the robot later must not start what this life of the bridge left behind.
// Asked a second time, it waits for nothing any more.
void Controller::shut_down(const View& view) noexcept {
  if (shut_down_) {
    stop_.cancel();
    actions_.end_all(Reason::kShutdown);
    return sequencer_.end_all(ReceiptState::kAborted, Reason::kShutdown);
  }
  shut_down_ = true;
  arbiter_.drop(ControlState::Loss::kShutdown, false);
  end_contest(Reason::kShutdown);
  actions_.end_all_but_deactivate(Reason::kShutdown);
  actions_.engage_brakes();
  velocity_.reset();
  if (seeded_ && (view.in.robot_status.activated || view.in.robot_status.busy)) {
    stop(Reason::kShutdown, view.now);
  } else {
    sequencer_.end_all(ReceiptState::kAborted, Reason::kShutdown);
  }
}

// ---------------------------------------------------------------- what to do now

bool Controller::velocity_allowed(const View& view) const noexcept {
  const image::RobotStatus& status = view.in.robot_status;
  return arbiter_.owned() && sequencer_.idle() && !stop_.active() && !actions_.clearing() && !actions_.deactivating() &&
         !actions_.pause_held_by_stop() && !view.in.motion_status.paused && status.activated &&
         (status.homed || status.recovery_mode) && status.error_code == 0 && !safety_stop(view.in);
}

void Controller::advance(const View& view) noexcept {
  const StopSequence::Progress progress = stop_.advance(view, sequencer_.unproved());
  if (progress != StopSequence::Progress::kNone) {
    const bool cleared = progress == StopSequence::Progress::kCleared;
    sequencer_.end_all(cleared ? ReceiptState::kDiscarded : ReceiptState::kAborted, stop_.reason());
  }
  const Actions::Events events = actions_.advance(view, stop_.active(), sequencer_.unproved());
  if (events.clear_started) sequencer_.discard_unsent(Reason::kCleared);
  if (events.clear_confirmed && !stop_.active()) sequencer_.end_all(ReceiptState::kDiscarded, Reason::kCleared);
  if (events.deactivate_started) sequencer_.discard_unsent(Reason::kNotActivated);
  const bool dropping = stop_.active() || actions_.clearing() || actions_.deactivating();
  sequencer_.set_dropping(dropping);
  // With SetPoint up a command whose frame was lost would be taken from the very image that empties the queue, and a
  // checkpoint among them would prove what was just dropped.
  if (dropping) sequencer_.disarm();
  const bool pause_rises = actions_.pausing() && !was_pausing_;
  was_pausing_ = actions_.pausing();
  if (dropping || pause_rises) sequencer_.pause_rises();
  const bool hold = dropping || pause_rises || held_by_stop(view);
  sequencer_.advance(view, hold, actions_.pausing());
  if (!arbiter_.owned() && sequencer_.handshake_idle()) sequencer_.disarm();
  velocity_.advance(view, velocity_allowed(view));
  if (velocity_.active()) sequencer_.stand_aside();
}

image::Outputs Controller::outputs() noexcept {
  image::Outputs out;
  sequencer_.write(out);
  if (sequencer_.handshake_idle()) {
    velocity_.write(out);
  } else {
    velocity_.yield();
  }
  actions_.write(out);
  if (stop_.clear()) out.motion_control.clear_motion = true;
  out.dynamic_data_configuration.type_ids = actions_.dynamic_data();
  return out;
}

}  // namespace meca::control
