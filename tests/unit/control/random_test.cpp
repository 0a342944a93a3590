// Thousands of random commands, lost frames, cut links, errors and silent owners; rules that must hold whatever
// happens. Seeded: a failure names its seed and is repeated by it.
#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>
#include <set>

#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

class Player : public Bench {
 public:
  Player(unsigned seed, Layout layout) : Bench(settings_for_play(), layout), random_(seed) {}
  static CycleSettings settings_for_play() {
    CycleSettings s;
    s.action_timeout = 500ms;
    return s;
  }

  void play(int cycles) {
    link_up = true;
    for (int i = 0; i < cycles; ++i) {
      disturb();
      if (chance(30)) ask();
      if (chance(10)) help();
      watched_step();
    }
    settle();
    judge();
  }

 private:
  using Key = std::pair<std::string, std::uint64_t>;
  static Key key(const CommandRequest& r) { return {std::string(r.client.view()), r.command_id}; }

  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  bool chance(int percent) { return pick(100) < percent; }

  // A joint value that no other command of this life has.
  static float signature(std::uint64_t id) { return static_cast<float>(id) / 64.0f - 170.0f; }

  void disturb() {
    lose_output = chance(2);
    lose_input = chance(2);
    if (link_up ? pick(1000) == 0 : chance(2)) link_up = !link_up;
    if (pick(2000) == 0) robot.raise_error(3005);
    if (keep_alive ? pick(700) == 0 : chance(1)) keep_alive = !keep_alive;
    if (pick(3000) == 0) robot.in.safety_status.stop.p_stop2 = robot.in.motion_status.p_stop2 = true;
    if (pick(200) == 0) {
      robot.in.safety_status.resettable.p_stop2 = robot.in.safety_status.stop.p_stop2;
      robot.in.motion_status.p_stop2_resettable = layout == Layout::kFirmware9 && robot.in.motion_status.p_stop2;
    }
    robot.executes = !chance(40);
  }

  // Somebody at the panel who wants the robot to move: asks for what is missing. Without him a random life is mostly
  // refusals.
  void help() {
    const image::Inputs& in = robot.in;
    const ControlState& c = result->record.control;
    CommandKind kind = kTakeControl;
    if (!c.owned) {
      keep_alive = true;
    } else if (in.robot_status.error_code != 0) {
      kind = kResetError;
    } else if (!in.robot_status.activated) {
      kind = kActivate;
    } else if (!in.robot_status.homed) {
      kind = kHome;
    } else if (in.motion_status.paused || out.motion_control.pause_motion) {
      kind = kResumeMotion;
    } else {
      return;
    }
    note(request(kind));
  }

  void note(const CommandRequest& r) {
    asked_.insert(key(r));
    if (r.report_completion) reported_.insert(key(r));
    if (r.kind == kResumeMotion) ++resumes_;
    if (r.kind == kResetError) ++resets_;
    previous_.push_back(r);
    if (previous_.size() > 50) previous_.erase(previous_.begin());
    pending.push_back(r);
  }

  void ask() {
    static constexpr CommandKind kKinds[] = {kTakeControl,  kReleaseControl, kActivate,     kDeactivate,  kHome,
                                             kResetError,   kPauseMotion,    kResumeMotion, kClearMotion, kSimMode,
                                             kRecoveryMode, kBrakes,         kDynamicData,  kSetHostTime};
    policy = chance(50) ? LossPolicy::kStopMotion : LossPolicy::kFinishMotion;
    CommandRequest r;
    const int what = pick(100);
    if (what < 55) {
      r = motion(image::kMoveJoints, {signature(last_id + 1), 0, 0, 0, 0, 0}, chance(60));
    } else if (what < 65) {
      r = request(chance(50) ? kActivate : kHome);
    } else if (what < 75) {
      r = request(chance(50) ? kResumeMotion : kTakeControl);
    } else if (what < 80) {
      pending.push_back(velocity(5));
      return;
    } else if (what < 90 || previous_.empty()) {
      r = request(kKinds[pick(14)], {});
      if (r.kind == kSimMode || r.kind == kRecoveryMode || r.kind == kBrakes) r.argument_count = 1;
      if (r.kind == kDynamicData) r.arguments = {3, 40}, r.argument_count = 2;
      if (r.kind == kDeactivate && chance(80)) r.kind = kResetError;
    } else {
      r = previous_[static_cast<std::size_t>(pick(static_cast<int>(previous_.size())))];  // resent
      pending.push_back(r);
      return;
    }
    if (chance(5)) {  // somebody else
      r.participant = participant(2);
      r.client = ClientName("other");
    }
    note(r);
  }

  void watched_step() {
    const image::Outputs before = out;
    const std::uint16_t echo_before = exchange.fresh ? seen_echo() : last_echo_;
    last_echo_ = echo_before;
    step();
    if (!exchange.output_valid) return;
    const image::MotionControl &was = before.motion_control, &is = out.motion_control;
    if (was.set_point && is.set_point && was.move_id != is.move_id && was.move_id != 0) {
      EXPECT_EQ(echo_before, was.move_id) << "MoveID changed before its echo";
    }
    if (is.resume_motion && !was.resume_motion) ++resume_edges_;
    if (out.robot_control.reset_error && !before.robot_control.reset_error) ++reset_edges_;
    EXPECT_FALSE(is.resume_motion && (is.pause_motion || is.clear_motion));
    // The bridge's own checkpoint behind a command that may finish is bookkeeping, and the only exception.
    const bool own = out.motion_command.command_id == image::kSetCheckpoint && out.motion_command.arguments[0] > 7000;
    EXPECT_FALSE(is.set_point && is.pause_motion && was.pause_motion && was.move_id != is.move_id && !own &&
                 !result->record.control.owned)
        << "a command was sent to a stopped robot";
    // Reserved bits (spec 1.1): 0:6 is never used here, 0:7..3:7, 6:5..7:7, 40:2..43:7.
    EXPECT_EQ(std::to_integer<int>(exchange.output[0]) & 0xc0, 0);
    for (const int at : {1, 2, 3, 7, 41, 42, 43}) EXPECT_EQ(std::to_integer<int>(exchange.output[at]), 0) << at;
    EXPECT_EQ(std::to_integer<int>(exchange.output[6]) & 0xe0, 0);
    EXPECT_EQ(std::to_integer<int>(exchange.output[40]) & 0xfc, 0);
  }
  std::uint16_t seen_echo() const { return image::decode_inputs(exchange.input, {layout}).motion_status.move_id; }

  void settle() {
    link_up = true;
    keep_alive = false;
    lose_output = lose_input = false;
    robot.executes = true;
    for (int i = 0; i < 40000 && !(i % 500 == 0 && all_ended()); ++i) step();  // at most past every time-out
    if (all_ended()) return;
    // One excuse only: the owner paused, queued motion that may finish, and went. The robot still has it, so it has not
    // ended; it does when somebody clears the queue.
    EXPECT_TRUE(robot.in.motion_status.paused && robot.queued() > 0) << "a command hangs, and not in the robot's queue";
    client = ClientName("operator");
    keep_alive = true;
    note(request(kTakeControl));
    note(request(kClearMotion));
    for (int i = 0; i < 1000 && !all_ended(); ++i) step();
  }
  bool all_ended() const {
    std::set<Key> ended;
    for (const Receipt& r : receipts) {
      if (is_terminal(r.state)) ended.insert({std::string(r.client.view()), r.command_id});
    }
    return pending.empty() && std::ranges::includes(ended, asked_);
  }

  void judge() {
    std::map<Key, std::vector<Receipt>> by_command;
    for (const Receipt& r : receipts) by_command[{std::string(r.client.view()), r.command_id}].push_back(r);
    for (const Key& k : asked_) {
      const auto& list = by_command[k];
      ASSERT_FALSE(list.empty()) << k.first << " " << k.second << " got no receipt";
      std::set<int> terminal;
      ReceiptState highest = kAccepted;
      for (const Receipt& r : list) {
        if (r.reason == Reason::kDuplicate) continue;  // resent so late that it was forgotten
        if (is_terminal(r.state)) terminal.insert(static_cast<int>(r.state));
        EXPECT_TRUE(is_terminal(r.state) || !is_terminal(highest)) << "not terminal after terminal: " << k.second;
        EXPECT_GE(r.state, std::min(highest, r.state));
        highest = std::max(highest, r.state);
        EXPECT_FALSE(describe(r).empty());
        EXPECT_LT(describe(r).size(), 255u) << describe(r);
      }
      EXPECT_EQ(terminal.size(), 1u) << k.first << " " << k.second << " must end exactly once";
    }
    EXPECT_LE(resume_edges_, resumes_) << "ResumeMotion without a request";
    EXPECT_LE(reset_edges_, resets_) << "ResetError without a request";
    EXPECT_TRUE(robot.violations.empty()) << robot.violations.front();
    completed_were_executed(by_command);
  }

  // Nothing is executed twice; what was COMPLETED on request was executed; what was refused or never sent was not.
  void completed_were_executed(const std::map<Key, std::vector<Receipt>>& by_command) {
    std::map<float, int> executed;
    for (const Executed& e : robot.executed) {
      if (e.command == image::kMoveJoints) ++executed[e.arguments[0]];
    }
    for (const auto& [signature, times] : executed) EXPECT_EQ(times, 1) << "executed twice: " << signature;
    std::size_t completed = 0;
    for (const auto& [k, list] : by_command) {
      if (list.front().kind != kMotion) continue;
      bool sent = false;
      for (const Receipt& r : list) sent |= r.state == kSent;
      const bool ran = executed.contains(signature(k.second));
      EXPECT_TRUE(sent || !ran) << "never sent, yet executed: " << k.second;
      if (list.back().state == kCompleted && reported_.contains(k)) {
        EXPECT_TRUE(ran) << "COMPLETED, yet not executed: " << k.second;
        ++completed;
      }
    }
    EXPECT_GT(completed, 20u) << "this life has proved little";
  }

  std::mt19937 random_;
  std::set<Key> asked_, reported_;
  std::vector<CommandRequest> previous_;
  std::uint16_t last_echo_ = 0;
  int resumes_ = 0, resets_ = 0, resume_edges_ = 0, reset_edges_ = 0;
};

class RandomLife : public testing::TestWithParam<unsigned> {};

TEST_P(RandomLife, ends_every_command_exactly_once_and_breaks_no_rule) {
  Player player(GetParam(), static_cast<Layout>(GetParam() % 3));
  player.play(10000);
}

// MECA_RANDOM_LIVES=500 plays more of them than every build can wait for.
unsigned lives() {
  const char* wanted = std::getenv("MECA_RANDOM_LIVES");
  return wanted ? static_cast<unsigned>(std::strtoul(wanted, nullptr, 10)) : 12;
}

INSTANTIATE_TEST_SUITE_P(Seed, RandomLife, testing::Range(1u, 1u + lives()));

}  // namespace
}  // namespace meca::test
