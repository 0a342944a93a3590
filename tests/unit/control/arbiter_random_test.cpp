// Five clients of different priorities fight for one robot at random, with leases that lapse and a link that breaks;
// a model of a page says what must come of it, receipt by receipt. Seeded: a failure names its seed and is repeated.
#include <map>
#include <random>

#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;
using Loss = ControlState::Loss;

constexpr int kClients = 5;
constexpr int kNobody = -1;
constexpr std::uint32_t kPriority[kClients] = {0, 0, 5, 5, 9};
constexpr auto kLease = 20ms;
constexpr auto kGrace = 30ms;

std::string name_of(int who) { return "client " + std::to_string(who); }

CycleSettings rules() {
  CycleSettings s;
  s.lease = kLease;
  s.clients.take_over_grace = kGrace;
  for (int who = 0; who < kClients; ++who) {
    const auto i = static_cast<std::size_t>(who);
    s.clients.clients[i] = {ClientName(name_of(who)), false, kPriority[who], std::nullopt};
  }
  s.clients.count = kClients;
  return s;
}

struct Answer {
  ReceiptState state;
  Reason reason;
  friend bool operator==(const Answer&, const Answer&) = default;
};
std::ostream& operator<<(std::ostream& out, const Answer& a) {
  return out << "state " << static_cast<int>(a.state) << " reason " << static_cast<int>(a.reason);
}
constexpr Answer kDone{kCompleted, Reason::kNone}, kRefused{kRejected, Reason::kNotOwner};

// Behaviour.md, "One owner at a time", as simply as it can be written.
class Model {
 public:
  using Time = std::chrono::nanoseconds;
  using Id = std::pair<int, std::uint64_t>;

  int owner = kNobody, contender = kNobody;
  std::map<Id, Answer> answers;  // the last of each command

  // In the order of a cycle: link, requests, what has lapsed.
  void link_is_gone() {
    if (owner != kNobody) must_take[owner] = true;
    owner = kNobody;
    end_contest({kAborted, Reason::kLinkLost});
  }
  void sign_of_life(int who, Time now) { life[who] = now; }
  void ask(int who, std::uint64_t id, CommandKind kind, std::optional<Reason> not_now, Time now) {
    sign_of_life(who, now);
    answers[{who, id}] = answer(who, id, kind, not_now, now);
  }
  void lapse(Time now) {
    if (owner != kNobody && now - life[owner] > kLease) lose_owner();
    end_silent_contest(now);
    if (contender == kNobody || (owner != kNobody && now < takes_over_at)) return;
    if (owner != kNobody) lose_owner();
    succeed();
  }

 private:
  Answer answer(int who, std::uint64_t id, CommandKind kind, std::optional<Reason> not_now, Time now) {
    if (kind == kReleaseControl && owner == kNobody) return kDone;
    if (kind == kReleaseControl && contender == who) {
      end_contest({kAborted, Reason::kOwnerLost});
      return kDone;
    }
    if (not_now) return {kRejected, *not_now};
    if (owner == kNobody) {
      if (must_take[who] && kind != kTakeControl) return kRefused;
      must_take[who] = false;
      owner = who;
      return kDone;
    }
    if (owner == who) {
      if (kind == kReleaseControl) {
        owner = kNobody;
        end_silent_contest(now);
        if (contender != kNobody) succeed();
      }
      return kDone;
    }
    const bool above =
        kPriority[who] > kPriority[owner] && (contender == kNobody || kPriority[who] > kPriority[contender]);
    if (kind != kTakeControl || !above) return kRefused;
    if (contender == kNobody) {
      takes_over_at = now + kGrace;
    } else {
      end_contest({kAborted, Reason::kNotOwner});
    }
    contender = who;
    contest_id = id;
    return {kAccepted, Reason::kNone};
  }
  void lose_owner() {
    must_take[owner] = true;
    owner = kNobody;
  }
  void succeed() {
    owner = contender;
    must_take[owner] = false;
    end_contest(kDone);
  }
  void end_silent_contest(Time now) {
    if (contender != kNobody && now - life[contender] > kLease) end_contest({kAborted, Reason::kOwnerLost});
  }
  void end_contest(Answer how) {
    if (contender != kNobody) answers[{contender, contest_id}] = how;
    contender = kNobody;
  }

  std::array<Time, kClients> life{};
  std::array<bool, kClients> must_take{};
  std::uint64_t contest_id = 0;
  Time takes_over_at{};
};

class Fight : public testing::TestWithParam<unsigned> {
 protected:
  Fight() : b(rules()), random_(GetParam()) {
    b.keep_alive = false;
    b.connect();
  }
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  void cycle() {
    struct Asked {
      int who;
      std::uint64_t id;
      std::optional<CommandKind> kind;  // empty: a renewal
    };
    std::vector<Asked> asked;
    for (int who = 0; who < kClients; ++who) {
      if (pick(400) == 0) asleep_[who] = !asleep_[who];
      if (asleep_[who] || pick(4) != 0) continue;
      if (pick(8) != 0) {
        asked.push_back({who, 0, std::nullopt});
        b.pending.push_back(LeaseRenewal{ClientName(name_of(who)), participant(who + 1), ++renewals_});
        continue;
      }
      static constexpr CommandKind kKinds[] = {kTakeControl, kTakeControl, kReleaseControl, kClearMotion};
      CommandRequest r = b.request(kKinds[pick(4)]);  // ClearMotion of an idle robot: done at once, changes nothing
      r.client = ClientName(name_of(who));
      r.participant = participant(who + 1);
      asked.push_back({who, r.command_id, r.kind});
      b.send(r);
    }
    if (pick(b.link_up ? 3000 : 50) == 0) b.link_up = !b.link_up;
    const std::size_t receipts_before = b.receipts.size();
    b.step();

    const Quality quality = b.result->record.quality;
    std::optional<Reason> not_now;
    if (quality == Quality::kUnknown) not_now = Reason::kFirmwareUnknown;
    if (quality == Quality::kDisconnected) {
      not_now = Reason::kNoLink;
      model_.link_is_gone();
    }
    for (const Asked& a : asked) {
      life_[a.who] = b.now;
      a.kind ? model_.ask(a.who, a.id, *a.kind, not_now, b.now) : model_.sign_of_life(a.who, b.now);
    }
    model_.lapse(b.now);
    compare(receipts_before);
  }

  void compare(std::size_t receipts_before) {
    const ControlState& state = b.result->record.control;
    const auto shown = [](int who) { return who == kNobody ? std::string() : name_of(who); };
    ASSERT_EQ(std::string(state.owner.view()), shown(model_.owner));
    ASSERT_EQ(state.owned, model_.owner != kNobody);
    ASSERT_EQ(std::string(state.contender.view()), shown(model_.contender));
    if (model_.owner != kNobody) {
      ASSERT_LE(b.now - life_[model_.owner], kLease) << "an owner without a sign of life";
      ASSERT_EQ(state.priority, kPriority[model_.owner]);
    }
    std::map<Model::Id, Answer> last;
    for (std::size_t i = receipts_before; i < b.receipts.size(); ++i) {
      const Receipt& r = b.receipts[i];
      last[{r.client.view().back() - '0', r.command_id}] = {r.state, r.reason};
      refused_ += r.state == kRejected;
      taken_over_ += state.last_loss == Loss::kTakenOver && r.kind == kTakeControl && r.state == kCompleted;
      if (r.reason == Reason::kNone) continue;
      ASSERT_GT(describe(r).size(), 30u) << "a refusal has a reason in words";
      if (r.state == kRejected && r.reason == Reason::kNotOwner && state.owned && !r.other.empty()) {
        ASSERT_NE(describe(r).find("'" + std::string(r.other.view()) + "' has control"), std::string::npos);
      }
    }
    for (const auto& [id, answer] : last) ASSERT_EQ(answer, model_.answers.at(id)) << name_of(id.first);
  }

  Bench b;
  Model model_;
  std::mt19937 random_;
  std::array<bool, kClients> asleep_{};
  std::array<std::chrono::nanoseconds, kClients> life_{};
  std::uint64_t renewals_ = 0;
  int refused_ = 0, taken_over_ = 0;
};

TEST_P(Fight, has_one_owner_at_a_time_and_an_answer_for_everybody) {
  for (int i = 0; i < 20000 && !HasFatalFailure(); ++i) cycle();
  EXPECT_GT(refused_, 100) << "this life has proved little";
  EXPECT_GT(taken_over_, 10);
  // Every command has ended but the TAKE_CONTROL that waits.
  int waiting = 0;
  for (const auto& [id, answer] : model_.answers) waiting += !is_terminal(answer.state);
  EXPECT_LE(waiting, model_.contender == kNobody ? 0 : 1);
}

INSTANTIATE_TEST_SUITE_P(Seed, Fight, testing::Range(1u, 13u));

}  // namespace
}  // namespace meca::test
