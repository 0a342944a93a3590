// The words about the network of a simulated robot: every word once as it is meant and once mistyped, and what it sets.
#include <gmock/gmock.h>

#include "sim/panel.hpp"
#include "sim/panel_port.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using testing::HasSubstr;

// A robot with a network in between, and what a person reads after a line.
struct Bench {
  std::string say(std::string_view line) {
    const auto parsed = parse_panel_line(line);
    if (const auto* complaint = std::get_if<std::string>(&parsed)) return panel_error(*complaint);
    PanelAnswer answer;
    apply(std::get<PanelRequest>(parsed), robot, &faults, answer);
    return to_text(answer);
  }
  Robot robot;
  NetworkFaults faults;
};

struct Said {
  std::string line, answer;
};
void PrintTo(const Said& said, std::ostream* out) { *out << said.line; }

class NetworkWord : public testing::TestWithParam<Said> {};

TEST_P(NetworkWord, IsListedUntilFaultsOff) {
  Bench bench;
  EXPECT_EQ(bench.say(GetParam().line), "ok: " + GetParam().answer + "\n");
  EXPECT_EQ(bench.say("faults"), "ok: " + GetParam().line + "\n");
  EXPECT_EQ(bench.say("faults off"), "ok: the network is healthy\n");
  EXPECT_EQ(bench.say("faults"), "ok: nothing is wrong with the network\n");
  EXPECT_EQ(bench.faults, NetworkFaults{});
}

INSTANTIATE_TEST_SUITE_P(
    AsMeant, NetworkWord,
    testing::Values(Said{"unplug", "the cable is out"}, Said{"freeze", "no I/O is handled"},
                    Said{"late 12.5", "answers are late"}, Said{"refuse open 0x0106", "connections are refused"},
                    Said{"wrong size 200", "connections of that T->O size are accepted, no others"},
                    Said{"api 20000", "new connections get this interval"},
                    Said{"no socket items", "replies have no socket address items"},
                    Said{"foreign address 192.0.2.9:2222", "replies name a foreign address"},
                    Said{"foreign address 255.255.255.255:65535", "replies name a foreign address"},
                    Said{"stop producing", "no T->O packets"}, Said{"duplicate", "every T->O packet comes twice"},
                    Said{"stale sequence", "every second T->O packet is stale"},
                    Said{"corrupt", "T->O packets are too short"},
                    Said{"frozen count", "the sequence count stands still"}));

class MistypedNetworkWord : public testing::TestWithParam<Said> {};

TEST_P(MistypedNetworkWord, IsAnsweredLikeThis) {
  Bench bench;
  EXPECT_EQ(bench.say(GetParam().line), "error: " + GetParam().answer + "\n");
  EXPECT_EQ(bench.faults, NetworkFaults{});
}

INSTANTIATE_TEST_SUITE_P(
    Mistyped, MistypedNetworkWord,
    testing::Values(
        Said{"unplgu", "there is no word 'unplgu', did you mean 'unplug'?"},
        Said{"unplug now", "'unplug' does not take 'now'; say 'unplug'"},
        Said{"late", "'late' wants MS; say 'late MS'"},
        Said{"late -1", "MS: found '-1'; expected a number from 0 to 60000"},
        Said{"refuse open 0x10000",
             "STATUS: found '0x10000'; expected a whole number from 1 to 65535, or in hex, 0x..."},
        Said{"refuse open 0x", "STATUS: found '0x'; expected a whole number from 1 to 65535, or in hex, 0x..."},
        Said{"refuse", "'refuse' wants a second word: open; say for example 'refuse open STATUS'"},
        Said{"wrong size 512", "SIZE: found '512'; expected a whole number from 3 to 511"},
        Said{"api 999", "US: found '999'; expected a whole number from 1000 to 10000000"},
        Said{"foreign address 192.0.2.9",
             "A.B.C.D:PORT: found '192.0.2.9'; expected an IPv4 address and a port, e.g. 192.0.2.9:2222"},
        Said{"foreign address 192.0.2.256:1",
             "A.B.C.D:PORT: found '192.0.2.256:1'; expected an IPv4 address and a port, e.g. 192.0.2.9:2222"},
        Said{"foreign address 192.0.2.9:65536",
             "A.B.C.D:PORT: found '192.0.2.9:65536'; expected an IPv4 address and a port, e.g. "
             "192.0.2.9:2222"},
        Said{"stop producng", "'stop' does not take 'producng', only producing"},
        Said{"faults of", "'faults' does not take 'of'; say 'faults'"},
        Said{"dupilcate", "there is no word 'dupilcate', did you mean 'duplicate'?"}));

TEST(NetworkPanel, SetsWhatItsWordsName) {
  Bench bench;
  bench.say("late 12.5");
  EXPECT_EQ(bench.faults.late, std::chrono::microseconds(12'500));
  bench.say("refuse open 262");
  EXPECT_EQ(bench.faults.refuse_open, 0x0106);
  bench.say("foreign address 192.0.2.9:2222");
  EXPECT_EQ(bench.faults.foreign_address, (NetworkAddress{0xC0000209, 2222}));
  EXPECT_EQ(bench.say("faults"), "ok: late 12.5, refuse open 0x0106, foreign address 192.0.2.9:2222\n");
}

TEST(NetworkPanel, EndsSomeFaultsByTheirOwnWords) {
  Bench bench;
  for (const char* line : {"unplug", "freeze", "late 5", "plug", "thaw", "late 0"}) bench.say(line);
  EXPECT_EQ(bench.faults, NetworkFaults{});
}

TEST(NetworkPanel, ClosesTcpAsOftenAsItIsAskedTo) {
  Bench bench;
  EXPECT_EQ(bench.say("close tcp"), "ok: TCP connections are closed\n");
  bench.say("faults off");
  bench.say("close tcp");
  EXPECT_EQ(bench.faults.tcp_closures, 2u);
}

TEST(NetworkPanel, StillPressesTheButtonsOfTheRobot) {
  Bench bench;
  EXPECT_EQ(bench.say("press p-stop2"), "ok: P-Stop 2 pressed\n");
  EXPECT_EQ(bench.robot.stops().p_stop2, StopSignal::kPresent);
}

TEST(NetworkPanel, RefusesItsWordsToARobotThatIsBuiltIn) {
  Robot robot;
  PanelAnswer answer;
  apply(std::get<PanelRequest>(parse_panel_line("unplug")), robot, nullptr, answer);
  EXPECT_EQ(to_text(answer),
            "error: this robot is built into the bridge, there is no network in between; meca-sim has one\n");
}

TEST(NetworkPanel, HelpNamesEveryWord) {
  const std::string text = panel_help();
  for (const char* word :
       {"unplug ", "plug ", "freeze ", "thaw ", "late MS ", "refuse open STATUS ", "wrong size SIZE ", "api US ",
        "no socket items ", "foreign address A.B.C.D:PORT ", "stop producing ", "duplicate ", "stale sequence ",
        "corrupt ", "frozen count ", "close tcp ", "faults off ", "faults "}) {
    EXPECT_THAT(text, HasSubstr("\n" + std::string(word)));
  }
}

TEST(NetworkPanel, CrossesThePortToTheThreadThatStepsTheRobot) {
  PanelPort port;
  Bench bench;
  ASSERT_TRUE(port.ask(std::get<PanelRequest>(parse_panel_line("unplug"))));
  EXPECT_EQ(port.answer(), nullptr);
  port.serve(bench.robot, &bench.faults);
  ASSERT_NE(port.answer(), nullptr);
  EXPECT_TRUE(bench.faults.unplugged);
}

}  // namespace
}  // namespace meca::sim
