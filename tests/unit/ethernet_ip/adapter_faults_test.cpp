// Every fault on request, and what it looks like from outside.
#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace meca::ethernet_ip::adapter_test {
namespace {

class AdapterFault : public ::testing::Test {
 protected:
  AdapterFault() { rig.enter(); }
  void open() { ASSERT_EQ(rig.open(usual_open()), "ok"); }
  std::vector<std::uint32_t> sequences(Time duration) {
    std::vector<std::uint32_t> out;
    for (const auto& sent : rig.run_for(duration)) out.push_back(sent.packet().sequence);
    return out;
  }
  std::vector<unsigned> counts(Time duration) {
    std::vector<unsigned> out;
    for (const auto& sent : rig.run_for(duration)) out.push_back(wire::Reader(sent.packet().data).u16());
    return out;
  }
  AdapterRig rig;
};

TEST_F(AdapterFault, RefuseOpenAnswersWithTheStatusAsked) {
  rig.adapter.faults().refuse_open = 0x0113;
  EXPECT_EQ(rig.open(usual_open()), "01 0113");
  rig.adapter.faults() = {};
  open();
}

TEST_F(AdapterFault, WrongSizeWantsAnotherTToOSizeAndSendsIt) {
  rig.adapter.faults().wrong_size = 258;
  EXPECT_EQ(rig.open(usual_open()), "01 0128 0102");
  auto f = usual_open();
  f.t_to_o.size = 258;
  ASSERT_EQ(rig.open(f), "ok");
  EXPECT_EQ(rig.run_for(1ms).at(0).packet().data.size(), 258u);
}

TEST_F(AdapterFault, WrongSizeMayBeAnyNumber) {
  for (const std::uint16_t size : {0, 1, 2, 3, 511}) {
    rig.adapter.faults().wrong_size = size;
    rig.adapter.faults().corrupt = true;
    auto f = usual_open();
    f.t_to_o.size = size;
    ASSERT_EQ(rig.open(f), "ok");
    EXPECT_EQ(rig.run_for(1ms).at(0).packet().data.size(), std::max<std::size_t>(size, 3) - 1);
    ASSERT_EQ(rig.close(f.triad), "ok");
  }
}

TEST_F(AdapterFault, ApiIsToldAndKeptInBothDirections) {
  rig.adapter.faults().api_us = 20'000;
  open();
  EXPECT_EQ(rig.opened.o_to_t_api_us, 20'000u);
  EXPECT_EQ(rig.opened.t_to_o_api_us, 20'000u);
  rig.io();
  EXPECT_EQ(rig.run_for(79ms).size(), 4u);
  EXPECT_TRUE(rig.adapter.connected());
  rig.run_for(2ms);
  EXPECT_FALSE(rig.adapter.connected());  // 4 x 20 ms
}

TEST_F(AdapterFault, AnApiOfZeroIsToldButDoesNotFloodTheNetwork) {
  rig.adapter.faults().api_us = 0;
  open();
  EXPECT_EQ(rig.opened.t_to_o_api_us, 0u);
  EXPECT_EQ(rig.run_for(10ms).size(), 10u);
}

TEST_F(AdapterFault, AForeignAddressIsOnlyTold) {
  rig.adapter.faults().foreign_address = SocketAddress{kStranger, 5000};
  open();
  EXPECT_EQ(rig.socket_item(ItemType::kSocketAddressOToT), (SocketAddress{kStranger, 5000}));
  EXPECT_EQ(rig.socket_item(ItemType::kSocketAddressTToO), (SocketAddress{kStranger, 5000}));
  EXPECT_EQ(rig.run_for(1ms).at(0).to, (SocketAddress{kOriginator, 2222}));
}

TEST_F(AdapterFault, StopProducingKeepsTheConnectionWithoutTToO) {
  open();
  EXPECT_EQ(rig.run_for(20ms).size(), 2u);
  rig.adapter.faults().stop_producing = true;
  EXPECT_TRUE(rig.run_for(100ms).empty());
  EXPECT_TRUE(rig.adapter.connected());
  rig.adapter.faults().stop_producing = false;
  EXPECT_EQ(rig.run_for(20ms).size(), 2u);  // what was missed is not made up for
}

TEST_F(AdapterFault, DuplicateSendsEveryPacketTwice) {
  rig.adapter.faults().duplicate = true;
  open();
  EXPECT_THAT(sequences(30ms), ::testing::ElementsAre(1, 1, 2, 2, 3, 3));
}

TEST_F(AdapterFault, StaleSequenceMakesEverySecondPacketAnOldOne) {
  rig.adapter.faults().stale_sequence = true;
  open();
  EXPECT_THAT(sequences(60ms), ::testing::ElementsAre(1, 0, 2, 1, 3, 2));
}

TEST_F(AdapterFault, CorruptPacketsAreOneByteShort) {
  rig.adapter.faults().corrupt = true;
  open();
  EXPECT_EQ(rig.run_for(1ms).at(0).packet().data.size(), 253u);
}

TEST_F(AdapterFault, AFrozenCountStandsStillWhileTheSequenceGoesOn) {
  open();
  EXPECT_THAT(counts(30ms), ::testing::ElementsAre(1, 2, 3));
  rig.adapter.faults().frozen_count = true;
  EXPECT_THAT(counts(30ms), ::testing::ElementsAre(3, 3, 3));
  EXPECT_THAT(sequences(10ms), ::testing::ElementsAre(7));
}

TEST_F(AdapterFault, ClosingTcpLeavesIoRunning) {
  open();
  rig.io();
  rig.adapter.close_tcp_connections();
  EXPECT_TRUE(rig.adapter.wants_closed(0));
  EXPECT_FALSE(rig.adapter.wants_closed(1));  // never accepted
  rig.adapter.tcp_closed(0, rig.now);
  EXPECT_FALSE(rig.run_for(20ms).empty());
  EXPECT_TRUE(rig.adapter.run());
}

TEST_F(AdapterFault, APowerCycleForgetsEverythingAndSendsNothing) {
  open();
  rig.io();
  rig.adapter.tcp_received(0, bytes("63000000 00000000 00000000 0000000000000000 00000000"), rig.now);
  rig.adapter.power_cycle();
  EXPECT_TRUE(rig.adapter.tcp_output(0).empty());
  EXPECT_TRUE(rig.adapter.wants_closed(0));
  EXPECT_FALSE(rig.adapter.connected());
  EXPECT_EQ(rig.adapter.output(), image::OutputBytes{});
  EXPECT_TRUE(rig.run_for(100ms).empty());
  rig.io();
  EXPECT_EQ(rig.adapter.counters().foreign, 1u);
  rig.connect(0);
  rig.enter();
  open();
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
