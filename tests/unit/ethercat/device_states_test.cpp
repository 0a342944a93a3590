// The AL state machine of the device: which steps it takes, and what it says when it does not (AL status code).
#include "tests/unit/ethercat/device_rig.hpp"

namespace meca::ethercat::device_test {
namespace {

TEST(DeviceStates, BeginWithInit) { EXPECT_EQ(DeviceRig().al(), "INIT"); }

TEST(DeviceStates, GoUpToOpAndDownAgain) {
  DeviceRig robot;
  robot.to_op();
  EXPECT_TRUE(robot.device.operational());
  EXPECT_EQ(robot.ask(0x04), "SAFEOP");
  EXPECT_EQ(robot.ask(0x02), "PREOP");
  EXPECT_EQ(robot.ask(0x01), "INIT");
  EXPECT_EQ(robot.device.counters().strict, 0u);
  EXPECT_EQ(robot.device.counters().refused_states, 0u);
}

TEST(DeviceStates, TakeTheirTime) {
  DeviceSettings slow = meca500();
  slow.transition = 300ms;
  DeviceRig robot(slow);
  robot.set_up_mailbox();
  EXPECT_EQ(robot.ask(0x02, 299ms), "INIT");
  EXPECT_EQ(robot.ask(0x02, 1ms), "PREOP") << "asking again does not begin anew";
}

TEST(DeviceStates, FallToInitFromAnywhereAtOnce) {
  DeviceRig robot;
  robot.to_op();
  EXPECT_EQ(robot.ask(0x01, 0ms), "INIT");
  EXPECT_EQ(robot.post("00 20 40 08 10 00 00 00 00 00"), 1u) << "the mailbox itself is the master's";
  robot.run(10ms);
  EXPECT_EQ(robot.fetch(), "empty");
  EXPECT_EQ(robot.cycle(), 0u);
}

TEST(DeviceStates, AcceptAnAcknowledgementWithoutAnError) {
  DeviceRig robot;
  robot.set_up_mailbox();
  EXPECT_EQ(robot.ask(0x11), "INIT");
  EXPECT_EQ(robot.ask(0x12), "PREOP");
  EXPECT_EQ(robot.ask(0x12), "PREOP");
}

TEST(DeviceStates, AreNotSkipped) {
  DeviceRig robot;
  robot.set_up_mailbox();
  EXPECT_EQ(robot.ask(0x04), "INIT+0011");
  EXPECT_EQ(robot.ask(0x18), "INIT+0011");
  EXPECT_EQ(robot.ask(0x12), "PREOP");
  EXPECT_EQ(robot.ask(0x08), "PREOP+0011");
  EXPECT_EQ(robot.device.counters().refused_states, 3u);
}

TEST(DeviceStates, KnowNoBootAndNoOthers) {
  DeviceRig robot;
  EXPECT_EQ(robot.ask(0x03), "INIT+0013");
  EXPECT_EQ(robot.ask(0x15), "INIT+0012");
  EXPECT_EQ(robot.ask(0x10), "INIT+0012");
}

TEST(DeviceStates, WaitForTheAcknowledgementOfAnError) {
  DeviceRig robot;
  robot.to_preop();
  ASSERT_EQ(robot.ask(0x08), "PREOP+0011");
  const auto strict = robot.device.counters().strict;
  EXPECT_EQ(robot.ask(0x02), "PREOP+0011");
  EXPECT_EQ(robot.ask(0x04), "PREOP+0011");
  EXPECT_EQ(robot.device.counters().strict, strict + 2);
  EXPECT_EQ(robot.ask(0x12), "PREOP");
}

TEST(DeviceStates, LeaveAnErrorWithInitToo) {
  DeviceRig robot;
  robot.to_preop();
  ASSERT_EQ(robot.ask(0x08), "PREOP+0011");
  EXPECT_EQ(robot.ask(0x01), "INIT");
}

TEST(DeviceStates, NeedTheMailboxForPreop) {
  DeviceRig robot;
  EXPECT_EQ(robot.ask(0x02), "INIT+0016") << "no sync manager";
  robot.set_sync_manager(0, "00 10 80 00 26 00 01 00");
  EXPECT_EQ(robot.ask(0x12), "INIT+0016") << "only one";
  robot.set_sync_manager(1, "80 10 40 00 22 00 01 00");
  EXPECT_EQ(robot.ask(0x12), "INIT+0016") << "64 bytes";
  robot.set_sync_manager(1, "80 10 80 00 26 00 01 00");
  EXPECT_EQ(robot.ask(0x12), "INIT+0016") << "the wrong direction";
  robot.set_sync_manager(1, "80 10 80 00 22 00 00 00");
  EXPECT_EQ(robot.ask(0x12), "INIT+0016") << "not enabled";
  robot.set_sync_manager(1, "80 10 80 00 22 00 01 00");
  EXPECT_EQ(robot.ask(0x12), "PREOP");
}

TEST(DeviceStates, NeedTheSiiForPreopWhereThatIsAskedFor) {
  DeviceSettings settings = meca500();
  settings.wants_sii = true;
  DeviceRig robot(settings);
  robot.set_up_mailbox();
  robot.write(reg::kSiiOwner, "00");
  EXPECT_EQ(robot.ask(0x02), "INIT+0050");
  robot.give_sii_back();
  EXPECT_EQ(robot.ask(0x12), "PREOP");
}

// SOEM issue 706: a real robot of firmware 9.2.
TEST(DeviceStates, NeedTheAssignmentForSafeop) {
  DeviceRig robot;
  robot.to_preop();
  robot.set_up_process_data();
  EXPECT_EQ(robot.ask(0x04), "PREOP+0025");
  robot.sdo("00 20 31 12 1C 00 14 00 00 00 09 00 00 16 01 16 02 16 10 16 11 16 20 16 21 16 22 16 23 16");
  EXPECT_EQ(robot.ask(0x14), "PREOP+0024");
  robot.assign();
  EXPECT_EQ(robot.ask(0x14), "SAFEOP");
}

TEST(DeviceStates, RefuseTheSafetyMappingOnFirmware9) {
  DeviceRig robot(meca500(Layout::kFirmware9));
  robot.to_preop();
  robot.set_up_process_data();
  robot.assign();
  EXPECT_EQ(robot.ask(0x04), "PREOP+0024");
  robot.device_has_safety = false;
  robot.assign();
  EXPECT_EQ(robot.ask(0x14), "SAFEOP");
}

TEST(DeviceStates, NeedTheSyncManagersForSafeop) {
  DeviceRig robot;
  robot.to_preop();
  robot.assign();
  EXPECT_EQ(robot.ask(0x04), "PREOP+001D") << "no outputs";
  robot.set_sync_manager(2, "00 11 24 00 64 00 01 00");
  EXPECT_EQ(robot.ask(0x14), "PREOP+001D") << "36 bytes";
  robot.set_sync_manager(2, "00 11 3C 00 64 00 01 00");
  robot.set_sync_manager(3, "00 14 84 00 20 00 01 00");
  EXPECT_EQ(robot.ask(0x14), "PREOP+001E") << "132 bytes";
  robot.set_sync_manager(3, "00 14 FC 00 20 00 00 00");
  EXPECT_EQ(robot.ask(0x14), "PREOP+0017") << "not enabled";
  robot.set_sync_manager(3, "00 14 FC 00 20 00 01 00");
  EXPECT_EQ(robot.ask(0x14), "SAFEOP");
}

TEST(DeviceStates, NeedOutputsForOp) {
  DeviceRig robot;
  robot.to_safeop();
  EXPECT_EQ(robot.ask(0x08, 99ms), "SAFEOP");
  EXPECT_EQ(robot.ask(0x08, 10ms), "SAFEOP+001B");
  EXPECT_EQ(robot.device.counters().strict, 1u) << "OP was asked for before there were outputs";
  EXPECT_EQ(robot.ask(0x14), "SAFEOP");
  robot.cycle();
  EXPECT_EQ(robot.ask(0x08), "OP");
  EXPECT_EQ(robot.device.counters().strict, 1u);
}

TEST(DeviceStates, DoNotTakeOutputsOfAnotherTimeForNewOnes) {
  DeviceRig robot;
  robot.to_safeop();
  robot.cycle();
  robot.run(110ms);  // the watchdog runs out
  EXPECT_EQ(robot.ask(0x08, 110ms), "SAFEOP+001B");
}

TEST(DeviceStates, WaitALittleForOutputsOnTheWayToOp) {
  DeviceRig robot;
  robot.to_safeop();
  EXPECT_EQ(robot.ask(0x08, 50ms), "SAFEOP");
  robot.cycle();
  EXPECT_EQ(robot.al(), "OP");
}

TEST(DeviceStates, CanBeRefusedOnRequest) {
  DeviceRig robot;
  robot.device.faults().refuse_state = 0x0022;
  robot.to_preop();
  robot.assign();
  robot.set_up_process_data();
  EXPECT_EQ(robot.ask(0x04), "PREOP+0022");
  robot.device.faults().refuse_state.reset();
  EXPECT_EQ(robot.ask(0x14), "SAFEOP");
}

TEST(DeviceStates, FallToSafeopWithAnErrorOfTheRobot) {
  DeviceRig robot;
  robot.to_op();
  robot.device.raise_al_error(0x002C, robot.now);
  EXPECT_EQ(robot.al(), "SAFEOP+002C");
  EXPECT_FALSE(robot.device.operational());
  EXPECT_EQ(robot.ask(0x14), "SAFEOP");
  robot.device.raise_al_error(0x0020, robot.now);
  EXPECT_EQ(robot.al(), "SAFEOP+0020");
}

TEST(DeviceStates, FallWhenTheSyncManagersAreChangedUnderThem) {
  DeviceRig robot;
  robot.to_op();
  robot.set_sync_manager(2, "00 11 3C 00 64 00 00 00");
  robot.run(2ms);
  EXPECT_EQ(robot.al(), "PREOP+001D");
  robot.set_sync_manager(0, "00 10 80 00 26 00 00 00");
  robot.run(2ms);
  EXPECT_EQ(robot.al(), "INIT+0016");
}

TEST(DeviceStates, BeginAnewAfterPowerIsBack) {
  DeviceRig robot;
  robot.to_op();
  robot.device.power_cycle(robot.now);
  EXPECT_EQ(robot.read(reg::kStationAddress, 2), "00 00") << "nobody has this address any more";
  robot.write(reg::kStationAddress, "01 10", Command::kApwr, 0);
  EXPECT_EQ(robot.al(), "INIT");
  robot.to_preop();
  robot.set_up_process_data();
  EXPECT_EQ(robot.ask(0x04), "PREOP+0025") << "the assignment is gone";
}

}  // namespace
}  // namespace meca::ethercat::device_test
