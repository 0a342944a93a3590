#include "cli/format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/names.hpp"
#include "tests/unit/cli/samples.hpp"

namespace meca::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Activity, OfAStandingRobot) { EXPECT_EQ(activity(standing_robot()), "standing, nothing queued"); }

TEST(Activity, OfAMovingRobot) {
  auto view = standing_robot();
  view.motion_status->eom(false);
  view.motion_status->eob(false);
  EXPECT_EQ(activity(view), "moving");
}

TEST(Activity, OfAPausedRobotTellsWhetherItStands) {
  auto view = standing_robot();
  view.motion_status->paused(true);
  EXPECT_EQ(activity(view), "paused");
  view.motion_status->eom(false);
  EXPECT_EQ(activity(view), "coming to a pause");
}

TEST(Activity, NamesTheStepsToReadiness) {
  auto view = standing_robot();
  view.robot_status->homed(false);
  EXPECT_EQ(activity(view), "activated, not homed");
  view.robot_status->activated(false);
  EXPECT_EQ(activity(view), "deactivated, motors off");
  view.robot_status->busy(true);
  EXPECT_EQ(activity(view), "being activated or deactivated");
}

TEST(Activity, InRecoveryModeARobotMovesWithoutHoming) {
  auto view = standing_robot();
  view.robot_status->homed(false);
  view.robot_status->recovery_mode(true);
  view.motion_status->eom(false);
  EXPECT_EQ(activity(view), "moving");
}

TEST(Activity, AnErrorComesFirst) {
  auto view = standing_robot();
  view.robot_status->error_code(1011);
  view.motion_status->eom(false);
  EXPECT_EQ(activity(view), "in error 1011");
}

TEST(Activity, WithoutLinkNothingOldIsShownAsTrue) {
  auto view = standing_robot();
  view.bridge->link(meca500::LinkState::LINK_DOWN);
  view.bridge->link_detail("no reply");
  EXPECT_EQ(activity(view), "not connected: no reply");
  view.bridge->link(meca500::LinkState::LINK_CONNECTING);
  EXPECT_EQ(activity(view), "connecting: no reply");
}

TEST(Activity, SaysWhenTheImageIsStaleOrUnknown) {
  auto view = standing_robot();
  view.robot_status->header().quality(meca500::Quality::STALE);
  EXPECT_THAT(activity(view), HasSubstr("stale"));
  view.robot_status->header().quality(meca500::Quality::UNKNOWN);
  EXPECT_THAT(activity(view), HasSubstr("not known"));
  view.robot_status->header().quality(meca500::Quality::DISCONNECTED);
  EXPECT_EQ(activity(view), "not connected");
}

TEST(Activity, OfARobotNothingIsKnownOf) { EXPECT_THAT(activity(RobotView{}), HasSubstr("not known")); }

TEST(Readiness, IsTheBridgesCauseAndRemedy) {
  auto view = standing_robot();
  EXPECT_EQ(readiness(view), "yes");
  view.bridge->ready(false);
  view.bridge->cause("P-Stop 2 is active");
  view.bridge->remedy("release it, then resume");
  EXPECT_EQ(readiness(view), "no: P-Stop 2 is active; release it, then resume");
}

TEST(Readiness, DoesNotTellAClientThatItHasControlItself) {
  auto view = standing_robot();
  view.bridge->ready(false);
  view.bridge->cause("motion is paused");
  view.bridge->remedy("'meca-ctl resume'; 'meca-ctl@host:1' has control: command from there");
  EXPECT_EQ(readiness(view, "meca-ctl@host:1"), "no: motion is paused; 'meca-ctl resume'");
  EXPECT_EQ(readiness(view, "tablet"), readiness(view));
  EXPECT_THAT(readiness(view), HasSubstr("'meca-ctl@host:1' has control"));
}

TEST(Safety, NamesSignalsAndWhatMayBeReset) {
  auto view = standing_robot();
  EXPECT_EQ(safety(view), "no stop signal; motor supply on");
  view.safety->stop().p_stop2(true);
  view.safety->stop().e_stop(true);
  view.safety->resettable().p_stop2(true);
  view.safety->vmotor_on(false);
  EXPECT_EQ(safety(view), "E-Stop, P-Stop 2; may be reset: P-Stop 2; motor supply off");
}

TEST(Safety, NeverClaimsNoStopWhenTheRobotDoesNotSay) {
  auto view = standing_robot();
  view.safety->known(false);
  EXPECT_THAT(safety(view), Not(HasSubstr("no stop")));
  view.safety->known(true);
  view.safety->header().quality(meca500::Quality::UNKNOWN);
  EXPECT_THAT(safety(view), Not(HasSubstr("no stop")));
  view.safety.reset();
  EXPECT_THAT(safety(view), Not(HasSubstr("no stop")));
}

TEST(Safety, MarksAnOldValueAsOld) {
  auto view = standing_robot();
  view.safety->header().quality(meca500::Quality::DISCONNECTED);
  EXPECT_THAT(safety(view), HasSubstr("(DISCONNECTED: last known)"));
}

TEST(ErrorText, HasCodeNameAndRemedy) {
  EXPECT_EQ(error_text(0), "none");
  EXPECT_THAT(error_text(1011), StartsWith("1011 "));
  EXPECT_THAT(error_text(1011), HasSubstr("; "));
  EXPECT_EQ(error_text(65000), "65000, a code that no document names");
}

TEST(ControlText, TellsTheOwnerAndForHowLong) {
  meca500::ControlStatus status;
  EXPECT_EQ(control_text(status, 0), "free");
  status.owned(true);
  status.owner("cell-plc");
  status.lease_ms(100);
  status.since_ns(1'000'000'000);
  EXPECT_EQ(control_text(status, 13'000'000'000), "cell-plc for 12 s, lease 100 ms");
}

TEST(ControlText, TellsPrioritiesAndWhoTakesOverWhen) {
  meca500::ControlStatus status;
  status.owned(true);
  status.owner("cell-plc");
  status.priority(1);
  status.lease_ms(100);
  status.contender("supervisor");
  status.contender_priority(10);
  status.contender_takes_over_ns(400'000'000);
  EXPECT_EQ(control_text(status, 0),
            "cell-plc (priority 1) for 0 s, lease 100 ms; supervisor (priority 10) takes over in 0.4 s");
}

TEST(ControlText, RemembersTheLastOwnerAndTheLastRefusal) {
  meca500::ControlStatus status;
  status.last_owner("cell-plc");
  status.last_loss("lease expired");
  status.last_refused("tablet");
  status.last_refusal("cell-plc has control");
  EXPECT_EQ(control_text(status, 0), "free; last cell-plc (lease expired); refused tablet: cell-plc has control");
}

TEST(StatusText, FitsOnAScreenAndAnswersWhatAndWhyNot) {
  auto view = standing_robot();
  view.bridge->ready(false);
  view.bridge->cause("motion is paused");
  view.bridge->remedy("resume");
  view.motion_status->fifo_space(12990);
  const auto text = status_text("arm1", view, 0);
  EXPECT_THAT(text, StartsWith("arm1  Meca500 R4, serial 4711, firmware 11.3.0.1 (layout 11.x), over builtin\n"));
  EXPECT_THAT(text, HasSubstr("Doing    standing, nothing queued\n"));
  EXPECT_THAT(text, HasSubstr("Ready    no: motion is paused; resume\n"));
  EXPECT_THAT(text, HasSubstr("Link     up; cycle 1000 us"));
  EXPECT_THAT(text, HasSubstr("Control  free\n"));
  EXPECT_THAT(text, HasSubstr("State    activated, homed\n"));
  EXPECT_THAT(text, HasSubstr("Queue    10 waiting, 12990 places free\n"));
  EXPECT_THAT(text, HasSubstr("-10.000     0.000     0.500     0.000     0.000   720.250  deg\n"));
  EXPECT_LT(std::ranges::count(text, '\n'), 24);
}

TEST(StatusText, ShowsWhatTheFieldbusCountsAndMeasures) {
  auto view = standing_robot();
  EXPECT_THAT(status_text("arm1", view, 0), AllOf(Not(HasSubstr("Bus")), Not(HasSubstr("Timing"))));
  view.bridge->transport_counters({counter("lost_packets", 2), counter("send_period_mean", 10000, "us")});
  EXPECT_THAT(status_text("arm1", view, 0), HasSubstr("Bus      lost packets 2\n"
                                                      "  Timing   send period 10000 us (mean)\n"));
}

TEST(StatusText, OfARobotThatOnlyHasANameHoldsNoInventedValues) {
  const auto text = status_text("arm1", RobotView{}, 0);
  EXPECT_THAT(text, HasSubstr("not known"));
  EXPECT_THAT(text, Not(HasSubstr("0.000")));
}

TEST(ReceiptText, IsASentenceWithTheReason) {
  meca500::CommandReceipt receipt;
  receipt.robot("arm1");
  receipt.state(meca500::ReceiptState::ACKNOWLEDGED);
  EXPECT_EQ(receipt_text(receipt, "move-joints"), "arm1: move-joints: acknowledged");
  receipt.state(meca500::ReceiptState::REJECTED);
  receipt.reason(meca500::ReceiptReason::REASON_ARGUMENT_RANGE);
  receipt.text("q1 = 400 is outside -175 .. 175 deg");
  EXPECT_EQ(receipt_text(receipt, "move-joints"),
            "arm1: move-joints: rejected (ARGUMENT_RANGE): q1 = 400 is outside -175 .. 175 deg");
}

TEST(Names, TerminalReceiptsAreTheLastFour) {
  using S = meca500::ReceiptState;
  for (const auto state : {S::ACCEPTED, S::SENT, S::ACKNOWLEDGED}) EXPECT_FALSE(is_terminal(state)) << name(state);
  for (const auto state : {S::COMPLETED, S::DISCARDED, S::REJECTED, S::ABORTED}) {
    EXPECT_TRUE(is_terminal(state)) << name(state);
  }
}

TEST(Names, ANumberFromANewerBridgeIsAQuestionMark) {
  EXPECT_EQ(name(static_cast<meca500::ReceiptReason>(200)), "?");
  EXPECT_EQ(name(static_cast<meca500::Quality>(200)), "?");
}

TEST(Table, LinesUpItsColumns) {
  EXPECT_EQ(table({{"A", "B"}, {"long", "x"}, {"y", "z"}}), "A     B\nlong  x\ny     z\n");
  EXPECT_EQ(table({}), "");
}

TEST(Fixed, HasWidthAndDecimals) {
  EXPECT_EQ(fixed(-1.5, 8, 3), "  -1.500");
  EXPECT_EQ(fixed(12.6, 0, 0), "13");
}

}  // namespace
}  // namespace meca::cli
