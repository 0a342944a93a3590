// What a person reads where bridge and robots do not get together, and that they do, once the reason is gone.
#include <gmock/gmock.h>

#include "tests/ethercat/cell.hpp"

namespace meca::test {
namespace {

using testing::HasSubstr;

const std::string kSim = MECA_BINARY_DIR "/meca-sim";

using Sentence = EthercatCell;

TEST_F(Sentence, OfARefusedStateHasItsCodeAndWhatItMeans) {
  Simulator& sim = start_robots(1, {"--fault", "refuse state 0x0025"});
  BridgeProcess& bridge = start_bridge(1);
  EXPECT_TRUE(bridge.until_told("0x0025")) << bridge.status();
  EXPECT_EQ(sim.say("faults off"), "ok: the network is healthy");
  EXPECT_TRUE(bridge.until_up());
}

TEST_F(Sentence, OfARobotThatAnswersNoMailSaysSo) {
  Simulator& sim = start_robots(1, {"--fault", "no mailbox"});
  BridgeProcess& bridge = start_bridge(1);
  EXPECT_TRUE(bridge.until_told("does not answer an SDO")) << bridge.status();
  EXPECT_EQ(sim.say("faults off"), "ok: the network is healthy");
  EXPECT_TRUE(bridge.until_up());
}

TEST_F(Sentence, OfRobotsThatAreTooFewSaysHowManyAnswer) {
  start_robots(1);
  BridgeProcess& bridge = start_bridge(2);
  EXPECT_TRUE(bridge.until_told("position 1 is not there: 1 device answers", "arm2")) << bridge.status("arm2");
  EXPECT_TRUE(bridge.until_up("arm1"));
}

TEST_F(Sentence, OfWordsOfAnotherBusNamesIt) {
  const Simulator& sim = start_robots(1);
  EXPECT_EQ(sim.say("refuse open 0x0106"),
            "error: that is a word for EtherNet/IP, and this robot is on EtherCAT; 'help' says which words are for it");
}

TEST_F(Sentence, OfAnInterfaceThatThereIsNotListsThoseThatThereAre) {
  const Result result = run({kSim, "--protocol", "ethercat", "--interface", "eth7", "--control", "off"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.output, HasSubstr("arm1: "));
  EXPECT_THAT(result.output, HasSubstr("eth7"));
  EXPECT_THAT(result.output, HasSubstr("meca0"));
}

TEST_F(Sentence, OfAnInterfaceThatIsDownSaysHowItComesUp) {
  ASSERT_TRUE(network_.ip("link set meca1 down"));
  Process sim({kSim, "--protocol", "ethercat", "--interface", "meca1", "--control", "off"});
  EXPECT_TRUE(sim.wait_for_output("meca1 is down: 'ip link set meca1 up' switches it on")) << sim.output();
}

TEST_F(Sentence, OfASecondSimulatorOnAnInterfaceNamesTheFirst) {
  start_robots(1);
  const Result result = run({kSim, "--protocol", "ethercat", "--interface", "meca1", "--control", "off"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.output, HasSubstr("'meca1' has simulated robots already: another meca-sim runs on it; stop that "
                                       "one first (several robots of one line: --count)"));
}

}  // namespace
}  // namespace meca::test
