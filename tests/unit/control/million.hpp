// A million commands of three clients over a link that loses, repeats and is cut: what the robot executed and what the
// receipts say must be the same, command by command. The robot's own list is the referee.
//
// Every command asks for completion, but for the episodes that fill the robot's queue: there COMPLETED means "queued",
// and everything queued is let run. Resent ids stay within one life of the bridge: a bridge that was restarted has
// forgotten them (idl/control.idl says so).
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <unordered_map>

#include "sim/robot.hpp"
#include "tests/unit/control/bench.hpp"

namespace meca::test {

struct Key {
  std::uint32_t id = 0;
  std::array<float, 6> arguments{};
  friend bool operator==(const Key&, const Key&) = default;
};
struct KeyHash {
  std::size_t operator()(const Key& k) const {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(&k), sizeof k});
  }
};

struct Figures {
  std::uint64_t commands = 0, executed = 0, completed = 0, discarded = 0, rejected = 0, aborted = 0, resent = 0;
  std::uint64_t cuts = 0, restarts = 0, full_queues = 0, lost_out = 0, lost_in = 0, repeated = 0, cycles = 0;
  std::uint64_t owners_changed = 0, clears = 0, errors = 0, deactivations = 0;
  std::uint64_t unknown = 0;  // executed, and told ABORTED: how far it got was not known
};

// Who wants what: one of three has control at a time, or tries to.
class Million : public Bench {
  using enum ReceiptState;
  using enum CommandKind;

 public:
  static CycleSettings settings_for_play() {
    CycleSettings s;
    s.action_timeout = 5s;
    return s;
  }
  Million(Layout layout, std::uint64_t commands, unsigned seed, std::uint32_t trouble = 1,
          const CycleSettings& play = settings_for_play())
      : Bench(play, layout), goal_(commands), trouble_(trouble), random_(seed), model_(options(layout, seed)) {
    sim = &model_;
    keep_alive = false;
    for (int i = 0; i < kClients; ++i) {
      clients_[i].name = ClientName("client-" + std::to_string(i));
      clients_[i].participant = participant(10 + i);
    }
  }

  // On a bus whose loss makes the robot stop and clear its queue by itself, nobody can know what became of the command
  // that it was at: ABORTED says so, and at most `most` such commands may have been executed.
  void allow_unknown(std::uint64_t most) { most_unknown_ = most; }

  const Figures& figures() const { return figures_; }

  void play() {
    link_up = true;
    const std::uint64_t between_cuts = goal_ / (kCuts + 1), between_episodes = goal_ / (kEpisodes + 1);
    while (figures_.commands < goal_ && !HasFatalFailure()) {
      if (figures_.cuts < kCuts && figures_.commands > (figures_.cuts + 1) * between_cuts) cut();
      if (figures_.restarts == 0 && figures_.commands > goal_ / 2) restart();
      if (figures_.full_queues < kEpisodes && figures_.commands > figures_.full_queues * between_episodes + 500) {
        fill_the_queue();
      }
      act();
      cycle();
    }
    finish();
    judge();
  }

 private:
  static constexpr int kClients = 3;
  static constexpr std::uint64_t kCuts = 20, kEpisodes = 3;
  static constexpr std::size_t kWindow = 60;

  struct Asked {
    Key key;
    bool motion = false, may_fail = false;
  };
  struct Client {
    ClientName name;
    ParticipantId participant{};
    std::uint64_t last_id = 0, renewals = 0;
    std::unordered_map<std::uint64_t, Asked> open;
    std::vector<std::uint8_t> ended{0};  // by command id: 0 not yet, else its terminal state + 1
    std::vector<CommandRequest> recent;  // what it may send again
    LossPolicy policy = LossPolicy::kStopMotion;
    bool action_open = false;
  };

  static bool HasFatalFailure() { return testing::Test::HasFailure(); }
  static sim::RobotOptions options(Layout layout, unsigned seed) {
    sim::RobotOptions o;
    o.echo_cycles = static_cast<int>(seed + 2) % 3;  // with each seed another one of 0, 1, 2
    o.layout = layout;
    o.activation_time = o.homing_time = o.deactivation_time = 5ms;
    o.noise = false;
    return o;
  }

  std::uint32_t pick(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  bool one_in(std::uint32_t n) { return pick(n) == 0; }
  Client& active() { return clients_[active_]; }
  bool owns(const Client& c) const {
    const ControlState& s = result->record.control;
    return s.owned && s.owner == c.name;
  }

  // ---------------------------------------------------------------- asking

  CommandRequest make(Client& c, CommandKind kind) {
    CommandRequest r;
    r.client = c.name;
    r.participant = c.participant;
    r.command_id = ++c.last_id;
    r.kind = kind;
    r.on_loss = c.policy;
    return r;
  }
  void ask(Client& c, const CommandRequest& r, bool may_fail = false) {
    ++figures_.commands;
    Asked asked;
    asked.motion = r.kind == kMotion;
    asked.may_fail = may_fail;
    asked.key.id = r.motion_command_id;
    for (std::size_t i = 0; i < r.argument_count; ++i) asked.key.arguments[i] = static_cast<float>(r.arguments[i]);
    c.open.emplace(r.command_id, asked);
    c.ended.resize(r.command_id + 1, 0);
    if (!asked.motion) c.action_open = true;
    if (c.recent.size() < 30) {
      c.recent.push_back(r);
    } else {
      c.recent[pick(30)] = r;
    }
    pending.push_back(r);
  }
  void ask(Client& c, CommandKind kind) { ask(c, make(c, kind)); }

  // Arguments that tell commands apart, small enough that the arm needs only milliseconds.
  CommandRequest random_motion(Client& c) {
    CommandRequest r = make(c, kMotion);
    const std::uint32_t s = signature_++ % (1u << 20);
    const double low = s % 1024, high = s / 1024;
    const auto set = [&r](std::uint32_t id, std::initializer_list<double> a) {
      r.motion_command_id = id;
      std::copy(a.begin(), a.end(), r.arguments.begin());
      r.argument_count = static_cast<std::uint8_t>(a.size());
    };
    switch (pick(14)) {
      case 0:
      case 1:
      case 2:
        set(image::kMoveJoints, {0, 0, 0, low / 65536, 10 + high / 65536, 0});
        break;
      case 3:
        set(image::kMoveJointsRel, {0, 0, 0, (low - 512) / (1 << 20), 0, (high - 512) / (1 << 20)});
        break;
      case 4:
        set(image::kDelay, {s / 536870912.0});
        break;
      case 5:
        set(image::kSetBlending, {s / 16384.0});
        break;
      case 6:
        set(image::kSetJointVel, {64 + s / 65536.0});
        break;
      case 7:
        set(image::kSetJointAcc, {100 + s / 32768.0});
        break;
      case 8:
        set(image::kSetCartLinVel, {1000 + s / 1024.0});
        break;
      case 9:
        set(image::kSetTrf, {low / 64, high / 64, 0, 0, 0, 0});
        break;
      case 10:
        set(image::kSetCheckpoint, {1.0 + s % 7000});
        break;
      case 11:
        set(image::kMoveLinRelTrf, {low / 65536, 0, 0, 0, 0, 0});
        break;
      case 12:
        set(image::kSetCartAcc, {300 + s / 16384.0});
        break;
      default:
        set(image::kSetVelTimeout, {0.25 + s / 4194304.0});
        break;
    }
    r.report_completion = true;
    return r;
  }

  // Good for the bridge, not for the robot: refused on reception, or failing when its turn comes.
  void ask_for_trouble(Client& c) {
    CommandRequest r = make(c, kMotion);
    r.report_completion = true;
    r.motion_command_id = one_in(2) ? image::kMovePose : image::kSetGripperForce;
    r.arguments = {500.0 + signature_++ % 65536, 0, 0, 0, 0, 0};
    r.argument_count = 6;
    if (r.motion_command_id == image::kSetGripperForce) {
      r.argument_count = 1;
      r.arguments[0] = 50;
    }
    ask(c, r, true);
  }

  // Somebody who wants the robot to move asks for what is missing.
  bool help() {
    Client& c = active();
    const image::Inputs& in = result->record.inputs;
    if (c.action_open) return true;
    if (!owns(c)) return ask(c, kTakeControl), true;
    if (in.robot_status.error_code != 0) return ++figures_.errors, ask(c, kResetError), true;
    if (!in.robot_status.activated) return ask(c, kActivate), true;
    if (!in.robot_status.homed) return ask(c, kHome), true;
    if (in.motion_status.paused || out.motion_control.pause_motion) return ask(c, kResumeMotion), true;
    return false;
  }

  void act() {
    Client& c = active();
    if (silent_ > 0) {
      if (--silent_ == 0) change_client();
    } else if (figures_.cycles % 20 == 0) {
      pending.push_back(LeaseRenewal{c.name, c.participant, ++c.renewals});
    }
    if (result->record.quality != Quality::kGood || silent_ > 0) return;
    if (one_in(50)) {  // somebody else tries
      Client& other = clients_[pick(kClients)];
      if (&other != &c && !owns(other) && result->record.control.owned) ask(other, random_motion(other));
    }
    if (one_in(200) && !c.recent.empty()) {
      pending.push_back(c.recent[pick(static_cast<std::uint32_t>(c.recent.size()))]);
      ++figures_.resent;
    }
    if (one_in(4)) help();
    if (!owns(c)) return;
    if (one_in(20000 / trouble_)) {
      silent_ = 400;  // its lease runs out
    } else if (one_in(20000 / trouble_)) {
      ask(c, kReleaseControl);
      change_client();
    } else if (one_in(6000 / trouble_)) {
      ask(c, kPauseMotion);
    } else if (one_in(6000 / trouble_)) {
      ++figures_.clears;
      ask(c, kClearMotion);
    } else if (one_in(40000 / trouble_)) {
      ++figures_.deactivations;
      ask(c, kDeactivate);
    } else if (one_in(6000 / trouble_)) {
      ask_for_trouble(c);
    } else if (c.open.size() < kWindow) {
      ask(c, random_motion(c));
    }
  }

  void change_client() {
    active_ = (active_ + 1) % kClients;
    active().policy = one_in(2) ? LossPolicy::kStopMotion : LossPolicy::kFinishMotion;
    ++figures_.owners_changed;
  }

  // ---------------------------------------------------------------- the wire, and what is seen

  void cycle() {
    ++figures_.cycles;
    lose_output = one_in(100);
    lose_input = one_in(100);
    repeat_output = one_in(100);
    repeat_input = one_in(100);
    figures_.lost_out += lose_output;
    figures_.lost_in += lose_input;
    figures_.repeated += repeat_output + repeat_input;
    step();
    for (const Receipt& r : receipts) take(r);
    receipts.clear();
    const sim::Journal& journal = model_.journal();
    ASSERT_GE(read_, journal.first()) << "the journal has forgotten what was not read yet";
    for (; read_ < journal.size(); ++read_) {
      const sim::JournalEntry& e = journal[read_];
      const bool own = e.command.id == image::kSetCheckpoint && e.command.arguments[0] > 7000;
      if (e.outcome != sim::Outcome::kExecuted || own) continue;
      ++figures_.executed;
      count({e.command.id, e.command.arguments}, +1);
    }
  }

  // Executed less COMPLETED, by command.
  void count(const Key& key, int by) {
    const auto [at, added] = balance_.try_emplace(key, 0);
    at->second += by;
    if (at->second == 0) balance_.erase(at);
  }

  void take(const Receipt& r) {
    for (Client& c : clients_) {
      if (!(c.name == r.client)) continue;
      ASSERT_LT(r.command_id, c.ended.size());
      std::uint8_t& ended = c.ended[r.command_id];
      if (!is_terminal(r.state)) {
        // A resent command is answered with what became of it so far.
        ASSERT_EQ(ended, 0) << "a receipt after the end of " << r.command_id << ": " << describe(r);
        return;
      }
      const auto state = static_cast<std::uint8_t>(static_cast<int>(r.state) + 1);
      if (r.reason == Reason::kDuplicate && ended != 0) return;  // resent so late that it is forgotten
      if (ended != 0) {
        ASSERT_EQ(ended, state) << "a second, different end of " << r.command_id << ": " << describe(r);
        return;
      }
      ended = state;
      const auto open = c.open.find(r.command_id);
      ASSERT_NE(open, c.open.end()) << r.command_id;
      if (!open->second.motion) c.action_open = false;
      if (open->second.motion && r.state == kCompleted) count(open->second.key, -1);
      if (open->second.motion && r.state == kAborted) ++aborted_[open->second.key];
      figures_.completed += open->second.motion && r.state == kCompleted;
      figures_.discarded += r.state == kDiscarded;
      figures_.rejected += r.state == kRejected;
      figures_.aborted += r.state == kAborted;
      c.open.erase(open);
    }
  }

  // ---------------------------------------------------------------- what happens to it

  void cut() {
    ++figures_.cuts;
    link_up = false;
    const std::uint32_t length = one_in(2) ? 1 + pick(20) : 1 + pick(3000);
    for (std::uint32_t i = 0; i < length; ++i) cycle();
    link_up = true;
    if (one_in(2)) change_client();
  }

  bool all_ended() const {
    for (const Client& c : clients_) {
      if (!c.open.empty()) return false;
    }
    return pending.empty();
  }

  void restart() {
    ++figures_.restarts;
    pending.push_back(ShutdownRequest{});
    for (int i = 0; i < 1500 && !cycle_is_finished(); ++i) cycle();
    ASSERT_TRUE(cycle_is_finished()) << "the bridge has not come to its end within 1.5 s";
    ASSERT_TRUE(all_ended()) << "a bridge that stops leaves a command without an end";
    bridge_life_ = std::make_unique<bridge::Cycle>(settings);
    Bench::cycle.swap(bridge_life_);
    link_up = false;
    for (int i = 0; i < 50; ++i) cycle();
    link_up = true;
    for (Client& c : clients_) c.recent.clear();
  }
  bool cycle_is_finished() const { return Bench::cycle->finished() && pending.empty(); }

  // Pauses the robot and goes on queueing until nothing fits, then lets it run.
  void fill_the_queue() {
    const auto wait = [this](const std::function<bool()>& done, int most) {
      for (int i = 0; i < most && !done() && !HasFatalFailure(); ++i) {
        if (figures_.cycles % 20 == 0) {
          pending.push_back(LeaseRenewal{active().name, active().participant, ++active().renewals});
        }
        cycle();
      }
      return done();
    };
    silent_ = 0;
    const auto calm = [this] { return !help() && all_ended(); };
    ASSERT_TRUE(wait(calm, 100000)) << "the robot was not got ready for a full queue";
    ask(active(), kPauseMotion);
    ASSERT_TRUE(wait([this] { return all_ended(); }, 10000));
    const auto full = [this] {
      Client& c = active();
      if (c.open.size() < kWindow) {
        CommandRequest r = random_motion(c);
        r.report_completion = false;
        ask(c, r);
      }
      return result->record.inputs.motion_status.fifo_space == 0 && c.open.size() >= kWindow;
    };
    ASSERT_TRUE(wait(full, 200000)) << "FIFOSpace " << result->record.inputs.motion_status.fifo_space;
    ++figures_.full_queues;
    ASSERT_TRUE(wait([] { return false; }, 500) || !all_ended()) << "nothing fits, so nothing may end";
    ask(active(), kResumeMotion);
    const auto empty = [this] {
      const image::MotionStatus& m = result->record.inputs.motion_status;
      return all_ended() && m.fifo_space == 13000 && m.eob;
    };
    ASSERT_TRUE(wait(empty, 4000000));
  }

  void finish() {
    silent_ = 0;
    for (int i = 0; i < 200000 && !all_ended() && !HasFatalFailure(); ++i) {
      if (figures_.cycles % 20 == 0) {
        pending.push_back(LeaseRenewal{active().name, active().participant, ++active().renewals});
      }
      help();
      cycle();
    }
    for (int i = 0; i < 3000; ++i) cycle();
  }

  void judge() {
    std::erase_if(balance_, [this](auto& entry) {
      const auto aborted = aborted_.find(entry.first);
      const bool unknown = most_unknown_ > 0 && entry.second == 1 && aborted != aborted_.end();
      figures_.unknown += unknown;
      return unknown;
    });
    EXPECT_LE(figures_.unknown, most_unknown_);
    int shown = 0;
    for (const auto& [key, balance] : balance_) {
      ADD_FAILURE() << (balance > 0 ? "executed, but not COMPLETED: " : "COMPLETED, but not executed: ") << "command "
                    << key.id << " (" << key.arguments[0] << ", " << key.arguments[1] << ", ... " << key.arguments[3]
                    << ", " << key.arguments[4] << "), " << balance;
      if (++shown == 10) break;
    }
    EXPECT_TRUE(balance_.empty()) << balance_.size() << " commands differ";
    for (const Client& c : clients_) {
      EXPECT_TRUE(c.open.empty()) << c.open.size() << " commands of " << c.name.view() << " have no end";
    }
    for (auto i = model_.violations().first(); i < model_.violations().size(); ++i) {
      ADD_FAILURE() << model_.violations()[i].what;
    }
    const Figures& f = figures_;
    EXPECT_EQ(f.executed, f.completed + f.unknown);
    EXPECT_GT(f.executed, f.commands / 3) << "too little was executed to prove anything";
    EXPECT_EQ(f.cuts, kCuts);
    EXPECT_EQ(f.full_queues, kEpisodes);
    EXPECT_EQ(f.restarts, 1u);
    std::printf(
        "commands %llu: executed %llu, COMPLETED %llu, DISCARDED %llu, REJECTED %llu, ABORTED %llu; resent %llu\n"
        "link cuts %llu, full queues %llu, restarts %llu, images lost %llu out and %llu in, repeated %llu\n"
        "owner changes %llu, clears %llu, deactivations %llu, robot errors %llu; %.2f h of the robot's time\n",
        n(f.commands), n(f.executed), n(f.completed), n(f.discarded), n(f.rejected), n(f.aborted), n(f.resent),
        n(f.cuts), n(f.full_queues), n(f.restarts), n(f.lost_out), n(f.lost_in), n(f.repeated), n(f.owners_changed),
        n(f.clears), n(f.deactivations), n(f.errors),
        std::chrono::duration<double, std::ratio<3600>>(settings.cycle).count() * static_cast<double>(f.cycles));
  }
  static unsigned long long n(std::uint64_t x) { return x; }

  std::uint64_t goal_;
  std::uint32_t trouble_;
  std::mt19937_64 random_;
  sim::Robot model_;
  std::array<Client, kClients> clients_;
  int active_ = 0, silent_ = 0;
  std::uint32_t signature_ = 0;
  std::uint64_t read_ = 0;
  std::unordered_map<Key, int, KeyHash> balance_, aborted_;
  std::uint64_t most_unknown_ = 0;
  std::unique_ptr<bridge::Cycle> bridge_life_;
  Figures figures_;
};

}  // namespace meca::test
