// One robot's control: ties arbiter, actions, sequencer, velocity stream and stop sequence together. Decoded images and
// requests come in, the output image and receipts go out. No threads, no clock, no allocation after construction.
#pragma once

#include <array>
#include <span>

#include "bridge/control/actions.hpp"
#include "bridge/control/arbiter.hpp"
#include "bridge/control/ledger.hpp"
#include "bridge/control/messages.hpp"
#include "bridge/control/move_sequencer.hpp"
#include "bridge/control/stop_sequence.hpp"
#include "bridge/control/validation.hpp"
#include "bridge/control/velocity_stream.hpp"

namespace meca::control {

struct ControllerSettings {
  Time lease{}, velocity_lease{}, action_timeout{}, acknowledge_timeout{};
  bool monitoring_only = false;
  bool allow_brakes = false;
  std::array<std::uint32_t, image::kDynamicSlots> dynamic_data{};
  ClientRules clients{};
};

// What the cycle knows about the connection in this step.
struct LinkFacts {
  bool up = false;                 // as the transport says
  bool usable = false;             // and images arriving
  bool firmware_known = false;     // and it is one that is expected
  std::uint32_t product_type = 0;  // dynamic data type 2, 0 = not known
};

class Controller {
 public:
  explicit Controller(const ControllerSettings& settings) noexcept;

  // One cycle, in this order: what the robot says, what clients ask, what has lapsed, what to do about it.
  void step(std::span<const Request> requests, const View& view, LinkFacts link) noexcept;

  // False: this robot is not to be commanded, send nothing. Blind (the link stands, images fail to come) we still send:
  // the robot may hear that it is to stop.
  bool may_command() const noexcept { return (seeded_ || blind_) && !monitoring_only_; }
  // The image to send; the dynamic data types are what clients want, without those the firmware probe borrows.
  image::Outputs outputs() noexcept;
  const std::array<std::uint32_t, image::kDynamicSlots>& dynamic_data() const noexcept {
    return actions_.dynamic_data();
  }

  // After a ShutdownRequest: stopped, and every command has its end.
  bool finished() const noexcept {
    return shut_down_ && !stop_.active() && !actions_.deactivating() && sequencer_.idle() && ledger_.drained();
  }

  const ControlState& state() const noexcept { return arbiter_.state(); }
  Ledger& ledger() noexcept { return ledger_; }

 private:
  void follow_link(const View& view, LinkFacts link) noexcept;
  void follow_robot(const View& view) noexcept;
  void follow_monitoring_mode(const View& view) noexcept;
  void handle(const CommandRequest& request, const View& view, LinkFacts link) noexcept;
  void handle(const VelocityRequest& request, const View& view) noexcept;
  void execute(const CommandRequest& request, const Ticket& ticket, const View& view) noexcept;
  void contend(const CommandRequest& request, const Ticket& ticket, const View& view) noexcept;
  void follow_contender(const View& view) noexcept;
  void end_contest(Reason reason) noexcept;
  std::optional<Refusal> refusal_of_control(const CommandRequest& request, LinkFacts link) const noexcept;
  std::optional<Refusal> refusal_of_command(const CommandRequest& request, const Ticket& ticket, const View& view,
                                            LinkFacts link) noexcept;
  void reject(const CommandRequest& request, const Ticket& ticket, const Refusal& refusal) noexcept;
  void release(const View& view) noexcept;
  void lose_owner(ControlState::Loss why, const View& view) noexcept;
  void stop(Reason reason, Time now) noexcept;
  void shut_down(const View& view) noexcept;
  void advance(const View& view) noexcept;
  bool robot_may_move(const View& view) const noexcept;
  bool held_by_stop(const View& view) const noexcept;
  bool loss_stops(const View& view) const noexcept;
  bool velocity_allowed(const View& view) const noexcept;

  ControllerSettings settings_;
  Ledger ledger_;
  Arbiter arbiter_;
  Actions actions_;
  MoveSequencer sequencer_;
  VelocityStream velocity_;
  StopSequence stop_;
  JointLimits limits_;
  bool monitoring_only_ = false;
  bool seeded_ = false;  // the image starts from what the robot shows
  bool had_link_ = false;
  bool blind_ = false;
  bool stop_on_return_ = false;  // the link went while the owner's motion was under way: stop it when the link is back
  bool finishing_ = false;       // nobody has control, but queued motion is left to finish
  bool in_safety_stop_ = false, stop_present_ = false, in_error_ = false;
  bool shut_down_ = false;
  bool was_pausing_ = false;
  Time link_lost_at_{};
};

}  // namespace meca::control
