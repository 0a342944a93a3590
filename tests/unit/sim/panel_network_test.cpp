// The words about the network of a simulated robot: every word once as it is meant and once mistyped, and what it sets.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "sim/panel.hpp"
#include "sim/panel_port.hpp"
#include "tests/unit/sim/rig.hpp"

namespace meca::sim {
namespace {

using testing::HasSubstr;

// A robot with a network in between, and what a person reads after a line.
struct Bench {
  explicit Bench(Fieldbus bus = Fieldbus::kEthernetIp) { faults.bus = bus; }
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
  Fieldbus bus = Fieldbus::kEthernetIp;
};
void PrintTo(const Said& said, std::ostream* out) { *out << said.line; }

class NetworkWord : public testing::TestWithParam<Said> {};

TEST_P(NetworkWord, IsListedUntilFaultsOff) {
  Bench bench(GetParam().bus);
  const NetworkFaults healthy = bench.faults;
  EXPECT_EQ(bench.say(GetParam().line), "ok: " + GetParam().answer + "\n");
  EXPECT_EQ(bench.say("faults"), "ok: " + GetParam().line + "\n");
  EXPECT_EQ(bench.say("faults off"), "ok: the network is healthy\n");
  EXPECT_EQ(bench.say("faults"), "ok: nothing is wrong with the network\n");
  EXPECT_EQ(bench.faults, healthy);
}

constexpr Fieldbus kEthercat = Fieldbus::kEthercat;

INSTANTIATE_TEST_SUITE_P(OnAnyBus, NetworkWord,
                         testing::Values(Said{"unplug", "the cable is out"},
                                         Said{"power off", "the robot has no power"},
                                         Said{"freeze", "no I/O is handled"}, Said{"late 12.5", "answers are late"},
                                         Said{"unplug", "the cable is out", kEthercat},
                                         Said{"power off", "the robot has no power", kEthercat},
                                         Said{"freeze", "no I/O is handled", kEthercat},
                                         Said{"late 0.5", "answers are late", kEthercat},
                                         Said{"duplicate", "what the robot sends comes twice"},
                                         Said{"duplicate", "what the robot sends comes twice", kEthercat},
                                         Said{"corrupt", "what the robot sends is too short"},
                                         Said{"corrupt", "what the robot sends is too short", kEthercat}));

INSTANTIATE_TEST_SUITE_P(OnEthercat, NetworkWord,
                         testing::Values(Said{"cut", "the cable before this robot is cut", kEthercat},
                                         Said{"cut behind", "the cable behind this robot is cut", kEthercat},
                                         Said{"clock drift -100", "the clock drifts", kEthercat},
                                         Said{"foreign on", "another maker's device is in the robot's place",
                                              kEthercat},
                                         Said{"lose next 3", "the next frames do not come back", kEthercat},
                                         Said{"lose every 200", "some frames do not come back", kEthercat},
                                         Said{"lose mails", "mails of the robot are lost on their way", kEthercat},
                                         Said{"no mailbox", "mails are not answered", kEthercat},
                                         Said{"working counter -1", "the working counter is wrong", kEthercat},
                                         Said{"refuse state 0x0025", "states above PREOP are refused", kEthercat}));

INSTANTIATE_TEST_SUITE_P(
    OnEthernetIp, NetworkWord,
    testing::Values(Said{"refuse open 0x0106", "connections are refused"},
                    Said{"wrong size 200", "connections of that T->O size are accepted, no others"},
                    Said{"api 20000", "new connections get this interval"},
                    Said{"no socket items", "replies have no socket address items"},
                    Said{"foreign address 192.0.2.9:2222", "replies name a foreign address"},
                    Said{"foreign address 255.255.255.255:65535", "replies name a foreign address"},
                    Said{"stop producing", "no T->O packets"},
                    Said{"stale sequence", "every second T->O packet is stale"},
                    Said{"frozen count", "the sequence count stands still"}));

class MistypedNetworkWord : public testing::TestWithParam<Said> {};

TEST_P(MistypedNetworkWord, IsAnsweredLikeThis) {
  Bench bench(GetParam().bus);
  const NetworkFaults healthy = bench.faults;
  EXPECT_EQ(bench.say(GetParam().line), "error: " + GetParam().answer + "\n");
  EXPECT_EQ(bench.faults, healthy);
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
        Said{"refuse", "'refuse' wants a second word: open, state; say for example 'refuse open STATUS'"},
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
        Said{"dupilcate", "there is no word 'dupilcate', did you mean 'duplicate'?"},
        Said{"lose", "'lose' wants a second word: next, every, mails; say for example 'lose next N'", kEthercat},
        Said{"lose every -1", "N: found '-1'; expected a whole number from 0 to 1000000", kEthercat},
        Said{"working counter 4", "N: found '4'; expected a whole number from -3 to 3", kEthercat},
        Said{"clock drift", "'clock drift' wants PPM; say 'clock drift PPM'", kEthercat},
        Said{"clock drift 0.5", "PPM: found '0.5'; expected a whole number from -1000 to 1000", kEthercat},
        Said{"clock drift 1001", "PPM: found '1001'; expected a whole number from -1000 to 1000", kEthercat},
        Said{"clock", "'clock' wants a second word: drift; say for example 'clock drift PPM'", kEthercat},
        Said{"cut before", "'cut' does not take 'before'; say 'cut'", kEthercat},
        Said{"foreign",
             "'foreign' wants a second word: address, on, off; say for example 'foreign address "
             "A.B.C.D:PORT'",
             kEthercat},
        Said{"refuse stat 1", "'refuse' does not take 'stat', only open, state", kEthercat},
        Said{"al error", "'al error' wants CODE; say 'al error CODE'", kEthercat},
        Said{"al error 0x1001B", "CODE: found '0x1001b'; expected a whole number from 1 to 65535, or in hex, 0x...",
             kEthercat}));

class MisplacedWord : public testing::TestWithParam<Said> {};

TEST_P(MisplacedWord, IsRefusedWithTheBusItIsFor) {
  Bench bench(GetParam().bus);
  const NetworkFaults healthy = bench.faults;
  EXPECT_EQ(bench.say(GetParam().line), "error: " + GetParam().answer + "\n");
  EXPECT_EQ(bench.faults, healthy);
}

const std::string kForEthercat =
    "that is a word for EtherCAT, and this robot is on EtherNet/IP; 'help' says which words are for it";
const std::string kForEthernetIp =
    "that is a word for EtherNet/IP, and this robot is on EtherCAT; 'help' says which words are for it";

INSTANTIATE_TEST_SUITE_P(
    OfAnotherBus, MisplacedWord,
    testing::Values(
        Said{"cut", kForEthercat}, Said{"heal", kForEthercat}, Said{"cut behind", kForEthercat},
        Said{"heal behind", kForEthercat}, Said{"clock drift 20", kForEthercat}, Said{"foreign on", kForEthercat},
        Said{"foreign off", kForEthercat}, Said{"lose next 1", kForEthercat}, Said{"lose every 2", kForEthercat},
        Said{"lose mails", kForEthercat}, Said{"no mailbox", kForEthercat}, Said{"working counter 1", kForEthercat},
        Said{"refuse state 0x25", kForEthercat}, Said{"al error 0x1b", kForEthercat},
        Said{"emergency 0xff00", kForEthercat}, Said{"refuse open 0x0106", kForEthernetIp, kEthercat},
        Said{"wrong size 200", kForEthernetIp, kEthercat}, Said{"api 20000", kForEthernetIp, kEthercat},
        Said{"no socket items", kForEthernetIp, kEthercat},
        Said{"foreign address 192.0.2.9:2222", kForEthernetIp, kEthercat},
        Said{"stop producing", kForEthernetIp, kEthercat}, Said{"stale sequence", kForEthernetIp, kEthercat},
        Said{"frozen count", kForEthernetIp, kEthercat}, Said{"close tcp", kForEthernetIp, kEthercat}));

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
  for (const char* line : {"unplug", "power off", "freeze", "late 5", "plug", "power on", "thaw", "late 0"}) {
    EXPECT_THAT(bench.say(line), testing::StartsWith("ok: "));
  }
  EXPECT_EQ(bench.faults, NetworkFaults{});
}

TEST(NetworkPanel, EndsSomeFaultsOfEthercatByTheirOwnWords) {
  Bench bench(kEthercat);
  const NetworkFaults healthy = bench.faults;
  for (const char* line :
       {"cut", "cut behind", "lose every 5", "working counter 1", "clock drift 20", "foreign on", "heal", "heal behind",
        "lose every 0", "working counter 0", "clock drift 0", "foreign off"}) {
    EXPECT_THAT(bench.say(line), testing::StartsWith("ok: "));
  }
  EXPECT_EQ(bench.faults, healthy);
}

TEST(NetworkPanel, RaisesAlErrorsAndEmergenciesAsOftenAsItIsAskedTo) {
  Bench bench(kEthercat);
  EXPECT_EQ(bench.say("al error 0x001B"), "ok: the robot raises an AL error\n");
  EXPECT_EQ(bench.say("emergency 0xFF00"), "ok: the robot sends an emergency message\n");
  bench.say("faults off");
  bench.say("al error 26");
  EXPECT_EQ(bench.faults.events, (NetworkFaults::Events{0, 2, 1, 26, 0xFF00}));
}

TEST(NetworkPanel, ClosesTcpAsOftenAsItIsAskedTo) {
  Bench bench;
  EXPECT_EQ(bench.say("close tcp"), "ok: TCP connections are closed\n");
  bench.say("faults off");
  bench.say("close tcp");
  EXPECT_EQ(bench.faults.events.tcp_closures, 2u);
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
  for (const char* word : {"unplug ",
                           "plug ",
                           "freeze ",
                           "thaw ",
                           "late MS ",
                           "refuse open STATUS ",
                           "wrong size SIZE ",
                           "api US ",
                           "no socket items ",
                           "foreign address A.B.C.D:PORT ",
                           "stop producing ",
                           "duplicate ",
                           "stale sequence ",
                           "corrupt ",
                           "frozen count ",
                           "close tcp ",
                           "faults off ",
                           "faults ",
                           "power off ",
                           "power on ",
                           "cut ",
                           "heal ",
                           "lose next N ",
                           "lose every N ",
                           "lose mails ",
                           "no mailbox ",
                           "working counter N ",
                           "cut behind ",
                           "heal behind ",
                           "clock drift PPM ",
                           "foreign on ",
                           "foreign off ",
                           "refuse state CODE ",
                           "al error CODE ",
                           "emergency CODE ",
                           "on EtherNet/IP:",
                           "on EtherCAT:"}) {
    EXPECT_THAT(text, HasSubstr("\n" + std::string(word)));
  }
}

TEST(NetworkPanel, HasItsWordsInTheReadme) {
  std::ifstream file(MECA_SOURCE_DIR "/sim/README.md");
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  std::istringstream help(panel_help());
  std::string line;
  while (std::getline(help, line) && !line.starts_with("and with a network in between")) continue;
  ASSERT_TRUE(help) << "the heading of the words about networks is another one now";
  while (std::getline(help, line)) {
    const std::string words = line.substr(0, line.find("  "));
    if (words.ends_with(':')) continue;  // the heading of a bus
    EXPECT_THAT(readme, HasSubstr("`" + words + "`"));
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
