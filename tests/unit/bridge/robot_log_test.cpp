// What is worth a line in the log, and how often.
#include "bridge/robot_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using transports::LinkState;

CycleRecord good() {
  CycleRecord record;
  record.link = LinkState::kUp;
  record.quality = Quality::kGood;
  return record;
}

template <typename Facts>
std::vector<std::string> said(RobotLog& log, const Facts& facts, Time now) {
  std::vector<LogLine> lines;
  log.look(facts, now, lines);
  std::vector<std::string> texts;
  for (const auto& line : lines) texts.push_back(line.text);
  return texts;
}

TEST(RobotLog, TheLinkIsTalkedAboutWhenItChanges) {
  RobotLog log("arm1");
  CycleRecord down;
  down.link_detail = "no reply";
  EXPECT_THAT(said(log, down, 0s), ElementsAre("arm1: no link yet: no reply"));
  EXPECT_THAT(said(log, down, 1s), IsEmpty());
  EXPECT_THAT(said(log, good(), 2s), ElementsAre("arm1: link up"));
  EXPECT_THAT(said(log, good(), 3s), IsEmpty());
  EXPECT_THAT(said(log, down, 4s), ElementsAre("arm1: link down: no reply"));
}

TEST(RobotLog, ALinkThatIsNotAsItWasAskedForComesUpWithARemark) {
  RobotLog log("arm1");
  CycleRecord up = good();
  up.link_detail = "another interval";
  EXPECT_THAT(said(log, up, 0s), ElementsAre("arm1: link up: another interval"));
}

TEST(RobotLog, ALinkThatIsUpButLacksSomethingIsToldOnceAndSoIsThatItIsSoundAgain) {
  RobotLog log("arm1");
  CycleRecord record = good();
  said(log, record, 0s);
  record.link_detail = "the ring is open";
  EXPECT_THAT(said(log, record, 1s), ElementsAre("arm1: link up, but: the ring is open"));
  EXPECT_THAT(said(log, record, 60s), IsEmpty());
  record.link_detail = {};
  EXPECT_THAT(said(log, record, 61s), ElementsAre("arm1: link up, as it should be"));
  record.link_detail = "the ring is open";
  EXPECT_THAT(said(log, record, 62s), ElementsAre("arm1: link up, but: the ring is open"));
}

TEST(RobotLog, ALinkThatFlapsIsCountedAndNotRepeated) {
  RobotLog log("arm1");
  CycleRecord down;
  said(log, good(), 0s);
  EXPECT_THAT(said(log, down, 1s), ElementsAre("arm1: link down"));
  for (int i = 0; i < 3; ++i) {
    EXPECT_THAT(said(log, good(), 2s), IsEmpty());
    EXPECT_THAT(said(log, down, 2s), IsEmpty());
  }
  said(log, good(), 20s);
  EXPECT_THAT(said(log, down, 20s), ElementsAre("arm1: link down (3 more of this kind since the last line)"));
}

TEST(RobotLog, ALinkThatStaysUpAfterItFlappedIsSaidToBeUpWhenTheQuietTimeIsOver) {
  RobotLog log("arm1");
  CycleRecord down;
  said(log, good(), 0s);
  EXPECT_THAT(said(log, down, 1s), ElementsAre("arm1: link down"));
  EXPECT_THAT(said(log, good(), 2s), IsEmpty());
  EXPECT_THAT(said(log, good(), 9s), IsEmpty());
  EXPECT_THAT(said(log, good(), 10s), ElementsAre("arm1: link up (1 more of this kind since the last line)"));
  EXPECT_THAT(said(log, good(), 30s), IsEmpty());
}

TEST(RobotLog, AnotherReasonWhyThereIsNoLinkIsSaidOnce) {
  RobotLog log("arm1");
  CycleRecord down;
  EXPECT_THAT(said(log, down, 0s), ElementsAre("arm1: no link yet"));
  down.link_detail = "Forward Open refused: another controller owns the outputs";
  EXPECT_THAT(said(log, down, 1s),
              ElementsAre("arm1: no link: Forward Open refused: another controller owns the outputs"));
  EXPECT_THAT(said(log, down, 2s), IsEmpty());
  down.link_detail = "no answer";
  EXPECT_THAT(said(log, down, 3s), IsEmpty());  // not a line for every attempt
  EXPECT_THAT(said(log, down, 11s), ElementsAre("arm1: no link: no answer"));
}

TEST(RobotLog, WhatHappensOnTheWayUpIsNoReasonWhyThereIsNoLink) {
  RobotLog log("arm1");
  CycleRecord record;
  EXPECT_THAT(said(log, record, 0s), ElementsAre("arm1: no link yet"));
  record.link = transports::LinkState::kConnecting;
  record.link_detail = "is being brought to SAFEOP";
  EXPECT_THAT(said(log, record, 1s), IsEmpty());
  record.link = transports::LinkState::kDown;
  record.link_detail = "refuses SAFEOP: invalid output mapping";
  EXPECT_THAT(said(log, record, 2s), ElementsAre("arm1: no link: refuses SAFEOP: invalid output mapping"));
}

TEST(RobotLog, ThatTheBridgeStopsIsSaidOfNoRobotButWhoHadControlLostIt) {
  RobotLog log("arm1");
  CycleRecord record = good();
  record.control.owned = true;
  record.control.owner = "cell-plc";
  said(log, record, 0s);
  record.link = LinkState::kDown;
  record.link_detail = "the bridge has stopped";
  record.closing = true;
  record.control.owned = false;
  record.control.owner = {};
  record.control.last_loss = control::ControlState::Loss::kShutdown;
  EXPECT_THAT(said(log, record, 60s), ElementsAre("arm1: cell-plc lost control: the bridge is stopping"));
}

TEST(RobotLog, FirmwareIsNamedOnceAndAMismatchIsAnError) {
  RobotLog log("arm1");
  auto record = good();
  said(log, record, 0s);
  record.firmware_known = true;
  record.firmware = {11, 3, 3, 12637};
  EXPECT_THAT(said(log, record, 1s), ElementsAre("arm1: firmware 11.3.3.12637"));
  EXPECT_THAT(said(log, record, 2s), IsEmpty());
  record.firmware_mismatch = true;
  std::vector<LogLine> lines;
  log.look(record, 3s, lines);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].level, LogLine::Level::kError);
}

TEST(RobotLog, OwnersComeAndGoByName) {
  RobotLog log("arm1");
  auto record = good();
  said(log, record, 0s);
  record.control.owned = true;
  record.control.owner = std::string_view("plc");
  record.control.lease_ms = 100;
  EXPECT_THAT(said(log, record, 1s), ElementsAre("arm1: plc has control"));
  record.control.owned = false;
  record.control.owner = {};
  record.control.last_loss = control::ControlState::Loss::kLeaseExpired;
  EXPECT_THAT(said(log, record, 1s), ElementsAre("arm1: plc lost control: its lease was not renewed for 100 ms"));
}

TEST(RobotLog, ATakeOverIsToldFromItsAnnouncementToItsEnd) {
  RobotLog log("arm1");
  auto record = good();
  record.control.owned = true;
  record.control.owner = std::string_view("plc");
  said(log, record, 0s);
  record.control.contender = std::string_view("supervisor");
  record.control.contender_priority = 10;
  EXPECT_THAT(said(log, record, 1s), ElementsAre("arm1: supervisor (priority 10) takes over from plc"));
  EXPECT_THAT(said(log, record, 1s), IsEmpty());
  record.control.owner = record.control.contender;
  record.control.contender = {};
  record.control.last_loss = control::ControlState::Loss::kTakenOver;
  EXPECT_THAT(said(log, record, 30s),
              ElementsAre("arm1: plc lost control: supervisor took over", "arm1: supervisor has control"));
}

TEST(RobotLog, ARobotErrorComesWithItsNameAndRemedy) {
  RobotLog log("arm1");
  auto record = good();
  said(log, record, 0s);
  record.inputs.robot_status.error_code = 1011;
  EXPECT_THAT(said(log, record, 1s), ElementsAre(HasSubstr("arm1: error 1011 ")));
  EXPECT_THAT(said(log, record, 2s), IsEmpty());
  record.inputs.robot_status.error_code = 0;
  EXPECT_THAT(said(log, record, 3s), ElementsAre("arm1: the error is gone"));
}

TEST(RobotLog, OldValuesAreNoNews) {
  RobotLog log("arm1");
  auto record = good();
  said(log, record, 0s);
  record.quality = Quality::kStale;
  record.inputs.robot_status.error_code = 1011;
  EXPECT_THAT(said(log, record, 1s), IsEmpty());
}

TEST(RobotLog, WithoutASafetySectionNothingIsSaidAboutStops) {
  RobotLog log("arm1");
  auto record = good();
  said(log, record, 0s);
  record.inputs.safety_status.stop.p_stop2 = true;
  EXPECT_THAT(said(log, record, 1s), IsEmpty());  // known is false: firmware 9
  record.inputs.safety_status.known = true;
  EXPECT_THAT(said(log, record, 2s), ElementsAre(HasSubstr("safety stop")));
}

TEST(RobotLog, CountersThatRiseAreToldWithTheirTotal) {
  RobotLog log("arm1");
  EXPECT_THAT(said(log, LogFacts{}, 0s), IsEmpty());
  EXPECT_THAT(said(log, LogFacts{.refused_writes = 3}, 1s),
              ElementsAre("arm1: samples refused by DDS: 3, 3 since the start"));
  EXPECT_THAT(said(log, LogFacts{.refused_writes = 3}, 30s), IsEmpty());
  EXPECT_THAT(
      said(log, LogFacts{.receipts_lost = 1, .refused_writes = 5}, 60s),
      ElementsAre("arm1: lost receipts: 1, 1 since the start", "arm1: samples refused by DDS: 2, 5 since the start"));
}

TEST(RobotLog, WhatACounterCountedInTheQuietTimeIsToldAfterIt) {
  RobotLog log("arm1");
  said(log, LogFacts{.records_dropped = 1}, 0s);
  EXPECT_THAT(said(log, LogFacts{.records_dropped = 250}, 1s), IsEmpty());
  EXPECT_THAT(said(log, LogFacts{.records_dropped = 250}, 10s), ElementsAre(HasSubstr(": 249, 250 since the start")));
}

}  // namespace
}  // namespace meca::bridge
