// Queued motion through the MoveID handshake (spec 5.2): command, arguments and MoveID in one consistent image, held
// until the robot echoes the MoveID, then the next. Clients never see a MoveID; there is one numbering, and it is this
// one.
//
// Completion is proved by a checkpoint the sequencer places behind the command, with a number of its own (7001..8000,
// cycling); clients have 1..7000. Where none can be placed any more (the link was cut, the owner is gone, the queue is
// to be cleared) the robot's state proves it: an arm at rest with nothing queued and nothing begun has executed
// everything it echoed. So that no image can mean both, no checkpoint enters the queue while the arm comes to rest in a
// pause.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "bridge/control/ledger.hpp"
#include "bridge/control/ring.hpp"
#include "bridge/control/view.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::control {

inline constexpr std::uint32_t kFirstOwnCheckpoint = 7001, kLastOwnCheckpoint = 8000;

struct Motion {
  Ticket ticket;
  image::CommandClass command_class = image::CommandClass::kMotion;
  std::array<float, 6> arguments{};
  bool use_variables = false;
  bool report_completion = false;
};

class MoveSequencer {
 public:
  static constexpr std::size_t kQueue = 256;     // accepted, not yet sent
  static constexpr std::size_t kAwaiting = 256;  // queued in the robot, completion wanted

  MoveSequencer(Ledger& ledger, Time acknowledge_timeout) noexcept;

  // After start or reconnection: numbering goes on from the robot's echo, and a command that was under way when the
  // link went is resolved by it.
  void seed(const View& view) noexcept;

  // False when the queue is full.
  bool accept(const Motion& motion) noexcept {
    proofs_wait_ = false;
    return queue_.push(motion);
  }
  bool full() const noexcept { return queue_.full(); }

  // Reads echo and checkpoints of a fresh image, and ends what timed out.
  void observe(const View& view) noexcept;
  // Puts the next command into the image when the handshake is free. `hold`: the robot takes no commands just now.
  // `pausing`: PauseMotion is in the image, whether the robot shows it already or not.
  void advance(const View& view, bool hold, bool pausing) noexcept;

  // Commands that have not been sent end DISCARDED; what is under way goes on.
  void discard_unsent(Reason reason) noexcept;
  // Everything ends: not sent DISCARDED, under way or in the robot's queue as `sent` says.
  void end_all(ReceiptState sent, Reason reason, std::uint16_t robot_error = 0) noexcept;
  // The same for commands that need running motors only (motors went off).
  void end_motion(Reason reason) noexcept;
  // While the robot is told to clear its queue: what it echoes now it may have refused, so its end waits for end_all().
  void set_dropping(bool on) noexcept { dropping_ = on; }
  // Pause goes into this image: a checkpoint that the robot has not echoed yet is taken back, or it could reach a robot
  // whose pause hides whether the command before it was done.
  void pause_rises() noexcept;
  // Nothing is sent, not even our own checkpoints, until a client asks for motion again.
  void hold_proofs() noexcept { proofs_wait_ = true; }
  // SetPoint 0: the robot ignores MoveID and command until the next one is sent.
  void disarm() noexcept { armed_ = false; }
  // The velocity stream has the image: MoveID 0, and nothing of the last command left in it.
  void stand_aside() noexcept {
    armed_ = use_variables_ = false;
    move_id_ = 0;
    command_ = 0;
    arguments_ = {};
  }
  // The link is gone: what the robot may have is resolved when it is back, at the latest after `patience`.
  void link_lost() noexcept;
  void give_up_unresolved() noexcept { end_all(ReceiptState::kAborted, Reason::kLinkLost); }

  // Nothing waiting, under way, or unproved in the robot's queue.
  bool idle() const noexcept { return queue_.empty() && !unproved(); }
  // The robot may have something of which we do not know yet whether it executes it.
  bool unproved() const noexcept { return flight_ || checkpoint_due_ || withdrawn_ || !awaiting_.empty(); }
  // No handshake under way and none waiting: the image is free for a velocity stream.
  bool handshake_idle() const noexcept { return queue_.empty() && !flight_ && !checkpoint_due_ && !withdrawing_; }
  // Something was given to the robot that may still be executing.
  bool robot_may_be_busy() const noexcept { return unproved() || fresh_since_echo_ < kSettleImages; }

  void write(image::Outputs& out) const noexcept;

 private:
  struct Flight {
    Motion motion;
    bool is_checkpoint = false;  // our own, behind `motion`
    std::uint32_t checkpoint = 0;
    Time sent_at{};
  };
  struct Awaited {
    Ticket ticket;
    std::uint32_t checkpoint = 0;
  };

  std::uint16_t next_id(std::uint16_t echo) const noexcept;
  void put(const View& view, std::uint32_t command, const Motion& motion, bool is_checkpoint) noexcept;
  void acknowledged(const Flight& flight) noexcept;
  std::size_t awaited_through(std::uint32_t checkpoint) const noexcept;
  std::uint32_t next_checkpoint(const image::MotionStatus& shown) noexcept;
  void reached(const View& view) noexcept;
  void prove_by_rest(const image::MotionStatus& m) noexcept;
  void resolve_withdrawn(bool taken) noexcept;
  void complete_through(std::size_t count) noexcept;
  void discard_through(std::size_t count, const View& view, bool first_open) noexcept;
  // SetPoint falls before the echo; the next images tell whether the robot took it. `open`: its end is still to be
  // told.
  void withdraw(const std::optional<Flight>& open) noexcept;

  Ledger& ledger_;
  Time acknowledge_timeout_;
  Ring<Motion, kQueue> queue_;
  Ring<Awaited, kAwaiting> awaiting_;  // in the order of the robot's queue
  std::optional<Flight> flight_;
  std::optional<Ticket> checkpoint_due_;  // echoed, its checkpoint not yet sent (or its fate not yet known)

  // What stands in the image.
  std::uint16_t move_id_ = 0;
  std::uint32_t command_ = 0;
  std::array<float, 6> arguments_{};
  bool use_variables_ = false;
  bool armed_ = false;

  std::uint16_t last_id_ = 0;  // last MoveID used, echoed or not
  std::uint32_t last_checkpoint_ = kLastOwnCheckpoint;
  bool dropping_ = false;
  bool withdrawing_ = false;  // a MoveID stands unechoed with SetPoint 0: learn whether it was taken
  std::uint16_t withdrawn_id_ = 0;
  int withdrawn_images_ = 0;
  std::optional<Flight> withdrawn_;  // what becomes of it is still to be told
  bool proofs_wait_ = false;
  int fresh_since_echo_ = kSettleImages;
  int idle_images_ = 0;
  int rest_images_ = 0;        // paused and at rest
  bool slowing_down_ = false;  // after an error, until the arm is seen at rest
  bool seeded_ = false;
};

}  // namespace meca::control
