// The judge of a fight must be able to condemn: a fair fight, and each rule broken once.
#include "tests/bench/fight_judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace meca::bench {
namespace {

using meca500::CommandKind;
using meca500::ReceiptReason;
using meca500::ReceiptState;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

std::int64_t stamp(std::uint64_t cycle) { return static_cast<std::int64_t>(cycle) * 1'000'000; }

struct Scene : Fight {
  // The receipt as published, and as its client saw it.
  void receipt(const std::string& client, std::uint64_t id, ReceiptState state, std::uint64_t cycle,
               ReceiptReason reason = ReceiptReason::REASON_NONE, const std::string& text = "a sentence") {
    receipts.push_back({client, id, state, reason, text, cycle, stamp(cycle)});
    diaries[client].commands[id].seen.push_back({state, reason});
  }
  void sent(const std::string& client, std::uint64_t id, CommandKind kind, bool lived = true) {
    diaries[client].commands[id].kind = kind;
    diaries[client].commands[id].lived = lived;
  }
  void take(const std::string& client, std::uint64_t id, std::uint64_t cycle) {
    sent(client, id, CommandKind::TAKE_CONTROL);
    receipt(client, id, ReceiptState::COMPLETED, cycle);
    owners[stamp(cycle)] = client;
  }
  void motion(const std::string& client, std::uint64_t id, std::uint64_t cycle) {
    sent(client, id, CommandKind::MOTION);
    receipt(client, id, ReceiptState::ACCEPTED, cycle);
    receipt(client, id, ReceiptState::SENT, cycle);
    receipt(client, id, ReceiptState::ACKNOWLEDGED, cycle + 1);
    receipt(client, id, ReceiptState::COMPLETED, cycle + 1);
  }
  void refusal(const std::string& client, std::uint64_t id, std::uint64_t cycle, const std::string& text) {
    sent(client, id, CommandKind::MOTION);
    receipt(client, id, ReceiptState::REJECTED, cycle, ReceiptReason::REASON_NOT_OWNER, text);
  }
};

// A has control from cycle 10, B from cycle 100.
Scene fair() {
  Scene s;
  s.take("a", 1, 10);
  s.motion("a", 2, 20);
  s.refusal("b", 1, 30, "'a' has control of the robot");
  s.take("b", 2, 100);
  s.motion("b", 3, 100);
  s.refusal("a", 3, 110, "'a' lost control of the robot; take control again before commanding it");
  return s;
}

TEST(FightJudge, AcquitsAFairFight) {
  const FightFacts facts = judge(fair());
  EXPECT_THAT(facts.broken, IsEmpty());
  EXPECT_EQ(facts.reigns, 2);
  EXPECT_EQ(facts.rejections, 2);
  EXPECT_EQ(facts.named_owner, 1);
  EXPECT_EQ(facts.owners_acts, 6);  // two taken, two accepted, two sent
}

TEST(FightJudge, CondemnsACommandAcceptedInTheReignOfAnother) {
  Scene s = fair();
  s.motion("a", 4, 150);
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("when somebody else had control")));
  s.owners_known = false;
  EXPECT_THAT(judge(s).broken, IsEmpty()) << "a reign of a's may be the one that is missing";
}

TEST(FightJudge, LeavesTheCycleOfTheChangeToBoth) {
  Scene s = fair();
  s.motion("a", 4, 100);
  EXPECT_THAT(judge(s).broken, IsEmpty());
}

TEST(FightJudge, CondemnsControlThatNobodyAskedFor) {
  Scene s = fair();
  s.owners[stamp(200)] = "a";
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("without a command accepted then")));
}

TEST(FightJudge, CondemnsARefusalThatNamesSomebodyElse) {
  Scene s = fair();
  s.refusal("b", 4, 50, "'c' has control of the robot");
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("not named")));
}

TEST(FightJudge, CondemnsARefusalWithoutReasonOrSentence) {
  Scene s = fair();
  s.sent("b", 4, CommandKind::MOTION);
  s.receipt("b", 4, ReceiptState::REJECTED, 50, ReceiptReason::REASON_NONE, "");
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("without a reason")));
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("without a sentence")));
}

TEST(FightJudge, CondemnsACommandWithoutAnEnd) {
  Scene s = fair();
  s.sent("b", 4, CommandKind::MOTION, false);
  s.receipt("b", 4, ReceiptState::ACCEPTED, 120);
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("no end")));
}

TEST(FightJudge, CondemnsTwoEndsAndAReceiptAfterTheEnd) {
  Scene s = fair();
  s.receipt("b", 3, ReceiptState::ABORTED, 120, ReceiptReason::REASON_OWNER_LOST);
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("after its end")));
}

TEST(FightJudge, AllowsTheAnswerToAResentCommandOncePerResend) {
  Scene s = fair();
  s.receipt("b", 3, ReceiptState::COMPLETED, 120);
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("the same receipt 2 times")));
  s.diaries["b"].commands[3].resends = 1;
  EXPECT_THAT(judge(s).broken, IsEmpty());
}

TEST(FightJudge, CondemnsAnEndThatASurvivorDidNotSee) {
  Scene s = fair();
  s.diaries["b"].commands[3].seen.pop_back();
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("saw 0 different ends")));
  s.diaries["b"].commands[3].lived = false;
  EXPECT_THAT(judge(s).broken, IsEmpty());
}

TEST(FightJudge, CondemnsAReceiptForWhatWasNeverSent) {
  Scene s = fair();
  s.receipts.push_back({"b", 99, ReceiptState::COMPLETED, {}, "x", 120, stamp(120)});
  EXPECT_THAT(judge(s).broken, Contains(HasSubstr("never sent")));
}

}  // namespace
}  // namespace meca::bench
