#include "tests/bench/fight_judge.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "tests/bench/client.hpp"

namespace meca::bench {
namespace {

using meca500::CommandKind;
using meca500::ReceiptReason;
using meca500::ReceiptState;

struct Reign {
  std::uint64_t start = 0;  // cycle
  std::string owner;
};

std::string name_of(const ReceiptLine& r) { return r.client + "'s command " + std::to_string(r.id); }

class Judge {
 public:
  explicit Judge(const Fight& fight) : fight_(fight) {}

  FightFacts run() {
    find_reigns();
    std::map<std::pair<std::string, std::uint64_t>, std::vector<const ReceiptLine*>> commands;
    for (const auto& r : fight_.receipts) commands[{r.client, r.id}].push_back(&r);
    for (const auto& [key, receipts] : commands) {
      const Sent* sent = find(key.first, key.second);
      if (sent == nullptr) {
        say("a receipt for " + name_of(*receipts.front()) + ", which it never sent");
        continue;
      }
      ++facts_.commands;
      judge_acts(receipts, *sent);
      judge_end(receipts, sent->resends);
      for (const auto* r : receipts) {
        if (r->state == ReceiptState::REJECTED) judge_rejection(*r);
      }
    }
    for (const auto& [client, diary] : fight_.diaries) {
      for (const auto& [id, sent] : diary.commands) {
        const auto published = commands.find({client, id});
        if (published == commands.end()) ++facts_.unanswered;
        judge_view(client, id, sent, published == commands.end() ? nullptr : &published->second);
      }
    }
    return std::move(facts_);
  }

 private:
  using Receipts = std::vector<const ReceiptLine*>;

  void say(const std::string& sentence) { facts_.broken.push_back(sentence); }

  const Sent* find(const std::string& client, std::uint64_t id) const {
    const auto diary = fight_.diaries.find(client);
    if (diary == fight_.diaries.end()) return nullptr;
    const auto command = diary->second.commands.find(id);
    return command == diary->second.commands.end() ? nullptr : &command->second;
  }

  void find_reigns() {
    for (const auto& [since, owner] : fight_.owners) {
      const auto first =
          std::ranges::find_if(fight_.receipts, [&, since = since, &owner = owner](const ReceiptLine& r) {
            return r.time_ns == since && r.client == owner && r.state != ReceiptState::REJECTED;
          });
      if (first == fight_.receipts.end()) {
        say(owner + " has control since " + std::to_string(since) + " ns without a command accepted then");
        continue;
      }
      reigns_.push_back({first->cycle, owner});
    }
    std::ranges::stable_sort(reigns_, {}, &Reign::start);
    facts_.reigns = static_cast<long>(reigns_.size());
  }

  // Who had control in this cycle, or until it, or from it on.
  std::set<std::string> owners_in(std::uint64_t cycle) const {
    std::set<std::string> owners;
    auto at = std::ranges::upper_bound(reigns_, cycle, {}, &Reign::start);
    while (at != reigns_.begin()) {
      --at;
      owners.insert(at->owner);
      if (at->start < cycle) break;
    }
    return owners;
  }

  void judge_acts(const Receipts& receipts, const Sent& sent) {
    // Both may be answered to anybody: nothing to give back; control later.
    if (sent.kind == CommandKind::RELEASE_CONTROL) return;
    std::set<ReceiptState> known;
    for (const auto* r : receipts) {
      if (!known.insert(r->state).second) continue;  // the answer to a resent id
      const bool take = sent.kind == CommandKind::TAKE_CONTROL;
      const bool act = take ? r->state == ReceiptState::COMPLETED
                            : r->state == ReceiptState::ACCEPTED || r->state == ReceiptState::SENT ||
                                  (r->state == ReceiptState::COMPLETED && r == receipts.front());
      if (!act) continue;
      ++facts_.owners_acts;
      if (!fight_.owners_known || owners_in(r->cycle).contains(r->client)) continue;
      say(name_of(*r) + " was taken in cycle " + std::to_string(r->cycle) + ", when somebody else had control");
    }
  }

  void judge_end(const Receipts& receipts, int resends) {
    const ReceiptLine* end = nullptr;
    int ends = 0;
    std::map<ReceiptState, int> times;
    for (const auto* r : receipts) {
      ++times[r->state];
      if (end != nullptr && (r->state != end->state || r->reason != end->reason)) {
        say(name_of(*r) + ": a receipt after its end");
      }
      if (!is_terminal(r->state)) continue;
      if (end == nullptr) end = r;
      ++ends;
    }
    if (ends == 0) say(name_of(*receipts.front()) + " has receipts and no end");
    for (const auto& [state, count] : times) {
      if (count > 1 + resends)
        say(name_of(*receipts.front()) + ": the same receipt " + std::to_string(count) + " times");
    }
  }

  void judge_rejection(const ReceiptLine& r) {
    ++facts_.rejections;
    if (r.reason == ReceiptReason::REASON_NONE) say(name_of(r) + " was rejected without a reason");
    if (r.text.empty()) say(name_of(r) + " was rejected without a sentence");
    if (r.reason != ReceiptReason::REASON_NOT_OWNER) return;
    const bool nobody = r.text.find("nobody has control") != std::string::npos ||
                        r.text.find("'" + r.client + "' lost control") != std::string::npos;
    const auto owners = owners_in(r.cycle);
    const bool named = std::ranges::any_of(
        owners, [&](const std::string& owner) { return r.text.find("'" + owner + "'") != std::string::npos; });
    facts_.named_owner += named && !nobody;
    if (fight_.owners_known && !nobody && !named)
      say(name_of(r) + " was rejected as not of the owner, who is not named: " + r.text);
  }

  void judge_view(const std::string& client, std::uint64_t id, const Sent& sent, const Receipts* published) {
    const std::string who = client + " itself, command " + std::to_string(id);
    for (const auto& seen : sent.seen) {
      const bool known = published != nullptr && std::ranges::any_of(*published, [&](const ReceiptLine* r) {
                           return r->state == seen.state && r->reason == seen.reason;
                         });
      if (!known) say(who + ": saw a receipt that was not published");
    }
    if (!sent.lived) return;
    std::set<std::pair<ReceiptState, ReceiptReason>> ends;
    for (const auto& seen : sent.seen) {
      if (is_terminal(seen.state)) ends.insert({seen.state, seen.reason});
    }
    facts_.seen_to_the_end += ends.size() == 1;
    if (ends.size() != 1) say(who + ": saw " + std::to_string(ends.size()) + " different ends, not one");
  }

  const Fight& fight_;
  std::vector<Reign> reigns_;
  FightFacts facts_;
};

}  // namespace

FightFacts judge(const Fight& fight) { return Judge(fight).run(); }

}  // namespace meca::bench
