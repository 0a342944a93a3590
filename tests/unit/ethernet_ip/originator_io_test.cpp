// The open connection: our packets on time, the robot's packets checked, and silence noticed.
#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/originator_rig.hpp"

namespace meca::ethernet_ip {
namespace {

using namespace test;

// ---- Producing

TEST(Producer, BeginsAtOnceAndSendsOnePacketPerInterval) {
  Rig rig;
  rig.to_running();
  const Time begin = rig.now;
  EXPECT_EQ(rig.machine.next_send(), begin);
  std::vector<Time> at;
  for (int ms = 0; ms < 100; ++ms, rig.now += 1ms) {
    if (rig.produce()) at.push_back(rig.now - begin);
  }
  ASSERT_EQ(at.size(), 10u);
  for (std::size_t i = 0; i < at.size(); ++i) EXPECT_EQ(at[i], i * 10ms);
}

TEST(Producer, WritesThePacketOfTheRecordedConnection) {
  Rig rig;
  rig.to_running();
  const auto golden = from_hex(golden::kOutputPacket1);
  std::copy(golden.begin() + 24, golden.end(), rig.outputs.begin());  // behind sequence count and run/idle header
  const auto datagram = rig.machine.produce(rig.outputs, true, rig.now);
  ASSERT_TRUE(datagram);
  EXPECT_EQ(to_hex(datagram->bytes), golden::kOutputPacket1);
  EXPECT_EQ(datagram->to, (SocketAddress{kRobot, 2222}));
}

TEST(Producer, SaysRunOrIdle) {
  Rig rig;
  rig.to_running();
  EXPECT_EQ(rig.produce(true)->header, 1u);
  rig.now += 10ms;
  EXPECT_EQ(rig.produce(false)->header, 0u);
}

TEST(Producer, CountsBothSequencesUpWithEveryPacket) {
  Rig rig;
  rig.to_running();
  for (std::uint32_t n = 1; n <= 70'000; ++n, rig.now += 10ms) {
    const auto sent = rig.produce();
    ASSERT_TRUE(sent);
    ASSERT_EQ(sent->sequence, n);
    ASSERT_EQ(sent->count, static_cast<std::uint16_t>(n)) << "16 bits, wraps";
    ASSERT_EQ(sent->size, kOutputSize);
    ASSERT_EQ(sent->connection_id, kOutputId);
  }
}

TEST(Producer, KeepsItsDeadlinesWhenItIsAskedLate) {
  Rig rig;
  rig.to_running();
  const Time begin = rig.now;
  int sent = 0;
  for (int i = 0; rig.now < begin + 10s; ++i, rig.now += i % 3 == 0 ? 3ms : 1ms) sent += rig.produce() ? 1 : 0;
  EXPECT_EQ(sent, 1000);
  EXPECT_EQ(rig.machine.counters().skipped_sends, 0u);
  EXPECT_EQ(rig.machine.next_send(), begin + 10s) << "no drift";
}

TEST(Producer, SkipsWhatItMissedAndNeverBursts) {
  Rig rig;
  rig.to_running();
  const Time begin = rig.now;
  EXPECT_TRUE(rig.produce());
  rig.now += 55ms;  // 10, 20, 30 and 40 ms are over, the packet of 50 ms is late
  EXPECT_TRUE(rig.produce());
  EXPECT_FALSE(rig.produce());
  EXPECT_EQ(rig.machine.counters().skipped_sends, 4u);
  EXPECT_EQ(rig.machine.next_send(), begin + 60ms);
}

TEST(Producer, TakesWhatIsDueWithinHalfATickAsDue) {
  Rig rig;
  rig.to_running();
  EXPECT_TRUE(rig.produce());
  rig.now += 9'499us;
  EXPECT_FALSE(rig.produce());
  rig.now += 1us;
  EXPECT_TRUE(rig.produce());
}

TEST(Producer, UsesTheIntervalThatTheRobotGrantsNotTheOneAsked) {
  auto settings = usual_settings();
  settings.o_to_t_rpi_us = settings.t_to_o_rpi_us = 7'500;
  Rig rig(settings);
  rig.to_running({.o_to_t_api_us = 7'000, .t_to_o_api_us = 7'000});  // as CIPster answers
  const Time begin = rig.now;
  EXPECT_TRUE(rig.produce());
  EXPECT_EQ(rig.machine.next_send(), begin + 7ms);
  rig.receive(1, 1);
  EXPECT_EQ(rig.until([&] { return rig.machine.state() != State::kRunning; }, 1s), 16 * 7ms);
}

TEST(Consumer, SaysWhichIntervalTheRobotGrantsWhereItIsNotTheOneAsked) {
  Rig rig;
  rig.to_running({.t_to_o_api_us = 20'000});
  rig.receive(1, 1);
  EXPECT_EQ(
      rig.machine.trouble(),
      "the robot grants a packet interval of 10 ms O->T and 20 ms T->O, 10 and 10 ms were asked for; the watchdog is "
      "320 ms; set rpi to what it grants if it stays so");
  EXPECT_TRUE(rig.machine.running());
}

TEST(Producer, IsSilentWhileTheConnectionIsNotOpen) {
  Rig rig;
  EXPECT_FALSE(rig.produce());
  EXPECT_FALSE(rig.machine.next_send());
  rig.to_opening();
  EXPECT_FALSE(rig.produce());
}

// ---- Consuming

TEST(Consumer, TakesAnyFirstSequence) {
  Rig rig;
  rig.to_running();
  EXPECT_TRUE(rig.receive(0x80000000, 0x8000));
  EXPECT_TRUE(rig.machine.running());
  EXPECT_EQ(rig.machine.counters().received, 1u);
  EXPECT_EQ(rig.machine.counters().lost, 0u);
}

TEST(Consumer, GoesOnWhereBothSequencesWrap) {
  Rig rig;
  rig.to_running();
  rig.receive(0xFFFFFFFE, 0xFFFF);
  rig.receive(0xFFFFFFFF, 0x0000);
  rig.receive(0x00000000, 0x0001);
  EXPECT_EQ(rig.machine.counters().received, 3u);
  EXPECT_EQ(rig.machine.counters().stale, 0u);
  EXPECT_EQ(rig.machine.counters().lost, 0u);
}

TEST(Consumer, CountsWhatWasLost) {
  Rig rig;
  rig.to_receiving();
  rig.receive(5, 5);
  EXPECT_EQ(rig.machine.counters().lost, 3u);
}

TEST(Consumer, DropsStaleAndDuplicatePackets) {
  Rig rig;
  rig.to_running();
  rig.receive(10, 10, 0xAA);
  rig.machine.take_fresh();
  rig.receive(10, 10, 0xBB);
  rig.receive(9, 9, 0xBB);
  EXPECT_FALSE(rig.machine.take_fresh());
  EXPECT_EQ(rig.machine.input()[0], std::byte{0xAA});
  EXPECT_EQ(rig.machine.counters().stale, 2u);
}

TEST(Consumer, TakesTheSameSequenceCountAsALifeSignWithoutData) {
  Rig rig;
  rig.to_running();
  rig.receive(1, 7, 0xAA);
  rig.machine.take_fresh();
  rig.now += 100ms;
  rig.receive(2, 7, 0xBB);
  EXPECT_FALSE(rig.machine.take_fresh());
  EXPECT_EQ(rig.machine.input()[0], std::byte{0xAA});
  EXPECT_EQ(rig.machine.counters().repeated, 1u);
  rig.tick(159ms);
  EXPECT_TRUE(rig.machine.running()) << "it counts as alive";
}

TEST(Consumer, DropsPacketsOfAnotherSender) {
  Rig rig;
  rig.to_receiving();
  EXPECT_FALSE(rig.machine.io_received({kStranger, 2222}, rig.packet(2, 2, 0xBB), rig.now));
  EXPECT_FALSE(rig.machine.take_fresh());
  EXPECT_EQ(rig.machine.counters().foreign, 1u);
}

TEST(Consumer, TakesTheRobotsPacketsFromAnyPort) {
  Rig rig;
  rig.to_receiving();
  EXPECT_TRUE(rig.machine.io_received({kRobot, 54321}, rig.packet(2, 2), rig.now));
  EXPECT_TRUE(rig.machine.take_fresh());
}

TEST(Consumer, DropsPacketsOfAnotherConnectionOfTheRobot) {
  Rig rig;
  rig.to_receiving();
  rig.connection_id = 0xDEAD;
  EXPECT_TRUE(rig.receive(2, 2));
  EXPECT_FALSE(rig.machine.take_fresh());
  EXPECT_EQ(rig.machine.counters().foreign, 1u);
}

TEST(Consumer, LeavesWhatConcernsItNotAtAllToOthers) {
  Rig rig;
  rig.to_receiving();
  rig.connection_id = 0xDEAD;
  EXPECT_FALSE(rig.machine.io_received({kStranger, 2222}, rig.packet(2, 2), rig.now));
  EXPECT_FALSE(rig.machine.io_received({kStranger, 2222}, from_hex("0102"), rig.now));
  EXPECT_EQ(rig.machine.counters().foreign, 0u);
  EXPECT_EQ(rig.machine.counters().malformed, 0u);
}

TEST(Consumer, DropsPacketsOfAnotherSize) {
  Rig rig;
  rig.to_receiving();
  for (const std::size_t size : {std::size_t{2}, kInputSize - 1ul, kInputSize + 1ul, kInputSize + 4ul}) {
    rig.receive(2, 2, 0xBB, size);
  }
  rig.machine.io_received({kRobot, 2222}, from_hex("0102"), rig.now);
  EXPECT_FALSE(rig.machine.take_fresh());
  EXPECT_EQ(rig.machine.counters().malformed, 5u);
  EXPECT_TRUE(rig.machine.running());
}

TEST(Consumer, EveryTruncationOfAPacketIsQuiet) {
  Rig rig;
  rig.to_receiving();
  const auto whole = rig.packet(2, 2);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    rig.machine.io_received({kRobot, 2222}, part, rig.now);
  }
  EXPECT_FALSE(rig.machine.take_fresh());
  EXPECT_EQ(rig.machine.counters().malformed, whole.size());
}

TEST(Consumer, LeavesPacketsAloneThatComeBeforeTheAnswerToForwardOpen) {
  Rig rig;
  rig.to_opening();
  EXPECT_TRUE(rig.receive(1, 1));
  EXPECT_FALSE(rig.machine.take_fresh());
  EXPECT_EQ(rig.machine.counters().foreign, 0u);
}

// ---- Silence

TEST(Watchdog, TripsAfterIntervalTimesMultiplierAndSaysSo) {
  Rig rig;
  rig.to_receiving();
  EXPECT_EQ(rig.until([&] { return rig.machine.state() != State::kRunning; }, 1s), 160ms);
  EXPECT_EQ(rig.machine.trouble(),
            "no packet from 192.168.0.100 for 160 ms (10 ms x 16); check the network, and whether EtherNet/IP is still "
            "enabled on the robot");
  EXPECT_EQ(rig.machine.counters().watchdog_trips, 1u);
  EXPECT_FALSE(rig.machine.running());
  EXPECT_EQ(rig.machine.o_to_t_api_us(), 0u);
  EXPECT_EQ(rig.take_close(), rig.asked.triad) << "best effort";
}

TEST(Watchdog, IsFedByNewPacketsOnly) {
  Rig rig;
  rig.to_receiving();
  for (int i = 0; i < 15; ++i) {
    rig.tick(10ms);
    rig.receive(1, 1);
    rig.receive(2, 2, 0, 100);
    rig.machine.io_received({kStranger, 2222}, rig.packet(2, 2), rig.now);
  }
  rig.tick(10ms);
  EXPECT_EQ(rig.machine.state(), State::kClosing);
}

TEST(Watchdog, IsFedByEveryNewPacket) {
  Rig rig;
  rig.to_receiving();
  for (std::uint16_t n = 2; n < 100; ++n) {
    rig.tick(159ms);
    rig.receive(n, n);
  }
  EXPECT_TRUE(rig.machine.running());
}

TEST(FirstPacket, MayTakeTenSecondsAndThenTheFirewallIsNamed) {
  Rig rig;
  rig.to_running();
  EXPECT_EQ(rig.until([&] { return rig.machine.state() != State::kRunning; }, 20s), 10s);
  EXPECT_EQ(rig.machine.trouble(),
            "connection open, but no answer on UDP from 192.168.0.100 for 10 s; let UDP 2222 towards this host through "
            "its firewall");
}

TEST(FirstPacket, MayTakeAsLongAsTheWatchdogWhereThatIsLonger) {
  auto settings = usual_settings();
  settings.multiplier_code = 7;
  Rig rig(settings);
  rig.to_running({.t_to_o_api_us = 100'000});
  EXPECT_EQ(rig.until([&] { return rig.machine.state() != State::kRunning; }, 60s), 51'200ms);
}

TEST(FirstPacket, OfMulticastNamesTheGroupToo) {
  auto settings = usual_settings();
  settings.multicast = true;
  Rig rig(settings);
  rig.to_running({.t_to_o = SocketAddress{kGroup, 2222}});
  rig.tick(10s);
  EXPECT_EQ(rig.machine.trouble(),
            "connection open, but nothing arrives from 192.168.0.100 at group 239.192.1.64 for 10 s; let UDP 2222 "
            "through this host's firewall, check IGMP snooping, or ask for point-to-point");
}

TEST(FirstPacket, OfAWrongSizeIsSaidAtOnce) {
  Rig rig;
  rig.to_running();
  rig.receive(1, 1, 0, 258);
  EXPECT_EQ(rig.machine.trouble(),
            "the robot's packets have 258 bytes, 254 were agreed (does it send a run/idle header?); check that it is a "
            "Meca500, and its firmware");
  EXPECT_FALSE(rig.machine.running());
  rig.receive(1, 1);
  EXPECT_TRUE(rig.machine.running());
  EXPECT_TRUE(rig.machine.trouble().empty());
}

TEST(Watchdog, TheNextConnectionHasANewSerialAndDoesNotTakeOldPackets) {
  Rig rig;
  rig.to_receiving();
  const auto old = rig.asked;
  rig.tick(160ms);
  rig.finish_closing();
  EXPECT_EQ(rig.machine.state(), State::kWaiting);
  EXPECT_FALSE(rig.machine.wants_tcp());
  rig.to_running();
  EXPECT_NE(rig.asked.triad.connection_serial, old.triad.connection_serial);
  EXPECT_NE(rig.asked.t_to_o_id, old.t_to_o_id);
  EXPECT_FALSE(rig.machine.trouble().empty()) << "stays until the connection runs";
  rig.connection_id = old.t_to_o_id;
  rig.receive(100, 100);
  EXPECT_FALSE(rig.machine.running());
  rig.connection_id.reset();
  rig.receive(1, 1);
  EXPECT_TRUE(rig.machine.running());
  EXPECT_TRUE(rig.machine.trouble().empty());
}

// ---- TCP while running

TEST(TcpLoss, IsNoFaultOfARunningConnection) {
  Rig rig;
  rig.to_receiving();
  rig.machine.tcp_closed("", rig.now);
  EXPECT_FALSE(rig.machine.wants_tcp()) << "not needed now";
  for (std::uint16_t n = 2; n < 1000; ++n) {
    rig.tick(10ms);
    rig.receive(n, n);
    ASSERT_TRUE(rig.produce());
  }
  EXPECT_TRUE(rig.machine.running());
  EXPECT_TRUE(rig.machine.trouble().empty());
}

}  // namespace
}  // namespace meca::ethernet_ip
