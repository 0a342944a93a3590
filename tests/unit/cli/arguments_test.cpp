#include "cli/arguments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace meca::cli {
namespace {

using meca500::CommandKind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

Invocation understood(const Words& words) {
  const auto parsed = parse_arguments(words);
  if (const auto* answer = std::get_if<Answer>(&parsed)) {
    ADD_FAILURE() << answer->text;
    return {};
  }
  return std::get<Invocation>(parsed);
}

// What a person reads when the words are not understood; the exit code is 2 then.
std::string refusal(const Words& words) {
  const auto parsed = parse_arguments(words);
  const auto* answer = std::get_if<Answer>(&parsed);
  if (answer == nullptr) return "(understood)";
  EXPECT_EQ(answer->code, ExitCode::kArguments);
  return answer->text;
}

TEST(Arguments, NegativeNumbersArePositionsAndNotOptions) {
  const auto call = understood({"move-joints", "-10", "0", "-0.5", "-.25", "-1e1", "-0"});
  EXPECT_EQ(call.verb, Verb::kCommand);
  EXPECT_EQ(call.command.kind, CommandKind::MOTION);
  EXPECT_EQ(call.command.motion_command_id, 1u);
  EXPECT_THAT(call.command.arguments, ElementsAre(-10, 0, -0.5, -0.25, -10, 0));
}

TEST(Arguments, TwoDashesEndTheOptions) {
  EXPECT_THAT(understood({"move-joints", "--wait", "--", "-1", "-2", "-3", "-4", "-5", "-6"}).command.arguments,
              ElementsAre(-1, -2, -3, -4, -5, -6));
}

TEST(Arguments, OptionsMayStandBeforeOrBehindTheCommand) {
  const auto before =
      understood({"--robot", "arm2", "--wait", "--json", "move-lin", "190", "-50", "250", "0", "90", "0"});
  const auto behind =
      understood({"move-lin", "190", "-50", "250", "0", "90", "0", "--robot", "arm2", "--wait", "--json"});
  for (const auto& call : {before, behind}) {
    EXPECT_EQ(call.robot, "arm2");
    EXPECT_TRUE(call.wait);
    EXPECT_TRUE(call.json);
    EXPECT_EQ(call.command.motion_command_id, 3u);
    EXPECT_THAT(call.command.arguments, ElementsAre(190, -50, 250, 0, 90, 0));
  }
}

TEST(Arguments, ConnectionOptionsHaveDefaultsThatFitTheBridge) {
  const auto call = understood({"status"});
  EXPECT_EQ(call.verb, Verb::kStatus);
  EXPECT_EQ(call.domain, 0);
  EXPECT_EQ(call.prefix, "meca500/");
  EXPECT_TRUE(call.interfaces.empty());
  EXPECT_TRUE(call.shared_memory);
  EXPECT_FALSE(call.wait);
}

TEST(Arguments, SimTakesWordsAsTheyAreAndNoneForTheirList) {
  const auto call = understood({"sim", "push", "2", "-30", "--robot", "arm2", "--socket", "/run/arm2.sock"});
  EXPECT_EQ(call.verb, Verb::kSim);
  EXPECT_EQ(call.sim_line, "push 2 -30");
  EXPECT_EQ(call.robot, "arm2");
  EXPECT_EQ(call.socket, "/run/arm2.sock");
  EXPECT_EQ(understood({"sim"}).sim_line, "");
  EXPECT_THAT(refusal({"sim", "press", "e-stop", "--sockt", "x"}), HasSubstr("did you mean '--socket'?"));
}

TEST(Arguments, ScanWantsAFieldbusThatItKnows) {
  const auto call = understood({"scan", "ethernet_ip", "--interface", "eth1", "--address", "192.168.0.100"});
  EXPECT_EQ(call.verb, Verb::kScan);
  EXPECT_THAT(call.interfaces, ElementsAre("eth1"));
  EXPECT_EQ(call.address, "192.168.0.100");
  EXPECT_THAT(refusal({"scan"}), HasSubstr("scan wants a fieldbus"));
  EXPECT_THAT(refusal({"scan", "ethernetip"}), HasSubstr("did you mean 'ethernet_ip'?"));
  EXPECT_THAT(refusal({"scan", "ethercad"}), HasSubstr("did you mean 'ethercat'?"));
}

TEST(Arguments, ScanOfEthercatWantsTheInterfaceOfTheChain) {
  const auto call = understood({"scan", "ethercat", "--interface", "eth1", "--interface", "eth2"});
  EXPECT_EQ(call.verb, Verb::kScan);
  EXPECT_EQ(call.scan_bus, ScanBus::kEthercat);
  EXPECT_THAT(call.interfaces, ElementsAre("eth1", "eth2"));
  EXPECT_THAT(refusal({"scan", "ethercat"}), HasSubstr("scan ethercat wants --interface NAME"));
  EXPECT_THAT(refusal({"scan", "ethercat", "--interface", "eth1", "--address", "10.0.0.1"}),
              HasSubstr("takes no --address"));
  EXPECT_EQ(understood({"scan", "ethernet_ip"}).scan_bus, ScanBus::kEthernetIp);
}

TEST(Arguments, ConnectionOptionsAreTaken) {
  const auto call =
      understood({"watch", "--domain", "7", "--prefix", "cell/", "--interface", "127.0.0.1", "--interface", "10.0.0.1",
                  "--no-shared-memory", "--client", "me", "--for", "2", "--rate", "5"});
  EXPECT_EQ(call.verb, Verb::kWatch);
  EXPECT_EQ(call.domain, 7);
  EXPECT_EQ(call.prefix, "cell/");
  EXPECT_THAT(call.interfaces, ElementsAre("127.0.0.1", "10.0.0.1"));
  EXPECT_FALSE(call.shared_memory);
  EXPECT_EQ(call.client, "me");
  EXPECT_EQ(call.duration_s, 2.0);
  EXPECT_EQ(call.rate_hz, 5.0);
}

TEST(Arguments, AnInterfaceDoesNotSwallowTheCommandBehindIt) {
  const auto call = understood({"--interface", "127.0.0.1", "health"});
  EXPECT_EQ(call.verb, Verb::kHealth);
  EXPECT_THAT(call.interfaces, ElementsAre("127.0.0.1"));
}

TEST(Arguments, TheEnvironmentGivesTheDomainAndTheCommandLineOverrulesIt) {
  ASSERT_EQ(setenv("MECA_DOMAIN", "42", 1), 0);
  EXPECT_EQ(understood({"status"}).domain, 42);
  EXPECT_EQ(understood({"--domain", "43", "status"}).domain, 43);
  ASSERT_EQ(unsetenv("MECA_DOMAIN"), 0);
}

TEST(Arguments, EveryActionHasItsCommandKind) {
  const std::vector<std::pair<Words, CommandKind>> actions{
      {{"activate"}, CommandKind::ACTIVATE},
      {{"deactivate"}, CommandKind::DEACTIVATE},
      {{"home"}, CommandKind::HOME},
      {{"reset-error"}, CommandKind::RESET_ERROR},
      {{"pause"}, CommandKind::PAUSE_MOTION},
      {{"resume"}, CommandKind::RESUME_MOTION},
      {{"clear"}, CommandKind::CLEAR_MOTION},
      {{"release"}, CommandKind::RELEASE_CONTROL},
      {{"sim-mode", "on"}, CommandKind::SIM_MODE},
      {{"recovery-mode", "off"}, CommandKind::RECOVERY_MODE},
  };
  for (const auto& [words, kind] : actions) EXPECT_EQ(understood(words).command.kind, kind) << words.front();
}

TEST(Arguments, OnAndOffBecomeOneAndZero) {
  EXPECT_THAT(understood({"sim-mode", "on"}).command.arguments, ElementsAre(1));
  EXPECT_THAT(understood({"recovery-mode", "off"}).command.arguments, ElementsAre(0));
  EXPECT_THAT(refusal({"sim-mode", "of"}), HasSubstr("sim-mode wants 'on' or 'off', not 'of'"));
  EXPECT_THAT(refusal({"sim-mode"}), HasSubstr("not nothing"));
}

TEST(Arguments, SendTakesANameOrANumber) {
  for (const Words& words :
       {Words{"send", "SetJointVel", "50"}, Words{"send", "setjointvel", "50"}, Words{"send", "8", "50"}}) {
    const auto call = understood(words);
    EXPECT_EQ(call.command.motion_command_id, 8u);
    EXPECT_EQ(call.command.title, "SetJointVel");
    EXPECT_THAT(call.command.arguments, ElementsAre(50));
  }
}

TEST(Arguments, SendLeavesNumbersThatNoTableHasToTheBridge) {
  const auto call = understood({"send", "77", "1", "2"});
  EXPECT_EQ(call.command.motion_command_id, 77u);
  EXPECT_THAT(call.command.arguments, ElementsAre(1, 2));
}

TEST(Arguments, SendSetsAVariableByItsCyclicId) {
  const auto call = understood({"send", "10007", "1.5"});
  EXPECT_EQ(call.command.motion_command_id, 10007u);
  EXPECT_THAT(call.command.arguments, ElementsAre(1.5));
}

TEST(Arguments, SendMarksArgumentsAsVariablesOnlyWhenAsked) {
  EXPECT_TRUE(understood({"send", "SetJointVel", "10000", "--use-variables"}).command.use_variables);
  EXPECT_FALSE(understood({"send", "SetJointVel", "50"}).command.use_variables);
}

TEST(Arguments, SendSuggestsTheNameThatWasMeant) {
  EXPECT_THAT(refusal({"send", "SetJointVell", "50"}), HasSubstr("did you mean 'SetJointVel'?"));
  EXPECT_THAT(refusal({"send", "Frobnicate"}), HasSubstr("no motion command is called 'Frobnicate'; names are"));
}

TEST(Arguments, SendPointsVelocityCommandsToTheStream) {
  EXPECT_THAT(refusal({"send", "22", "0", "0", "-20", "0", "0", "0"}), HasSubstr("meca-ctl velocity lin-wrf"));
}

TEST(Arguments, VelocityKnowsItsThreeFrames) {
  EXPECT_EQ(understood({"velocity", "joints", "1", "0", "0", "0", "0", "-6", "--for", "1.5"}).velocity.velocity[5],
            -6.0f);
  EXPECT_EQ(understood({"velocity", "lin-wrf", "0", "0", "-20", "0", "0", "0", "--for", "1"}).velocity.kind,
            meca500::VelocityKind::MOVE_LIN_VEL_WRF);
  EXPECT_EQ(understood({"velocity", "lin-trf", "0", "0", "-20", "0", "0", "0", "--for", "1"}).velocity.kind,
            meca500::VelocityKind::MOVE_LIN_VEL_TRF);
}

TEST(Arguments, VelocityRefusesWhatHasNoEndNoFrameOrNoSense) {
  EXPECT_THAT(refusal({"velocity", "joints", "1", "0", "0", "0", "0", "0"}), HasSubstr("--for SECONDS"));
  EXPECT_THAT(refusal({"velocity", "sideways", "1", "0", "0", "0", "0", "0", "--for", "1"}),
              HasSubstr("not 'sideways'"));
  EXPECT_THAT(refusal({"velocity", "joints", "1e300", "0", "0", "0", "0", "0", "--for", "1"}), HasSubstr("1e300"));
  EXPECT_THAT(refusal({"velocity", "joints", "1", "0", "0", "0", "0", "0", "--for", "-1"}), HasSubstr("--for"));
}

TEST(Arguments, AWrongNumberOfArgumentsNamesThoseThatAreWantedWithUnits) {
  EXPECT_THAT(refusal({"move-joints", "1", "2", "3"}),
              HasSubstr("move-joints wants 6 numbers: q1 q2 q3 q4 q5 q6 (deg); 3 came"));
  EXPECT_THAT(refusal({"move-pose"}), HasSubstr("x y z (mm) alpha beta gamma (deg); none came"));
  EXPECT_THAT(refusal({"move-lin", "1", "2", "3", "4", "5", "6", "7"}), HasSubstr("7 came"));
  EXPECT_THAT(refusal({"send", "SetJointVel"}), HasSubstr("wants 1 number: p (%); none came"));
}

TEST(Arguments, WhatIsNoNumberIsNamed) {
  EXPECT_THAT(refusal({"move-joints", "1", "2", "3", "4", "5", "x"}), HasSubstr("q6: 'x' is not a finite number"));
  EXPECT_THAT(refusal({"move-joints", "1", "nan", "3", "4", "5", "6"}), HasSubstr("q2: 'nan' is not a finite number"));
  EXPECT_THAT(refusal({"move-joints", "1e999", "2", "3", "4", "5", "6"}), HasSubstr("q1: '1e999'"));
  EXPECT_THAT(refusal({"move-joints", "10deg", "2", "3", "4", "5", "6"}), HasSubstr("q1: '10deg'"));
}

TEST(Arguments, AMistypedCommandGetsASuggestion) {
  EXPECT_THAT(refusal({"actvate"}), HasSubstr("there is no command 'actvate', did you mean 'activate'?"));
  EXPECT_THAT(refusal({"mvoe-joints", "-10", "0", "0", "0", "0", "0"}), HasSubstr("did you mean 'move-joints'?"));
  EXPECT_THAT(refusal({"--robot", "arm1", "statsu"}), HasSubstr("did you mean 'status'?"));
}

TEST(Arguments, AMistypedOptionGetsASuggestion) {
  EXPECT_THAT(refusal({"status", "--domian", "3"}),
              HasSubstr("there is no option '--domian', did you mean '--domain'?"));
  EXPECT_THAT(refusal({"activate", "--wiat"}), HasSubstr("did you mean '--wait'?"));
}

TEST(Arguments, WordsTooManyAreRefused) {
  EXPECT_THAT(refusal({"activate", "now"}), HasSubstr("activate does not take 'now'"));
  EXPECT_THAT(refusal({"status", "home"}), HasSubstr("status does not take 'home'"));
}

TEST(Arguments, ValuesOutOfRangeAreRefusedWithTheRange) {
  EXPECT_THAT(refusal({"status", "--domain", "233"}), HasSubstr("232"));
  EXPECT_THAT(refusal({"status", "--timeout", "0"}), HasSubstr("--timeout"));
  EXPECT_THAT(refusal({"status", "--client", std::string(64, 'c')}), HasSubstr("at most 63 bytes"));
  EXPECT_THAT(refusal({"decode", "--input", "00", "--byte-order", "middle"}), HasSubstr("--byte-order"));
}

TEST(Arguments, HelpIsNoMistakeAndTeachesWithExamplesAndExitCodes) {
  const auto parsed = parse_arguments({"--help"});
  ASSERT_TRUE(std::holds_alternative<Answer>(parsed));
  EXPECT_EQ(std::get<Answer>(parsed).code, ExitCode::kDone);
  EXPECT_THAT(std::get<Answer>(parsed).text, HasSubstr("move-joints -10 0 0 0 0 0 --wait"));
  EXPECT_THAT(std::get<Answer>(parsed).text, HasSubstr("Exit codes: 0 done, 1 refused"));
}

TEST(Arguments, NoCommandAtAllShowsTheHelpAsAMistake) { EXPECT_THAT(refusal({}), HasSubstr("Subcommands:")); }

TEST(Arguments, ErrorsTakesOneKnownCodeOrNone) {
  EXPECT_EQ(understood({"errors"}).verb, Verb::kErrors);
  EXPECT_EQ(understood({"errors", "1007"}).trouble, "1007");
  EXPECT_TRUE(understood({"errors", "--markdown"}).markdown);
  EXPECT_THAT(refusal({"errors", "4711"}), HasSubstr("no document names an error or stop '4711'"));
  EXPECT_THAT(refusal({"errors", "1007", "3005"}), HasSubstr("errors does not take '3005'"));
  EXPECT_THAT(refusal({"errors", "1007", "--markdown"}), HasSubstr("prints the whole page"));
}

TEST(Arguments, DecodeTakesInputFirmwareAndByteOrder) {
  const auto call = understood({"decode", "--input", "-", "--firmware", "10.2", "--byte-order", "big"});
  EXPECT_EQ(call.verb, Verb::kDecode);
  EXPECT_EQ(call.input, "-");
  EXPECT_EQ(call.firmware, "10.2");
  EXPECT_TRUE(call.big_endian);
  EXPECT_THAT(refusal({"decode"}), HasSubstr("decode wants --input"));
}

}  // namespace
}  // namespace meca::cli
