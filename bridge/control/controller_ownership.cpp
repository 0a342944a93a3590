// How control changes hands: released, taken over, or lost.
#include "bridge/control/controller.hpp"

namespace meca::control {

// The owner keeps control for its grace; follow_contender() goes on from here.
void Controller::contend(const CommandRequest& request, const Ticket& ticket, const View& view) noexcept {
  const ClientName owner = arbiter_.state().owner;
  if (const auto outranked = arbiter_.contend(request, ticket, view.now, view.unix_ns)) {
    const Detail detail{.other = request.client, .hint = ControlHint::kOutranked};
    ledger_.report(*outranked, ReceiptState::kAborted, Reason::kNotOwner, detail);
  }
  ledger_.report(ticket, ReceiptState::kAccepted, Reason::kNone, {.other = owner});
}

void Controller::follow_contender(const View& view) noexcept {
  if (arbiter_.contender_expired(view.now)) end_contest(Reason::kOwnerLost);
  if (!arbiter_.contended() || (arbiter_.owned() && !arbiter_.grace_over(view.now))) return;
  if (arbiter_.owned()) lose_owner(ControlState::Loss::kTakenOver, view);
  if (sequencer_.handshake_idle()) sequencer_.disarm();  // the next owner starts from an image that asks for nothing
  const Ticket ticket = arbiter_.succeed(view.unix_ns);
  finishing_ = false;
  ledger_.report(ticket, ReceiptState::kCompleted);
}

void Controller::end_contest(Reason reason) noexcept {
  if (const auto ticket = arbiter_.withdraw()) ledger_.report(*ticket, ReceiptState::kAborted, reason);
}

void Controller::release(const View& view) noexcept {
  const LossPolicy policy = arbiter_.state().on_loss;
  arbiter_.drop(ControlState::Loss::kReleased, false);
  actions_.discard_queued(Reason::kOwnerLost);
  actions_.end_resume(Reason::kOwnerLost);
  actions_.engage_brakes();
  if (policy == LossPolicy::kStopMotion && robot_may_move(view)) {
    stop(Reason::kOwnerLost, view.now);
  } else {
    sequencer_.discard_unsent(Reason::kOwnerLost);
    sequencer_.hold_proofs();
    finishing_ = true;
  }
  velocity_.reset();
  follow_contender(view);  // before anybody else's command of this cycle
}

// A paused robot has nothing under way that could finish, and the next owner's Resume must not run what a client left
// that is gone.
bool Controller::loss_stops(const View& view) const noexcept {
  return arbiter_.state().on_loss == LossPolicy::kStopMotion || view.in.motion_status.paused || actions_.pausing();
}

void Controller::lose_owner(ControlState::Loss why, const View& view) noexcept {
  const bool taken_over = why == ControlState::Loss::kTakenOver;
  const bool stops = loss_stops(view);
  arbiter_.drop(why, stops || taken_over);
  const bool on = view.in.robot_status.activated || view.in.robot_status.busy;
  // Somebody is there to mind a robot that was taken over: one that stands is left alone, as after a release.
  if (stops && (taken_over ? robot_may_move(view) : on)) stop(Reason::kOwnerLost, view.now);
  sequencer_.discard_unsent(Reason::kOwnerLost);
  sequencer_.hold_proofs();
  actions_.discard_queued(Reason::kOwnerLost);
  actions_.end_resume(Reason::kOwnerLost);
  actions_.engage_brakes();
  velocity_.reset();
  finishing_ = !stops;
}

}  // namespace meca::control
