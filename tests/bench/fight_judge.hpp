// Judges a fight for one robot from what the bridge published and what every client saw. No DDS, no clock.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/fighter.hpp"

namespace meca::bench {

struct ReceiptLine {
  std::string client;
  std::uint64_t id = 0;
  meca500::ReceiptState state{};
  meca500::ReceiptReason reason{};
  std::string text;
  std::uint64_t cycle = 0;
  std::int64_t time_ns = 0;
};

struct Fight {
  std::vector<ReceiptLine> receipts;  // in order for each client
  // From ControlStatus: who had control, by since_ns, which is the stamp of the cycle that gave it.
  std::map<std::int64_t, std::string> owners;
  bool owners_known = true;              // false: some may be missing; what needs them all is not judged
  std::map<std::string, Diary> diaries;  // by client name
};

struct FightFacts {
  long reigns = 0, owners_acts = 0, commands = 0, unanswered = 0, rejections = 0, named_owner = 0, seen_to_the_end = 0;
  std::vector<std::string> broken;
};

// - Every reign begins with a command of its owner, accepted in that very cycle; every act that only an owner may do (a
//   command accepted or sent, control taken) lies in a reign of its client, in the bridge's order of cycles. Where one
//   reign follows another in one cycle, that cycle belongs to both.
// - Every REJECTED has a reason and a sentence, and NOT_OWNER names the owner of that cycle, or says that nobody is.
// - Every command with a receipt has exactly one end and nothing after it. A resent command id is answered with the
//   receipt it has: equal repetitions, at most one for each.
// - Who lived to see it has seen the end of every command, and nothing that the bridge did not publish.
FightFacts judge(const Fight& fight);

}  // namespace meca::bench
