// What BridgeStatus says in each situation: the record is a robot that would move, changed by one or a few facts.
#include "bridge/diagnosis.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "transports/image/error_codes.hpp"

namespace {

using namespace meca;
using bridge::CycleRecord;
using bridge::Diagnosis;
using bridge::Quality;
using control::ControlState;
using transports::LinkState;

CycleRecord moving_robot() {
  CycleRecord r;
  r.quality = Quality::kGood;
  r.link = LinkState::kUp;
  r.firmware_known = true;
  r.firmware = {11, 3, 3, 12637};
  r.product_type = 4;  // Meca500 R4
  r.inputs.robot_status.activated = true;
  r.inputs.robot_status.homed = true;
  r.inputs.motion_status.fifo_space = 13000;
  r.inputs.safety_status.known = true;
  r.inputs.safety_status.vmotor_on = true;
  return r;
}

CycleRecord firmware9_robot() {
  CycleRecord r = moving_robot();
  r.firmware = {9, 3, 3, 5809};
  r.layout = image::Layout::kFirmware9;
  r.inputs.safety_status = {};  // this image has no safety section
  return r;
}

struct Situation {
  const char* name;
  void (*change)(CycleRecord&);
  const char* cause;  // empty: ready
  const char* remedy;
  CycleRecord (*base)() = moving_robot;
};
std::ostream& operator<<(std::ostream& out, const Situation& s) { return out << s.name; }

const Situation kSituations[] = {
    {"NothingInTheWay", [](CycleRecord&) {}, "", ""},
    {"SomebodyHasControl",
     [](CycleRecord& r) {
       r.control.owned = true;
       r.control.owner = control::ClientName("cell-plc");
     },
     "", ""},
    {"QueueEmptyAndIdle", [](CycleRecord& r) { r.inputs.motion_status.eob = r.inputs.motion_status.eom = true; }, "",
     ""},
    {"BrakesBitOfARealRobot", [](CycleRecord& r) { r.inputs.robot_status.brakes_engaged = true; }, "", ""},
    {"QueueClearedButNotPaused", [](CycleRecord& r) { r.inputs.motion_status.cleared = true; }, "", ""},
    {"SimulationModeNeedsNoMotorPower",
     [](CycleRecord& r) {
       r.inputs.robot_status.sim_activated = true;
       r.inputs.safety_status.vmotor_on = false;
     },
     "", ""},
    {"RecoveryModeNeedsNoHoming",
     [](CycleRecord& r) {
       r.inputs.robot_status.homed = false;
       r.inputs.robot_status.recovery_mode = true;
     },
     "", ""},
    {"Firmware9WithNothingInTheWay", [](CycleRecord&) {}, "", "", firmware9_robot},

    {"ConfiguredToMonitorOnly", [](CycleRecord& r) { r.control.monitoring_only = true; },
     "this bridge is configured to monitor this robot only",
     "to command it from here, set control: {enabled: true} for this robot and restart the bridge"},
    {"LinkDownR4",
     [](CycleRecord& r) {
       r.link = LinkState::kDown;
       r.quality = Quality::kDisconnected;
       r.link_detail = "no reply to Forward Open";
     },
     "no link to the robot: no reply to Forward Open",
     "check its power, the cables to it, and its address or position in the configuration; the bridge keeps trying"},
    {"LinkDownOfAnUnknownProduct",
     [](CycleRecord& r) {
       r.link = LinkState::kDown;
       r.quality = Quality::kDisconnected;
       r.product_type = 0;
     },
     "no link to the robot",
     "check its power (E-Stop takes all power of a Meca500 R3), the cables to it, and its address or position in the "
     "configuration; the bridge keeps trying"},
    {"LinkComingUp",
     [](CycleRecord& r) {
       r.link = LinkState::kConnecting;
       r.quality = Quality::kDisconnected;
       r.link_detail = "SAFE_OP";
     },
     "connecting to the robot: SAFE_OP",
     "wait; when it stays like this, check which fieldbus the robot has switched on, and the cables"},
    {"LinkUpWithoutAnImageYet", [](CycleRecord& r) { r.quality = Quality::kDisconnected; },
     "no image from the robot yet", "wait; when it stays like this, check cable and protocol"},
    {"FirmwareUnknown",
     [](CycleRecord& r) {
       r.firmware_known = false;
       r.quality = Quality::kUnknown;
     },
     "the robot's firmware is not known yet, so its image cannot be read with certainty",
     "wait until the robot has reported it (dynamic data type 1); known are firmware 9, 10 and 11"},
    {"FirmwareMismatch",
     [](CycleRecord& r) {
       r.firmware_mismatch = true;
       r.firmware = {10, 2, 1, 8120};
     },
     "firmware mismatch: the robot reports 10.2.1.8120 and is not what the configuration expects",
     "correct 'firmware' of this robot in the configuration, or write auto, and restart the bridge"},
    {"StaleImage", [](CycleRecord& r) { r.quality = Quality::kStale; },
     "no fresh image from the robot: what is shown is old",
     "check the cables and the load of network and machine; commands work again with the next image"},

    {"EStopPressedR4",
     [](CycleRecord& r) {
       r.inputs.safety_status.stop.e_stop = true;
       r.inputs.safety_status.vmotor_on = false;
       r.inputs.robot_status.activated = false;
       r.inputs.robot_status.e_stop = true;
     },
     "E-Stop is active", "release it, press Reset on the power supply, then 'meca-ctl activate'"},
    {"EStopReleasedR4",
     [](CycleRecord& r) {
       r.inputs.safety_status.stop.e_stop = r.inputs.safety_status.resettable.e_stop = true;
       r.inputs.safety_status.reset_ready = true;
       r.inputs.robot_status.activated = false;
     },
     "E-Stop is released and waits for its reset", "press Reset on the power supply, then 'meca-ctl activate'"},
    {"EStopPressedR3",
     [](CycleRecord& r) {
       r.inputs.safety_status.stop.e_stop = true;
       r.product_type = 3;
     },
     "E-Stop is active", "release it, switch the power on again, then 'meca-ctl activate'"},
    {"OnlyTheDeprecatedEStopBit", [](CycleRecord& r) { r.inputs.robot_status.e_stop = true; }, "E-Stop is active",
     "release it, press Reset on the power supply, then 'meca-ctl activate'"},
    {"EStopOnFirmware9", [](CycleRecord& r) { r.inputs.robot_status.e_stop = true; }, "E-Stop is active",
     "release it, press Reset on the power supply if it has that button, then 'meca-ctl activate'", firmware9_robot},
    {"PowerSupplyWaitsForReset",
     [](CycleRecord& r) {
       r.inputs.robot_status.activated = false;
       r.inputs.safety_status.reset_ready = true;
     },
     "the power supply waits for its reset", "press Reset on the power supply, then 'meca-ctl activate'"},
    {"RebootStopWaitsForReset",
     [](CycleRecord& r) { r.inputs.safety_status.stop.reboot = r.inputs.safety_status.resettable.reboot = true; },
     "the stop after a reboot is over and waits for its reset",
     "press Reset on the power supply, then 'meca-ctl activate'"},
    {"ConnectionDroppedStop", [](CycleRecord& r) { r.inputs.safety_status.stop.connection_dropped = true; },
     "a stop because the robot lost a control connection is active",
     "restore that connection or let its program end, then 'meca-ctl resume'"},
    {"ConnectionDroppedStopResettable",
     [](CycleRecord& r) {
       r.inputs.safety_status.stop.connection_dropped = r.inputs.safety_status.resettable.connection_dropped = true;
     },
     "a stop because the robot lost a control connection is over and waits for its reset", "'meca-ctl resume'"},
    {"AStopTheMeca500DoesNotHave", [](CycleRecord& r) { r.inputs.safety_status.stop.standstill_fault = true; },
     "a standstill fault is active",
     "find what moved the arm, then press Reset on the power supply, then 'meca-ctl activate'"},

    {"ResettableError", [](CycleRecord& r) { r.inputs.robot_status.error_code = 1012; },
     "robot error 1012: the path runs into a singularity (likely: a linear move through or close to a singular "
     "posture)",
     "'meca-ctl reset-error' and 'meca-ctl resume', then use a joint move, shift the path, or let the robot choose the "
     "configuration"},
    {"ErrorThatSomethingInTheCellCauses", [](CycleRecord& r) { r.inputs.robot_status.error_code = 3005; },
     "robot error 3005: the motion failed (likely: a collision, a blocked joint or an overload)",
     "free the arm, check payload and path, then 'meca-ctl reset-error' and 'meca-ctl resume'"},
    {"ErrorOfARobotThatIsNotActivated",
     [](CycleRecord& r) {
       r.inputs.robot_status.error_code = 1013;
       r.inputs.robot_status.activated = false;
     },
     "robot error 1013: the robot could not be activated (likely: a drive did not start or a safety stop came in "
     "between)",
     "clear all safety stops, then 'meca-ctl reset-error', then activate again"},
    {"ErrorUnderAPStop",
     [](CycleRecord& r) {
       r.inputs.robot_status.error_code = 3005;
       r.inputs.safety_status.stop.p_stop2 = true;
     },
     "robot error 3005: the motion failed (likely: a collision, a blocked joint or an overload)",
     "free the arm, check payload and path, then 'meca-ctl reset-error'"},
    {"EStopOfARobotInError",
     [](CycleRecord& r) {
       r.inputs.robot_status.error_code = 3005;
       r.inputs.safety_status.stop.e_stop = true;
     },
     "E-Stop is active", "release it, press Reset on the power supply"},
    {"PermanentError", [](CycleRecord& r) { r.inputs.robot_status.error_code = 1024; },
     "robot error 1024: the robot has lost its mastering (likely: calibration data of a joint is gone)",
     "do not move the robot; contact the vendor's support; reset-error does not clear this one"},
    {"ErrorThatNoDocumentNames", [](CycleRecord& r) { r.inputs.robot_status.error_code = 65535; },
     "robot error 65535, which no document names",
     "read the robot's log, then try 'meca-ctl reset-error' and 'meca-ctl resume'"},
    {"MonitoringModeOfTheRobot",
     [](CycleRecord& r) { r.inputs.robot_status.monitoring_mode = r.control.monitoring_only = true; },
     "the robot lets this connection only monitor",
     "end the other control connection, or enable this protocol for control in the robot's portal"},
    {"NotActivated", [](CycleRecord& r) { r.inputs.robot_status.activated = r.inputs.robot_status.homed = false; },
     "the robot is not activated: its motors are off", "'meca-ctl activate', then 'meca-ctl home'"},
    {"NotActivatedOnFirmware9", [](CycleRecord& r) { r.inputs.robot_status.activated = false; },
     "the robot is not activated: its motors are off",
     "'meca-ctl activate', then 'meca-ctl home' (safety stops are not reported by this firmware: check E-Stop and "
     "P-Stop as well)",
     firmware9_robot},
    {"NotActivatedR3",
     [](CycleRecord& r) {
       r.inputs.robot_status.activated = false;
       r.product_type = 3;
     },
     "the robot is not activated: its motors are off",
     "release E-Stop if it is pressed (a Meca500 R3 does not report it), then 'meca-ctl activate', then 'meca-ctl "
     "home'"},
    {"BeingActivated",
     [](CycleRecord& r) {
       r.inputs.robot_status.activated = false;
       r.inputs.robot_status.busy = true;
     },
     "the robot is being activated", "wait until it is, then 'meca-ctl home'"},
    {"BeingDeactivated",
     [](CycleRecord& r) {
       r.inputs.robot_status.busy = true;
       r.outputs.robot_control.deactivate = true;
     },
     "the robot is being deactivated", "wait; then 'meca-ctl activate'"},
    {"ActivatedWithoutMotorPower", [](CycleRecord& r) { r.inputs.safety_status.vmotor_on = false; },
     "the motors have no power", "check the power supply, then 'meca-ctl deactivate' and 'meca-ctl activate'"},
    {"NotHomed", [](CycleRecord& r) { r.inputs.robot_status.homed = false; }, "the robot is not homed",
     "keep clear of the arm, then 'meca-ctl home'"},
    {"BeingHomed",
     [](CycleRecord& r) {
       r.inputs.robot_status.homed = false;
       r.inputs.robot_status.busy = true;
     },
     "the robot is being homed", "wait until it is done"},

    {"PStop2Present", [](CycleRecord& r) { r.inputs.safety_status.stop.p_stop2 = true; }, "P-Stop 2 is active",
     "release it, then 'meca-ctl resume'"},
    {"PStop2Resettable",
     [](CycleRecord& r) { r.inputs.safety_status.stop.p_stop2 = r.inputs.safety_status.resettable.p_stop2 = true; },
     "P-Stop 2 is released and waits for its reset", "'meca-ctl resume'"},
    {"PStop2OnFirmware9", [](CycleRecord& r) { r.inputs.motion_status.p_stop2 = true; }, "P-Stop 2 is active",
     "release it, then 'meca-ctl resume'", firmware9_robot},
    {"PStop2ResettableOnFirmware9",
     [](CycleRecord& r) { r.inputs.motion_status.p_stop2 = r.inputs.motion_status.p_stop2_resettable = true; },
     "P-Stop 2 is released and waits for its reset", "'meca-ctl resume'", firmware9_robot},
    {"ImminentCollision", [](CycleRecord& r) { r.inputs.robot_status.collision_status = true; },
     "the robot sees an imminent collision",
     "take what is in its way out of it, or plan another path; then 'meca-ctl resume'"},
    {"WorkZone", [](CycleRecord& r) { r.inputs.robot_status.work_zone_status = true; },
     "the robot is at the border of its work zone", "plan a path inside the zone; then 'meca-ctl resume'"},
    {"ClearMotionSet", [](CycleRecord& r) { r.outputs.motion_control.clear_motion = true; },
     "the bridge is clearing the robot's queue (ClearMotion is set)", "wait until it is done, then 'meca-ctl resume'"},
    {"PausedByTheBridgeForItsOwner",
     [](CycleRecord& r) {
       r.outputs.motion_control.pause_motion = r.inputs.motion_status.paused = true;
       r.control.owned = true;
       r.control.owner = control::ClientName("cell-plc");
     },
     "the bridge holds the robot (PauseMotion is set)",
     "'meca-ctl resume'; 'cell-plc' has control: command from there, or let it release control first"},
    {"PausedByTheBridgeBecauseTheOwnerIsGone",
     [](CycleRecord& r) {
       r.outputs.motion_control.pause_motion = true;
       r.control.last_owner = control::ClientName("cell-plc");
       r.control.last_loss = ControlState::Loss::kLeaseExpired;
     },
     "the bridge holds the robot (PauseMotion is set): 'cell-plc' did not renew its lease", "'meca-ctl resume'"},
    {"PausedByAClientThatLeft",
     [](CycleRecord& r) {
       r.outputs.motion_control.pause_motion = true;
       r.control.last_owner = control::ClientName("meca-ctl@host:1");
       r.control.last_loss = ControlState::Loss::kReleased;
     },
     "the bridge holds the robot (PauseMotion is set): 'meca-ctl@host:1' paused it or left it with motion queued, and "
     "released control",
     "'meca-ctl resume'"},
    {"PausedByTheRobot", [](CycleRecord& r) { r.inputs.motion_status.paused = true; }, "motion is paused",
     "'meca-ctl resume'"},
    {"PausedOnFirmware9", [](CycleRecord& r) { r.inputs.motion_status.paused = true; }, "motion is paused",
     "'meca-ctl resume' (safety stops are not reported by this firmware: check E-Stop and P-Stop as well)",
     firmware9_robot},
    {"PausedAfterClear", [](CycleRecord& r) { r.inputs.motion_status.paused = r.inputs.motion_status.cleared = true; },
     "motion is paused and the queue was cleared", "'meca-ctl resume'"},
    {"PausedByTorque",
     [](CycleRecord& r) { r.inputs.motion_status.paused = r.inputs.motion_status.excessive_torque = true; },
     "motion is paused: a joint's torque exceeds its limit",
     "free the arm or lower load and speed, then 'meca-ctl resume'"},
    {"QueueFull", [](CycleRecord& r) { r.inputs.motion_status.fifo_space = 0; }, "the robot's motion queue is full",
     "wait until it has worked off some of it, or 'meca-ctl clear'"},
};

class WhyTheRobotIsNotMoving : public testing::TestWithParam<Situation> {};

TEST_P(WhyTheRobotIsNotMoving, IsSaidWithItsRemedy) {
  CycleRecord record = GetParam().base();
  GetParam().change(record);
  const Diagnosis diagnosis = bridge::diagnose(record);
  EXPECT_EQ(diagnosis.cause, GetParam().cause);
  EXPECT_EQ(diagnosis.remedy, GetParam().remedy);
  EXPECT_EQ(diagnosis.ready, std::string(GetParam().cause).empty());
}

INSTANTIATE_TEST_SUITE_P(Diagnosis, WhyTheRobotIsNotMoving, testing::ValuesIn(kSituations),
                         [](const auto& each) { return std::string(each.param.name); });

// Facts in the order of importance; with all of them true, the first is said, and each next one when that is gone.
TEST(Diagnosis, SaysTheMostImportantCauseFirst) {
  struct Fact {
    void (*set)(CycleRecord&);
    const char* begins;
  };
  const std::vector<Fact> facts{
      {[](CycleRecord& r) { r.control.monitoring_only = true; }, "this bridge is configured"},
      {[](CycleRecord& r) { r.link = LinkState::kDown; }, "no link"},
      {[](CycleRecord& r) { r.firmware_mismatch = true; }, "firmware mismatch"},
      {[](CycleRecord& r) { r.firmware_known = false; }, "the robot's firmware is not known"},
      {[](CycleRecord& r) { r.quality = Quality::kStale; }, "no fresh image"},
      {[](CycleRecord& r) { r.inputs.safety_status.stop.e_stop = true; }, "E-Stop is active"},
      {[](CycleRecord& r) { r.inputs.safety_status.stop.reboot = true; }, "the stop after a reboot"},
      {[](CycleRecord& r) { r.inputs.robot_status.error_code = 3005; }, "robot error 3005"},
      {[](CycleRecord& r) { r.inputs.robot_status.activated = false; }, "the robot is not activated"},
      {[](CycleRecord& r) { r.inputs.safety_status.stop.p_stop2 = true; }, "P-Stop 2"},
      {[](CycleRecord& r) { r.inputs.safety_status.stop.connection_dropped = true; }, "a stop because"},
      {[](CycleRecord& r) { r.inputs.robot_status.homed = false; }, "the robot is not homed"},
      {[](CycleRecord& r) { r.inputs.robot_status.collision_status = true; }, "the robot sees an imminent"},
      {[](CycleRecord& r) { r.inputs.robot_status.work_zone_status = true; }, "the robot is at the border"},
      {[](CycleRecord& r) { r.outputs.motion_control.clear_motion = true; }, "the bridge is clearing"},
      {[](CycleRecord& r) { r.outputs.motion_control.pause_motion = true; }, "the bridge holds"},
      {[](CycleRecord& r) { r.inputs.motion_status.paused = true; }, "motion is paused"},
      {[](CycleRecord& r) { r.inputs.motion_status.fifo_space = 0; }, "the robot's motion queue is full"},
  };
  for (std::size_t first = 0; first < facts.size(); ++first) {
    CycleRecord record = moving_robot();
    for (std::size_t i = first; i < facts.size(); ++i) facts[i].set(record);
    const Diagnosis diagnosis = bridge::diagnose(record);
    EXPECT_TRUE(diagnosis.cause.starts_with(facts[first].begins))
        << diagnosis.cause << "\nand not: " << facts[first].begins;
  }
}

TEST(Diagnosis, NamesNoCommandAsARemedyWhereTheRobotTakesNone) {
  CycleRecord record = moving_robot();
  record.inputs.robot_status.monitoring_mode = record.control.monitoring_only = true;
  record.inputs.safety_status.stop.e_stop = true;
  record.inputs.robot_status.error_code = 3005;
  EXPECT_EQ(bridge::diagnose(record).cause, "the robot lets this connection only monitor");
}

// None is reset while the cause of another one is there.
TEST(Diagnosis, OfTwoStopsThatAResumeEndsSaysFirstTheOneThatIsStillPressed) {
  CycleRecord record = moving_robot();
  auto& safety = record.inputs.safety_status;
  safety.stop.p_stop2 = safety.stop.connection_dropped = true;
  EXPECT_EQ(bridge::diagnose(record).remedy, "release it");
  safety.resettable.p_stop2 = true;
  EXPECT_EQ(bridge::diagnose(record).cause, "a stop because the robot lost a control connection is active");
  EXPECT_EQ(bridge::diagnose(record).remedy, "restore that connection or let its program end, then 'meca-ctl resume'");
  safety.resettable.connection_dropped = true;
  EXPECT_EQ(bridge::diagnose(record).cause, "P-Stop 2 is released and waits for its reset");
}

TEST(Diagnosis, OfEveryErrorCodeFitsIntoBridgeStatusUncut) {
  for (const image::ErrorInfo& error : image::error_codes()) {
    CycleRecord record = moving_robot();
    record.inputs.robot_status.error_code = error.code;
    const Diagnosis diagnosis = bridge::diagnose(record);
    EXPECT_FALSE(diagnosis.ready) << error.code;
    EXPECT_NE(diagnosis.cause.find(error.text), std::string::npos) << error.code;
    EXPECT_EQ(diagnosis.remedy.find("..."), std::string::npos) << error.code;
    EXPECT_EQ(diagnosis.remedy.find("'meca-ctl reset-error'") != std::string::npos, error.resettable) << error.code;
  }
}

TEST(Diagnosis, CutsWhatIsLongerThanBridgeStatusHoldsAndNoCharacterInHalf) {
  static const std::string kLong = std::string(229, 'x') + "\xC3\xA4\xC3\xA4\xC3\xA4";  // ä is two bytes
  CycleRecord record = moving_robot();
  record.link = LinkState::kDown;
  record.link_detail = std::string_view(kLong);
  const std::string cause = bridge::diagnose(record).cause;
  EXPECT_EQ(cause, "no link to the robot: " + kLong.substr(0, 229) + "...") << cause.size();
  record.link_detail = std::string_view(kLong).substr(1);
  EXPECT_LE(bridge::diagnose(record).cause.size(), Diagnosis::kMaxText);
}

}  // namespace
