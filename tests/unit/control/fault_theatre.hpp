// Thousands of faults, and what comes after them: until a client asks anew, nothing in the images lets the robot take a
// command, resume, reset an error, or move. The referee believes no receipt but that a request was accepted.
//
// Over a fieldbus (Bench::wire) it judges what the robot's end takes, and a cut is a fault once the link is seen to be
// down: a shorter one is a loss of frames, over which work goes on.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

#include "bridge/control/view.hpp"
#include "sim/robot.hpp"
#include "tests/unit/control/bench.hpp"
#include "tests/unit/control/referee.hpp"

namespace meca::test {

enum class Fault : std::uint8_t {
  kShortCut,
  kLongCut,
  kFlapping,
  kNoImages,
  kError,
  kPStop2,
  kEStop,
  kConnectionDropped,
  kLeaseLost,
  kReleased,
  kMonitoring,
  kBridgeKilled,
  kBridgeStopped,
  kRobotReplaced,
};
constexpr std::array kFaultNames{"short cut",       "long cut",      "flapping link",   "no images",     "robot error",
                                 "P-Stop 2",        "E-Stop",        "connection lost", "lease lost",    "released",
                                 "monitoring mode", "bridge killed", "bridge stopped",  "robot rebooted"};
constexpr std::size_t kFaults = kFaultNames.size();

// MECA_FAULT_SEQUENCES=10000 is ./meca prove faults.
inline int fault_sequences(int usual) {
  const char* wanted = std::getenv("MECA_FAULT_SEQUENCES");
  return wanted ? static_cast<int>(std::strtol(wanted, nullptr, 10)) : usual;
}

class Theatre : public Bench {
  using enum ReceiptState;
  using enum CommandKind;

 public:
  Theatre(Layout layout, int echo_cycles, unsigned seed, const CycleSettings& settings = {})
      : Bench(settings, layout), echo_cycles_(echo_cycles), random_(seed), referee_(layout) {
    model_ = std::make_unique<sim::Robot>(options());
    sim = model_.get();
    on_heard = [this](std::span<const std::byte> out) { out.empty() ? referee_.disconnect() : judge(out); };
  }

  void play(int sequences) {
    link_up = true;
    recover();
    for (int i = 0; i < sequences && !testing::Test::HasFailure(); ++i) {
      SCOPED_TRACE("sequence " + std::to_string(i));
      work();
      strike();
      if (chance(30)) {
        ticks(pick(200));
        if (chance(50)) begin_recovery();
        strike();
      }
      quiet(pick(300));
      recovered_ += recover();
      ++sequences_;
    }
    print();
    EXPECT_EQ(recovered_, sequences_) << "the arm was not got moving again after some faults";
    for (std::size_t f = 0; f < kFaults; ++f) {
      const bool shown = (f != static_cast<std::size_t>(Fault::kMonitoring) || layout == Layout::kFirmware11) &&
                         (f != static_cast<std::size_t>(Fault::kConnectionDropped) || layout != Layout::kFirmware9);
      if (shown && sequences >= 500) {
        EXPECT_GT(struck_[f], sequences / 80) << kFaultNames[f];
      }
    }
  }

 private:
  sim::RobotOptions options() const {
    sim::RobotOptions o;
    o.layout = layout;
    o.echo_cycles = echo_cycles_;
    o.activation_time = o.homing_time = o.deactivation_time = 5ms;
    o.noise = false;
    o.journal_capacity = 16;
    o.boot_time = 30ms;
    return o;
  }
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  bool chance(int percent) { return pick(100) < percent; }

  // ---------------------------------------------------------------- one cycle, judged

  void tick() {
    lose_output = chance(1);
    lose_input = chance(1);
    renew();
    step_bridge();
    for (const Receipt& r : receipts) entitle(r);
    receipts.clear();
    if (!wire) exchange.output_valid ? judge(exchange.output) : referee_.silence();
    ++since_;
    const bool blind = no_images_ > 0;
    exchange_frames();
    if (blind) {
      --no_images_;
      exchange.fresh = false;
    }
    if (!revoke_on_sight_ || !fault_is_seen()) return;
    revoke_on_sight_ = false;
    referee_.revoke();
    asked_.clear();
  }
  void judge(std::span<const std::byte> out) {
    const image::MotionStatus& m = model_->inputs().motion_status;
    for (const std::string& fault : referee_.judge(out, m.move_id, m.fifo_space < 13000 || !m.eob)) {
      ADD_FAILURE() << fault << " that nobody asked for after: " << kFaultNames[static_cast<std::size_t>(last_)] << ", "
                    << since_ << " cycles ago";
    }
  }
  // The bridge can know of it: the link is seen to be down, or an image came that the robot made after it.
  bool fault_is_seen() const {
    if (exchange.link == LinkState::kDown) return true;
    return !seen_by_link_ && exchange.fresh && robot_time(image::decode_inputs(exchange.input, {layout})) > struck_at_;
  }
  static std::chrono::microseconds robot_time(const image::Inputs& in) {
    return std::chrono::seconds(in.robot_timestamp.seconds) +
           std::chrono::microseconds(in.robot_timestamp.microseconds);
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  void renew() {
    if (keep_renewing_) pending.push_back(LeaseRenewal{client, participant(1), ++renewals});
    keep_alive = false;
    if (streaming_) pending.push_back(velocity(3));
  }

  void ask(CommandKind kind, std::optional<Right> right = {}) {
    const CommandRequest r = request(kind);
    if (right) asked_[r.command_id] = *right;
    last_asked_ = r.command_id;
    ended_ = false;
    pending.push_back(r);
  }
  void ask_move() {
    CommandRequest r = motion(image::kMoveJoints, {pick(100) / 100.0, 0, 0, 0, 5, 0}, true);
    asked_[r.command_id] = Right::kCommand;
    last_asked_ = r.command_id;
    ended_ = false;
    pending.push_back(r);
  }
  void entitle(const Receipt& r) {
    const auto asked = asked_.find(r.command_id);
    if (asked != asked_.end() && r.state != kRejected) referee_.grant(asked->second);
    if (r.command_id == last_asked_ && is_terminal(r.state)) {
      ended_ = true;
      outcome_ = r.state;
      words_ = describe(r);
    }
  }
  bool ended(int most) {
    for (int i = 0; i < most && !ended_; ++i) tick();
    return ended_;
  }

  // ---------------------------------------------------------------- work, then a fault

  void work() {
    switch (pick(6)) {
      case 0:
        for (int i = pick(6); i >= 0; --i) ask_move();
        break;
      case 1:
        streaming_ = true;
        referee_.grant(Right::kVelocity);
        break;
      case 2: {
        static constexpr std::pair<CommandKind, std::optional<Right>> kActions[] = {
            {kPauseMotion, {}},   {kResumeMotion, Right::kResume},   {kClearMotion, {}},
            {kDeactivate, {}},    {kResetError, Right::kResetError}, {kActivate, Right::kActivate},
            {kHome, Right::kHome}};
        if (chance(50)) ask_move();
        const auto& [kind, right] = kActions[pick(7)];
        ask(kind, right);
        if (chance(40)) ask(kResumeMotion, Right::kResume);
        break;
      }
      case 3:
        ask_move();
        ask(kPauseMotion);
        ask_move();
        if (chance(50)) ask(kResumeMotion, Right::kResume);
        break;
      default:
        ask_move();
        break;
    }
    policy = chance(50) ? LossPolicy::kStopMotion : LossPolicy::kFinishMotion;
    ticks(pick(40));
  }

  // `on_sight`: the bridge learns of it by an image or by the link. Otherwise the fault happens at the bridge itself.
  void note(Fault fault, bool on_sight) {
    last_ = fault;
    since_ = 0;
    ++struck_[static_cast<std::size_t>(fault)];
    streaming_ = false;
    revoke_on_sight_ = on_sight;
    seen_by_link_ = fault <= Fault::kFlapping || fault == Fault::kRobotReplaced;
    struck_at_ = robot_time(model_->inputs());
    if (!on_sight) {
      referee_.revoke();
      asked_.clear();
    }
    erase_requests();
  }
  // A request still on its way would be one after the fault.
  void erase_requests() { pending.clear(); }

  // What is pressed already cannot be pressed: nothing changes that could be seen.
  bool present(Fault fault) const {
    return (fault == Fault::kPStop2 && p_stop_) || (fault == Fault::kEStop && e_stop_) ||
           (fault == Fault::kConnectionDropped && dropped_);
  }
  void strike() {
    const auto fault = static_cast<Fault>(pick(kFaults));
    if (present(fault)) return strike();
    switch (fault) {
      case Fault::kShortCut:
      case Fault::kLongCut:
        cut(fault, fault == Fault::kShortCut ? 1 + pick(5) : 50 + pick(400));
        break;
      case Fault::kFlapping:
        for (int i = 3 + pick(5); i > 0; --i) {
          cut(fault, 1 + pick(30));
          ticks(1 + pick(30));
          struck_[static_cast<std::size_t>(fault)] -= i > 1;
        }
        break;
      case Fault::kNoImages:  // so long that it counts as a loss
        note(fault, true);
        revoke_on_sight_ = false;
        no_images_ = 200 + pick(200);
        ticks(no_images_ - 1);
        referee_.revoke();
        asked_.clear();
        ticks(1);
        break;
      case Fault::kError:
        note(fault, true);
        model_->raise_error(chance(50) ? 3005 : 1016);
        break;
      case Fault::kPStop2:
        note(fault, true);
        model_->press_p_stop2();
        p_stop_ = true;
        break;
      case Fault::kEStop:
        note(fault, true);
        model_->press_e_stop();
        e_stop_ = true;
        break;
      case Fault::kConnectionDropped:
        if (layout == Layout::kFirmware9) return strike();  // it does not show this stop
        note(fault, true);
        model_->drop_connection();
        dropped_ = true;
        break;
      case Fault::kLeaseLost:
        keep_renewing_ = false;
        streaming_ = false;
        erase_requests();
        ticks(101);  // to the end of the lease: what was accepted may still be sent
        note(fault, false);
        break;
      case Fault::kReleased:
        ask(kReleaseControl);
        streaming_ = false;
        ended(10);
        note(fault, false);
        break;
      case Fault::kMonitoring:
        if (layout != Layout::kFirmware11) return strike();  // older firmware does not say so (spec 1.3)
        note(fault, true);
        model_->set_monitoring(true);
        ticks(2 + pick(50));
        model_->set_monitoring(false);
        break;
      case Fault::kBridgeStopped:
        erase_requests();
        pending.push_back(ShutdownRequest{});
        for (int i = 0; i < 1500 && !(pending.empty() && cycle->finished()); ++i) tick();
        [[fallthrough]];
      case Fault::kBridgeKilled:
        note(fault, false);
        restart_bridge();
        break;
      case Fault::kRobotReplaced:
        note(fault, true);
        replace_robot();
        break;
    }
  }
  void cut(Fault fault, int cycles) {
    note(fault, true);
    link_up = false;
    ticks(cycles);
    link_up = true;
  }
  // On a bus its end of the connection has to notice: it is the same robot, switched off and on.
  void replace_robot() {
    if (wire) {
      model_->power_cycle();
      referee_.power_cycle();
      return ticks(1 + pick(50));
    }
    link_up = false;
    ticks(1 + pick(50));
    *model_ = sim::Robot(options());
    sim = model_.get();
    p_stop_ = e_stop_ = dropped_ = false;
    referee_.power_cycle();
    link_up = true;
  }
  void restart_bridge() {
    exchange = {};
    if (!wire) referee_.silence();
    cycle = std::make_unique<bridge::Cycle>(settings);
    link_up = false;
    for (int i = 5 + pick(100); i > 0; --i) tick();
    link_up = true;
  }

  // Nobody asks for anything; the causes go away by themselves.
  void quiet(int cycles) {
    ticks(2 + cycles / 2);  // longer than a press that a Resume on its way undoes before anybody can see it
    if (p_stop_) model_->release_p_stop2();
    if (e_stop_) {
      model_->release_e_stop();
      ticks(2);
      model_->press_reset_button();
    }
    if (dropped_) model_->restore_connection();
    p_stop_ = e_stop_ = dropped_ = false;
    ticks(cycles / 2);
  }

  // ---------------------------------------------------------------- a client gets it going again

  void help() {
    const image::Inputs& in = result->record.inputs;
    const ControlState& c = result->record.control;
    if (!c.owned) return ask(kTakeControl);
    if (in.robot_status.error_code != 0) return ask(kResetError, Right::kResetError);
    if (!in.robot_status.activated) return ask(kActivate, Right::kActivate);
    if (control::safety_stop(in)) return ask(kResumeMotion, Right::kResume);
    if (!in.robot_status.homed) return ask(kHome, Right::kHome);
    if (in.motion_status.paused || out.motion_control.pause_motion) return ask(kResumeMotion, Right::kResume);
    ask_move();
  }
  void begin_recovery() {
    keep_renewing_ = true;
    for (int i = 0; i < pick(4); ++i) {
      help();
      ended(50);
    }
  }
  static constexpr int kMostToConnect = 30000;  // cycles: a bus has its back-offs
  bool recover() {
    quiet(4);
    keep_renewing_ = true;
    std::string tried;
    for (int attempt = 0; attempt < 60; ++attempt) {
      for (int i = 0; i < kMostToConnect && exchange.link != LinkState::kUp; ++i) tick();
      help();
      const bool move = asked_.contains(last_asked_) && asked_[last_asked_] == Right::kCommand;
      if (ended(3000) && move && outcome_ == kCompleted) return true;
      if (attempt < 12) tried += "\n  " + words_;
      ticks(20);
    }
    ADD_FAILURE() << "60 requests did not get the arm moving after: " << kFaultNames[static_cast<std::size_t>(last_)]
                  << tried;
    return false;
  }

  void print() const {
    std::printf("%d sequences, arm moving again after %d;", sequences_, recovered_);
    for (std::size_t f = 0; f < kFaults; ++f)
      std::printf(" %s %d%s", kFaultNames[f], struck_[f], f + 1 < kFaults ? "," : "\n");
  }

  int echo_cycles_;
  std::mt19937 random_;
  Referee referee_;
  std::unique_ptr<sim::Robot> model_;
  std::map<std::uint64_t, Right> asked_;  // after the last fault
  std::array<int, kFaults> struck_{};
  Fault last_ = Fault::kShortCut;
  std::uint64_t last_asked_ = 0;
  ReceiptState outcome_ = kAccepted;
  std::string words_;
  int since_ = 0, sequences_ = 0, recovered_ = 0, no_images_ = 0;
  bool ended_ = false, keep_renewing_ = true, streaming_ = false, revoke_on_sight_ = false;
  bool p_stop_ = false, e_stop_ = false, dropped_ = false;
  bool seen_by_link_ = false;              // the last fault shows in no image
  std::chrono::microseconds struck_at_{};  // by the robot's clock
};

}  // namespace meca::test
