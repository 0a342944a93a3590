#include "tests/bench/fight.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <string_view>
#include <thread>

#include "tests/bench/bridge_process.hpp"
#include "tests/bench/client.hpp"
#include "tests/bench/clock.hpp"
#include "tests/bench/fight_judge.hpp"
#include "tests/bench/progress.hpp"

namespace meca::bench {
namespace {

using namespace std::chrono_literals;
using json = nlohmann::ordered_json;

constexpr int kFighters = 8;
constexpr auto kPump = 5ms;

std::string fighter_name(int number) { return "fighter-" + std::to_string(number); }
int priority(int number) { return number < kFighters - 2 ? 0 : 10 * (number - kFighters + 3); }

std::string configuration(const Setting& setting) {
  std::string text = dds_on_loopback(setting.domain) +
                     "  topics:\n"
                     "    ControlStatus: {depth: 1000}\n"
                     "log: {level: error}\nrobots:\n  - name: " +
                     kRobot +
                     "\n    transport: {type: builtin, instant_homing: true}\n"
                     "    control:\n      take_over_grace: 30ms\n      clients:\n";
  for (int i = 0; i < kFighters; ++i) {
    if (priority(i) == 0) continue;
    text += "        - {name: " + fighter_name(i) + ", priority: " + std::to_string(priority(i)) + "}\n";
  }
  return text;
}

class Arena {
 public:
  explicit Arena(const Setting& setting)
      : setting_(setting),
        bridge_(setting, configuration(setting)),
        participant_(on_loopback(setting.domain, "bench-referee")),
        control_(participant_.create_reader<meca500::ControlStatus>("meca500/ControlStatus", kDeep)),
        receipts_(participant_.create_reader<meca500::CommandReceipt>("meca500/CommandReceipt", kDeep)),
        status_(participant_.create_reader<meca500::BridgeStatus>("meca500/BridgeStatus", kDeep)) {}
  ~Arena() {
    std::error_code ignored;
    for (int i = 0; i < kFighters; ++i) std::filesystem::remove(diary(i), ignored);
  }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  Proof run() {
    prepare();
    const auto begin = monotonic_now();
    for (int shown = 0; monotonic_now() < begin + setting_.duration;) {
      revive();
      pump();
      std::this_thread::sleep_for(kPump);
      const auto total = static_cast<int>(setting_.duration.count());
      const auto done = static_cast<int>((monotonic_now() - begin) / 1s);
      if (done == shown || done > total) continue;
      shown = done;
      progress("fight", done, total, std::to_string(fight_.owners.size()) + " reigns");
    }
    end();
    return conclude();
  }

 private:
  static constexpr dds::Qos kDeep{dds::Reliability::kReliable, dds::Durability::kTransientLocal, 10000};

  std::filesystem::path diary(int number) const {
    return std::filesystem::temp_directory_path() /
           ("meca-bench-" + std::to_string(getpid()) + "-" + fighter_name(number));
  }

  void prepare() {
    Client client(setting_.domain, "bench-prepare");
    client.prepare_robot();
    client.finish(Client::make(meca500::CommandKind::RELEASE_CONTROL));
  }

  // Who is dead comes back: the same name, another process.
  void revive() {
    for (int i = 0; i < kFighters; ++i) {
      auto& fighter = fighters_.at(static_cast<std::size_t>(i));
      if (fighter && fighter->running()) continue;
      if (fighter) fighter->kill();
      auto words = role("fighter", setting_);
      int& life = lives_.at(static_cast<std::size_t>(i));
      words.insert(words.end(), {"--name", fighter_name(i), "--diary", diary(i).string(), "--seed",
                                 std::to_string(1000 * i + ++life)});
      fighter = std::make_unique<Process>(words);
    }
  }

  void pump() {
    dds::SampleInfo info;
    meca500::ControlStatus control;
    while (control_.take(control, info)) {
      if (!info.valid_data || !control.owned() || !fights(control.owner().to_string())) continue;
      fight_.owners[control.since_ns()] = control.owner().to_string();
    }
    meca500::CommandReceipt r;
    while (receipts_.take(r, info)) {
      if (!info.valid_data || !fights(r.client())) continue;
      fight_.receipts.push_back({r.client().to_string(), r.command_id(), r.state(), r.reason(), r.text().to_string(),
                                 r.cycle(), r.time_ns()});
    }
    while (status_.take(bridge_status_, info)) {
    }
  }
  template <typename Name>
  static bool fights(const Name& name) {
    return std::string_view(name.c_str()).starts_with("fighter-");
  }

  // All stop to command, and wait for what is open.
  void end() {
    for (auto& fighter : fighters_) fighter->signal(SIGTERM);
    for (const auto patience = monotonic_now() + 40s; monotonic_now() < patience;) {
      pump();
      bool anybody = false;
      for (auto& fighter : fighters_) anybody |= fighter->running();
      if (!anybody) break;
      std::this_thread::sleep_for(kPump);
    }
    for (auto& fighter : fighters_) fighter->kill();
    for (const auto last = monotonic_now() + 500ms; monotonic_now() < last; std::this_thread::sleep_for(kPump)) pump();
    bridge_.process.stop();
    for (int i = 0; i < kFighters; ++i) fight_.diaries[fighter_name(i)] = read_diary(diary(i));
  }

  Proof conclude() {
    Proof proof;
    fight_.owners_known = bridge_status_.records_dropped() == 0;
    FightFacts facts = judge(fight_);
    if (!fight_.owners_known) {
      proof.not_told = "the publisher dropped " + std::to_string(bridge_status_.records_dropped()) +
                       " records of cycles, so that it is not known who had control in all of them";
    }
    proof.broken = std::move(facts.broken);
    int lives = 0;
    for (const auto& [name, diary] : fight_.diaries) lives += diary.lives;
    proof.figures["fight"] = {{"fighters", kFighters},
                              {"lives", lives},
                              {"reigns", facts.reigns},
                              {"commands", facts.commands},
                              {"without_receipt", facts.unanswered},
                              {"owners_acts", facts.owners_acts},
                              {"rejections", facts.rejections},
                              {"that_name_the_owner", facts.named_owner},
                              {"seen_to_the_end", facts.seen_to_the_end},
                              {"missed_cycles", bridge_status_.missed_cycles()},
                              {"records_dropped", bridge_status_.records_dropped()},
                              {"broken", proof.broken.size()}};
    proof.expect(facts.reigns > 1 && facts.rejections > 0, "nobody fought");
    return proof;
  }

  Setting setting_;
  BridgeProcess bridge_;
  dds::Participant participant_;
  dds::Reader<meca500::ControlStatus> control_;
  dds::Reader<meca500::CommandReceipt> receipts_;
  dds::Reader<meca500::BridgeStatus> status_;
  meca500::BridgeStatus bridge_status_;
  std::array<std::unique_ptr<Process>, kFighters> fighters_;
  std::array<int, kFighters> lives_{};
  Fight fight_;
};

}  // namespace

Proof prove_fight(const Setting& setting) { return Arena(setting).run(); }

}  // namespace meca::bench
