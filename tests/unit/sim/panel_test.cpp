// The words that people say to a simulated robot: every word once as it is meant and once mistyped.
#include "sim/panel.hpp"

#include <gmock/gmock.h>

#include "sim/panel_port.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// What a person reads after the line, the robot being stepped once afterwards.
std::string say(Rig& rig, std::string_view line) {
  const auto parsed = parse_panel_line(line);
  if (const auto* complaint = std::get_if<std::string>(&parsed)) return panel_error(*complaint);
  PanelAnswer answer;
  apply(std::get<PanelRequest>(parsed), rig.robot, nullptr, answer);
  rig.step();
  return to_text(answer);
}

struct Said {
  std::string line, answer;
};
void PrintTo(const Said& said, std::ostream* out) { *out << said.line; }

class PanelWord : public testing::TestWithParam<Said> {};

TEST_P(PanelWord, IsAnsweredLikeThis) {
  Rig rig;
  EXPECT_EQ(say(rig, GetParam().line), GetParam().answer + "\n");
}

INSTANTIATE_TEST_SUITE_P(
    AsMeant, PanelWord,
    testing::Values(
        Said{"press e-stop", "ok: E-Stop pressed"},  //
        Said{"release e-stop", "ok: E-Stop released"},
        Said{"press reset",
             "error: there is nothing to reset: neither a released E-Stop nor a reboot waits for the Reset button"},
        Said{"press p-stop2", "ok: P-Stop 2 pressed"}, Said{"release p-stop2", "ok: P-Stop 2 is not pressed"},
        Said{"drop connection", "ok: connection dropped"},
        Said{"restore connection", "ok: the connection is not dropped"},
        Said{"raise error 1007", "ok: the robot is in error"}, Said{"power cycle", "ok: the robot starts up"},
        Said{"place part 3",
             "error: no part fits: there is no gripper (transport.tool, meca-sim --tool), or it is not open wider than "
             "the "
             "part"},
        Said{"place obstacle 300 0 200 50", "ok: the obstacle is there"},
        Said{"remove obstacle", "ok: there is no obstacle"}, Said{"push joint 2 -40", "ok: somebody pushes the joint"},
        Said{"push joint 2 0", "ok: nobody pushes the joint"},
        Said{"monitoring on", "ok: the robot only lets this host watch"},
        Said{"monitoring off", "ok: the robot listens to this host"},
        Said{"status",
             "ok: nothing pressed; no error; not activated, not homed; 0 in the queue; 0 executed, "
             "0 discarded, 0 refused; violations: 0"},
        Said{"violations", "ok: the host broke no rule"}, Said{"journal", "ok: no command has come to its end yet"},
        Said{"journal 64", "ok: no command has come to its end yet"},
        Said{"  PRESS \t E-Stop \r", "ok: E-Stop pressed"}));

INSTANTIATE_TEST_SUITE_P(
    Mistyped, PanelWord,
    testing::Values(
        Said{"", "error: the line is empty; 'help' lists the words"},
        Said{" \t ", "error: the line is empty; 'help' lists the words"},
        Said{"press e-stopp", "error: 'press' does not take 'e-stopp', only e-stop, reset, p-stop2"},
        Said{"press e-stop now", "error: 'press e-stop' does not take 'now'; say 'press e-stop'"},
        Said{"relaese e-stop", "error: there is no word 'relaese e-stop', did you mean 'release e-stop'?"},
        Said{"release", "error: 'release' wants a second word: e-stop, p-stop2; say for example 'release e-stop'"},
        Said{"press rset", "error: 'press' does not take 'rset', only e-stop, reset, p-stop2"},
        Said{"release p-stop", "error: 'release' does not take 'p-stop', only e-stop, p-stop2"},
        Said{"drop conection", "error: 'drop' does not take 'conection', only connection"},
        Said{"restore", "error: 'restore' wants a second word: connection; say for example 'restore connection'"},
        Said{"raise", "error: 'raise' wants a second word: error; say for example 'raise error CODE'"},
        Said{"raise error", "error: 'raise error' wants CODE; say 'raise error CODE'"},
        Said{"raise error seven", "error: CODE: found 'seven'; expected a whole number from 0 to 65535"},
        Said{"raise error 1007.5", "error: CODE: found '1007.5'; expected a whole number from 0 to 65535"},
        Said{"raise error 65536", "error: CODE: found '65536'; expected a whole number from 0 to 65535"},
        Said{"raise error nan", "error: CODE: found 'nan'; expected a whole number from 0 to 65535"},
        Said{"raise error 7",
             "error: 7 is no error code of the Meca500 that any document names; try 1007, joint over limit"},
        Said{"raise error 1007 1012", "error: 'raise error' does not take '1012'; say 'raise error CODE'"},
        Said{"monitoring of", "error: 'monitoring' does not take 'of', only on, off"},
        Said{"power of", "error: 'power' does not take 'of', only cycle, off, on"},
        Said{"place part", "error: 'place part' wants MM; say 'place part MM'"},
        Said{"place part -1", "error: MM: found '-1'; expected a number from 0 to 1000"},
        Said{"place", "error: 'place' wants a second word: part, obstacle; say for example 'place part MM'"},
        Said{"place obstacle 300 0 200", "error: 'place obstacle' wants RADIUS; say 'place obstacle X Y Z RADIUS'"},
        Said{"place obstacle 300 0 200 0", "error: RADIUS: found '0'; expected a number from 1 to 1000"},
        Said{"remove obstacles", "error: 'remove' does not take 'obstacles', only obstacle"},
        Said{"push joint 7 10", "error: JOINT: found '7'; expected a whole number from 1 to 6"},
        Said{"push joint 2", "error: 'push joint' wants PERCENT; say 'push joint JOINT PERCENT'"},
        Said{"satus", "error: there is no word 'satus', did you mean 'status'?"},
        Said{"status all", "error: 'status' does not take 'all'; say 'status'"},
        Said{"violation", "error: there is no word 'violation', did you mean 'violations'?"},
        Said{"jurnal 10", "error: there is no word 'jurnal 10', did you mean 'journal'?"},
        Said{"journal 0", "error: N: found '0'; expected a whole number from 1 to 64"},
        Said{"journal 65", "error: N: found '65'; expected a whole number from 1 to 64"},
        Said{"hepl", "error: there is no word 'hepl', did you mean 'help'?"},
        Said{"make coffee", "error: there is no word 'make coffee'; 'help' lists them"},
        Said{"press\xFF", "error: byte 6 of the line is not printable ASCII; words are separated by blanks"}));

TEST(Panel, HelpNamesEveryWordWithWhatItIsFor) {
  Rig rig;
  const std::string text = say(rig, "help");
  EXPECT_THAT(text, StartsWith("ok: the words of a simulated robot\n"));
  for (const char* word :
       {"press e-stop ", "press reset ", "press p-stop2 ", "release e-stop ", "release p-stop2 ", "drop connection ",
        "restore connection ", "raise error CODE ", "power cycle ", "place part MM ", "place obstacle X Y Z RADIUS ",
        "remove obstacle ", "push joint JOINT PERCENT ", "monitoring on ", "monitoring off ", "status ", "violations ",
        "journal [N] ", "help "}) {
    EXPECT_THAT(text, HasSubstr("\n  " + std::string(word)));
  }
}

TEST(Panel, APushIsTorqueOfItsJoint) {
  RobotOptions options = Rig::quick();
  options.noise = false;
  Rig rig(options);
  rig.make_ready();
  rig.out.dynamic_data_configuration.type_ids[0] = 43;  // actual joint torques
  for (int i = 0; i < 5; ++i) rig.step();
  const float before = rig.robot.inputs().dynamic_data[0].values[3];
  say(rig, "push joint 4 25");
  for (int i = 0; i < 5; ++i) rig.step();
  EXPECT_NEAR(rig.robot.inputs().dynamic_data[0].values[3], before + 25, 0.01);
}

TEST(Panel, EStopOfAnR4NeedsReleaseAndResetInThisOrder) {
  Rig rig;
  rig.make_ready();
  say(rig, "press e-stop");
  EXPECT_TRUE(rig.robot.inputs().robot_status.e_stop);
  EXPECT_FALSE(rig.robot.inputs().robot_status.activated);
  EXPECT_EQ(say(rig, "press reset"), "error: Reset does nothing while the E-Stop is pressed; 'release e-stop' first\n");
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: E-Stop pressed; no error; not activated, "));
  EXPECT_EQ(say(rig, "release e-stop"), "ok: E-Stop released; the power supply waits for 'press reset'\n");
  EXPECT_TRUE(rig.robot.inputs().safety_status.reset_ready);
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: E-Stop released and not reset; "));
  EXPECT_EQ(say(rig, "press reset"), "ok: Reset pressed, no E-Stop and no reboot stops the robot any more\n");
  EXPECT_FALSE(rig.robot.inputs().robot_status.e_stop);
}

TEST(Panel, APowerCycleTakesTheRobotAwayAndAnR4MayWaitForTheResetButtonAfterwards) {
  RobotOptions options = Rig::quick();
  options.boot_time = 10ms;
  options.reboot_stop = true;
  Rig rig(options);
  say(rig, "press reset");
  say(rig, "power cycle");
  EXPECT_THAT(say(rig, "status"), HasSubstr("; starting up, before that: "));
  rig.run(20ms);
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: rebooted and not reset; no error; "));
  EXPECT_THAT(say(rig, "press reset"), StartsWith("ok: Reset pressed"));
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: nothing pressed; "));
}

TEST(Panel, TellsOfTheEStopOfAnR3ThatItsImageDoesNotShow) {
  Rig rig(Rig::quick(image::Layout::kFirmware9, Product::kMeca500R3));
  say(rig, "press e-stop");
  EXPECT_FALSE(rig.robot.inputs().robot_status.e_stop);
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: E-Stop pressed; "));
  EXPECT_EQ(say(rig, "release e-stop"), "ok: E-Stop released\n");
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: nothing pressed; "));
}

TEST(Panel, PStop2DiscardsWhatIsQueuedAndWaitsForTheHostToResume) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.send(image::kDelay, {1});
  rig.run(20ms);
  EXPECT_THAT(say(rig, "status"), HasSubstr("activated, homed; 1 in the queue; 0 executed"));
  say(rig, "press p-stop2");
  rig.run(1s);
  EXPECT_THAT(say(rig, "status"), AllOf(StartsWith("ok: P-Stop 2 pressed; no error; activated, homed; 0 in the queue;"),
                                        HasSubstr("2 discarded")));
  EXPECT_EQ(say(rig, "release p-stop2"), "ok: P-Stop 2 released; the host has to resume motion\n");
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: P-Stop 2 released and not resumed; "));
  rig.resume();
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: nothing pressed; "));
}

TEST(Panel, ADroppedConnectionIsASafetyStopUntilItIsBackAndTheHostResumes) {
  Rig rig;
  rig.make_ready();
  say(rig, "drop connection");
  EXPECT_TRUE(rig.robot.inputs().safety_status.stop.connection_dropped);
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: connection dropped; "));
  EXPECT_EQ(say(rig, "restore connection"), "ok: connection restored; the host has to resume motion\n");
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: connection restored and not resumed; "));
  rig.resume();
  EXPECT_FALSE(rig.robot.inputs().safety_status.stop.connection_dropped);
}

TEST(Panel, ARaisedErrorShowsWithItsNameAndTheFirstCauseStays) {
  Rig rig;
  rig.make_ready();
  say(rig, "raise error 1012");
  EXPECT_EQ(rig.error(), 1012);
  EXPECT_THAT(say(rig, "status"), HasSubstr("; error 1012 SINGULARITY_ERR; "));
  EXPECT_THAT(say(rig, "raise error 1007"), StartsWith("error: the robot is in error already"));
  EXPECT_EQ(rig.error(), 1012);
  rig.reset_error();
  EXPECT_EQ(say(rig, "raise error 1007"), "ok: the robot is in error\n");
  EXPECT_EQ(rig.error(), 1007);
}

TEST(Panel, MonitoringMakesTheRobotDeafUntilItIsOffAgain) {
  Rig rig;
  say(rig, "monitoring on");
  rig.out.robot_control.activate = true;
  rig.run(10ms);
  EXPECT_FALSE(rig.robot.inputs().robot_status.activated);
  EXPECT_THAT(say(rig, "status"), StartsWith("ok: monitoring only; "));
  say(rig, "monitoring off");
  rig.run(10ms);
  EXPECT_TRUE(rig.robot.inputs().robot_status.activated);
}

TEST(Panel, JournalListsTheLastCommandsWithArgumentsAndWhatBecameOfThem) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kSetJointVel, {50});
  rig.perform(image::kSetCheckpoint, {7});
  rig.send(image::kMoveJoints, {400, 0, 0, 0, 0, 0});
  rig.run(20ms);
  const std::string all = say(rig, "journal");
  EXPECT_THAT(all, StartsWith("ok: the last 3 of 3 commands"));
  EXPECT_THAT(all, HasSubstr(" s  SetJointVel(50), MoveID 1: executed\n"));
  EXPECT_THAT(all, HasSubstr(" s  SetCheckpoint(7), MoveID 2: executed\n"));
  EXPECT_THAT(all, HasSubstr(" s  MoveJoints(400, 0, 0, 0, 0, 0), MoveID 3: refused: 1007 JOINT_OVER_LIMIT\n"));
  const std::string last = say(rig, "journal 1");
  EXPECT_THAT(last, AllOf(StartsWith("ok: the last 1 of 3 commands"), HasSubstr("MoveID 3"),
                          testing::Not(HasSubstr("MoveID 2"))));
}

TEST(Panel, JournalNamesCommandsThatNoManualHasByTheirNumber) {
  Rig rig;
  rig.make_ready();
  rig.send(77, {1.5});
  EXPECT_THAT(say(rig, "journal"), HasSubstr("command 77(1.5, 0, 0, 0, 0, 0), MoveID 1: refused: 1001 UNKNOWN_CMD"));
}

TEST(Panel, JournalKeepsCountingBeyondWhatItRemembers) {
  RobotOptions options = Rig::quick();
  options.journal_capacity = 4;
  Rig rig(options);
  rig.make_ready();
  for (int i = 0; i < 10; ++i) rig.perform(image::kSetCheckpoint, {1});
  EXPECT_THAT(say(rig, "journal"), StartsWith("ok: the last 4 of 10 commands"));
  EXPECT_THAT(say(rig, "status"), HasSubstr("; 10 executed, 0 discarded, 0 refused; "));
}

TEST(Panel, ViolationsSayWhichRuleTheHostBroke) {
  Rig rig;
  rig.out.robot_control.activate = true;
  rig.step();
  rig.out.robot_control.activate = false;
  rig.step();
  EXPECT_THAT(say(rig, "violations"), AllOf(StartsWith("ok: the last 1 of 1 violations"),
                                            HasSubstr(" s  Activate was dropped before Activated confirmed it\n")));
  EXPECT_THAT(say(rig, "status"), HasSubstr("violations: 1\n"));
}

TEST(PanelPort, DoesOneRequestAStepInTheOrderTheyWereAsked) {
  Rig rig;
  PanelPort port;
  ASSERT_TRUE(port.ask(std::get<PanelRequest>(parse_panel_line("press p-stop2"))));
  ASSERT_TRUE(port.ask(std::get<PanelRequest>(parse_panel_line("status"))));
  EXPECT_EQ(port.answer(), nullptr);
  port.serve(rig.robot);
  EXPECT_EQ(port.answer(), nullptr);  // the answer to the first: not what was asked last
  port.serve(rig.robot);
  const PanelAnswer* answer = port.answer();
  ASSERT_NE(answer, nullptr);
  EXPECT_THAT(to_text(*answer), StartsWith("ok: P-Stop 2 pressed; "));
}

TEST(PanelPort, IsFullWhenNobodyStepsTheRobotAndLosesNothingThatItTook) {
  Rig rig;
  PanelPort port;
  const auto press = std::get<PanelRequest>(parse_panel_line("press p-stop2"));
  int taken = 0;
  while (port.ask(press)) ++taken;
  EXPECT_EQ(taken, 4);
  for (int i = 0; i < 20; ++i) port.serve(rig.robot);
  EXPECT_EQ(port.answer(), nullptr);  // the one asked last was never taken
  ASSERT_TRUE(port.ask(std::get<PanelRequest>(parse_panel_line("release p-stop2"))));
  port.serve(rig.robot);
  ASSERT_NE(port.answer(), nullptr);
}

}  // namespace
}  // namespace meca::sim
