// What a person reads in a receipt that did not end well: what was refused, why, and what to do instead.
#include "bridge/control/receipt_text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "transports/image/error_codes.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::control {
namespace {

Receipt receipt(CommandKind kind, ReceiptState state, Reason reason) {
  Receipt r;
  r.client = ClientName("cell-plc");
  r.kind = kind;
  r.state = state;
  r.reason = reason;
  if (kind == CommandKind::kMotion) r.motion_command_id = image::kMoveJoints;
  return r;
}

struct Sentence {
  CommandKind kind;
  ReceiptState state;
  Reason reason;
  const char* text;
};

using enum CommandKind;
using enum ReceiptState;

const std::vector<Sentence> kSentences{
    {kMotion, kRejected, Reason::kMonitoringOnly,
     "MoveJoints refused: this bridge may only monitor this robot; BridgeStatus says whether its configuration or the "
     "robot forbids more"},
    {kActivate, kRejected, Reason::kNoLink,
     "activation refused: there is no link to the robot; the bridge keeps trying, BridgeStatus says what is missing"},
    {kMotion, kRejected, Reason::kFirmwareUnknown,
     "MoveJoints refused: the robot's firmware is not known yet, or not the one configured; BridgeStatus says which"},
    {kHome, kRejected, Reason::kNotActivated, "homing refused: the robot is not activated; activate it first"},
    {kMotion, kAborted, Reason::kNotActivated,
     "MoveJoints aborted: the robot's motors went off; activate it again first"},
    {kMotion, kRejected, Reason::kNotHomed, "MoveJoints refused: the robot is not homed; home it first"},
    {kSimMode, kRejected, Reason::kWrongState,
     "changing simulation mode refused: the robot takes it only while it is deactivated; deactivate the robot first"},
    {kSetHostTime, kRejected, Reason::kWrongState,
     "setting the robot's clock refused: the clock of the bridge's computer is not set; set it first"},
    {kMotion, kRejected, Reason::kSafetyStop,
     "MoveJoints refused: a safety stop is active; remove its cause, then resume (after an E-Stop: press Reset on the "
     "power supply and activate)"},
    {kActivate, kRejected, Reason::kSafetyStop,
     "activation refused: a safety stop is active; remove its cause, then press Reset on the power supply and activate "
     "again"},
    {kMotion, kRejected, Reason::kPaused, "MoveJoints refused: motion is paused after a stop; resume it first"},
    {kResumeMotion, kAborted, Reason::kPaused,
     "resuming aborted: somebody paused the robot meanwhile; resume it again"},
    {kActivate, kAborted, Reason::kTimeOut,
     "activation aborted: the robot did not confirm it in time; check E-Stop, which a Meca500 R3 does not "
     "report"},
    {kHome, kAborted, Reason::kTimeOut,
     "homing aborted: the robot did not confirm it in time; look at its state before trying again"},
    {kMotion, kAborted, Reason::kLinkLost,
     "MoveJoints aborted: the link to the robot was lost; how far it got is not known, look where the arm is before "
     "sending it again"},
    {kMotion, kDiscarded, Reason::kOwnerLost,
     "MoveJoints discarded: its client lost or released control; take control and send it again if it is still wanted"},
    {kMotion, kDiscarded, Reason::kCleared,
     "MoveJoints discarded: the motion queue was cleared; send it again if it is still wanted"},
    {kBrakes, kRejected, Reason::kNotAllowed,
     "brakes control refused: the configuration does not allow brakes control; control: {allow_brakes: true} of this "
     "robot would"},
};

TEST(ReceiptText, SaysWhatWasRefusedWhyAndWhatInstead) {
  for (const Sentence& s : kSentences) EXPECT_EQ(describe(receipt(s.kind, s.state, s.reason)), s.text);
}

TEST(ReceiptText, OfARobotInErrorSaysWhetherAResetHelps) {
  Receipt r = receipt(kMotion, kRejected, Reason::kRobotError);
  r.robot_error = 3005;
  EXPECT_EQ(describe(r),
            "MoveJoints refused: the robot is in error 3005 (the motion failed); remove its cause and reset it first");
  r.robot_error = 3006;
  EXPECT_EQ(describe(r),
            "MoveJoints refused: the robot is in error 3006 (the robot lost contact with its drives); a reset does not "
            "clear it: power the robot off and on again; contact the vendor's support when it persists");
}

TEST(ReceiptText, OfAnUnknownCommandSaysWhatIsMissing) {
  Receipt r = receipt(kMotion, kRejected, Reason::kUnknownCommand);
  EXPECT_EQ(describe(r),
            "MoveJoints refused: this robot's firmware does not know variables as arguments, which came with firmware "
            "11; send numbers");
  r.motion_command_id = image::kSetPayload;
  EXPECT_EQ(describe(r),
            "SetPayload refused: this robot's firmware does not know SetPayload, which came with firmware 11.x, or not "
            "variables as arguments, which came with firmware 11; send numbers");
  r.motion_command_id = 9999;
  EXPECT_EQ(describe(r),
            "motion command 9999 refused: there is no motion command 9999; the robot manual's table of MotionCommandID "
            "lists those there are");
}

// Whatever comes together: a reason in words, and after it what to do; not longer than the receipt's text may be.
TEST(ReceiptText, OfEveryCommandAndReasonHasAReasonAndAWayOutAndFits) {
  const std::string longest(63, 'n');
  for (int kind = 0; kind <= static_cast<int>(kMotion); ++kind) {
    for (int reason = 1; reason <= static_cast<int>(Reason::kDuplicate); ++reason) {
      for (const ReceiptState state : {kRejected, kDiscarded, kAborted}) {
        for (const std::uint16_t error : {std::uint16_t{0}, std::uint16_t{3006}}) {
          Receipt r = receipt(static_cast<CommandKind>(kind), state, static_cast<Reason>(reason));
          r.client = r.other = ClientName(longest);
          r.robot_error = error;
          const std::string text = describe(r);
          const bool says_it_itself = r.reason == Reason::kArgumentCount;  // "got 3 arguments and takes 6"
          EXPECT_TRUE(says_it_itself || text.find("; ") != std::string::npos) << text;
          EXPECT_LE(text.size(), 255U) << text;
        }
      }
    }
  }
  for (const image::ErrorInfo& error : image::error_codes()) {
    Receipt r = receipt(kRecoveryMode, kRejected, Reason::kRobotError);
    r.robot_error = error.code;
    EXPECT_LE(describe(r).size(), 255U) << describe(r);
  }
}

}  // namespace
}  // namespace meca::control
