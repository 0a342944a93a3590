#include "bridge/control/actions.hpp"

#include <algorithm>

namespace meca::control {
namespace {

using image::Layout;

constexpr Time kAskTwiceWithin = std::chrono::seconds(5);
// not published: how soon after a deactivation the drives take an activation; a short rest costs nobody anything.
constexpr Time kReactivationRest = std::chrono::milliseconds(100);
}  // namespace

Actions::Actions(Ledger& ledger, const Settings& settings) noexcept
    : ledger_(ledger), settings_(settings), dynamic_data_(settings.dynamic_data) {}

void Actions::seed(const View& view) noexcept {
  sim_mode_ = view.in.robot_status.sim_activated;
  recovery_mode_ = view.in.robot_status.recovery_mode;
  // On firmware 9 letting go of Pause starts the robot by itself. A deactivated robot has an empty queue: nothing to
  // hold.
  pause_ = pause_by_stop_ = view.in.motion_status.paused && view.in.robot_status.activated;
  brakes_gate_ = brakes_engaged_ = brakes_returning_ = false;
  deactivated_at_.reset();
}

bool Actions::urgent(CommandKind kind) noexcept {
  return kind == CommandKind::kPauseMotion || kind == CommandKind::kClearMotion || kind == CommandKind::kDeactivate;
}

const Actions::Action* Actions::running(CommandKind kind) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (actions_[i].ticket.kind == kind && actions_[i].phase != Phase::kQueued) return &actions_[i];
  }
  return nullptr;
}

// Nothing of its kind of turn is in front of it. Resume waits for the urgent ones too: it is what they prevent.
bool Actions::may_start(const Action& action) const noexcept {
  if (urgent(action.ticket.kind)) return true;
  const bool resume = action.ticket.kind == CommandKind::kResumeMotion;
  for (std::size_t i = 0; i < count_ && &actions_[i] != &action; ++i) {
    if (resume || !urgent(actions_[i].ticket.kind)) return false;
  }
  return true;
}

Actions::Action Actions::make(const CommandRequest& request, const Ticket& ticket) noexcept {
  Action action;
  action.ticket = ticket;
  action.wanted = request.arguments[0] != 0;
  if (request.kind == CommandKind::kDynamicData) {  // ranges were checked
    action.slot = static_cast<std::uint8_t>(request.arguments[0]);
    action.type = static_cast<std::uint32_t>(request.arguments[1]);
  }
  return action;
}

std::optional<Refusal> Actions::check(const CommandRequest& request, const Ticket& ticket, const View& view) noexcept {
  if (const auto refusal = check_action_arguments(request)) return refusal;
  if (count_ + (urgent(request.kind) ? 0 : kUrgentPlaces) >= kMaxActions) return Refusal{Reason::kQueueFull};
  const Action action = make(request, ticket);
  if (may_start(action)) {
    if (const auto refusal = check_start(action, view)) return refusal;
  }
  if (request.kind == CommandKind::kBrakes && !action.wanted) {
    const bool asked = brakes_asked_ && view.now - *brakes_asked_ <= kAskTwiceWithin && brakes_client_ == ticket.client;
    brakes_client_ = ticket.client;
    if (asked) {
      brakes_asked_.reset();
    } else {
      brakes_asked_ = view.now;
      const auto seconds = std::chrono::duration<double>(kAskTwiceWithin).count();
      return Refusal{Reason::kNotAllowed, {.value = seconds, .maximum = seconds}};  // describe(): send it again
    }
  }
  return std::nullopt;
}

void Actions::accept(const CommandRequest& request, const Ticket& ticket, const View& view,
                     bool nothing_queued) noexcept {
  Action action = make(request, ticket);
  if (may_start(action) && already_done(action, view, nothing_queued)) {
    ledger_.report(ticket, ReceiptState::kCompleted);
    return;
  }
  if (request.kind == CommandKind::kDeactivate) overtake(true, Reason::kNotActivated);
  if (request.kind == CommandKind::kClearMotion) overtake(false, Reason::kCleared);
  if (request.kind == CommandKind::kPauseMotion) overtake(false, Reason::kPaused);
  ledger_.report(ticket, ReceiptState::kAccepted);
  actions_[count_++] = action;
}

void Actions::overtake(bool deactivate, Reason reason) noexcept {
  for (std::size_t i = count_; i-- > 0;) {
    const Action a = actions_[i];
    const CommandKind kind = a.ticket.kind;
    const bool contradicted = kind == CommandKind::kResumeMotion ||
                              (deactivate && (kind == CommandKind::kActivate || kind == CommandKind::kHome));
    if (!contradicted) continue;
    remove(i);
    const bool sent = a.phase != Phase::kQueued;
    if (sent) revert(a);
    linger_activate_ |= sent && kind == CommandKind::kActivate;
    linger_home_ |= sent && kind == CommandKind::kHome;
    ledger_.report(a.ticket, sent ? ReceiptState::kAborted : ReceiptState::kDiscarded, reason);
  }
}

void Actions::remove(std::size_t index) noexcept {
  if (actions_[index].ticket.kind == CommandKind::kDeactivate) linger_activate_ = linger_home_ = false;
  std::copy(actions_.begin() + index + 1, actions_.begin() + count_, actions_.begin() + index);
  --count_;
}

void Actions::enter(Action& a, Phase phase, const View& view) noexcept {
  a.phase = phase;
  a.images = 0;
  a.settle = confirmed(a, view);
}

void Actions::start(Action& a, const View& view, bool unproved) noexcept {
  ledger_.report(a.ticket, ReceiptState::kSent);
  a.started = view.now;
  const bool ends_motion = a.ticket.kind == CommandKind::kClearMotion || a.ticket.kind == CommandKind::kDeactivate;
  a.pauses = ends_motion && unproved;
  a.rest.restart(view.now);
  enter(a, a.pauses ? Phase::kRest : Phase::kSent, view);
  switch (a.ticket.kind) {
    case CommandKind::kPauseMotion:
      if (!pause_) pause_by_stop_ = false;
      pause_ = true;
      break;
    case CommandKind::kResumeMotion:
      if (view.layout == Layout::kFirmware9) {
        if (pause_by_stop_ || !pause_) {
          pause_ = pause_ || unproved;
          enter(a, unproved ? Phase::kRest : Phase::kClearFirst, view);
        } else {
          let_go(a, view);
        }
      } else {
        enter(a, Phase::kLowerLevels, view);
        pause_ = false;
      }
      break;
    case CommandKind::kSimMode:
      sim_mode_ = a.wanted;
      break;
    case CommandKind::kRecoveryMode:
      recovery_mode_ = a.wanted;
      break;
    case CommandKind::kBrakes:
      brakes_gate_ = true;
      brakes_engaged_ = a.wanted;
      brakes_returning_ = false;
      break;
    case CommandKind::kDynamicData:
      a.previous_type = dynamic_data_[a.slot];
      dynamic_data_[a.slot] = a.type;
      break;
    case CommandKind::kSetHostTime:
      host_time_ = static_cast<std::uint32_t>(view.unix_ns / 1'000'000'000);
      break;
    case CommandKind::kActivate:
      brakes_gate_ = brakes_engaged_ = false;
      break;
    case CommandKind::kDeactivate:
    case CommandKind::kHome:
    case CommandKind::kResetError:
    case CommandKind::kClearMotion:
    case CommandKind::kTakeControl:
    case CommandKind::kReleaseControl:
    case CommandKind::kMotion:
      break;
  }
}

Actions::Verdict Actions::step(Action& a, const View& view) noexcept {
  if (!view.fresh) return Verdict::kGoOn;
  ++a.images;
  if (a.ticket.kind == CommandKind::kResumeMotion) return step_resume(a, view);
  if (a.phase == Phase::kRest) {
    if (a.rest.reached(view)) enter(a, Phase::kSent, view);
    return Verdict::kGoOn;
  }
  if (!confirmed(a, view) || (a.settle && a.images < kSettleImages)) return Verdict::kGoOn;
  return Verdict::kDone;
}

// Firmware 9: both levels low, and the P-Stop, where there is one, reset in the same image; inferred: with Pause still
// set the robot may not take the reset.
void Actions::let_go(Action& a, const View& view) noexcept {
  a.reset_p_stop = view.in.motion_status.p_stop2;
  enter(a, Phase::kRelease, view);
  pause_ = false;
}

// ResumeMotion is a rising edge and works only with Pause and Clear at 0 (spec 5.4): let both be seen low, then raise
// it. Firmware 9 has no such bit: motion resumes when Pause and Clear are low, so what a stop has left in the queue
// goes first.
Actions::Verdict Actions::step_resume(Action& a, const View& view) noexcept {
  const bool settled = a.images >= kSettleImages;
  switch (a.phase) {
    case Phase::kLowerLevels:
      if (settled) enter(a, Phase::kRaise, view);
      return Verdict::kGoOn;
    case Phase::kRaise:
      return confirmed(a, view) && (!a.settle || settled) ? Verdict::kDone : Verdict::kGoOn;
    case Phase::kClearFirst:
      if (settled && view.in.motion_status.cleared) let_go(a, view);
      return Verdict::kGoOn;
    case Phase::kRelease:
      return confirmed(a, view) && (!a.settle || settled) ? Verdict::kDone : Verdict::kGoOn;
    case Phase::kRest:
      if (a.rest.reached(view)) enter(a, Phase::kClearFirst, view);
      return Verdict::kGoOn;
    case Phase::kQueued:
    case Phase::kSent:
      return Verdict::kGoOn;
  }
  return Verdict::kGoOn;
}

void Actions::finish(const Action& a) noexcept {
  switch (a.ticket.kind) {
    case CommandKind::kResumeMotion:
      pause_by_stop_ = false;
      break;
    case CommandKind::kBrakes:
      if (a.wanted) brakes_gate_ = brakes_engaged_ = false;
      break;
    case CommandKind::kSetHostTime:
      host_time_ = 0;
      break;
    case CommandKind::kActivate:
    case CommandKind::kDeactivate:
    case CommandKind::kHome:
    case CommandKind::kResetError:
    case CommandKind::kPauseMotion:
    case CommandKind::kClearMotion:
    case CommandKind::kSimMode:
    case CommandKind::kRecoveryMode:
    case CommandKind::kDynamicData:
    case CommandKind::kTakeControl:
    case CommandKind::kReleaseControl:
    case CommandKind::kMotion:
      break;
  }
}

// An action that did not come true leaves no level behind that asks for it.
void Actions::revert(const Action& a) noexcept {
  switch (a.ticket.kind) {
    case CommandKind::kResumeMotion:
      pause_ = true;
      break;  // still stopped, as far as we know
    case CommandKind::kSimMode:
      sim_mode_ = !a.wanted;
      break;
    case CommandKind::kRecoveryMode:
      recovery_mode_ = !a.wanted;
      break;
    case CommandKind::kBrakes:
      engage_brakes();
      break;
    case CommandKind::kDynamicData:
      dynamic_data_[a.slot] = a.previous_type;
      break;
    case CommandKind::kSetHostTime:
      host_time_ = 0;
      break;
    case CommandKind::kPauseMotion:  // stays: safe, and it may yet be heard
    case CommandKind::kActivate:
    case CommandKind::kDeactivate:
    case CommandKind::kHome:
    case CommandKind::kResetError:
    case CommandKind::kClearMotion:
    case CommandKind::kTakeControl:
    case CommandKind::kReleaseControl:
    case CommandKind::kMotion:
      break;
  }
}

Actions::Events Actions::advance(const View& view, bool hold, bool unproved) noexcept {
  Events events;
  if (view.fresh && brakes_returning_ && (view.in.robot_status.brakes_engaged || view.in.robot_status.activated)) {
    brakes_returning_ = brakes_gate_ = brakes_engaged_ = false;
  }
  for (std::size_t i = 0; i < count_;) {
    Action& a = actions_[i];
    const CommandKind kind = a.ticket.kind;
    if (hold && !urgent(kind)) {
      ++i;
      continue;
    }
    if (a.phase == Phase::kQueued) {
      const bool resting =
          kind == CommandKind::kActivate && deactivated_at_ && view.now - *deactivated_at_ < kReactivationRest;
      if (!may_start(a) || resting) {
        ++i;
        continue;
      }
      const auto refusal = check_start(a, view);
      const bool done = !refusal && !urgent(kind) && already_done(a, view, false);
      if (refusal || done) {
        ledger_.report(a.ticket, done ? ReceiptState::kCompleted : ReceiptState::kRejected,
                       done ? Reason::kNone : refusal->reason, done ? Detail{} : refusal->detail);
        remove(i);
        continue;
      }
      start(a, view, unproved);
      events.clear_started |= kind == CommandKind::kClearMotion;
      events.deactivate_started |= kind == CommandKind::kDeactivate;
      ++i;
      continue;
    }
    const bool was_clearing_first = a.phase == Phase::kClearFirst;
    if (step(a, view) == Verdict::kDone) {
      const Action done = a;
      remove(i);
      finish(done);
      events.clear_confirmed |= kind == CommandKind::kClearMotion;
      if (kind == CommandKind::kDeactivate) deactivated_at_ = view.now;
      ledger_.report(done.ticket, ReceiptState::kCompleted);
    } else if (const auto failure = failed(a, view)) {
      const Action lost = a;
      remove(i);
      revert(lost);
      ledger_.report(lost.ticket, ReceiptState::kAborted, failure->reason, failure->detail);
    } else {
      events.clear_confirmed |= was_clearing_first && a.phase != Phase::kClearFirst;
      ++i;
    }
  }
  return events;
}

void Actions::end_all(Reason reason) noexcept {
  end(reason, false);
  linger_activate_ = linger_home_ = false;
}

void Actions::end_all_but_deactivate(Reason reason) noexcept { end(reason, true); }

void Actions::end(Reason reason, bool keep_deactivate) noexcept {
  for (std::size_t i = count_; i-- > 0;) {
    const Action a = actions_[i];
    const bool sent = a.phase != Phase::kQueued;
    if (keep_deactivate && sent && a.ticket.kind == CommandKind::kDeactivate) continue;
    remove(i);
    if (sent) revert(a);
    ledger_.report(a.ticket, sent ? ReceiptState::kAborted : ReceiptState::kDiscarded, reason);
  }
  brakes_asked_.reset();
}

void Actions::discard_queued(Reason reason) noexcept {
  for (std::size_t i = count_; i-- > 0;) {
    if (actions_[i].phase != Phase::kQueued) continue;
    ledger_.report(actions_[i].ticket, ReceiptState::kDiscarded, reason);
    remove(i);
  }
}

void Actions::hold_pause(Reason reason) noexcept {
  overtake(false, reason);
  pause_ = pause_by_stop_ = true;
}

void Actions::engage_brakes() noexcept {
  if (!brakes_gate_) return;
  brakes_engaged_ = brakes_returning_ = true;
}

bool Actions::pausing() const noexcept {
  return pause_ || std::any_of(actions_.begin(), actions_.begin() + count_,
                               [](const Action& a) { return a.pauses && a.phase != Phase::kQueued; });
}

bool Actions::sent(CommandKind kind) const noexcept {
  const Action* action = running(kind);
  return action && action->phase != Phase::kRest;
}

bool Actions::clearing() const noexcept {
  const Action* resume = running(CommandKind::kResumeMotion);
  return running(CommandKind::kClearMotion) ||
         (resume && (resume->phase == Phase::kRest || resume->phase == Phase::kClearFirst));
}

void Actions::write(image::Outputs& out) const noexcept {
  out.robot_control.deactivate = sent(CommandKind::kDeactivate);
  out.robot_control.activate = linger_activate_ || running(CommandKind::kActivate);
  out.robot_control.home = linger_home_ || running(CommandKind::kHome);
  out.robot_control.reset_error = running(CommandKind::kResetError) != nullptr;
  out.robot_control.sim_mode = sim_mode_;
  out.robot_control.recovery_mode = recovery_mode_;
  const Action* resume = running(CommandKind::kResumeMotion);
  out.motion_control.pause_motion = pausing();
  out.motion_control.clear_motion = sent(CommandKind::kClearMotion) || (resume && resume->phase == Phase::kClearFirst);
  // On firmware 9 this bit is "Reset PStop2" (spec 1.3); raised only while there is one to reset, or when the robot
  // does not go on for a reason that this firmware does not show.
  const bool releases = resume && resume->phase == Phase::kRelease;
  const bool reset_p_stop = releases && (resume->reset_p_stop || resume->images > kRestImages);
  out.motion_control.resume_motion = (resume && resume->phase == Phase::kRaise) || reset_p_stop;
  out.brakes_control.brakes_control_allowed = brakes_gate_;
  out.brakes_control.brakes_engaged = brakes_engaged_;
  out.host_time.seconds = host_time_;
}

}  // namespace meca::control
