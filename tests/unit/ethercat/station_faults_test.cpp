// What goes wrong on the way up and in operation, what the station does about it, and what it says.
#include <gmock/gmock.h>

#include "tests/unit/ethercat/station_rig.hpp"

namespace meca::ethercat::station_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::uint16_t kWatchdogCode = 0x001B;

// ---- In operation

TEST(StationRecovery, FromTheWatchdogNeedsNoNewConfiguration) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  const std::size_t mails = rig.device.mails.size();
  rig.device.al_requests.clear();
  rig.device.set_status(0x14, kWatchdogCode);
  ASSERT_TRUE(rig.run_until(Phase::kRecovering));
  EXPECT_THAT(rig.trouble(), AllOf(StartsWith("the robot at position 0 went to SAFEOP with an error"),
                                   HasSubstr("AL status code 0x001B, sync manager watchdog")));
  EXPECT_TRUE(rig.station.wants_process_data());
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
  EXPECT_THAT(rig.device.al_requests, ElementsAre(0x14, 0x08));
  EXPECT_EQ(rig.device.mails.size(), mails);
  EXPECT_EQ(rig.station.counters().al_errors, 1u);
  EXPECT_EQ(rig.station.counters().operational, 2u);
  EXPECT_EQ(rig.trouble(), "");
}

TEST(StationRecovery, FromSafeopWithoutErrorNeedsNoAcknowledge) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.device.al_requests.clear();
  rig.device.set_status(0x04, 0);
  ASSERT_TRUE(rig.run_until(Phase::kRecovering));
  EXPECT_THAT(rig.trouble(), HasSubstr("went to SAFEOP by itself"));
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
  EXPECT_THAT(rig.device.al_requests, ElementsAre(0x08));
  EXPECT_EQ(rig.station.counters().al_errors, 0u);
}

TEST(StationRecovery, FromAnErrorInOpOnlyAcknowledges) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.device.al_requests.clear();
  rig.device.set_status(0x18, 0x001A);
  ASSERT_TRUE(rig.run_until(Phase::kRecovering));
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
  EXPECT_THAT(rig.device.al_requests, ElementsAre(0x18));
}

TEST(StationRecovery, OfARobotThatWasSwitchedOffAndOnIsAWholeWayUp) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.run(6s);
  rig.device.power_cycle();
  ASSERT_TRUE(rig.run_until(Phase::kInit));
  EXPECT_THAT(rig.trouble(), HasSubstr("went to INIT by itself: it was restarted, or another master is at work"));
  rig.device.dictionary.written.clear();
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
  EXPECT_EQ(rig.device.dictionary.written.size(), 28u);
}

TEST(StationRecovery, OfARobotThatIsSwitchedOffAllTheTimeIsPaced) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.run(1s);
  rig.device.power_cycle();
  ASSERT_TRUE(rig.run_until(Phase::kPausing, 100ms));
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
}

TEST(StationRecovery, BecomesTheLongWayWithPausesWhenErrorsDoNotEnd) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  for (int i = 0; i < 3; ++i) {
    rig.device.set_status(0x14, kWatchdogCode);
    ASSERT_TRUE(rig.run_until(Phase::kRecovering)) << i;
    ASSERT_TRUE(rig.run_until(Phase::kOperational)) << i;
  }
  rig.device.set_status(0x14, kWatchdogCode);
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
}

TEST(StationRecovery, IsQuickAgainAfterAQuietTime) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  for (int i = 0; i < 10; ++i) {
    rig.run(6s);
    rig.device.set_status(0x14, kWatchdogCode);
    ASSERT_TRUE(rig.run_until(Phase::kRecovering)) << i;
    ASSERT_TRUE(rig.run_until(Phase::kOperational)) << i;
  }
}

TEST(StationRecovery, OfARobotThatRefusesOpBeginsAgainFromInit) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.device.refuse[AlState::kOp] = 0x002D;
  rig.device.set_status(0x14, 0x001A);
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("refuses OP: AL status code 0x002D"));
  rig.device.refuse.clear();
  ASSERT_TRUE(rig.run_until(Phase::kInit));
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
}

// ---- On the way up

TEST(StationRefusal, OfAStateIsToldWithItsCodeInWords) {
  StationRig rig;
  rig.device.refuse[AlState::kSafeop] = 0x0025;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), AllOf(StartsWith("the robot at position 0 refuses SAFEOP: AL status code 0x0025"),
                                   HasSubstr("invalid output mapping")));
}

TEST(StationRefusal, MakesThePausesGrowUpToALimit) {
  StationRig rig;
  rig.device.refuse[AlState::kPreop] = 0x0016;
  rig.find();
  std::vector<Time> pauses;
  for (int i = 0; i < 7; ++i) {
    ASSERT_TRUE(rig.run_until(Phase::kPausing));
    const Time began = rig.now;
    ASSERT_TRUE(rig.run_until(Phase::kInit));
    pauses.push_back(std::chrono::round<std::chrono::milliseconds>(rig.now - began));
  }
  EXPECT_THAT(pauses, ElementsAre(200ms, 400ms, 800ms, 1600ms, 3200ms, 5s, 5s));
}

TEST(StationRefusal, EndsWhenTheReasonDoes) {
  StationRig rig;
  rig.device.refuse[AlState::kPreop] = 0x0016;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  rig.device.refuse.clear();
  ASSERT_TRUE(rig.run_until(Phase::kOperational));
  EXPECT_EQ(rig.trouble(), "");
}

TEST(StationRefusal, OfTheAssignmentIsToldWithObjectAndAbortCode) {
  StationRig rig;
  rig.device.dictionary.refuse_write[Dictionary::key(0x1C12, 3)] = 0x06010002;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("refuses to have object 0x1C12:03 written: abort 0x06010002"));
}

TEST(StationCheck, SeesAnAssignmentThatIsNotKept) {
  StationRig rig;
  rig.device.dictionary.set(0x1C12, 1, le(0, 2));  // as a real one was seen
  rig.device.dictionary.not_kept = {Dictionary::key(0x1C12, 1)};
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("keeps PDO 0x0000 in its assignment 0x1C12:01 where 0x1600 was written"));
}

TEST(StationCheck, SeesAnAssignmentOfAnotherLength) {
  StationRig rig;
  rig.device.dictionary.set(0x1C13, 0, le(11, 1));
  rig.device.dictionary.not_kept = {Dictionary::key(0x1C13, 0)};
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("keeps 11 PDOs in its assignment 0x1C13, 13 were written"));
}

TEST(StationCheck, NamesThePdoThatHasAnotherSize) {
  StationRig rig;
  rig.device.dictionary.set(0x1A03, 1, le(0x60310110, 4));
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), AllOf(HasSubstr("maps 2000 bits of inputs, 2016 expected"), HasSubstr("PDO 0x1A03 has")));
}

TEST(StationCheck, AcceptsAGapThatIsCountedToAnotherPdo) {
  StationRig rig(usual_settings(), image::Layout::kFirmware9);
  const auto count = static_cast<std::uint8_t>(rig.device.dictionary.number(0x1A10, 0));
  rig.device.dictionary.set(0x1A10, 0, le(count - 1U, 1));
  const auto gap = rig.device.dictionary.number(0x1A10, count);
  const auto next = static_cast<std::uint8_t>(rig.device.dictionary.number(0x1A20, 0) + 1);
  rig.device.dictionary.set(0x1A20, 0, le(next, 1));
  rig.device.dictionary.set(0x1A20, next, le(gap, 4));
  ASSERT_TRUE(rig.climbs());
}

TEST(StationTimeout, OfASilentRobotSaysSo) {
  StationRig rig;
  rig.wire.loses = [](std::size_t, const Access&) { return Wire::Loss::kReply; };
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("does not answer; check its power and the cables to it"));
}

TEST(StationTimeout, OfAStationThatNobodyCountsIsTheSame) {
  StationRig rig;
  rig.device.powered = false;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("does not answer; check its power and the cables to it"));
}

TEST(StationTimeout, OfAMailboxThatStaysFullSaysSo) {
  StationRig rig;
  rig.device.takes_mails = false;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("does not take a mail out of its mailbox within 100 ms"));
}

TEST(StationTimeout, OfAnSdoSaysSo) {
  StationRig rig;
  rig.device.answers_mails = false;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("does not answer an SDO within 2000 ms"));
}

TEST(StationTimeout, OfProcessDataThatDoesNotComeBackSaysSo) {
  StationRig rig;
  rig.process_data = false;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kPausing));
  EXPECT_THAT(rig.trouble(), HasSubstr("gets no process data back complete"));
}

TEST(StationTimeout, LeavesNoAnswerToBeTakenForAnother) {
  StationRig rig;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kConfiguring));
  const auto asked = rig.station.next(rig.now += 1ms);
  ASSERT_TRUE(asked);
  rig.station.al_status(0x11, 0x0016, rig.now);  // it fell back: everything begins again
  ASSERT_EQ(rig.station.phase(), Phase::kPausing);
  rig.station.tick(rig.now += 300ms);
  ASSERT_EQ(rig.station.phase(), Phase::kInit);
  rig.station.close(rig.now);
  const auto wanted = rig.station.next(rig.now);
  ASSERT_TRUE(wanted);
  EXPECT_EQ(wanted->address, reg::kAlControl);
}

TEST(StationTimeout, HoldsBackWhileAnAnswerToSomethingElseIsUnderWay) {
  StationRig rig;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kConfiguring));
  ASSERT_TRUE(rig.station.next(rig.now += 1ms));
  rig.station.close(rig.now);
  EXPECT_FALSE(rig.station.next(rig.now));
  rig.station.answered(1, ByteVector(128), rig.now);
  const auto wanted = rig.station.next(rig.now);
  ASSERT_TRUE(wanted);
  EXPECT_EQ(wanted->address, reg::kAlControl);
}

// ---- Coming and going

TEST(StationPresence, OfTheSameRobotChangesNothing) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.find();
  EXPECT_EQ(rig.station.phase(), Phase::kOperational);
}

TEST(StationPresence, LostAndFoundIsAWholeWayUp) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.station.absent("not in the chain: 0 of 1 devices answer", rig.now);
  EXPECT_EQ(rig.station.phase(), Phase::kAbsent);
  EXPECT_EQ(rig.trouble(), "not in the chain: 0 of 1 devices answer");
  EXPECT_FALSE(rig.station.wants_process_data());
  EXPECT_EQ(rig.station.firmware(), transports::FirmwareVersion{});
  EXPECT_EQ(rig.station.next_event(), Time::max());
  ASSERT_TRUE(rig.climbs());
  EXPECT_EQ(rig.station.counters().operational, 2u);
}

TEST(StationPresence, UnderAnotherAddressIsAWholeWayUp) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.station.found(0x1002, StationRig::kIdentity, rig.now);
  EXPECT_EQ(rig.station.phase(), Phase::kInit);
  EXPECT_EQ(rig.station.station_address(), 0x1002);
}

TEST(StationClose, BringsTheRobotToInitAndIsForEver) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.station.close(rig.now);
  ASSERT_TRUE(rig.run_until(Phase::kClosed));
  EXPECT_EQ(rig.device.status(), 1);
  rig.find();
  rig.run(1s);
  EXPECT_EQ(rig.station.phase(), Phase::kClosed);
  EXPECT_EQ(rig.station.next_event(), Time::max());
}

TEST(StationClose, OfASilentRobotEndsAllTheSame) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.device.powered = false;
  rig.station.close(rig.now);
  ASSERT_TRUE(rig.run_until(Phase::kClosed));
}

TEST(StationClose, OfAnAbsentRobotEndsAtOnce) {
  StationRig rig;
  rig.station.close(rig.now);
  EXPECT_EQ(rig.station.phase(), Phase::kClosed);
}

// ---- Emergencies

TEST(StationEmergency, BetweenRequestAndAnswerIsCountedAndDoesNoHarm) {
  StationRig rig;
  rig.find();
  ASSERT_TRUE(rig.run_until(Phase::kConfiguring));
  rig.device.post_emergency(0x8611);
  rig.run(10ms);
  rig.device.post_emergency(0x8612);
  ASSERT_TRUE(rig.run_until(Phase::kOperational)) << rig.trouble();
  EXPECT_EQ(rig.station.counters().emergencies, 2u);
  ASSERT_TRUE(rig.station.last_emergency());
  EXPECT_EQ(rig.station.last_emergency()->code, 0x8612);
}

TEST(StationEmergency, InOpIsFoundInTheMailbox) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.device.post_emergency(0xFF01);
  rig.run(1s);
  EXPECT_EQ(rig.station.counters().emergencies, 1u);
  EXPECT_TRUE(rig.station.operational());
}

TEST(StationEmergency, CannotBeLookedForWhenTheRobotIsGoneAndThatIsNoFaultOfItsOwn) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.device.powered = false;
  rig.run(10s);
  EXPECT_EQ(rig.station.phase(), Phase::kOperational);  // that it is gone is the master's to say
}

TEST(StationEmergency, IsLookedForAnewAfterAnAnswerThatNeverCame) {
  StationRig rig;
  ASSERT_TRUE(rig.climbs());
  rig.station.tick(rig.now += 1s);
  ASSERT_TRUE(rig.station.next(rig.now));
  rig.station.tick(rig.now += 3s);  // the master has not said what became of it
  EXPECT_FALSE(rig.station.next(rig.now));
  rig.station.lost(rig.now);
  rig.device.post_emergency(0xFF01);
  rig.run(1s);
  EXPECT_EQ(rig.station.counters().emergencies, 1u);
}

// ---- Nonsense

// One reply of the way up comes back with one byte turned over, or cut off there. Whatever it was, the station gets to
// OP in the end.
TEST(StationNonsense, InAnySingleReplyDoesNotKeepItFromOp) {
  StationRig good;
  ASSERT_TRUE(good.climbs());
  for (std::size_t k = 0; k < good.wire.log.size(); ++k) {
    const Access asked = good.wire.log[k];
    if (asked.write) continue;
    for (std::size_t byte = 0; byte < std::min<std::size_t>(asked.size, 24); ++byte) {
      for (const bool cut : {false, true}) {
        StationRig rig;
        rig.spoil = {k, byte, cut};
        ASSERT_TRUE(rig.climbs(60s)) << "access " << k << " byte " << byte << (cut ? " cut" : "");
      }
    }
  }
}

}  // namespace
}  // namespace meca::ethercat::station_test
