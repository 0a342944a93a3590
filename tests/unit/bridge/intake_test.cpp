// Sorting samples into inboxes: nothing is lost without a word.
#include "bridge/intake.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <variant>

namespace meca::bridge {
namespace {

using control::Reason;

class SorterTest : public testing::Test {
 protected:
  meca500::Command command(const char* robot, std::uint64_t id = 1) {
    meca500::Command sample;
    sample.robot(robot);
    sample.client("plc");
    sample.command_id(id);
    sample.kind(meca500::CommandKind::HOME);
    return sample;
  }

  RobotChannel arm1_{"arm1"}, arm2_{"arm2"};
  SpscQueue<ReaderEvent> events_{4};
  Sorter sorter_{{&arm1_, &arm2_}, events_};
  control::ParticipantId somebody_{};
};

TEST_F(SorterTest, ACommandGoesToTheInboxOfItsRobotAlone) {
  EXPECT_TRUE(sorter_.sort(command("arm2", 7), somebody_, 0));
  EXPECT_EQ(arm1_.inbox.front(), nullptr);
  ASSERT_NE(arm2_.inbox.front(), nullptr);
  EXPECT_EQ(std::get<control::CommandRequest>(*arm2_.inbox.front()).command_id, 7U);
  EXPECT_EQ(events_.front(), nullptr);
}

TEST_F(SorterTest, ACommandForAnUnknownRobotIsAnsweredUnderTheNameItWasSentTo) {
  EXPECT_TRUE(sorter_.sort(command("arm3", 7), somebody_, 99));
  const ReaderEvent* event = events_.front();
  ASSERT_NE(event, nullptr);
  EXPECT_TRUE(event->has_receipt);
  EXPECT_EQ(event->robot.view(), "arm3");
  EXPECT_EQ(event->receipt.command_id, 7U);
  EXPECT_EQ(event->receipt.state, control::ReceiptState::kRejected);
  EXPECT_EQ(event->text.view(), "no robot 'arm3' here; this bridge has arm1, arm2");
  EXPECT_THAT(std::string(event->log_line.view()), testing::StartsWith("command of 'plc' rejected: no robot 'arm3'"));
  EXPECT_EQ(event->unix_ns, 99);
}

TEST_F(SorterTest, ANameWithTerminalCodesNeverReachesTheLog) {
  EXPECT_TRUE(sorter_.sort(command("\x1b[2J"), somebody_, 0));
  ASSERT_NE(events_.front(), nullptr);
  EXPECT_THAT(std::string(events_.front()->log_line.view()), testing::Not(testing::HasSubstr("\x1b")));
}

TEST_F(SorterTest, AFullInboxIsAnsweredWithQueueFull) {
  for (std::size_t i = 0; i < arm1_.inbox.capacity(); ++i) EXPECT_TRUE(sorter_.sort(command("arm1"), somebody_, 0));
  EXPECT_EQ(events_.front(), nullptr);
  EXPECT_TRUE(sorter_.sort(command("arm1", 1000), somebody_, 0));
  ASSERT_NE(events_.front(), nullptr);
  EXPECT_EQ(events_.front()->receipt.reason, Reason::kQueueFull);
  EXPECT_EQ(events_.front()->receipt.command_id, 1000U);
}

TEST_F(SorterTest, WithoutRoomForTheAnswerTheCommandIsToBeTriedAgain) {
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(sorter_.sort(command("arm3"), somebody_, 0));
  EXPECT_FALSE(sorter_.sort(command("arm3"), somebody_, 0));
  events_.pop();
  EXPECT_TRUE(sorter_.sort(command("arm3"), somebody_, 0));
}

TEST_F(SorterTest, AStreamForAnUnknownRobotIsComplainedAboutOnce) {
  meca500::ControlLease lease;
  lease.robot("arm3");
  lease.client("plc");
  for (int i = 0; i < 100; ++i) sorter_.sort(lease, somebody_);
  ASSERT_NE(events_.front(), nullptr);
  EXPECT_FALSE(events_.front()->has_receipt);
  EXPECT_EQ(events_.front()->log_line.view(), "ControlLease ignored: no robot 'arm3' here; this bridge has arm1, arm2");
  EXPECT_EQ(events_.size(), 1U);
}

TEST_F(SorterTest, VelocityAndLeaseGoToTheInboxOfTheirRobot) {
  meca500::VelocityCommand velocity;
  velocity.robot("arm1");
  velocity.client("plc");
  sorter_.sort(velocity, somebody_);
  meca500::ControlLease lease;
  lease.robot("arm2");
  lease.client("plc");
  sorter_.sort(lease, somebody_);
  ASSERT_NE(arm1_.inbox.front(), nullptr);
  ASSERT_NE(arm2_.inbox.front(), nullptr);
  EXPECT_TRUE(std::holds_alternative<control::VelocityRequest>(*arm1_.inbox.front()));
  EXPECT_TRUE(std::holds_alternative<control::LeaseRenewal>(*arm2_.inbox.front()));
}

}  // namespace
}  // namespace meca::bridge
