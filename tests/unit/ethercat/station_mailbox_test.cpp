// One mail there and one back, whatever is lost in between.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "tests/unit/ethercat/station_mailbox_script.hpp"
#include "transports/ethercat/mailbox_client.hpp"

namespace meca::ethercat::station_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::string_view kUpload = "40 18 10 01 00 00 00 00";
constexpr std::string_view kReply = "0A 00 00 00 00 13 00 30 43 18 10 01 E1 AD EC 00";  // soem2, frame 272
constexpr std::string_view kEmergency = "0A 00 00 00 00 23 00 10 11 86 01 AA BB CC DD EE";

struct MailboxRig {
  MailboxScript device;
  StationCounters counters;
  MailboxClient client{{100ms, 2s}, counters};
  Time now = 1s;

  void request() { client.request(from_hex(kUpload), now); }
  Outcome run(const std::function<Loss(const Access&)>& loses = {}) {
    return station_test::run(client, device, now, loses);
  }
  std::string trouble() const { return std::string(client.trouble().view()); }
};

// Loses the n-th access to an address.
std::function<Loss(const Access&)> lose(std::uint16_t address, Loss how, int n = 0) {
  return [=](const Access& access) mutable { return access.address == address && n-- == 0 ? how : Loss::kNothing; };
}

TEST(StationMailbox, WritesTheWholeSyncManager) {
  MailboxRig rig;
  rig.request();
  const auto access = rig.client.next(rig.now);
  ASSERT_TRUE(access);
  EXPECT_TRUE(access->write);
  EXPECT_EQ(access->address, 0x1000);
  EXPECT_EQ(ByteVector(access->data.begin(), access->data.end()),
            in_mailbox("0A 00 00 00 00 13 00 20 40 18 10 01 00 00 00 00"));  // soem2, frame 259
}

TEST(StationMailbox, BringsTheAnswer) {
  MailboxRig rig;
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.client.service(), CoeService::kSdoResponse);
  EXPECT_EQ(ByteVector(rig.client.sdo().begin(), rig.client.sdo().end()), from_hex("43 18 10 01 E1 AD EC 00"));
  EXPECT_EQ(rig.counters.lost_accesses, 0u);
}

TEST(StationMailbox, CountsFrom1To7) {
  MailboxRig rig;
  std::vector<int> counters;
  for (int i = 0; i < 9; ++i) {
    rig.device.answers = {{in_mailbox(kReply)}};
    rig.request();
    ASSERT_EQ(rig.run(), Outcome::kDone);
    counters.push_back(std::to_integer<int>(rig.device.written.back()[5]) >> 4);
  }
  EXPECT_THAT(counters, ElementsAre(1, 2, 3, 4, 5, 6, 7, 1, 2));
}

TEST(StationMailbox, DoesNotMindTheCounterOfTheAnswer) {
  for (const std::string_view counter : {"03", "33", "73", "F3"}) {
    MailboxRig rig;
    rig.device.answers = {{in_mailbox("0A 00 00 00 00 " + std::string(counter) + " 00 30 43 18 10 01 E1 AD EC 00")}};
    rig.request();
    EXPECT_EQ(rig.run(), Outcome::kDone) << counter;
  }
}

TEST(StationMailbox, TriesAgainWhileTheOtherEndIsFull) {
  MailboxRig rig;
  rig.device.full_for = 20;
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.device.written.size(), 1u);
  EXPECT_EQ(rig.counters.lost_accesses, 0u);  // a full mailbox is no loss
}

// Once it wrote on and on, and the device waited for its answer to be read.
TEST(StationMailbox, ReadsTheAnswerToAMailThatItCouldNotKnowToBeThere) {
  for (const int lost : {1, 2, 3}) {
    MailboxRig rig;
    rig.device.one_at_a_time = true;
    rig.device.answers = {{in_mailbox(kReply)}};
    rig.request();
    const auto outcome = rig.run([n = lost](const Access& access) mutable {
      return access.address == 0x1000 && n-- > 0 ? Loss::kReply : Loss::kNothing;
    });
    EXPECT_EQ(outcome, Outcome::kDone) << lost << ": " << rig.trouble();
    EXPECT_EQ(rig.device.written.size(), 1u) << lost;
  }
}

TEST(StationMailbox, DoesNotTakeAnOldAnswerForItsOwnWhileItsMailIsNotEvenWritten) {
  MailboxRig rig;
  rig.device.full_for = 3;
  rig.device.outbox.push_back(in_mailbox("0A 00 00 00 00 13 00 30 43 18 10 01 11 11 11 11"));
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(ByteVector(rig.client.sdo().begin(), rig.client.sdo().end()), from_hex("43 18 10 01 E1 AD EC 00"));
}

TEST(StationMailbox, LeavesAFullOneTimeToEmpty) {
  MailboxRig rig;
  rig.request();
  ASSERT_TRUE(rig.client.next(rig.now));
  rig.client.answered(0, {}, rig.now);
  const auto status = rig.client.next(rig.now);  // an answer that lies there may be what it waits for
  ASSERT_TRUE(status);
  EXPECT_EQ(status->address, 0x080D);
  rig.client.answered(1, ByteVector{std::byte{0}}, rig.now);
  EXPECT_FALSE(rig.client.next(rig.now));
  EXPECT_EQ(rig.client.next_event(), rig.now + kPollPeriod);
  const auto again = rig.client.next(rig.now + kPollPeriod);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->address, 0x1000);
}

TEST(StationMailbox, WritesALostMailAgainWithTheSameCounter) {
  MailboxRig rig;
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(lose(0x1000, Loss::kReply)), Outcome::kDone);
  ASSERT_EQ(rig.device.written.size(), 2u);
  EXPECT_EQ(rig.device.written[0], rig.device.written[1]);
}

// Once the time to take a mail went on for it, though it may have been there all along: 100 ms in which its answer was
// read and lost, and the way began from INIT.
TEST(StationMailbox, GivesADeviceThatMayHaveTheMailTheTimeToAnswerIt) {
  MailboxRig rig;
  rig.device.one_at_a_time = true;
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  auto write = lose(0x1000, Loss::kReply);
  int reads = 30;
  const auto outcome = rig.run([&](const Access& a) {
    if (a.address == 0x1080 && reads-- > 0) return Loss::kReply;
    return write(a);
  });
  EXPECT_EQ(outcome, Outcome::kDone) << rig.trouble();
  EXPECT_EQ(rig.counters.mailbox_repeats, 30u);
  EXPECT_GT(rig.now, 1s + 100ms);
}

// Of a ring, the copy of a frame that passed no device.
TEST(StationMailbox, AsksForAMailWhoseReadingNobodyCounted) {
  struct OneUncounted {
    MailboxScript& device;
    bool once = true;
    MailboxScript::Answer access(const Access& access) {
      auto answer = device.access(access);
      if (access.address == 0x1080 && std::exchange(once, false)) return {0, ByteVector(access.size)};
      return answer;
    }
  };
  MailboxRig rig;
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  OneUncounted device{rig.device};
  ASSERT_EQ(station_test::run(rig.client, device, rig.now), Outcome::kDone) << rig.trouble();
  EXPECT_EQ(rig.counters.mailbox_repeats, 1u);
  EXPECT_EQ(rig.device.written.size(), 1u);
}

TEST(StationMailbox, TellsWithoutWaitingForAnAnswer) {
  for (const Loss how : {Loss::kNothing, Loss::kRequest, Loss::kReply}) {
    MailboxRig rig;
    rig.client.notify(from_hex("80 00 2F 00 00 00 03 05"), rig.now);
    ASSERT_EQ(rig.run(lose(0x1000, how)), Outcome::kDone);
    EXPECT_EQ(rig.device.written.front(), from_hex("0A 00 00 00 00 13 00 20 80 00 2F 00 00 00 03 05"));
    EXPECT_LT(rig.now, 1s + 100ms);
  }
}

TEST(StationMailbox, AsksForAMailThatWasLostOnItsWayToUs) {
  MailboxRig rig;
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(lose(0x1080, Loss::kReply)), Outcome::kDone);
  EXPECT_EQ(rig.counters.mailbox_repeats, 1u);
  EXPECT_EQ(rig.device.activate, 3);  // enabled, repeat requested; the acknowledge agrees
  EXPECT_EQ(rig.device.pdi, 2);
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(lose(0x1080, Loss::kReply)), Outcome::kDone);
  EXPECT_EQ(rig.device.activate, 1);  // toggled
}

TEST(StationMailbox, ReadsAgainWithoutARepeatWhatStillStandsThere) {
  MailboxRig rig;
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(lose(0x1080, Loss::kRequest)), Outcome::kDone);
  EXPECT_EQ(rig.counters.mailbox_repeats, 0u);
}

TEST(StationMailbox, SurvivesLossesWhileItAsksForARepeat) {
  for (const Loss how : {Loss::kRequest, Loss::kReply}) {
    for (int n = 0; n < 3; ++n) {
      MailboxRig rig;
      rig.device.answers = {{in_mailbox(kReply)}};
      rig.request();
      auto first = lose(0x1080, Loss::kReply), second = lose(0x080E, how, n);
      ASSERT_EQ(rig.run([&](const Access& a) { return a.address == 0x1080 ? first(a) : second(a); }), Outcome::kDone);
      EXPECT_EQ(rig.device.written.size(), 1u);
    }
  }
}

TEST(StationMailbox, GivesUpOnADeviceThatDoesNotRepeat) {
  MailboxRig rig;
  rig.device.repeats = false;
  rig.device.answers = {{in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(lose(0x1080, Loss::kReply)), Outcome::kFailed);
  EXPECT_TRUE(rig.client.reply_lost());
  EXPECT_THAT(rig.trouble(), HasSubstr("does not repeat a mail"));
}

TEST(StationMailbox, PassesOverEmergenciesAndOtherProtocols) {
  MailboxRig rig;
  rig.device.answers = {{in_mailbox(kEmergency), in_mailbox("02 00 00 00 00 12 00 00"),
                         in_mailbox("08 00 00 00 00 13 00 80 02 00 00 00 00 00"), in_mailbox(kReply)}};
  rig.request();
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_EQ(rig.counters.emergencies, 1u);
  ASSERT_TRUE(rig.client.last_emergency());
  EXPECT_EQ(rig.client.last_emergency()->code, 0x8611);
  EXPECT_EQ(rig.client.last_emergency()->error_register, 1);
}

TEST(StationMailbox, PassesOverWhatIsNoMail) {
  for (const std::string_view nonsense :
       {"", "FF FF 00 00 00 13", "00 00 00 00 00 13", "01 00 00 00 00 13 30", "05 00 00 00 00 13 00 10 11 86 01"}) {
    MailboxRig rig;
    rig.device.answers = {{in_mailbox(nonsense), in_mailbox(kReply)}};
    rig.request();
    EXPECT_EQ(rig.run(), Outcome::kDone) << nonsense;
    EXPECT_EQ(rig.counters.emergencies, 0u);
  }
}

TEST(StationMailbox, TellsAMailboxErrorInWords) {
  MailboxRig rig;
  rig.device.answers = {{in_mailbox("04 00 00 00 00 10 01 00 02 00")}};
  rig.request();
  ASSERT_EQ(rig.run(), Outcome::kFailed);
  EXPECT_THAT(rig.trouble(), HasSubstr("mailbox error 0x0002, protocol not supported"));
  EXPECT_FALSE(rig.client.reply_lost());
}

TEST(StationMailbox, IsEmptiedOfWhatIsOldAndCountsEmergencies) {
  MailboxRig rig;
  rig.device.outbox = {in_mailbox(kReply), in_mailbox(kEmergency), in_mailbox("04 00 00 00 00 10 01 00 02 00")};
  rig.client.drain(rig.now);
  ASSERT_EQ(rig.run(), Outcome::kDone);
  EXPECT_TRUE(rig.device.outbox.empty());
  EXPECT_EQ(rig.counters.emergencies, 1u);
}

TEST(StationMailbox, IsEmptiedWithoutRepeats) {
  MailboxRig rig;
  rig.device.outbox = {in_mailbox(kReply)};
  rig.client.drain(rig.now);
  ASSERT_EQ(rig.run(lose(0x1080, Loss::kReply)), Outcome::kDone);
  EXPECT_EQ(rig.counters.mailbox_repeats, 0u);
}

TEST(StationMailbox, ThatIsNeverEmptyIsATrouble) {
  MailboxRig rig;
  rig.device.outbox.resize(100'000, in_mailbox(kEmergency));
  rig.client.drain(rig.now);
  ASSERT_EQ(rig.run(), Outcome::kFailed);
  EXPECT_THAT(rig.trouble(), HasSubstr("ever more mails"));
}

}  // namespace
}  // namespace meca::ethercat::station_test
