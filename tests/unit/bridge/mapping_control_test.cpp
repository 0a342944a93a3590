// Samples of clients to requests: what is well-formed goes through unchanged, what is not gets an answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <variant>
#include <vector>

#include "bridge/mapping.hpp"

namespace meca::bridge {
namespace {

using control::Reason;

const control::ParticipantId kSomebody{std::byte{1}, std::byte{2}};

meca500::Command command() {
  meca500::Command sample;
  sample.robot("arm1");
  sample.client("plc");
  sample.command_id(18446744073709551615U);
  sample.kind(meca500::CommandKind::MOTION);
  sample.motion_command_id(17);
  sample.arguments({1.25, 2, 3});
  return sample;
}

Refusal refusal(const meca500::Command& sample) {
  const auto result = to_request(sample, kSomebody);
  EXPECT_TRUE(std::holds_alternative<Refusal>(result));
  return std::holds_alternative<Refusal>(result) ? std::get<Refusal>(result) : Refusal{};
}

TEST(CommandMapping, EveryFieldOfACommandArrives) {
  auto sample = command();
  sample.use_variables(true);
  sample.report_completion(true);
  sample.on_loss(meca500::LossPolicy::FINISH_MOTION);
  const auto result = to_request(sample, kSomebody);
  ASSERT_TRUE(std::holds_alternative<control::CommandRequest>(result));
  const auto& request = std::get<control::CommandRequest>(result);
  EXPECT_EQ(request.client.view(), "plc");
  EXPECT_EQ(request.participant, kSomebody);
  EXPECT_EQ(request.command_id, 18446744073709551615U);
  EXPECT_EQ(request.kind, control::CommandKind::kMotion);
  EXPECT_EQ(request.motion_command_id, 17U);
  EXPECT_THAT(request.arguments, testing::ElementsAre(1.25, 2, 3, 0, 0, 0));
  EXPECT_EQ(request.argument_count, 3);
  EXPECT_TRUE(request.use_variables);
  EXPECT_TRUE(request.report_completion);
  EXPECT_EQ(request.on_loss, control::LossPolicy::kFinishMotion);
}

TEST(CommandMapping, EachFlagGoesToItsOwnPlace) {
  auto sample = command();
  sample.use_variables(true);
  auto request = std::get<control::CommandRequest>(to_request(sample, kSomebody));
  EXPECT_TRUE(request.use_variables);
  EXPECT_FALSE(request.report_completion);
  sample.use_variables(false);
  sample.report_completion(true);
  request = std::get<control::CommandRequest>(to_request(sample, kSomebody));
  EXPECT_FALSE(request.use_variables);
  EXPECT_TRUE(request.report_completion);
  EXPECT_EQ(request.on_loss, control::LossPolicy::kStopMotion);
}

TEST(CommandMapping, EveryKindOfTheIdlIsAKindOfOurs) {
  for (int kind = 0; kind <= 14; ++kind) {
    auto sample = command();
    sample.kind(static_cast<meca500::CommandKind>(kind));
    const auto result = to_request(sample, kSomebody);
    ASSERT_TRUE(std::holds_alternative<control::CommandRequest>(result)) << kind;
    EXPECT_EQ(static_cast<int>(std::get<control::CommandRequest>(result).kind), kind);
  }
}

TEST(CommandMapping, AKindFromTheFutureIsRejectedWithItsNumber) {
  auto sample = command();
  sample.kind(static_cast<meca500::CommandKind>(15));
  const auto answer = refusal(sample);
  EXPECT_EQ(answer.receipt.reason, Reason::kUnknownCommand);
  EXPECT_EQ(answer.receipt.state, control::ReceiptState::kRejected);
  EXPECT_EQ(answer.receipt.command_id, sample.command_id());
  EXPECT_EQ(answer.receipt.client.view(), "plc");
  EXPECT_THAT(answer.text, testing::StartsWith("kind 15 is not a CommandKind"));
}

TEST(CommandMapping, SevenArgumentsAreRejectedAndNotCut) {
  auto sample = command();
  sample.arguments(std::vector<double>(7, 1.0));
  const auto answer = refusal(sample);
  EXPECT_EQ(answer.receipt.reason, Reason::kArgumentCount);
  EXPECT_EQ(answer.receipt.argument, 7);
  EXPECT_EQ(answer.text, "7 arguments were given; no command takes more than 6");
}

TEST(CommandMapping, SixArgumentsAreNotTooMany) {
  auto sample = command();
  sample.arguments({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(std::get<control::CommandRequest>(to_request(sample, kSomebody)).argument_count, 6);
}

TEST(CommandMapping, ANamelessOrUnprintableClientIsRejected) {
  for (const char* name : {"", "a\nb", "\x1b[2J"}) {
    auto sample = command();
    sample.client(name);
    EXPECT_EQ(refusal(sample).receipt.reason, Reason::kNotAllowed);
  }
}

TEST(CommandMapping, AnUnknownLossPolicyIsRejected) {
  auto sample = command();
  sample.on_loss(static_cast<meca500::LossPolicy>(2));
  EXPECT_EQ(refusal(sample).receipt.reason, Reason::kArgumentRange);
}

TEST(CommandMapping, EveryFieldOfAVelocityAndALeaseArrives) {
  meca500::VelocityCommand velocity;
  velocity.client("pad");
  velocity.sequence_number(5);
  velocity.kind(meca500::VelocityKind::MOVE_LIN_VEL_TRF);
  velocity.velocity({1, 2, 3, 4, 5, 6});
  const auto request = std::get<control::VelocityRequest>(to_request(velocity, kSomebody));
  EXPECT_EQ(request.client.view(), "pad");
  EXPECT_EQ(request.participant, kSomebody);
  EXPECT_EQ(request.sequence_number, 5U);
  EXPECT_EQ(request.kind, control::VelocityKind::kMoveLinVelTrf);
  EXPECT_THAT(request.velocity, testing::ElementsAre(1, 2, 3, 4, 5, 6));

  meca500::ControlLease lease;
  lease.client("pad");
  lease.sequence_number(6);
  const auto renewal = std::get<control::LeaseRenewal>(to_request(lease, kSomebody));
  EXPECT_EQ(renewal.client.view(), "pad");
  EXPECT_EQ(renewal.participant, kSomebody);
  EXPECT_EQ(renewal.sequence_number, 6U);
}

TEST(CommandMapping, ABadStreamSampleIsASentence) {
  meca500::VelocityCommand velocity;
  velocity.client("pad");
  velocity.kind(static_cast<meca500::VelocityKind>(3));
  EXPECT_THAT(std::get<std::string>(to_request(velocity, kSomebody)),
              testing::HasSubstr("pad ignored: kind 3 is not a VelocityKind"));
  EXPECT_THAT(std::get<std::string>(to_request(meca500::ControlLease{}, kSomebody)), testing::HasSubstr("client name"));
}

TEST(CommandMapping, EveryFieldOfAReceiptGoesOut) {
  control::Receipt receipt;
  receipt.client = std::string_view("plc");
  receipt.command_id = 3;
  receipt.state = control::ReceiptState::kAborted;
  receipt.reason = Reason::kRobotError;
  receipt.robot_error = 1012;
  meca500::CommandReceipt sample;
  fill("arm1", receipt, {}, 4, 5, sample);
  EXPECT_EQ(sample.robot().to_string(), "arm1");
  EXPECT_EQ(sample.client().to_string(), "plc");
  EXPECT_EQ(sample.command_id(), 3U);
  EXPECT_EQ(sample.state(), meca500::ReceiptState::ABORTED);
  EXPECT_EQ(sample.reason(), meca500::ReceiptReason::REASON_ROBOT_ERROR);
  EXPECT_EQ(sample.robot_error_code(), 1012);
  EXPECT_EQ(sample.cycle(), 4U);
  EXPECT_EQ(sample.time_ns(), 5);
  EXPECT_THAT(sample.text().to_string(), testing::HasSubstr("1012"));
}

}  // namespace
}  // namespace meca::bridge
