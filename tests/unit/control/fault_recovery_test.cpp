// Thousands of faults, and what comes after them: until a client asks anew, nothing in the images lets the robot take a
// command, resume, reset an error, or move. The referee reads the 60 bytes by the places of the manual's table, without
// the bridge's codec, and believes no receipt but that a request was accepted.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <span>

#include "bridge/control/view.hpp"
#include "sim/robot.hpp"
#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

enum class Right : std::uint8_t { kCommand, kVelocity, kResume, kResetError, kActivate, kHome };
constexpr std::size_t kRights = 6;

// What one image lets the robot do that the image before it did not.
class Referee {
 public:
  explicit Referee(Layout layout) : layout_(layout) {}

  // `echo`, `busy`: what the robot has before it reads this image. Returns what is done without the right to it.
  std::vector<std::string> judge(std::span<const std::byte> out, std::uint16_t echo, bool busy) {
    const auto bit = [&out](std::size_t at, int n) { return ((std::to_integer<unsigned>(out[at]) >> n) & 1u) != 0; };
    std::vector<std::string> faults;
    const auto need = [&](Right right, const char* what) {
      if (!rights_[static_cast<std::size_t>(right)]) faults.emplace_back(what);
    };
    // Table 1.1: MoveID 4..5, SetPoint 6:0, Pause 6:1, Clear 6:2, Resume 6:3, command 8..11, arguments 12..35.
    const bool set_point = bit(6, 0), pause = bit(6, 1), clear = bit(6, 2), resume = bit(6, 3);
    const std::uint16_t id = little(out, 4);
    if (set_point && id != 0 && id != echo && id != last_id_) need(Right::kCommand, "a command (MoveID edge)");
    if (set_point && id != 0) last_id_ = id;
    if (set_point && id == 0 && little(out, 8) >= 21 && little(out, 8) <= 23) {
      bool moves = false;
      for (std::size_t i = 12; i < 36; ++i) moves |= std::to_integer<unsigned>(out[i]) != 0;
      if (moves) need(Right::kVelocity, "a velocity");
    }
    if (resume && !resume_) need(Right::kResume, "a ResumeMotion edge");
    // Firmware 9 resumes when both levels are low (spec 1.3): letting go of a robot that has something to do.
    if (layout_ == Layout::kFirmware9 && busy && !pause && !clear && (pause_ || clear_)) {
      need(Right::kResume, "Pause let go with motion queued");
    }
    if (bit(0, 3) && !reset_) need(Right::kResetError, "ResetError");
    if (bit(0, 1) && !activate_) need(Right::kActivate, "Activate");
    if (bit(0, 2) && !home_) need(Right::kHome, "Home");
    pause_ = pause;
    clear_ = clear;
    resume_ = resume;
    reset_ = bit(0, 3);
    activate_ = bit(0, 1);
    home_ = bit(0, 2);
    return faults;
  }

  // The robot hears nobody: the next image is compared with nothing.
  void silence() { resume_ = reset_ = activate_ = home_ = pause_ = clear_ = false; }
  void revoke() { rights_.fill(false); }
  void grant(Right right) { rights_[static_cast<std::size_t>(right)] = true; }

 private:
  static std::uint16_t little(std::span<const std::byte> out, std::size_t at) {
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(out[at]) | std::to_integer<unsigned>(out[at + 1]) << 8);
  }

  Layout layout_;
  std::array<bool, kRights> rights_{};
  std::uint16_t last_id_ = 0;
  bool pause_ = false, clear_ = false, resume_ = false, reset_ = false, activate_ = false, home_ = false;
};

TEST(FaultAndRecoveryReferee, sees_every_way_to_set_a_robot_going) {
  const auto image = [](std::initializer_list<std::pair<std::size_t, unsigned>> bytes) {
    std::array<std::byte, 60> out{};
    for (const auto& [at, value] : bytes) out[at] = static_cast<std::byte>(value);
    return out;
  };
  const auto faults = [&](auto first, auto second, bool busy = false, Layout layout = Layout::kFirmware11) {
    Referee referee(layout);
    referee.judge(first, 0, busy);
    return referee.judge(second, 0, busy).size();
  };
  const auto still = image({});
  EXPECT_EQ(faults(still, still), 0u);
  EXPECT_EQ(faults(still, image({{4, 7}, {6, 1}, {8, 1}})), 1u);            // MoveID 7, SetPoint
  EXPECT_EQ(faults(still, image({{4, 7}, {8, 1}})), 0u);                    // without SetPoint nothing is taken
  EXPECT_EQ(faults(image({{4, 7}, {6, 1}}), image({{4, 7}, {6, 1}})), 0u);  // the same MoveID again
  EXPECT_EQ(faults(still, image({{6, 1}, {8, 21}, {15, 0x41}})), 1u);       // MoveJointsVel, 8 deg/s
  EXPECT_EQ(faults(still, image({{6, 1}, {8, 21}})), 0u);                   // zero velocity
  EXPECT_EQ(faults(still, image({{6, 8}})), 1u);                            // ResumeMotion
  EXPECT_EQ(faults(image({{6, 8}}), image({{6, 8}})), 0u);                  // no edge
  EXPECT_EQ(faults(still, image({{0, 2}})) + faults(still, image({{0, 4}})) + faults(still, image({{0, 8}})), 3u);
  EXPECT_EQ(faults(image({{6, 2}}), still, true, Layout::kFirmware9), 1u);  // Pause falls, something is queued
  EXPECT_EQ(faults(image({{6, 2}}), still, false, Layout::kFirmware9), 0u);
  EXPECT_EQ(faults(image({{6, 2}}), still, true, Layout::kFirmware11), 0u);
  Referee referee(Layout::kFirmware11);
  referee.grant(Right::kCommand);
  EXPECT_EQ(referee.judge(image({{4, 7}, {6, 1}, {8, 1}}), 0, false).size(), 0u);
  referee.revoke();
  EXPECT_EQ(referee.judge(image({{4, 8}, {6, 1}, {8, 1}}), 7, false).size(), 1u);
}

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

class Theatre : public Bench {
 public:
  Theatre(Layout layout, int echo_cycles, unsigned seed)
      : Bench({}, layout), echo_cycles_(echo_cycles), random_(seed), referee_(layout) {
    model_ = std::make_unique<sim::Robot>(options());
    sim = model_.get();
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
    return o;
  }
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  bool chance(int percent) { return pick(100) < percent; }

  // ---------------------------------------------------------------- one cycle, judged

  void tick() {
    const image::Inputs& in = model_->inputs();
    const std::uint16_t echo = in.motion_status.move_id;
    const bool busy = in.motion_status.fifo_space < 13000 || !in.motion_status.eob;
    lose_output = chance(1);
    lose_input = chance(1);
    renew();
    step_bridge();
    for (const Receipt& r : receipts) entitle(r);
    receipts.clear();
    if (exchange.output_valid) {
      for (const std::string& fault : referee_.judge(exchange.output, echo, busy)) {
        ADD_FAILURE() << fault << " that nobody asked for after: " << kFaultNames[static_cast<std::size_t>(last_)]
                      << ", " << since_ << " cycles ago";
      }
    } else {
      referee_.silence();
    }
    ++since_;
    const bool blind = no_images_ > 0;
    exchange_frames();
    if (blind) {
      --no_images_;
      exchange.fresh = false;
    }
    // The bridge can know of the fault from the next image on, or from a link that is seen to be down.
    if (revoke_on_sight_ && (exchange.fresh || exchange.link == LinkState::kDown)) {
      revoke_on_sight_ = false;
      referee_.revoke();
      asked_.clear();
    }
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
        link_up = false;
        ticks(1 + pick(50));
        *model_ = sim::Robot(options());
        sim = model_.get();
        p_stop_ = e_stop_ = dropped_ = false;
        link_up = true;
        break;
    }
  }
  void cut(Fault fault, int cycles) {
    note(fault, true);
    link_up = false;
    ticks(cycles);
    link_up = true;
  }
  void restart_bridge() {
    exchange = {};
    referee_.silence();
    cycle = std::make_unique<bridge::Cycle>(settings);
    link_up = false;
    for (int i = 5 + pick(100); i > 0; --i) tick();
    link_up = true;
  }

  // Nobody asks for anything; the causes go away by themselves.
  void quiet(int cycles) {
    ticks(cycles / 2);
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
  bool recover() {
    quiet(4);
    keep_renewing_ = true;
    std::string tried;
    for (int attempt = 0; attempt < 60; ++attempt) {
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
};

// MECA_FAULT_SEQUENCES=10000 is ./meca prove faults.
int sequences() {
  const char* wanted = std::getenv("MECA_FAULT_SEQUENCES");
  return wanted ? static_cast<int>(std::strtol(wanted, nullptr, 10)) : 1000;
}

class FaultAndRecovery : public testing::TestWithParam<std::tuple<Layout, int>> {};

TEST_P(FaultAndRecovery, set_nothing_going_that_nobody_asked_for_after_the_fault) {
  const auto [layout, echo_cycles] = GetParam();
  Theatre(layout, echo_cycles, 7).play(sequences());
}

INSTANTIATE_TEST_SUITE_P(Firmware, FaultAndRecovery,
                         testing::Combine(testing::Values(Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11),
                                          testing::Values(0, 2)),
                         [](const auto& info) {
                           return "firmware_" + std::to_string(9 + static_cast<int>(std::get<0>(info.param))) +
                                  "_echo_after_" + std::to_string(std::get<1>(info.param)) + "_cycles";
                         });

}  // namespace
}  // namespace meca::test
