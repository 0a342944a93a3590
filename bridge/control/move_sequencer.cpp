#include "bridge/control/move_sequencer.hpp"

#include <algorithm>
#include <utility>

namespace meca::control {
namespace {

constexpr std::uint16_t kWholeQueue = 13000;  // FIFOSpace of an empty queue (spec 1.2)

// A client's checkpoint reached in the same robot cycle as ours hides ours: the image shows the last one only. An empty
// queue and a standing arm for this many images prove the same. inferred: EOB may come early, but not for this long.
constexpr int kIdleProof = 200;

constexpr bool own_checkpoint(std::uint32_t n) noexcept { return n >= kFirstOwnCheckpoint && n <= kLastOwnCheckpoint; }

constexpr bool needs_motors(image::CommandClass c) noexcept {
  return c == image::CommandClass::kMotion || c == image::CommandClass::kQueued;
}

}  // namespace

MoveSequencer::MoveSequencer(Ledger& ledger, Time acknowledge_timeout) noexcept
    : ledger_(ledger), acknowledge_timeout_(acknowledge_timeout) {}

void MoveSequencer::seed(const View& view) noexcept {
  const std::uint16_t echo = view.in.motion_status.move_id;
  // The first images may be older than what was sent last: whether the robot got it shows a little later.
  if (flight_) withdraw(*flight_);
  withdrawn_images_ = 0;
  proofs_wait_ = true;
  if (seeded_) {
    reached(view);
  } else {
    // Half the range further: whatever an earlier life of this bridge left in the robot's queue is passed before ours.
    const std::uint32_t last = view.in.motion_status.checkpoint_reached;
    if (own_checkpoint(last)) {
      last_checkpoint_ =
          kFirstOwnCheckpoint + (last - kFirstOwnCheckpoint + 500) % (kLastOwnCheckpoint - kFirstOwnCheckpoint + 1);
    }
  }
  if (!withdrawing_) last_id_ = echo;  // else on from our own: what may still be on its way must not meet a namesake
  seeded_ = true;
  move_id_ = echo;
  command_ = 0;
  arguments_ = {};
  use_variables_ = armed_ = false;
  idle_images_ = rest_images_ = 0;
}

std::uint16_t MoveSequencer::next_id(std::uint16_t echo) const noexcept {
  std::uint16_t id = last_id_;
  do {
    id = id == 65535 ? 1 : static_cast<std::uint16_t>(id + 1);
  } while (id == echo);
  return id;
}

void MoveSequencer::observe(const View& view) noexcept {
  if (view.fresh) {
    const std::uint16_t echo = view.in.motion_status.move_id;
    if (fresh_since_echo_ < kSettleImages) ++fresh_since_echo_;
    // inferred: an arm that still slows down from what an error cleared may drop what it is sent, without an error.
    slowing_down_ = view.in.robot_status.error_code != 0 || (slowing_down_ && !view.in.motion_status.eom);
    const bool resting = view.in.motion_status.paused && view.in.motion_status.eom;
    rest_images_ = resting ? std::min(rest_images_ + 1, kRestImages + 1) : 0;
    if (flight_ && echo == move_id_) acknowledged(*std::exchange(flight_, std::nullopt));
    if (withdrawing_ && (echo == withdrawn_id_ || ++withdrawn_images_ > kSettleImages)) {
      withdrawing_ = false;
      if (withdrawn_) resolve_withdrawn(echo == withdrawn_id_);
      move_id_ = echo;  // with SetPoint 0 the robot does not look at it
    }
    reached(view);
  }
  if (flight_ && view.now - flight_->sent_at > acknowledge_timeout_) {
    // What follows was meant to come after it: a path with a hole in it is not the client's path.
    end_all(ReceiptState::kAborted, Reason::kTimeOut);
  }
}

void MoveSequencer::acknowledged(const Flight& flight) noexcept {
  fresh_since_echo_ = 0;
  idle_images_ = 0;
  const Ticket& ticket = flight.motion.ticket;
  if (flight.is_checkpoint) {
    awaiting_.push({ticket, flight.checkpoint});
    return;
  }
  ledger_.report(ticket, ReceiptState::kAcknowledged);
  if (dropping_ || (flight.motion.report_completion && needs_motors(flight.motion.command_class))) {
    checkpoint_due_ = ticket;
  } else {
    ledger_.report(ticket, ReceiptState::kCompleted);
  }
}

void MoveSequencer::complete_through(std::size_t count) noexcept {
  for (; count > 0; --count) {
    ledger_.report(awaiting_.front().ticket, ReceiptState::kCompleted);
    awaiting_.pop();
  }
}

// The robot dropped them by itself. `first_open`: the first of them is the one that the robot was at. It may have been
// executed, or half of it, before its checkpoint was dropped; those behind it were not begun.
void MoveSequencer::discard_through(std::size_t count, const View& view, bool first_open) noexcept {
  const std::uint16_t code = view.in.robot_status.error_code;
  const Reason reason = code != 0                         ? Reason::kRobotError
                        : safety_stop(view.in)            ? Reason::kSafetyStop
                        : !view.in.robot_status.activated ? Reason::kNotActivated
                                                          : Reason::kCleared;
  for (; count > 0; --count) {
    const bool begun = code != 0 || std::exchange(first_open, false);
    ledger_.report(awaiting_.front().ticket, begun ? ReceiptState::kAborted : ReceiptState::kDiscarded, reason,
                   {.robot_error = code});
    awaiting_.pop();
  }
}

// How many of the awaited ones this checkpoint says something about: up to itself. What an image shows is taken as it
// stands, not as an edge: a robot may show a checkpoint before it echoes the MoveID that brought it.
std::size_t MoveSequencer::awaited_through(std::uint32_t checkpoint) const noexcept {
  for (std::size_t i = 0; i < awaiting_.size(); ++i) {
    if (awaiting_.at(i).checkpoint == checkpoint) return i + 1;
  }
  return 0;
}

// One that the robot does not show already, as reached or as discarded.
std::uint32_t MoveSequencer::next_checkpoint(const image::MotionStatus& shown) noexcept {
  do {
    last_checkpoint_ = last_checkpoint_ == kLastOwnCheckpoint ? kFirstOwnCheckpoint : last_checkpoint_ + 1;
  } while (last_checkpoint_ == shown.checkpoint_reached || last_checkpoint_ == shown.checkpoint_discarded);
  return last_checkpoint_;
}

void MoveSequencer::reached(const View& view) noexcept {
  const image::MotionStatus& m = view.in.motion_status;
  if (const std::size_t count = awaited_through(m.checkpoint_reached); count > 0) {
    complete_through(count);  // several may be reached between two images; the queue keeps their order
  }
  // While the queue is being cleared on purpose, end_all() tells the reason.
  if (const std::size_t count = dropping_ ? 0 : awaited_through(m.checkpoint_discarded); count > 0) {
    discard_through(count, view, true);
    // A command behind it whose own checkpoint was not sent yet is gone too, and its checkpoint would prove nothing.
    if (checkpoint_due_ && awaiting_.empty()) {
      awaiting_.push({*checkpoint_due_, 0});
      checkpoint_due_.reset();
      discard_through(1, view, false);
    }
  }
  // The robot cleared its queue by itself, as a P-Stop can make it. Cleared falls when a command is queued (spec 5.4).
  if (m.cleared && !dropping_ && fresh_since_echo_ >= kSettleImages) discard_through(awaiting_.size(), view, true);
  prove_by_rest(m);
}

// At rest, nothing queued, nothing begun: everything echoed was executed. With one of our checkpoints outstanding that
// holds only where a client's checkpoint may hide it.
void MoveSequencer::prove_by_rest(const image::MotionStatus& m) noexcept {
  const bool empty = m.eob && m.eom && m.fifo_space >= kWholeQueue && !m.cleared;
  const bool open = checkpoint_due_ || !awaiting_.empty();
  const bool believable = awaiting_.empty() || !own_checkpoint(m.checkpoint_reached);
  const bool quiet = !flight_ && !withdrawing_ && fresh_since_echo_ >= kSettleImages;
  idle_images_ = empty && open && believable && quiet ? idle_images_ + 1 : 0;
  if (idle_images_ <= (m.paused ? kRestImages / 2 : kIdleProof)) return;
  complete_through(awaiting_.size());
  if (checkpoint_due_) ledger_.report(*checkpoint_due_, ReceiptState::kCompleted);
  checkpoint_due_.reset();
}

void MoveSequencer::resolve_withdrawn(bool taken) noexcept {
  const Flight flight = *std::exchange(withdrawn_, std::nullopt);
  if (taken) {
    acknowledged(flight);
  } else if (flight.is_checkpoint) {
    checkpoint_due_ = flight.motion.ticket;
  } else {
    ledger_.report(flight.motion.ticket, ReceiptState::kAborted, Reason::kLinkLost);  // the robot never got it
  }
}

void MoveSequencer::pause_rises() noexcept {
  if (flight_ && flight_->is_checkpoint) withdraw(*flight_);
}

void MoveSequencer::put(const View& view, std::uint32_t command, const Motion& motion, bool is_checkpoint) noexcept {
  move_id_ = last_id_ = next_id(view.in.motion_status.move_id);
  command_ = command;
  arguments_ = motion.arguments;
  use_variables_ = motion.use_variables;
  armed_ = true;
  flight_ = Flight{motion, is_checkpoint, 0, view.now};
}

void MoveSequencer::advance(const View& view, bool hold, bool pausing) noexcept {
  if (flight_ || withdrawing_ || hold || !view.fresh || view.in.motion_status.fifo_space == 0) return;
  const bool reboot = !queue_.empty() && queue_.front().ticket.motion_command_id == image::kRebootRobot;
  if (slowing_down_ && !reboot) return;
  const bool paused = view.in.motion_status.paused || (pausing && view.in.robot_status.activated);
  if (paused && rest_images_ <= kRestImages) return;
  if (checkpoint_due_) {
    if (awaiting_.full() || proofs_wait_) return;
    const std::uint32_t number = next_checkpoint(view.in.motion_status);
    Motion checkpoint;
    checkpoint.ticket = *checkpoint_due_;
    checkpoint.arguments[0] = static_cast<float>(number);
    put(view, image::kSetCheckpoint, checkpoint, true);
    flight_->checkpoint = number;
    checkpoint_due_.reset();
    return;
  }
  if (queue_.empty()) return;
  const Motion next = queue_.front();
  queue_.pop();
  put(view, next.ticket.motion_command_id, next, false);
  ledger_.report(next.ticket, ReceiptState::kSent);
}

void MoveSequencer::discard_unsent(Reason reason) noexcept {
  for (; !queue_.empty(); queue_.pop()) ledger_.report(queue_.front().ticket, ReceiptState::kDiscarded, reason);
}

void MoveSequencer::withdraw(const std::optional<Flight>& open) noexcept {
  withdrawn_ = open;
  withdrawn_id_ = move_id_;
  withdrawn_images_ = 0;
  withdrawing_ = true;
  flight_.reset();
  armed_ = false;
}

void MoveSequencer::end_all(ReceiptState sent, Reason reason, std::uint16_t robot_error) noexcept {
  const Detail detail{.robot_error = robot_error};
  // Where the robot stopped by itself, the first of them may have been executed before it did; those behind it were not
  // begun.
  bool open = sent == ReceiptState::kDiscarded && (reason == Reason::kLinkLost || reason == Reason::kSafetyStop);
  const auto end = [&](const Ticket& ticket) {
    ledger_.report(ticket, std::exchange(open, false) ? ReceiptState::kAborted : sent, reason, detail);
  };
  for (; !awaiting_.empty(); awaiting_.pop()) end(awaiting_.front().ticket);
  if (checkpoint_due_) end(*checkpoint_due_);
  checkpoint_due_.reset();
  if (withdrawn_) end(withdrawn_->motion.ticket);
  withdrawn_.reset();
  if (flight_) {
    end(flight_->motion.ticket);
    withdraw(std::nullopt);
  }
  for (; !queue_.empty(); queue_.pop()) {
    ledger_.report(queue_.front().ticket, ReceiptState::kDiscarded, reason, detail);
  }
  armed_ = false;
}

void MoveSequencer::end_motion(Reason reason) noexcept {
  for (; !awaiting_.empty(); awaiting_.pop()) {
    ledger_.report(awaiting_.front().ticket, ReceiptState::kAborted, reason);
  }
  if (checkpoint_due_) ledger_.report(*checkpoint_due_, ReceiptState::kAborted, reason);
  checkpoint_due_.reset();
  if (withdrawn_) ledger_.report(withdrawn_->motion.ticket, ReceiptState::kAborted, reason);
  withdrawn_.reset();
  if (flight_ && needs_motors(flight_->motion.command_class)) {
    ledger_.report(flight_->motion.ticket, ReceiptState::kAborted, reason);
    withdraw(std::nullopt);
  }
  for (std::size_t left = queue_.size(); left > 0; --left) {
    const Motion m = queue_.front();
    queue_.pop();
    if (needs_motors(m.command_class)) {
      ledger_.report(m.ticket, ReceiptState::kDiscarded, reason);
    } else {
      queue_.push(m);
    }
  }
}

void MoveSequencer::link_lost() noexcept {
  discard_unsent(Reason::kLinkLost);
  armed_ = false;
}

void MoveSequencer::write(image::Outputs& out) const noexcept {
  out.motion_control.move_id = move_id_;
  out.motion_control.set_point = armed_;
  out.motion_control.use_variables = use_variables_;
  out.motion_command.command_id = command_;
  out.motion_command.arguments = arguments_;
}

}  // namespace meca::control
