// The actions: set a bit, wait for the status bit that confirms it, clear the bit, report (spec 5.1). Also keeper of
// the levels that outlive an action: Pause, SimMode, RecoveryMode, brakes, dynamic data types.
//
// Actions run one at a time in the order they came, and do not wait for queued motion. Pause, Clear and Deactivate run
// at once beside them, and end what they contradict (Resume; with Deactivate also Activate and Home). A time-out is an
// answer.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "bridge/control/ledger.hpp"
#include "bridge/control/stop_sequence.hpp"
#include "bridge/control/validation.hpp"
#include "bridge/control/view.hpp"

namespace meca::control {

class Actions {
 public:
  static constexpr std::size_t kMaxActions = 16;
  static constexpr std::size_t kUrgentPlaces = 4;  // of them kept for Pause, Clear and Deactivate

  struct Settings {
    Time timeout{};
    bool allow_brakes = false;
    std::array<std::uint32_t, image::kDynamicSlots> dynamic_data{};
  };
  // What other machines must know: the queue is being cleared, or has been.
  struct Events {
    bool clear_started = false, clear_confirmed = false, deactivate_started = false;
  };

  Actions(Ledger& ledger, const Settings& settings) noexcept;

  // After start or reconnection: levels are what the robot shows, so that connecting changes nothing.
  void seed(const View& view) noexcept;

  // Arguments, and the robot's state where the action would start at once. Asking for brake release the first time is
  // refused here: it must come twice within 5 s.
  std::optional<Refusal> check(const CommandRequest& request, const Ticket& ticket, const View& view) noexcept;
  // After check(). `nothing_queued`: the sequencer is idle, so a cleared queue needs no clearing.
  void accept(const CommandRequest& request, const Ticket& ticket, const View& view, bool nothing_queued) noexcept;

  // `hold`: a stop sequence is under way; only Pause, Clear and Deactivate go on.
  // `unproved`: of what the robot has, something's end is not known; Clear and Deactivate pause the arm first and wait
  // until it is at rest, because they wipe out what could tell.
  Events advance(const View& view, bool hold, bool unproved) noexcept;

  // All actions end: running ones ABORTED, queued ones DISCARDED.
  void end_all(Reason reason) noexcept;
  // The same before an orderly end: motors going off are left to it.
  void end_all_but_deactivate(Reason reason) noexcept;
  // Running ones go on to their confirmation: a bit is not dropped halfway.
  void discard_queued(Reason reason) noexcept;
  // But a Resume does not: whoever wanted the robot to go on is gone.
  void end_resume(Reason reason) noexcept { overtake(false, reason); }

  // The stop image's Pause: held until somebody resumes. On firmware 9 letting go of it clears the queue first.
  // Ends a Resume that is under way or waiting.
  void hold_pause(Reason reason) noexcept;
  bool pause_held_by_stop() const noexcept { return pause_ && pause_by_stop_; }
  // An owner that released the brakes is gone: engage them again.
  void engage_brakes() noexcept;

  bool clearing() const noexcept;  // ClearMotion is in the image, or about to be: the robot is to take no commands
  bool pausing() const noexcept;   // PauseMotion is in the image
  bool deactivating() const noexcept { return running(CommandKind::kDeactivate) != nullptr; }
  void write(image::Outputs& out) const noexcept;
  const std::array<std::uint32_t, image::kDynamicSlots>& dynamic_data() const noexcept { return dynamic_data_; }

 private:
  // Resume walks through the later ones; Clear and Deactivate may rest first; the other actions know kSent only.
  enum class Phase : std::uint8_t { kQueued, kRest, kSent, kLowerLevels, kClearFirst, kRaise, kRelease };
  struct Action {
    Ticket ticket;
    Phase phase = Phase::kQueued;
    bool wanted = false;    // sim mode, recovery mode, brakes
    std::uint8_t slot = 0;  // dynamic data
    std::uint32_t type = 0, previous_type = 0;
    Time started{};
    Rest rest;
    bool pauses = false;        // until it is done: it rested
    int images = 0;             // fresh images since the phase began
    bool reset_p_stop = false;  // firmware 9
    bool settle = false;        // the confirming bit stood already: believe it only after some images
  };
  enum class Verdict : std::uint8_t { kGoOn, kDone };

  static bool urgent(CommandKind kind) noexcept;
  bool may_start(const Action& action) const noexcept;
  static Action make(const CommandRequest& request, const Ticket& ticket) noexcept;
  std::optional<Refusal> check_start(const Action& action, const View& view) const noexcept;
  bool already_done(const Action& action, const View& view, bool nothing_queued) const noexcept;
  bool confirmed(const Action& action, const View& view) const noexcept;
  std::optional<Refusal> failed(const Action& action, const View& view) const noexcept;
  void start(Action& action, const View& view, bool unproved) noexcept;
  void enter(Action& action, Phase phase, const View& view) noexcept;
  Verdict step(Action& action, const View& view) noexcept;
  void let_go(Action& action, const View& view) noexcept;
  Verdict step_resume(Action& action, const View& view) noexcept;
  void finish(const Action& action) noexcept;
  void revert(const Action& action) noexcept;
  void overtake(bool deactivate, Reason reason) noexcept;
  void remove(std::size_t index) noexcept;
  void end(Reason reason, bool keep_deactivate) noexcept;
  const Action* running(CommandKind kind) const noexcept;
  bool sent(CommandKind kind) const noexcept;  // its bit is in the image

  Ledger& ledger_;
  Settings settings_;
  std::array<Action, kMaxActions> actions_{};  // in the order they came
  std::size_t count_ = 0;

  bool pause_ = false, pause_by_stop_ = false;
  bool sim_mode_ = false, recovery_mode_ = false;
  // Overtaken by Deactivate, which wins while both are set: they fall together with it, never before the robot heard
  // it.
  bool linger_activate_ = false, linger_home_ = false;
  bool brakes_gate_ = false, brakes_engaged_ = false, brakes_returning_ = false;
  std::array<std::uint32_t, image::kDynamicSlots> dynamic_data_{};
  std::uint32_t host_time_ = 0;

  std::optional<Time> brakes_asked_;
  std::uint8_t brakes_client_ = 0;
  std::optional<Time> deactivated_at_;
};

}  // namespace meca::control
