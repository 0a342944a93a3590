// meca-ctl scan ethercat against simulated robots on a virtual cable in a network namespace: no bridge.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/process.hpp"
#include "tests/network_namespace.hpp"
#include "tests/session/chain_host.hpp"

namespace meca::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ScanEthercat : public testing::Test {
 protected:
  void SetUp() override {
    if (!network_.usable()) GTEST_SKIP() << kNoNamespace;
    network_.cable("eth1", "robot1");
    network_.cable("eth2", "robot2");
  }
  static ChainOptions three_robots() {
    ChainOptions out;
    out.interface = "robot1";
    out.robots.resize(3);
    for (std::uint32_t i = 0; i < 3; ++i) out.robots[i].serial = 4711 + i;
    return out;
  }
  static Result scan(std::vector<std::string> words) {
    words.insert(words.begin(), {MECA_CTL, "scan", "ethercat"});
    return run(words);
  }
  NetworkNamespace network_;
};

TEST_F(ScanEthercat, ListsTheRobotsOfTheChain) {
  const ChainHost robots(three_robots());
  const auto result = scan({"--interface", "eth1", "--timeout", "30"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("0         -        -      Meca500  0x00ecade1  0x0004d500"));
  EXPECT_THAT(result.output, HasSubstr("eth1: 3 devices, 3 Meca500"));
}

TEST_F(ScanEthercat, TellsProgramsInJson) {
  const ChainHost robots(three_robots());
  const auto result = scan({"--interface", "eth1", "--timeout", "30", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  std::istringstream lines(result.output);
  std::string line;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(std::getline(lines, line));
    const auto device = nlohmann::json::parse(line);
    EXPECT_EQ(device["interface"], "eth1");
    EXPECT_EQ(device["position"], i);
    EXPECT_EQ(device["meca500"], true);
    EXPECT_EQ(device["serial"], 4711 + i);
    EXPECT_EQ(device["al_state"], "INIT");
    EXPECT_EQ(device["ports"][1]["link"], i < 2);
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST_F(ScanEthercat, ListsARingOnceFromBothItsEndsInAnyOrder) {
  ChainOptions ring = three_robots();
  ring.redundant_interface = "robot2";
  const ChainHost robots(ring);
  for (const auto& [a, b] : {std::pair("eth1", "eth2"), std::pair("eth2", "eth1")}) {
    const auto result = scan({"--interface", a, "--interface", b, "--timeout", "2"});
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("eth1: 3 devices, 3 Meca500"));
    EXPECT_THAT(result.output, HasSubstr("frames sent on eth1 come back on eth2: the cables make a ring"));
    EXPECT_THAT(result.output, Not(HasSubstr("\neth2: ")));
  }
}

TEST_F(ScanEthercat, SaysWhatToCheckWhenNobodyAnswers) {
  const auto result = scan({"--interface", "eth1", "--timeout", "0.2"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("no EtherCAT device answered on eth1 within 0.2 s"));
}

TEST_F(ScanEthercat, SaysThatTheCableIsMissingOrTheInterfaceIsOff) {
  ASSERT_TRUE(network_.ip("link set robot1 down"));
  EXPECT_THAT(scan({"--interface", "eth1"}).output, HasSubstr("eth1 has no carrier"));
  ASSERT_TRUE(network_.ip("link set eth1 down"));
  const auto off = scan({"--interface", "eth1"});
  EXPECT_EQ(off.exit_code, 2);
  EXPECT_THAT(off.output, HasSubstr("eth1 is switched off: sudo ip link set eth1 up"));
}

TEST_F(ScanEthercat, ListsTheInterfacesWhenTheOneThatWasNamedIsNotThere) {
  const auto result = scan({"--interface", "nowhere0"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("there is no network interface 'nowhere0'"));
  EXPECT_THAT(result.output, HasSubstr("eth1"));
}

}  // namespace
}  // namespace meca::test
