#include "tests/bench/deaths.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>

#include "tests/bench/bridge_process.hpp"
#include "tests/bench/client.hpp"
#include "tests/bench/clock.hpp"
#include "tests/bench/death_judge.hpp"
#include "tests/bench/owner.hpp"
#include "tests/bench/progress.hpp"
#include "tests/bench/wire_log.hpp"

namespace meca::bench {
namespace {

using namespace std::chrono_literals;
using json = nlohmann::ordered_json;
using meca500::ReceiptState;

constexpr auto kPump = 5ms;
constexpr auto kRepair = 3s;         // time for lost samples to be sent again
constexpr std::size_t kStandby = 3;  // owners that have found the bridge already and wait for their turn
constexpr std::size_t kEnoughForAMedian = 100;
constexpr std::array kCauses{"killed", "stopped", "hung"};

std::string configuration(const Setting& setting) {
  return dds_on_loopback(setting.domain) + "  topics:\n" + kWireLogTopics +
         "    ControlStatus: {depth: 200}\nlog: {level: error}\nrobots:\n  - name: " + kRobot +
         "\n    cycle: 1ms\n    transport: {type: builtin, instant_homing: true}\n"
         "    control: {lease: 100ms, velocity_lease: 50ms}\n";
}

// Everything the proof sees of the bridge.
class Watch {
 public:
  explicit Watch(int domain)
      : participant_(on_loopback(domain, "bench-watch")),
        wire_(participant_),
        control_(participant_.create_reader<meca500::ControlStatus>("meca500/ControlStatus", kDeep)),
        receipts_(participant_.create_reader<meca500::CommandReceipt>("meca500/CommandReceipt", kDeep)),
        status_(participant_.create_reader<meca500::BridgeStatus>("meca500/BridgeStatus", kDeep)) {}

  void pump() {
    wire_.pump();
    dds::SampleInfo info;
    meca500::ControlStatus control;
    while (control_.take(control, info)) {
      if (!info.valid_data) continue;
      owner_ = control.owner().to_string();
      const bool expired = control.last_loss().to_string() == "lease expired";
      if (!control.owned() && expired) loss_ = control;
    }
    meca500::CommandReceipt receipt;
    while (receipts_.take(receipt, info)) {
      if (info.valid_data && receipt.client().to_string() == follow_) of_followed_.push_back(receipt);
    }
    while (status_.take(status, info)) {
    }
  }
  // Pumps until the condition holds; false when it does not in time. An owner gives up earlier, and says why.
  bool until(const std::function<bool()>& condition, std::chrono::nanoseconds patience = 30s) {
    for (const auto end = monotonic_now() + patience; monotonic_now() < end;) {
      if (condition()) return true;
      std::this_thread::sleep_for(kPump);
      pump();
    }
    return condition();
  }
  void pump_for(std::chrono::nanoseconds time) {
    for (const auto end = monotonic_now() + time; monotonic_now() < end;) {
      pump();
      std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(kPump, end - monotonic_now()));
    }
  }
  void follow(const std::string& client) {
    follow_ = client;
    of_followed_.clear();
  }
  // The first cycle in which a command of the followed client with this id or a later one got this far; 0 = none.
  std::uint64_t cycle_of(std::uint64_t id, bool completed) const {
    for (const auto& r : of_followed_) {
      const bool far = completed ? r.state() == ReceiptState::COMPLETED : r.state() != ReceiptState::REJECTED;
      if (id != 0 && r.command_id() >= id && far) return r.cycle();
    }
    return 0;
  }
  // Who has control; empty: nobody.
  const std::string& owner() const { return owner_; }
  void forget_loss() { loss_ = {}; }
  // The loss of this owner's lease; nullptr when it is not known (yet).
  const meca500::ControlStatus* loss_of(const std::string& owner) const {
    return loss_.last_owner().to_string() == owner ? &loss_ : nullptr;
  }
  WireLog& wire() { return wire_; }
  std::uint64_t last_cycle() const { return wire_.images().empty() ? 0 : wire_.images().rbegin()->first; }

  meca500::BridgeStatus status;

 private:
  static constexpr dds::Qos kDeep{dds::Reliability::kReliable, dds::Durability::kVolatile, 4000};
  dds::Participant participant_;
  WireLog wire_;
  dds::Reader<meca500::ControlStatus> control_;
  dds::Reader<meca500::CommandReceipt> receipts_;
  dds::Reader<meca500::BridgeStatus> status_;
  std::string owner_;
  meca500::ControlStatus loss_;
  std::string follow_;
  std::vector<meca500::CommandReceipt> of_followed_;
};

struct Owner {
  Owner(const Setting& setting, int number)
      : name("owner-" + std::to_string(number)),
        velocity(number % 2 == 1),
        path(std::filesystem::temp_directory_path() / ("meca-bench-" + std::to_string(getpid()) + "-" + name)),
        board(SharedBoard::make(path)),
        process(command(setting)) {}

  std::vector<std::string> command(const Setting& setting) const {
    auto words = role("owner", setting);
    words.insert(words.end(), {"--name", name, "--board", path.string()});
    if (velocity) words.push_back("--velocity");
    return words;
  }
  bool reached(OwnerBoard::Phase phase) const { return board->phase >= phase; }

  std::string name;
  bool velocity;
  std::filesystem::path path;
  SharedBoard board;
  Process process;
};

// Figures of one cause of death.
struct Row {
  int deaths = 0, not_measured = 0;
  std::vector<double> cycles, velocity_cycles, wall_ms;

  void add(const Row& other) {
    deaths += other.deaths;
    not_measured += other.not_measured;
    cycles.insert(cycles.end(), other.cycles.begin(), other.cycles.end());
    velocity_cycles.insert(velocity_cycles.end(), other.velocity_cycles.begin(), other.velocity_cycles.end());
    wall_ms.insert(wall_ms.end(), other.wall_ms.begin(), other.wall_ms.end());
  }
  json figures() {
    const auto whole = [](std::vector<double>& v, double share) { return static_cast<long>(percentile(v, share)); };
    return {{"deaths", deaths},
            {"measured", cycles.size()},
            {"cycles_p50", whole(cycles, 0.5)},
            {"cycles_max", whole(cycles, 1)},
            {"velocity_cycles_p50", whole(velocity_cycles, 0.5)},
            {"velocity_cycles_max", whole(velocity_cycles, 1)},
            {"wall_p50_ms", percentile(wall_ms, 0.5)},
            {"wall_p99_ms", percentile(wall_ms, 0.99)},
            {"wall_max_ms", percentile(wall_ms, 1)}};
  }
};

class Deaths {
 public:
  Deaths(const Setting& setting, int deaths)
      : setting_(setting), deaths_(deaths), bridge_(setting, configuration(setting)), watch_(setting.domain) {}

  Proof run() {
    prepare();
    for (int i = 0; i < deaths_; ++i) {
      one(i);
      progress("deaths", i + 1, deaths_, std::to_string(proof_.broken.size()) + " broken");
    }
    watch_.pump_for(300ms);
    next_owner_came(watch_.last_cycle(), watch_.last_cycle());
    conclude();
    bridge_.process.stop();
    return std::move(proof_);
  }

 private:
  // Activates and homes, and leaves the robot to the owners.
  void prepare() {
    Client client(setting_.domain, "bench-prepare");
    client.prepare_robot();
    client.finish(Client::make(meca500::CommandKind::RELEASE_CONTROL));
    if (!watch_.until([&] { return watch_.last_cycle() > 0; })) throw std::runtime_error("no samples of the wire");
  }

  void one(int number) {
    auto owner = next_owner();
    while (watch_.owner() != owner->name) {  // a busy machine has let its lease lapse
      ++lapsed_;
      stop_cycle_ = 0;
      owner = next_owner();
    }
    const int cause = number % static_cast<int>(kCauses.size());
    watch_.forget_loss();  // it may have lost its lease before, on the way to control
    die(*owner, cause);
    judge(*owner, number, cause);
    owner->process.kill();
  }

  // In control, streaming for a random time.
  std::unique_ptr<Owner> next_owner() {
    while (standby_.size() < kStandby && started_ < deaths_ + lapsed_) {
      standby_.push_back(std::make_unique<Owner>(setting_, started_++));
    }
    auto owner = std::move(standby_.front());
    standby_.pop_front();
    watch_.follow(owner->name);
    wait(*owner, OwnerBoard::kStandby, "find the bridge");
    owner->board->go = true;
    wait(*owner, OwnerBoard::kStreaming, "stream motion");
    const auto& board = owner->board;
    std::uint64_t resumed = 0, commanded = 0;
    watch_.until(
        [&] {
          resumed = watch_.cycle_of(board->first_resume_id, false);
          commanded = owner->velocity ? watch_.cycle_of(board->first_resume_id, true)
                                      : watch_.cycle_of(board->first_motion_id, false);
          return resumed != 0 && commanded != 0;
        },
        kRepair);
    next_owner_came(resumed, commanded);
    watch_.pump_for(std::chrono::microseconds(std::uniform_int_distribution(50'000, 400'000)(random_)));
    return owner;
  }

  void wait(const Owner& owner, OwnerBoard::Phase phase, const char* what) {
    if (watch_.until([&] { return owner.reached(phase); }) && !owner.reached(OwnerBoard::kFailed)) return;
    throw std::runtime_error(owner.name + " could not " + what + ": " + owner.board->problem);
  }

  static void die(Owner& owner, int cause) {
    if (cause == 0) owner.process.kill();
    if (cause == 1) owner.process.signal(SIGSTOP);
    if (cause == 2) owner.board->hang = true;
  }

  void judge(const Owner& owner, int number, int cause) {
    Row& row = rows_.at(static_cast<std::size_t>(cause));
    ++row.deaths;
    const std::string who = owner.name + " (" + kCauses.at(static_cast<std::size_t>(cause)) + ")";
    stop_cycle_ = 0;
    if (!watch_.until([&] { return watch_.loss_of(owner.name) != nullptr; })) {
      proof_.broken.push_back(who + ": still has control after 30 s");
      return;
    }
    const std::int64_t renewal = watch_.loss_of(owner.name)->last_renewal_ns();
    std::optional<StopFacts> facts;
    const auto measured = [&] {
      facts = judge_stop(watch_.wire().images(), renewal, owner.velocity, limits_);
      return facts.has_value();
    };
    if (!watch_.until(measured, kRepair)) {
      ++row.not_measured;
      return;
    }
    for (const auto& sentence : facts->broken) proof_.broken.push_back(who + ": " + sentence);
    row.cycles.push_back(static_cast<double>(facts->cycles));
    if (facts->velocity_cycles) row.velocity_cycles.push_back(static_cast<double>(*facts->velocity_cycles));
    row.wall_ms.push_back(static_cast<double>(facts->on_wire_ns - owner.board->last_sent_ns) / 1e6);
    stop_cycle_ = facts->stop_cycle;
    last_ = "after death " + std::to_string(number + 1) + ", " + who + ": ";
    watch_.wire().forget_before(stop_cycle_);
  }

  // The time between the last stop and the next owner's first acts is over.
  void next_owner_came(std::uint64_t resumed, std::uint64_t commanded) {
    if (stop_cycle_ == 0) return;
    std::optional<std::vector<std::string>> broken;
    const auto measured = [&] {
      if (resumed != 0 && commanded != 0) {
        broken = judge_quiet(watch_.wire().images(), stop_cycle_, resumed, commanded);
      }
      return broken.has_value();
    };
    if (!watch_.until(measured, kRepair)) ++quiet_not_measured_;
    for (const auto& sentence : broken.value_or(std::vector<std::string>{})) proof_.broken.push_back(last_ + sentence);
    watch_.wire().forget_before(commanded);
  }

  void conclude() {
    Row all;
    for (const auto& row : rows_) all.add(row);
    for (std::size_t i = 0; i < kCauses.size(); ++i) proof_.figures[kCauses[i]] = rows_[i].figures();
    proof_.figures["all"] = all.figures();
    proof_.figures["promised"] = {{"cycles_max", limits_.most_cycles(limits_.lease_ns)},
                                  {"velocity_cycles_max", limits_.most_cycles(limits_.velocity_lease_ns)}};
    proof_.figures["bridge"] = {{"lapsed_before", lapsed_},
                                {"quiet_not_measured", quiet_not_measured_},
                                {"cycles", watch_.status.cycles()},
                                {"missed_cycles", watch_.status.missed_cycles()},
                                {"records_dropped", watch_.status.records_dropped()}};
    const int not_measured = all.not_measured + quiet_not_measured_;
    if (20 * not_measured > all.deaths) {
      proof_.not_told = std::to_string(not_measured) + " of " + std::to_string(all.deaths) +
                        " deaths could not be measured (records of cycles were lost), more than 5 %";
    }
    if (all.wall_ms.size() < kEnoughForAMedian) return;
    const double median = percentile(all.wall_ms, 0.5);
    const double most = static_cast<double>(limits_.lease_ns + 10 * limits_.cycle_ns) / 1e6;
    proof_.expect(median <= most, "from the last sign of life sent to the stop on the wire: median " +
                                      std::to_string(median) + " ms, more than lease + 10 cycles");
  }

  Setting setting_;
  int deaths_;
  int started_ = 0;
  int lapsed_ = 0;  // owners that lost control before they died
  int quiet_not_measured_ = 0;
  DeathLimits limits_;
  BridgeProcess bridge_;
  Watch watch_;
  std::deque<std::unique_ptr<Owner>> standby_;
  std::array<Row, kCauses.size()> rows_;
  std::uint64_t stop_cycle_ = 0;  // of the last death; 0: not measured
  std::string last_;
  Proof proof_;
  std::mt19937 random_{500};
};

}  // namespace

Proof prove_deaths(const Setting& setting, int deaths) { return Deaths(setting, deaths).run(); }

}  // namespace meca::bench
