// Mails of the device through the sync managers: counters, repetition, what it says to mails that make no sense.
#include "tests/unit/ethercat/device_rig.hpp"

namespace meca::ethercat::device_test {
namespace {

constexpr const char* kHardwareVersion = "00 20 40 09 10 00 00 00 00 00";
constexpr const char* kItIs3 = "00 30 4F 09 10 00 33 00 00 00";

TEST(DeviceMailbox, AnswersAfterItsTime) {
  DeviceSettings settings = meca500();
  settings.mailbox_reply = 28ms;  // the slowest of a real robot
  DeviceRig robot(settings);
  robot.to_preop();
  EXPECT_EQ(robot.post(kHardwareVersion), 1u);
  robot.run(27ms);
  EXPECT_EQ(robot.fetch(), "empty");
  robot.run(2ms);
  EXPECT_EQ(robot.fetch(), std::string("3 1: ") + kItIs3);
  EXPECT_EQ(robot.fetch(), "empty");
}

TEST(DeviceMailbox, CountsItsOwnMailsFrom1To7) {
  DeviceRig robot;
  robot.to_preop();
  for (const int expected : {1, 2, 3, 4, 5, 6, 7, 1}) {
    robot.post(kHardwareVersion);
    robot.run(5ms);
    EXPECT_EQ(robot.fetch(), "3 " + std::to_string(expected) + ": " + kItIs3);
  }
}

TEST(DeviceMailbox, DropsAMailThatComesTwice) {
  DeviceRig robot;
  robot.to_preop();
  robot.post(kHardwareVersion, 3);
  robot.run(5ms);
  robot.fetch();
  robot.post(kHardwareVersion, 3);
  robot.run(5ms);
  EXPECT_EQ(robot.fetch(), "empty");
  EXPECT_EQ(robot.device.counters().duplicate_mails, 1u);
  EXPECT_EQ(robot.device.counters().mails, 1u);
}

TEST(DeviceMailbox, DoesNotCountWhereTheMasterDoesNot) {
  DeviceRig robot;
  robot.to_preop();
  for (int i = 0; i < 2; ++i) {
    robot.post(kHardwareVersion, 0);
    robot.run(5ms);
    EXPECT_THAT(robot.fetch(), testing::EndsWith(kItIs3));
  }
}

TEST(DeviceMailbox, PutsTheLastMailAgainOnRequest) {
  DeviceRig robot;
  robot.to_preop();
  robot.post(kHardwareVersion);
  robot.run(5ms);
  const std::string lost = robot.fetch();  // imagine the frame did not come back
  robot.write(reg::sync_manager(1) + 6, "03");
  robot.run(2ms);
  EXPECT_EQ(robot.read(reg::sync_manager(1) + 7, 1), "02");
  EXPECT_EQ(robot.fetch(), lost);
  robot.write(reg::sync_manager(1) + 6, "01");
  robot.run(2ms);
  EXPECT_EQ(robot.read(reg::sync_manager(1) + 7, 1), "00");
  EXPECT_EQ(robot.fetch(), lost);
}

TEST(DeviceMailbox, PutsTheLostMailBehindOneThatCameMeanwhile) {
  DeviceRig robot;
  robot.to_preop();
  robot.post(kHardwareVersion);
  robot.run(5ms);
  const std::string lost = robot.fetch();
  robot.device.send_emergency({.code = 0x1234, .error_register = 1});
  robot.run(2ms);
  robot.write(reg::sync_manager(1) + 6, "03");
  robot.run(2ms);
  EXPECT_EQ(robot.read(reg::sync_manager(1) + 7, 1), "02");
  EXPECT_EQ(robot.fetch(), "3 2: 00 10 34 12 01 00 00 00 00 00");
  robot.run(2ms);
  EXPECT_EQ(robot.fetch(), lost);
  robot.run(2ms);
  EXPECT_EQ(robot.fetch(), "empty");
}

TEST(DeviceMailbox, RepeatsNothingBeforeTheFirstMail) {
  DeviceRig robot;
  robot.to_preop();
  robot.write(reg::sync_manager(1) + 6, "03");
  robot.run(2ms);
  EXPECT_EQ(robot.read(reg::sync_manager(1) + 7, 1), "02");
  EXPECT_EQ(robot.fetch(), "empty");
}

TEST(DeviceMailbox, KeepsTheNextMailUntilTheAnswerIsRead) {
  DeviceRig robot;
  robot.to_preop();
  robot.post(kHardwareVersion);
  robot.run(5ms);
  EXPECT_EQ(robot.device.counters().strict, 0u);
  EXPECT_EQ(robot.post("00 20 40 01 10 00 00 00 00 00"), 1u);
  robot.run(5ms);
  EXPECT_EQ(robot.post("00 20 40 01 10 00 00 00 00 00"), 0u) << "the mailbox is full";
  EXPECT_EQ(robot.device.counters().strict, 1u) << "a reply lay unread";
  EXPECT_THAT(robot.fetch(), testing::EndsWith(kItIs3));
  robot.run(5ms);
  EXPECT_THAT(robot.fetch(), testing::EndsWith("4F 01 10 00 00 00 00 00"));
}

TEST(DeviceMailbox, KnowsCoeOnly) {
  DeviceRig robot;
  robot.to_preop();
  for (const auto type :
       {MailboxType::kAoe, MailboxType::kEoe, MailboxType::kFoe, MailboxType::kSoe, MailboxType::kVoe}) {
    robot.post("00 00", std::nullopt, type);
    robot.run(5ms);
    EXPECT_THAT(robot.fetch(), testing::EndsWith(": 01 00 02 00"));
  }
}

TEST(DeviceMailbox, SaysWhatIsWrongWithAMail) {
  DeviceRig robot;
  robot.to_preop();
  robot.post("00 20 40");
  robot.run(5ms);
  EXPECT_EQ(robot.fetch(), "0 1: 01 00 06 00") << "too short";
  std::array<std::byte, kMailboxSize> mail{};
  mail[0] = std::byte{123};  // one more than fits
  robot.write(kSyncManagers[0].start, mail);
  robot.run(5ms);
  EXPECT_EQ(robot.fetch(), "0 2: 01 00 08 00") << "invalid size";
}

TEST(DeviceMailbox, SendsListsInSeveralMails) {
  DeviceRig robot;
  robot.to_preop();
  robot.post("00 80 01 00 00 00 01 00");
  robot.run(5ms);
  EXPECT_THAT(robot.fetch(), testing::StartsWith("3 1: 00 80 82 00 01 00 01 00 00 10"));
  robot.run(2ms);
  EXPECT_THAT(robot.fetch(), testing::StartsWith("3 2: 00 80 02 00 00 00 21 74"));
  robot.run(2ms);
  EXPECT_EQ(robot.fetch(), "empty");
}

TEST(DeviceMailbox, ServesSdosInOpBetweenTheCycles) {
  DeviceRig robot;
  robot.to_op();
  robot.post(kHardwareVersion);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(robot.cycle(), 3u);
  EXPECT_THAT(robot.fetch(), testing::EndsWith(kItIs3));
}

TEST(DeviceMailbox, CanGoSilentOnRequest) {
  DeviceRig robot;
  robot.to_preop();
  robot.device.faults().no_mailbox = true;
  EXPECT_EQ(robot.post(kHardwareVersion), 1u);
  robot.run(100ms);
  EXPECT_EQ(robot.fetch(), "empty");
}

TEST(DeviceEmergency, ComesWithAnAlError) {
  DeviceRig robot;
  robot.to_op();
  robot.run(200ms);
  ASSERT_EQ(robot.al(), "SAFEOP+001B");
  EXPECT_THAT(robot.fetch(), testing::EndsWith(": 00 10 01 A0 10 1B 00 00 00 00"));
  EXPECT_EQ(robot.sdo("00 20 40 01 10 00 00 00 00 00"), "00 30 4F 01 10 00 10 00 00 00");
  ASSERT_EQ(robot.ask(0x14), "SAFEOP");
  EXPECT_EQ(robot.sdo("00 20 40 01 10 00 00 00 00 00"), "00 30 4F 01 10 00 00 00 00 00");
}

TEST(DeviceEmergency, ComesBetweenRequestAndAnswer) {
  DeviceRig robot;
  robot.to_preop();
  robot.device.send_emergency({.code = 0x1234, .error_register = 1});
  robot.post(kHardwareVersion);
  robot.run(5ms);
  EXPECT_EQ(robot.fetch(), "3 1: 00 10 34 12 01 00 00 00 00 00");
  robot.run(5ms);
  EXPECT_EQ(robot.fetch(), std::string("3 2: ") + kItIs3);
}

}  // namespace
}  // namespace meca::ethercat::device_test
