// The EtherNet/IP transport against robots on real sockets.
#include "transports/ethernet_ip/transport.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "tests/session/adapter_host.hpp"
#include "tests/session/turner.hpp"

namespace meca::test {
namespace {

using namespace ethernet_ip;
using testing::HasSubstr;
using transports::LinkState;

TEST(EthernetIpTransport, CarriesTheImageInBothDirections) {
  AdapterHost arm1(kArm1);
  arm1.with([](auto& a) { a.set_input(input_of(0x5A)); });
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  EXPECT_TRUE(bus.until([&] { return bus.exchanges[0].input == input_of(0x5A); }));
  bus.exchanges[0].output.fill(std::byte{0xA5});
  bus.exchanges[0].output_valid = true;
  EXPECT_TRUE(
      bus.until([&] { return arm1.with([&](auto& a) { return a.run() && a.output() == bus.exchanges[0].output; }); }));
  EXPECT_EQ(bus.detail(), "");
  EXPECT_EQ(bus.counter("api_o_to_t"), 10'000);
  EXPECT_EQ(bus.counter("api_t_to_o"), 10'000);
}

TEST(EthernetIpTransport, SaysIdleWhileThereAreNoOutputs) {
  AdapterHost arm1(kArm1);
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until([&] { return arm1.counters().idle >= 3; }));
  EXPECT_FALSE(arm1.with([](auto& a) { return a.run(); }));
  bus.exchanges[0].output_valid = true;
  EXPECT_TRUE(bus.until([&] { return arm1.with([](auto& a) { return a.run(); }); }));
  bus.exchanges[0].output_valid = false;
  EXPECT_TRUE(bus.until([&] { return arm1.with([](auto& a) { return a.connected() && !a.run(); }); }));
}

TEST(EthernetIpTransport, ReadsTheFirmwareFromTheRevisionWhereItIsTheFirmware) {
  auto old = meca500_at(kArm2);
  old.identity.major = 2;  // as firmware 9.x identifies itself
  old.identity.minor = 1;
  AdapterHost arm1(kArm1), arm2(old);
  Turner bus({robot(kArm1), robot(kArm2)});
  ASSERT_TRUE(bus.until_up());
  EXPECT_EQ(bus.exchanges[0].identity, (transports::FirmwareVersion{11, 3, 0, 0}));
  EXPECT_EQ(bus.exchanges[1].identity, transports::FirmwareVersion{});
}

TEST(EthernetIpTransport, ComesBackToARobotThatWasUnpluggedAndSaysWhatHappened) {
  AdapterHost arm1(kArm1);
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  arm1.unplug();
  ASSERT_TRUE(bus.until([&] { return bus.exchanges[0].link != LinkState::kUp; }));
  EXPECT_THAT(bus.detail(), HasSubstr("no packet from 127.0.7.2 for 640 ms (10 ms x 64)"));
  EXPECT_EQ(bus.counter("watchdog_trips"), 1);
  EXPECT_EQ(bus.counter("api_o_to_t"), 0);
  ASSERT_TRUE(bus.until([&] { return bus.detail().find("refused") != std::string::npos; })) << bus.detail();
  EXPECT_THAT(bus.detail(), HasSubstr("TCP connection to 127.0.7.2 port 44818 failed"));
  arm1.plug_in();
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  EXPECT_EQ(bus.counter("reconnects"), 1);
  EXPECT_EQ(bus.detail(), "");
  const auto before = bus.images[0];
  EXPECT_TRUE(bus.until([&] { return bus.images[0] > before; }));
}

TEST(EthernetIpTransport, FindsARobotThatIsSwitchedOnLater) {
  AdapterHost arm1(kArm1);
  arm1.unplug();
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until([&] { return !bus.detail().empty(); }));
  EXPECT_NE(bus.exchanges[0].link, LinkState::kUp);
  arm1.plug_in();
  EXPECT_TRUE(bus.until_up()) << bus.detail();
}

TEST(EthernetIpTransport, TellsARefusalInWordsAndTriesAgain) {
  AdapterHost arm1(kArm1);
  arm1.with([](auto& a) { a.faults().refuse_open = 0x0106; });
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until([&] { return bus.counter("refusals") >= 2; }));
  EXPECT_THAT(bus.detail(), HasSubstr("Forward Open refused (0x01/0x0106)"));
  EXPECT_NE(bus.exchanges[0].link, LinkState::kUp);
  arm1.with([](auto& a) { a.faults().refuse_open.reset(); });
  EXPECT_TRUE(bus.until_up()) << bus.detail();
}

TEST(EthernetIpTransport, LetsNoRobotMissAPacketBecauseAnotherIsUnplugged) {
  AdapterHost arm1(kArm1), arm2(kArm2);
  auto patient = robot(kArm1);
  patient.timeout_multiplier = 512;  // a busy machine is not what this is about
  Turner bus({patient, robot(kArm2)});
  ASSERT_TRUE(bus.until_up());
  arm2.unplug();
  ASSERT_TRUE(bus.until([&] { return bus.counter("watchdog_trips", 1) == 1 && !bus.detail(1).empty(); }));
  arm2.plug_in();
  ASSERT_TRUE(bus.until_up());
  EXPECT_EQ(bus.counter("reconnects", 1), 1);
  EXPECT_EQ(bus.counter("lost_packets"), 0);
  EXPECT_EQ(bus.counter("watchdog_trips"), 0);
  EXPECT_EQ(bus.counter("reconnects"), 0);
  EXPECT_EQ(bus.counter("foreign_packets"), 0);
  // Every packet that was sent to the first robot reaches it.
  const auto sent = static_cast<std::uint64_t>(bus.counter("sent_packets"));
  EXPECT_TRUE(eventually([&] { return arm1.counters().consumed >= sent; }));
  EXPECT_EQ(arm1.counters().timeouts, 0U);
}

TEST(EthernetIpTransport, SendsWhenPacketsAreDueHoweverSlowlyTheLoopTurns) {
  AdapterHost arm1(kArm1);
  Turner bus({robot(kArm1)}, usual_bus(), 100ms);
  ASSERT_TRUE(bus.until_up());
  const auto before = bus.counter("sent_packets");
  for (int i = 0; i < 10; ++i) bus.turn();
  EXPECT_GT(bus.counter("sent_packets") - before, 3 * 10);  // 10 in each turn on an idle machine
}

TEST(EthernetIpTransport, WakesTheLoopForAnArrivalOnceInEachTurn) {
  AdapterHost arm1(kArm1);
  Turner bus({robot(kArm1)}, usual_bus(), 100ms);  // some ten images in each
  ASSERT_TRUE(bus.until_up());
  const auto exchanges = bus.exchanged;
  for (int i = 0; i < 5; ++i) bus.turn();
  EXPECT_LE(bus.exchanged - exchanges, 2 * 5);
}

TEST(EthernetIpTransport, SaysGoodByeSoThatTheRobotIsFreeAtOnce) {
  AdapterHost arm1(kArm1);
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until_up());
  bus.close();
  EXPECT_FALSE(arm1.with([](auto& a) { return a.connected(); }));
  EXPECT_EQ(arm1.counters().closes, 1U);
  EXPECT_EQ(arm1.counters().timeouts, 0U);
}

TEST(EthernetIpTransport, SaysGoodByeToThoseWhoListenAndDoesNotWaitForTheOthers) {
  AdapterHost arm1(kArm1), arm2(kArm2);
  Turner bus({robot(kArm2), robot(kArm1)});
  ASSERT_TRUE(bus.until_up());
  arm2.unplug();
  bus.close();
  EXPECT_EQ(arm1.counters().closes, 1U);
}

TEST(EthernetIpTransport, SaysGoodByeOverANewConnectionWhereTheRobotHasClosedTheOldOne) {
  AdapterHost arm1(kArm1);
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until_up());
  arm1.with([](auto& a) { a.close_tcp_connections(); });
  for (int i = 0; i < 5; ++i) bus.turn();
  EXPECT_EQ(bus.exchanges[0].link, LinkState::kUp);  // cyclic data goes on without TCP
  bus.close();
  EXPECT_EQ(arm1.counters().closes, 1U);
}

// A robot may keep its outputs for the owner that it lost.
TEST(EthernetIpTransport, IsTheSameOwnerAfterACrashAndAnotherUnderAnotherName) {
  auto jealous = meca500_at(kArm1);
  jealous.ownership = OwnershipPolicy::kKeep;
  AdapterHost arm1(jealous);
  Turner crashing({robot(kArm1)});
  ASSERT_TRUE(crashing.until_up());
  crashing.crash();
  ASSERT_TRUE(eventually([&] { return arm1.counters().timeouts == 1; }));
  {
    auto other = usual_bus();
    other.name = "another bridge";
    Turner stranger({robot(kArm1)}, other);
    ASSERT_TRUE(stranger.until([&] { return stranger.counter("refusals") > 0; }));
    EXPECT_THAT(stranger.detail(), HasSubstr("0x0106"));
  }
  Turner again({robot(kArm1)});
  EXPECT_TRUE(again.until_up()) << again.detail();
}

TEST(EthernetIpTransport, ListensOnAnotherPortWhereItIsToldTo) {
  AdapterHost arm1(kArm1);
  auto options = usual_bus();
  options.io_port = 2223;
  Turner bus({robot(kArm1)}, options);
  EXPECT_TRUE(bus.until_up()) << bus.detail();
}

TEST(EthernetIpTransport, JoinsTheGroupOfARobotThatSendsToOne) {
  auto beside_us = [](const std::string& address) {  // our socket has port 2222 on all addresses of this machine
    auto out = meca500_at(address);
    out.io_port = 2230;
    out.netmask = 0xFF000000;  // we are at 127.0.0.1
    return out;
  };
  AdapterHost arm1(beside_us(kArm1)), arm2(beside_us(kArm2));
  auto to_group = robot(kArm1);
  to_group.multicast = true;
  auto options = usual_bus();
  options.bind = 0;
  Turner bus({to_group, robot(kArm2)}, options);
  ASSERT_TRUE(bus.until_up()) << bus.detail() << bus.detail(1);
  const auto before = bus.images[0];
  EXPECT_TRUE(bus.until([&] { return bus.images[0] > before + 3; }));
  arm1.unplug();
  ASSERT_TRUE(bus.until([&] { return bus.counter("watchdog_trips") == 1; }));
  arm1.plug_in();
  EXPECT_TRUE(bus.until_up()) << bus.detail();
}

TEST(EthernetIpTransport, CountsPacketsOfStrangersAndGoesOnInAFlood) {
  AdapterHost arm1(kArm1);
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until_up());
  net::UdpSocket stranger({net::parse_ipv4("127.0.7.9").value(), 0}, {});
  const std::vector<std::byte> datagram(300);
  std::atomic<bool> enough = false;
  std::thread flood([&] {
    while (!enough) stranger.send({net::parse_ipv4(kBridge).value(), kIoPort}, datagram);
  });
  const bool counted = bus.until([&] { return bus.counter("unknown_packets") > 10'000; });
  for (int i = 0; i < 20; ++i) bus.turn();  // every one of them ends
  enough = true;
  flood.join();
  EXPECT_TRUE(counted);
  EXPECT_TRUE(bus.until_up()) << bus.detail();
}

std::string sentence(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(EthernetIpTransport, SaysWhatKeepsItFromOpening) {
  Turner first({});
  EXPECT_EQ(sentence([] { Turner second({}); }),
            "UDP port 2222 of 127.0.7.1 is taken by another program on this machine; stop it, or choose another port");
  const auto open = [](BusOptions options, std::vector<RobotOptions> robots) {
    options.io_port = 2224;
    Turner bus(std::move(robots), options);
  };
  EXPECT_EQ(sentence([&] {
              open(usual_bus(), {robot("127.0.0.1"), robot(kArm1), robot("localhost")});
            }),
            "'127.0.0.1' and 'localhost' are both 127.0.0.1; a robot has one connection");
  EXPECT_THAT(sentence([&] { open(usual_bus(), {robot("no-such-robot.invalid")}); }),
              HasSubstr("the host name 'no-such-robot.invalid' has no IPv4 address here"));
  auto elsewhere = usual_bus();
  elsewhere.bind = net::parse_ipv4("192.0.2.1").value();
  EXPECT_EQ(sentence([&] { open(elsewhere, {}); }), "192.0.2.1 is not an address of this machine");
  auto to_group = robot(kArm1);
  to_group.multicast = true;
  EXPECT_EQ(sentence([&] { open(usual_bus(), {to_group}); }),
            "multicast does not reach a socket that is bound to 127.0.7.1; bind to 0.0.0.0, or ask for point-to-point");
}

TEST(EthernetIpTransport, ExplainsEveryCounterInItsExample) {
  std::ifstream in(std::string(MECA_SOURCE_DIR) + "/config/ethernet_ip.yaml");
  const std::string example{std::istreambuf_iterator<char>(in), {}};
  const auto counters = make_transport({}, usual_bus())->counters();
  EXPECT_GE(counters.size(), 20U);
  for (const auto& counter : counters) EXPECT_THAT(example, HasSubstr(std::string(counter.name)));
}

TEST(MultiplierCode, IsThePowerOfTwoBelow) {
  EXPECT_EQ(multiplier_code(4), 0);
  EXPECT_EQ(multiplier_code(8), 1);
  EXPECT_EQ(multiplier_code(16), 2);
  EXPECT_EQ(multiplier_code(512), 7);
  EXPECT_EQ(multiplier_code(20), 2);
  EXPECT_EQ(multiplier_code(0), 0);
  EXPECT_EQ(multiplier_code(4096), 7);
}

}  // namespace
}  // namespace meca::test
