// What happens to a segment, and how the transport comes back from it: cables, power, interfaces, rings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <thread>

#include "tests/session/segment.hpp"

namespace meca::test {
namespace {

using namespace ethercat;
using testing::HasSubstr;
using transports::LinkState;

class EthercatRecovery : public OnACable {};

bool up(const Segment& bus, std::size_t robot) { return bus.exchanges[robot].link == LinkState::kUp; }

// Its images keep coming.
bool goes_on(Segment& bus, std::size_t robot) {
  const auto before = bus.images[robot];
  return bus.until([&] { return bus.images[robot] > before + 20; });
}

TEST_F(EthercatRecovery, ARobotWithoutPowerIsMissedAndTheOthersGoOn) {
  ChainHost host(chain_of(3));
  Segment bus(first(3));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  host.with_chain([](auto& chain) { chain.set_powered(2, false); });
  ASSERT_TRUE(bus.until([&] { return !up(bus, 2); }));
  ASSERT_TRUE(bus.until([&] { return bus.detail(2).find("position 2 is not there") != std::string::npos; }))
      << bus.detail(2);
  EXPECT_TRUE(goes_on(bus, 0) && goes_on(bus, 1));
  host.with_chain([](auto& chain) { chain.set_powered(2, true); });
  host.power_cycle(2);
  ASSERT_TRUE(bus.until_up()) << bus.detail(2);
  EXPECT_TRUE(goes_on(bus, 2));
  EXPECT_EQ(bus.counter("losses", 0), 0);
  EXPECT_EQ(bus.counter("losses", 1), 0);
  EXPECT_EQ(bus.counter("losses", 2), 1);
  EXPECT_EQ(bus.detail(2), "");
}

TEST_F(EthercatRecovery, ACutChainKeepsItsFirstPartAndComesBackWhenHealed) {
  ChainHost host(chain_of(3));
  Segment bus(first(3));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  host.with_chain([](auto& chain) { chain.cut(1); });
  ASSERT_TRUE(bus.until([&] { return !up(bus, 1) && !up(bus, 2); }));
  EXPECT_TRUE(goes_on(bus, 0));
  EXPECT_TRUE(up(bus, 0));
  host.with_chain([](auto& chain) { chain.heal(1); });
  ASSERT_TRUE(bus.until_up()) << bus.detail(1) << bus.detail(2);
  EXPECT_TRUE(goes_on(bus, 1) && goes_on(bus, 2));
  EXPECT_EQ(bus.counter("losses", 0), 0);
}

TEST_F(EthercatRecovery, APowerCycledRobotIsStartedAgain) {
  ChainHost host(chain_of(3));
  Segment bus(first(3));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  host.power_cycle(1);
  ASSERT_TRUE(bus.until([&] { return !up(bus, 1); }));
  ASSERT_TRUE(bus.until_up()) << bus.detail(1);
  EXPECT_TRUE(goes_on(bus, 1));
  EXPECT_EQ(bus.counter("losses", 0), 0);
  EXPECT_EQ(bus.counter("losses", 1), 1);
  EXPECT_EQ(bus.counter("losses", 2), 0);
}

TEST_F(EthercatRecovery, AnInterfaceThatIsSwitchedOffIsNamedAndUsedAgain) {
  ChainHost host(chain_of(2));
  Segment bus(first(2));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  ASSERT_TRUE(network.ip("link set eth1 down"));
  ASSERT_TRUE(bus.until([&] { return !up(bus, 0) && !up(bus, 1); }));
  ASSERT_TRUE(bus.until([&] { return bus.detail() == "'eth1' is switched off on this machine; ip link set eth1 up"; }))
      << bus.detail();
  ASSERT_TRUE(network.ip("link set eth1 up"));
  EXPECT_TRUE(bus.until_up()) << bus.detail();
  EXPECT_TRUE(goes_on(bus, 0) && goes_on(bus, 1));
}

TEST_F(EthercatRecovery, ACableThatIsPulledIsNoCarrier) {
  ASSERT_TRUE(network.ip("link set robot1 down"));
  Segment bus(first(1));
  ASSERT_TRUE(bus.until([&] { return !bus.detail().empty(); }));
  EXPECT_EQ(bus.detail(), "no carrier on 'eth1'; check its cable and the power of the robot at the other end");
  ASSERT_TRUE(network.ip("link set robot1 up"));
  ASSERT_TRUE(bus.until([&] { return bus.detail().find("no device answers") != std::string::npos; })) << bus.detail();
  ChainHost host(chain_of(1));
  EXPECT_TRUE(bus.until_up()) << bus.detail();
}

TEST_F(EthercatRecovery, ASegmentWithoutRobotsSaysSoAndFindsThemLater) {
  Segment bus(first(2));
  ASSERT_TRUE(bus.until([&] { return !bus.detail(0).empty() && !bus.detail(1).empty(); }));
  EXPECT_EQ(bus.exchanges[0].link, LinkState::kDown);
  ChainHost host(chain_of(2));
  EXPECT_TRUE(bus.until_up()) << bus.detail();
}

TEST_F(EthercatRecovery, ADeviceThatIsNoMeca500IsLeftAloneAndNamed) {
  ChainOptions options = chain_of(3);
  options.robots[1].vendor = 0x2;
  options.robots[1].product = 0x044C2C52;
  ChainHost host(options);
  Segment bus(first(3));
  ASSERT_TRUE(bus.until([&] { return up(bus, 0) && up(bus, 2) && !bus.detail(1).empty(); }))
      << bus.detail(0) << bus.detail(1) << bus.detail(2);
  EXPECT_THAT(bus.detail(1), HasSubstr("not a Meca500"));
  EXPECT_TRUE(goes_on(bus, 0) && goes_on(bus, 2));
  EXPECT_EQ(bus.exchanges[1].link, LinkState::kDown);
}

TEST_F(EthercatRecovery, ARefusedStateIsToldInWordsAndTriedAgain) {
  ChainHost host(chain_of(2));
  host.with(0, [](auto& device) { device.faults().refuse_state = 0x001E; });
  Segment bus(first(2));
  ASSERT_TRUE(bus.until([&] { return up(bus, 1) && bus.detail(0).find("input") != std::string::npos; }))
      << bus.detail(0) << bus.detail(1);
  EXPECT_FALSE(up(bus, 0));
  host.with(0, [](auto& device) { device.faults().refuse_state.reset(); });
  EXPECT_TRUE(bus.until_up()) << bus.detail(0);
}

TEST_F(EthercatRecovery, AnEmergencyOfARobotIsCountedWithItsCode) {
  ChainHost host(chain_of(2));
  Segment bus(first(2));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  host.with(1, [](auto& device) { device.send_emergency({.code = 0x8612}); });
  EXPECT_TRUE(bus.until([&] { return bus.counter("emergency_code", 1) == 0x8612; }));
  EXPECT_EQ(bus.counter("emergencies", 1), 1);
  EXPECT_EQ(bus.counter("emergency_code", 0), 0);
}

TEST_F(EthercatRecovery, RepliesThatAreLostForAMomentCostImagesAndNothingElse) {
  ChainHost host(chain_of(2));
  Segment bus(first(2));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  const auto lost = bus.counter("lost_frames");
  host.swallow_replies(true);
  bus.turn();
  bus.turn();
  host.swallow_replies(false);
  ASSERT_TRUE(bus.until([&] { return bus.counter("lost_frames") > lost; }));
  EXPECT_TRUE(goes_on(bus, 0) && goes_on(bus, 1));
  EXPECT_EQ(host.state(0), AlState::kOp);
  EXPECT_EQ(bus.counter("losses", 0), 0);
}

TEST_F(EthercatRecovery, AFloodOfStrangeFramesCostsTimeAndIsCounted) {
  ChainHost host(chain_of(1));
  Segment bus(first(1));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  std::jthread flood([](const std::stop_token& stop) {
    net::RawEthernet stranger("robot1", kEtherType);
    std::array<std::byte, kLongestFrame> buffer{};
    FrameWriter writer(buffer, MacAddress{kReplyBit});
    writer.add(Command::kLrw, 0xEE, 0x12345678, 100);
    const Bytes never_sent = writer.finish();
    const Bytes cut = never_sent.first(60);
    while (!stop.stop_requested()) {
      stranger.send(never_sent);
      stranger.send(cut);
    }
  });
  EXPECT_TRUE(
      bus.until([&] { return bus.counter("unexpected_frames") > 5000 && bus.counter("malformed_frames") > 5000; }));
  flood.request_stop();
  EXPECT_TRUE(bus.until_up()) << bus.detail();
  EXPECT_TRUE(goes_on(bus, 0));
}

class EthercatRing : public OnACable {
 protected:
  static BusOptions ring() {
    BusOptions out = usual_segment();
    out.redundant_interface = "eth2";
    return out;
  }
  static ChainOptions chain() {
    ChainOptions out = chain_of(3);
    out.redundant_interface = "robot2";
    return out;
  }
};

TEST_F(EthercatRing, GoesOnAfterACutWithTheRobotsOnBothSides) {
  ChainHost host(chain());
  Segment bus(first(3), ring());
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  ASSERT_TRUE(bus.until([&] { return bus.counter("ring_open") == 0; }));
  host.with_chain([](auto& chain) { chain.cut(1); });
  ASSERT_TRUE(bus.until([&] { return bus.counter("ring_open") == 1; }));
  EXPECT_TRUE(goes_on(bus, 0) && goes_on(bus, 1) && goes_on(bus, 2));
  bus.exchanges[2].output.fill(std::byte{0x2C});
  bus.exchanges[2].output_valid = true;
  EXPECT_TRUE(bus.until(
      [&] { return host.with(2, [&](auto& device) { return device.output() == bus.exchanges[2].output; }); }));
  host.with_chain([](auto& chain) { chain.heal(1); });
  EXPECT_TRUE(bus.until([&] { return bus.counter("ring_open") == 0; }));
  EXPECT_TRUE(goes_on(bus, 0) && goes_on(bus, 1) && goes_on(bus, 2));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(bus.counter("losses", i), 0) << i;
    EXPECT_EQ(host.state(i), AlState::kOp) << i;
  }
}

TEST_F(EthercatRing, GoesOnWithOneOfItsInterfaces) {
  ChainHost host(chain());
  Segment bus(first(3), ring());
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  ASSERT_TRUE(network.ip("link set eth1 down"));
  host.with_chain([](auto& chain) { chain.cut(0); });
  ASSERT_TRUE(bus.until([&] { return bus.counter("ring_open") == 1; }));
  EXPECT_TRUE(goes_on(bus, 0) && goes_on(bus, 2));
  ASSERT_TRUE(network.ip("link set eth1 up"));
  host.with_chain([](auto& chain) { chain.heal(0); });
  EXPECT_TRUE(bus.until([&] { return bus.counter("ring_open") == 0; }));
  EXPECT_EQ(bus.counter("losses", 0), 0);
}

}  // namespace
}  // namespace meca::test
