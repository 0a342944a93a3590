// The EtherCAT transport against robots on raw sockets.
#include "transports/ethercat/transport.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/session/segment.hpp"

namespace meca::test {
namespace {

using namespace ethercat;
using testing::HasSubstr;
using transports::LinkState;

class EthercatTransport : public OnACable {};

constexpr std::uint16_t kSafeopWithError = 0x14, kInit = 0x01;

TEST_F(EthercatTransport, CarriesTheImagesOfThreeRobotsInBothDirections) {
  ChainHost host(chain_of(3));
  for (std::size_t i = 0; i < 3; ++i) {
    host.with(i, [&](auto& device) { device.set_input(input_of(0x51 + static_cast<int>(i))); });
  }
  Segment bus(first(3));
  ASSERT_TRUE(bus.until_up()) << bus.detail(0) << bus.detail(1) << bus.detail(2);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(bus.until([&] { return bus.exchanges[i].input == input_of(0x51 + static_cast<int>(i)); }));
    bus.exchanges[i].output.fill(static_cast<std::byte>(0xA1 + i));
    bus.exchanges[i].output_valid = true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(bus.until([&] {
      return host.with(i, [&](auto& device) { return device.output() == bus.exchanges[i].output; });
    })) << i;
    EXPECT_EQ(bus.detail(i), "");
    EXPECT_EQ(bus.counter("al_state", i), 8);
    EXPECT_EQ(bus.counter("losses", i), 0);
  }
}

// EtherCAT has no idle: repeating the last commands would bring them to a robot that was off in between.
TEST_F(EthercatTransport, SendsTheImageThatStandsThereAlsoWhenItIsNotMeantToCommand) {
  ChainHost host(chain_of(1));
  Segment bus(first(1));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  const auto robot_has = [&](int value) {
    image::OutputBytes wanted;
    wanted.fill(static_cast<std::byte>(value));
    return host.with(0, [&](auto& device) { return device.output() == wanted; });
  };
  bus.exchanges[0].output.fill(std::byte{0xA5});
  bus.exchanges[0].output_valid = true;
  ASSERT_TRUE(bus.until([&] { return robot_has(0xA5); }));
  bus.exchanges[0].output.fill(std::byte{0x77});
  bus.exchanges[0].output_valid = false;
  EXPECT_TRUE(bus.until([&] { return robot_has(0x77); }));
}

TEST_F(EthercatTransport, ReadsTheFirmwareThatEachRobotReports) {
  ChainOptions options = chain_of(2);
  options.robots[0].firmware = "9.3.3.5809";
  options.robots[0].layout = image::Layout::kFirmware9;
  options.robots[1].firmware = "11.3.3.12637";
  ChainHost host(options);
  Segment bus(first(2));
  ASSERT_TRUE(bus.until_up()) << bus.detail(0) << bus.detail(1);
  EXPECT_EQ(bus.exchanges[0].identity, (transports::FirmwareVersion{9, 3, 3, 5809}));
  EXPECT_EQ(bus.exchanges[1].identity, (transports::FirmwareVersion{11, 3, 3, 12637}));
}

TEST_F(EthercatTransport, FindsRobotsByTheirAliasesWhereverTheyStand) {
  ChainOptions options = chain_of(2);
  options.robots[0].alias = 12;
  options.robots[1].alias = 11;
  ChainHost host(options);
  host.with(0, [](auto& device) { device.set_input(input_of(0x12)); });
  host.with(1, [](auto& device) { device.set_input(input_of(0x11)); });
  Segment bus({{.position = 0, .alias = 11}, {.position = 0, .alias = 12}});
  ASSERT_TRUE(bus.until_up()) << bus.detail(0) << bus.detail(1);
  EXPECT_TRUE(bus.until([&] { return bus.exchanges[0].input == input_of(0x11); }));
  EXPECT_TRUE(bus.until([&] { return bus.exchanges[1].input == input_of(0x12); }));
}

TEST_F(EthercatTransport, WakesTheLoopForRepliesOnceInEachTurn) {
  ChainHost host(chain_of(2));
  Segment bus(first(2));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  const auto exchanges = bus.exchanged;
  const auto images = bus.images[0];
  constexpr std::uint64_t kTurns = 200;
  for (std::uint64_t i = 0; i < kTurns; ++i) bus.turn();
  EXPECT_GT(bus.exchanged - exchanges, kTurns);      // for some replies before the next deadline, ...
  EXPECT_LE(bus.exchanged - exchanges, 3 * kTurns);  // ... for each robot once
  EXPECT_GT(bus.images[0], images);
}

TEST_F(EthercatTransport, SendsReadAndWriteSeparatelyWhenAskedTo) {
  ChainHost host(chain_of(2));
  BusOptions options = usual_segment();
  options.separate = true;
  Segment bus(first(2), options);
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  bus.exchanges[1].output.fill(std::byte{0x5A});
  bus.exchanges[1].output_valid = true;
  EXPECT_TRUE(bus.until(
      [&] { return host.with(1, [&](auto& device) { return device.output() == bus.exchanges[1].output; }); }));
}

TEST_F(EthercatTransport, RunsRobotsOnDistributedClocks) {
  ChainOptions chain = chain_of(2);
  chain.robots[1].esc.clock_ppm = 20;
  ChainHost host(chain);
  BusOptions options = usual_segment();
  options.dc = true;
  options.cycle = 4ms;
  Segment bus(first(2), options);
  ASSERT_TRUE(bus.until_up()) << bus.detail(0) << "; " << bus.detail(1);
  EXPECT_TRUE(host.with(1, [](auto& device) { return device.esc().sync0_active(); }));
}

TEST_F(EthercatTransport, LeavesTheRobotsInInitWhenItCloses) {
  ChainHost host(chain_of(3));
  Segment bus(first(3));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  bus.close();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(host.with(i, [](auto& device) { return device.esc().al_status(); }), kInit) << i;
    EXPECT_EQ(host.with(i, [](auto& device) { return device.counters().watchdog_expiries; }), 0U) << i;
  }
}

TEST_F(EthercatTransport, SetsTheWatchdogThatStopsRobotsWithoutABridge) {
  ChainHost host(chain_of(2));
  Segment bus(first(2));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  bus.crash();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(eventually([&] {
      return host.with(i, [](auto& device) { return device.esc().al_status(); }) == kSafeopWithError;
    })) << i;
  }
}

TEST_F(EthercatTransport, MeasuresRoundTripsAndWakeUps) {
  ChainHost host(chain_of(1));
  Segment bus(first(1));
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  ASSERT_TRUE(bus.until([&] { return bus.counter("round_trip_max") > 0 && bus.counter("wake_up_max") > 0; }));
  EXPECT_LE(bus.counter("round_trip_p50"), bus.counter("round_trip_p99"));
  EXPECT_LE(bus.counter("round_trip_p99"), bus.counter("round_trip_p999"));
  EXPECT_LE(bus.counter("round_trip_p999"), bus.counter("round_trip_max"));
  EXPECT_LE(bus.counter("wake_up_p50"), bus.counter("wake_up_max"));
  EXPECT_GT(bus.counter("images"), 0);
  EXPECT_EQ(bus.counter("failed_sends"), 0);
  EXPECT_EQ(bus.counter("malformed_frames"), 0);
}

TEST_F(EthercatTransport, IsTheOnlyMasterOnItsInterfaces) {
  BusOptions other = usual_segment();
  other.interface = "robot2";
  other.redundant_interface = "eth1";
  {
    const Segment bus(first(1));
    for (const BusOptions& options : {usual_segment(), other}) {
      try {
        const Segment second(first(1), options);
        FAIL() << "no error";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(),
                     "'eth1' has an EtherCAT master already: another meca-bridge runs on it; stop that one first");
      }
    }
  }
  EXPECT_NO_THROW(Segment(first(1), other));
}

TEST_F(EthercatTransport, DoesNotOpenAnInterfaceThatIsNotThere) {
  BusOptions options = usual_segment();
  options.redundant_interface = "eth7";
  try {
    const Segment bus(first(1), options);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("there is no network interface 'eth7' on this machine; it has "));
  }
}

}  // namespace
}  // namespace meca::test
