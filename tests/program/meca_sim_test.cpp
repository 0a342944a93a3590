// meca-sim from the outside: what it answers to arguments and signals, and what a host sees of every fault.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "tests/cli/process.hpp"
#include "tests/program/eip_host.hpp"
#include "tests/unit/net/temporary_directory.hpp"
#include "transports/net/clock.hpp"
#include "transports/net/line_client.hpp"

namespace meca::test {
namespace {

using namespace std::chrono_literals;
using ethernet_ip::OriginatorSettings;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kProgram = MECA_BINARY_DIR "/meca-sim";

// An address of the loopback network that no other test of this machine has: 127.64.0.0/10 by process.
std::uint32_t own_address(unsigned which = 0) {
  return 0x7F400000u | ((static_cast<unsigned>(::getpid()) * 2 + which) & 0x3FFFFFu);
}

// A running meca-sim with its control socket.
class Sim {
 public:
  // `control`: empty for a socket of its own.
  explicit Sim(std::vector<std::string> more = {}, const std::string& control = {})
      : process_(words(std::move(more), control)) {
    if (!process_.wait_for_output("EtherNet/IP at ")) ADD_FAILURE() << process_.output();
  }
  std::string say(const std::string& line) const {
    auto client = net::LineClient::connect(directory_ / "sim.sock");
    return client ? client->ask(line, 60s).value_or("(no answer)") : "(nobody)";
  }
  // Asks it to stop; its exit code.
  int stop(int signal = SIGTERM) {
    process_.signal(signal);
    return process_.wait();
  }
  const std::string& output() const { return process_.output(); }
  bool wait_for_output(const std::string& text) { return process_.wait_for_output(text); }

 private:
  std::vector<std::string> words(std::vector<std::string> more, const std::string& control) const {
    std::vector<std::string> out{kProgram,
                                 "--bind",
                                 net::to_string(own_address()),
                                 "--instant-homing",
                                 "--no-noise",
                                 "--control",
                                 control.empty() ? (directory_ / "sim.sock").string() : control};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }

  TemporaryDirectory directory_;
  Process process_;
};

TEST(MecaSim, ExplainsItselfWithExamples) {
  const Result help = run({kProgram, "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output, HasSubstr("meca-sim --bind eth0 "));
  EXPECT_THAT(help.output, HasSubstr("at 2.5s unplug"));
  EXPECT_THAT(help.output, HasSubstr("Exit codes: 0"));
  EXPECT_THAT(help.output, HasSubstr("\nclock drift PPM "));
}

TEST(MecaSim, LeavesWithTwoWhenItsArgumentsAreWrong) {
  const Result result = run({kProgram, "--firmware", "12"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output,
            "meca-sim: --firmware: found '12'; expected a version of the firmware from 9.0 to 11.x, e.g. 11.3\n"
            "meca-sim --help shows the options and examples\n");
}

TEST(MecaSim, LeavesWithFourWhenTheAddressIsNotOfThisMachine) {
  const Result result = run({kProgram, "--bind", "203.0.113.7", "--control", "off"});  // TEST-NET-3, RFC 5737
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.output,
              HasSubstr("'203.0.113.7' is neither an address nor an interface of this machine; it has lo 127.0.0.1"));
}

TEST(MecaSim, LeavesWithFourWhenAPortIsTaken) {
  const Sim first;
  const std::string address = net::to_string(own_address());
  const Result second = run({kProgram, "--bind", address, "--control", "off"});
  EXPECT_EQ(second.exit_code, 4);
  EXPECT_THAT(second.output, HasSubstr("TCP port 44818 of " + address + " is taken by another program"));

  const net::UdpSocket io({own_address(1), 2222}, {});
  const Result third = run({kProgram, "--bind", net::to_string(own_address(1)), "--control", "off"});
  EXPECT_EQ(third.exit_code, 4);
  EXPECT_THAT(third.output, HasSubstr("UDP port 2222 of " + net::to_string(own_address(1)) + " is taken by another"));
}

TEST(MecaSim, RunsUntilItIsAskedToStopAndLeavesWithZero) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Sim sim;
    EXPECT_EQ(sim.stop(signal), 0);
    EXPECT_THAT(sim.output(), HasSubstr("arm1: simulated Meca500 R4, firmware 11.3, serial number 1; EtherNet/IP at "));
    EXPECT_THAT(sim.output(), HasSubstr("arm1: stopped; 0 opened, "));
  }
}

TEST(MecaSim, LeavesWhenItsTimeIsOver) {
  const Result result = run({kProgram, "--bind", net::to_string(own_address()), "--control", "off", "--for", "0.1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("stopped; "));
}

TEST(MecaSim, WorksWithoutAControlSocketThatCannotBeHad) {
  const Result result =
      run({kProgram, "--bind", net::to_string(own_address()), "--control", "/nowhere/sim.sock", "--for", "0.1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("no control socket, buttons cannot be pressed"));
}

TEST(MecaSim, FollowsAScriptAndSaysWhatBecameOfIt) {
  const TemporaryDirectory directory;
  const std::string path = directory / "faults.txt";
  if (std::FILE* file = std::fopen(path.c_str(), "w")) {
    std::fputs("at 0s press p-stop2\nafter 20ms unplug  # a comment\n", file);
    std::fclose(file);
  }
  Sim sim({"--faults", path, "--fault", "late 5"});
  EXPECT_TRUE(sim.wait_for_output("'late 5': ok: answers are late"));
  EXPECT_TRUE(sim.wait_for_output("'press p-stop2': ok: P-Stop 2 pressed"));
  EXPECT_TRUE(sim.wait_for_output("'unplug': ok: the cable is out"));
  EXPECT_EQ(sim.say("faults"), "ok: unplug, late 5\n");
  EXPECT_EQ(sim.stop(), 0);
}

TEST(MecaSim, ExchangesImagesWithAHost) {
  Sim sim;
  EipHost host(own_address());
  ASSERT_TRUE(host.run()) << host.originator.trouble();
  EXPECT_EQ(host.originator.identity()->product_code, 500);
  EXPECT_EQ(host.originator.identity()->major, 11);
  host.outputs.robot_control.activate = host.outputs.robot_control.home = true;
  ASSERT_TRUE(host.until([&] { return host.inputs().robot_status.homed; }));
  host.outputs.motion_control.set_point = true;
  host.outputs.motion_control.move_id = 1;
  host.outputs.motion_command = {1, {10, 0, 0, 0, 0, 0}};
  EXPECT_TRUE(host.until([&] { return host.inputs().target_joint_set.joints[0] == 10; }));
  EXPECT_EQ(sim.say("violations"), "ok: the host broke no rule\n");

  host.originator.close(net::monotonic());
  EXPECT_TRUE(host.until([&] { return host.originator.state() == ethernet_ip::Originator::State::kClosed; }));
  EXPECT_EQ(sim.stop(), 0);
  EXPECT_THAT(sim.output(), HasSubstr("the I/O connection was opened by 127.0.0.1"));
  EXPECT_THAT(sim.output(), HasSubstr("the I/O connection was closed by its host"));
}

TEST(MecaSim, ShowsItsHostWhatIsPressedAndRaised) {
  const Sim sim;
  EipHost host(own_address());
  ASSERT_TRUE(host.run()) << host.originator.trouble();
  EXPECT_EQ(sim.say("press p-stop2"), "ok: P-Stop 2 pressed\n");
  EXPECT_TRUE(host.until([&] { return host.inputs().safety_status.stop.p_stop2; }));
  EXPECT_EQ(sim.say("release p-stop2"), "ok: P-Stop 2 released; the host has to resume motion\n");
  EXPECT_TRUE(host.until([&] { return host.inputs().safety_status.resettable.p_stop2; }));
  EXPECT_EQ(sim.say("press e-stop"), "ok: E-Stop pressed\n");
  EXPECT_TRUE(host.until([&] { return host.inputs().safety_status.stop.e_stop; }));
  EXPECT_EQ(sim.say("raise error 1007"), "ok: the robot is in error\n");
  EXPECT_TRUE(host.until([&] { return host.inputs().robot_status.error_code == 1007; }));
}

TEST(MecaSim, RefusesASecondHost) {
  const Sim sim;
  EipHost first(own_address());
  ASSERT_TRUE(first.run());
  EipHost second(own_address(), {.serial_number = 99});
  EXPECT_TRUE(second.until([&] { return second.trouble_has("0x0106"); })) << second.originator.trouble();
}

// Asks for the identity at `to` until this robot answers, at most for a minute; empty then.
std::optional<ethernet_ip::ListedIdentity> list_identity(std::uint32_t to, std::uint8_t delay_ms) {
  net::UdpSocket socket({0x7F000001, 0}, {.broadcast = true});
  std::array<std::byte, 24> request{std::byte{0x63}};
  request[12] = std::byte{delay_ms};  // sender context: how long a broadcast may wait for its answer
  std::array<std::byte, 512> buffer{};
  for (int attempt = 0; attempt < 600; ++attempt) {
    socket.send({to, 44818}, request);
    ::usleep(100'000);
    while (const auto received = socket.receive(buffer)) {
      if (received->from != net::Endpoint{own_address(), 44818}) continue;  // another robot of this machine
      return ethernet_ip::read_listed_identity(std::span(buffer).first(received->size).subspan(24));
    }
  }
  return std::nullopt;
}

TEST(MecaSim, AnswersListIdentityByUnicastAndByBroadcast) {
  const Sim sim({"--serial", "4711"});
  for (const std::uint32_t to : {own_address(), 0x7FFFFFFFu}) {
    const auto listed = list_identity(to, 50);
    ASSERT_TRUE(listed) << net::to_string(to);
    EXPECT_EQ(listed->address, (ethernet_ip::SocketAddress{own_address(), 44818}));
    EXPECT_EQ(listed->identity.serial_number, 4711u);
    EXPECT_EQ(listed->identity.name(), "Meca500");
  }
}

TEST(MecaSim, ProducesToAGroupWhenItIsAskedTo) {
  const Sim sim;
  EipHost host(own_address(), {.multicast = true});
  ASSERT_TRUE(host.run()) << host.originator.trouble();
  EXPECT_EQ(host.originator.group() >> 16, 0xEFC0u);
  const auto before = host.originator.counters().received;
  EXPECT_TRUE(host.until([&] { return host.originator.counters().received > before + 10; }));
}

// The same scheme of paths as the bridge's built-in robots have.
TEST(MecaSim, IsFoundByMecaCtlByItsName) {
  const TemporaryDirectory runtime;
  ::setenv("XDG_RUNTIME_DIR", runtime.path().c_str(), 1);
  const Sim sim({"--name", "probe"}, "auto");
  const Result named = run({MECA_BINARY_DIR "/meca-ctl", "--robot", "probe", "sim", "refuse", "open", "0x0106"});
  EXPECT_EQ(named.exit_code, 0);
  EXPECT_EQ(named.output, "probe: connections are refused\n");
  const Result alone = run({MECA_BINARY_DIR "/meca-ctl", "sim", "faults"});
  EXPECT_EQ(alone.output, "probe: refuse open 0x0106\n");
}

// ---- Faults: the words, and what the host sees from then on.
struct Fault {
  std::string words;
  bool before;  // whether it acts on the opening of a connection; the others on one that is open
  std::function<bool(EipHost&)> seen;
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.words; }

class FaultOnTheWire : public testing::TestWithParam<Fault> {};

TEST_P(FaultOnTheWire, IsSeenByTheHostUntilItIsOff) {
  const Fault& fault = GetParam();
  Sim sim;
  EipHost host(own_address());
  if (!fault.before) {
    ASSERT_TRUE(host.run()) << host.originator.trouble();
  }
  ASSERT_THAT(sim.say(fault.words), StartsWith("ok: "));
  EXPECT_TRUE(host.until([&] { return fault.seen(host); })) << host.originator.trouble();
  ASSERT_EQ(sim.say("faults off"), "ok: the network is healthy\n");
  EXPECT_TRUE(host.run()) << host.originator.trouble();
  EXPECT_EQ(sim.stop(), 0);
}

std::string name_of(const testing::TestParamInfo<Fault>& info) {
  std::string name = info.param.words;
  std::ranges::replace_if(
      name, [](char c) { return c == ' ' || c == '.' || c == ':'; }, '_');
  return name;
}

bool has(const std::vector<std::byte>& bytes, std::initializer_list<int> wanted) {
  const auto same = [](std::byte b, int n) { return std::to_integer<int>(b) == n; };
  return std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end(), same) != bytes.end();
}

INSTANTIATE_TEST_SUITE_P(
    OfAConnection, FaultOnTheWire,
    testing::Values(Fault{"unplug", false, [](EipHost& h) { return h.originator.counters().watchdog_trips == 1; }},
                    Fault{"freeze", false,
                          [](EipHost& h) {
                            const auto& c = h.originator.counters();
                            return c.watchdog_trips == 1 && c.opens == 2 && !h.originator.running();
                          }},
                    Fault{"stop producing", false,
                          [](EipHost& h) { return h.originator.counters().watchdog_trips == 1; }},
                    Fault{"duplicate", false, [](EipHost& h) { return h.originator.counters().stale > 5; }},
                    Fault{"stale sequence", false, [](EipHost& h) { return h.originator.counters().stale > 5; }},
                    Fault{"corrupt", false, [](EipHost& h) { return h.originator.counters().malformed > 5; }},
                    Fault{"frozen count", false, [](EipHost& h) { return h.originator.counters().repeated > 5; }},
                    Fault{"close tcp", false,
                          [](EipHost& h) {
                            if (h.hung_up == 0) return false;
                            h.run_for(300ms);  // longer than the watchdog
                            return h.originator.running() && h.originator.counters().watchdog_trips == 0;
                          }},
                    Fault{"power off", false,
                          [](EipHost& h) { return h.refused > 0 && h.originator.counters().watchdog_trips == 1; }},
                    Fault{"power cycle", false,
                          [](EipHost& h) { return h.refused > 0 && h.originator.counters().watchdog_trips == 1; }}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    OfOpening, FaultOnTheWire,
    testing::Values(Fault{"refuse open 0x0106", true, [](EipHost& h) { return h.trouble_has("0x0106"); }},
                    Fault{"wrong size 200", true, [](EipHost& h) { return h.trouble_has("0x0128"); }},
                    Fault{"api 20000", true,
                          [](EipHost& h) { return h.originator.running() && h.originator.t_to_o_api_us() == 20'000; }},
                    Fault{"no socket items", true,
                          [](EipHost& h) {
                            // The reply to the Forward Open came last: it ends without an item 0x8000 of 16 bytes.
                            return h.originator.running() && !has(h.last_tcp, {0x00, 0x80, 0x10, 0x00});
                          }},
                    Fault{"foreign address 192.0.2.9:2222", true,
                          [](EipHost& h) { return h.trouble_has("192.0.2.9"); }},
                    Fault{"late 300", true,
                          [](EipHost& h) { return h.originator.running() && h.said_at - h.connected_at >= 300ms; }}),
    name_of);

TEST(MecaSim, NamesTheAddressToSendToWhenNothingIsWrong) {
  const Sim sim;
  EipHost host(own_address());
  ASSERT_TRUE(host.run());
  EXPECT_TRUE(has(host.last_tcp, {0x00, 0x80, 0x10, 0x00})) << "the counterpart of 'no socket items'";
}

}  // namespace
}  // namespace meca::test
