// Where the packets of a connection go, and how it is closed.
#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace meca::ethernet_ip::adapter_test {
namespace {

class AdapterInSession : public ::testing::Test {
 protected:
  AdapterInSession() { rig.enter(); }
  AdapterRig rig;
};
using AdapterRoute = AdapterInSession;
using AdapterClose = AdapterInSession;
using AdapterTruncation = AdapterInSession;

TEST_F(AdapterRoute, PointToPointGoesToPort2222OfTheOpener) {
  ASSERT_EQ(rig.open(usual_open()), "ok");
  EXPECT_EQ(rig.socket_item(ItemType::kSocketAddressOToT), (SocketAddress{0, 2222}));
  EXPECT_EQ(rig.socket_item(ItemType::kSocketAddressTToO), std::nullopt);
  EXPECT_EQ(rig.run_for(1ms).at(0).to, (SocketAddress{kOriginator, 2222}));
}

TEST_F(AdapterRoute, APortOfTheOpenersChoiceIsObeyedAndEchoed) {
  ASSERT_EQ(rig.open(usual_open(), kUsualPath, "0180 1000 0002 1f90 00000000 0000000000000000", 1), "ok");
  EXPECT_EQ(rig.socket_item(ItemType::kSocketAddressTToO), (SocketAddress{0, 8080}));
  EXPECT_EQ(rig.run_for(1ms).at(0).to, (SocketAddress{kOriginator, 8080}));
}

TEST_F(AdapterRoute, TheOpenersOwnAddressIsFineAndAThirdPartysIsRefused) {
  EXPECT_EQ(rig.open(usual_open(), kUsualPath, "0180 1000 0002 1f90 ac1c0109 0000000000000000", 1), "01 0205");
  EXPECT_EQ(rig.open(usual_open(), kUsualPath, "0180 1000 0002 08ae efc00140 0000000000000000", 1), "01 0205");
  EXPECT_EQ(rig.open(usual_open(), kUsualPath, "0180 1000 0002 0000 00000000 0000000000000000", 1), "01 0205");
  EXPECT_EQ(rig.open(usual_open(), kUsualPath, "0180 0800 0002 1f90 00000000", 1), "01 0205");
  EXPECT_EQ(rig.open(usual_open(), kUsualPath, "0180 1000 0002 1f90 ac1c0102 0000000000000000", 1), "ok");
}

TEST_F(AdapterRoute, MulticastHasTheGroupOfTheHostAddressAndAnIdOfOurs) {
  auto f = usual_open();
  f.t_to_o.type = ConnectionType::kMulticast;
  ASSERT_EQ(rig.open(f), "ok");
  EXPECT_NE(rig.opened.t_to_o_id, f.t_to_o_id);
  EXPECT_NE(rig.opened.t_to_o_id, rig.opened.o_to_t_id);
  const SocketAddress group{0xEFC00140, 2222};  // 239.192.1.64 for .3, as an independent adapter chose it
  EXPECT_EQ(rig.socket_item(ItemType::kSocketAddressTToO), group);
  const auto sent = rig.run_for(1ms);
  EXPECT_EQ(sent.at(0).to, group);
  EXPECT_TRUE(sent.at(0).multicast);
  EXPECT_EQ(sent.at(0).packet().connection_id, rig.opened.t_to_o_id);
}

TEST(AdapterMulticast, IsRefusedOffTheSubnet) {
  AdapterRig rig;
  rig.connect(0, 0xC0A80002);
  rig.enter();
  auto f = usual_open();
  f.t_to_o.type = ConnectionType::kMulticast;
  EXPECT_EQ(rig.open(f), "01 0813");
  EXPECT_EQ(rig.open(usual_open()), "ok");
}

TEST(AdapterSocketItems, NameAnotherPortWhereTheDeviceListensThere) {
  auto settings = meca500();
  settings.io_port = 2230;
  AdapterRig rig(settings);
  rig.enter();
  ASSERT_EQ(rig.open(usual_open()), "ok");
  EXPECT_EQ(rig.socket_item(ItemType::kSocketAddressOToT), (SocketAddress{0, 2230}));
}

TEST(AdapterMulticast, HasAGroupForEveryHostPartOfTenBits) {
  const auto group_of = [](std::uint32_t address, std::uint32_t netmask) {
    auto settings = meca500();
    settings.address = address;
    settings.netmask = netmask;
    AdapterRig rig(settings);
    rig.connect(0, address ^ 1);
    rig.enter();
    auto f = usual_open();
    f.t_to_o.type = ConnectionType::kMulticast;
    EXPECT_EQ(rig.open(f), "ok");
    return rig.socket_item(ItemType::kSocketAddressTToO).value().ipv4;
  };
  EXPECT_EQ(group_of(0xC0A80001, 0xFFFFFF00), 0xEFC00100u);  // .1: 239.192.1.0
  EXPECT_EQ(group_of(0xC0A80064, 0xFFFFFF00), 0xEFC00D60u);  // .100, the robot's default: 239.192.13.96
  EXPECT_EQ(group_of(0x0A000401, 0xFF000000), 0xEFC00100u);  // host part 1025: ten bits are kept
}

TEST(AdapterSocketItems, SwitchedOffOnlyTheGroupIsTold) {
  auto settings = meca500();
  settings.socket_items = false;
  AdapterRig rig(settings);
  rig.enter();
  ASSERT_EQ(rig.open(usual_open(), kUsualPath, "0180 1000 0002 1f90 00000000 0000000000000000", 1), "ok");
  EXPECT_EQ(rig.last_items.count, 2u);
  ASSERT_EQ(rig.close(usual_open().triad), "ok");
  auto f = usual_open();
  f.t_to_o.type = ConnectionType::kMulticast;
  ASSERT_EQ(rig.open(f), "ok");
  EXPECT_EQ(rig.last_items.count, 3u);
  EXPECT_TRUE(rig.socket_item(ItemType::kSocketAddressTToO));
}

// ---- Forward Close

TEST_F(AdapterClose, ForwardCloseStopsEverythingAndIsOnlyPossibleOnce) {
  ASSERT_EQ(rig.open(usual_open()), "ok");
  rig.run_for(20ms);
  EXPECT_EQ(rig.close(usual_open().triad), "ok");
  EXPECT_EQ(rig.last_data, "070034125b69026b0000");
  EXPECT_FALSE(rig.adapter.connected());
  EXPECT_TRUE(rig.run_for(100ms).empty());
  EXPECT_EQ(rig.close(usual_open().triad), "01 0107");
  EXPECT_EQ(rig.adapter.counters().closes, 1u);
}

TEST_F(AdapterClose, ForwardCloseNeedsTheWholeTriadAndThePath) {
  ASSERT_EQ(rig.open(usual_open()), "ok");
  auto triad = usual_open().triad;
  ++triad.connection_serial;
  EXPECT_EQ(rig.close(triad), "01 0107");
  triad = usual_open().triad;
  ++triad.originator_serial;
  EXPECT_EQ(rig.close(triad), "01 0107");
  EXPECT_EQ(rig.close(usual_open().triad, "20 04 2C 64 2C 96"), "01 0316");
  EXPECT_EQ(rig.close(usual_open().triad, ""), "01 0316");
  EXPECT_TRUE(rig.adapter.connected());
}

TEST_F(AdapterClose, ForwardCloseWorksFromAnotherSessionOfTheOpenerAndNotOfAStranger) {
  ASSERT_EQ(rig.open(usual_open()), "ok");
  rig.connect(1, kStranger);
  rig.enter(1);
  EXPECT_EQ(rig.close(usual_open().triad, kUsualPath, 1), "01 0107");
  rig.adapter.tcp_closed(0, rig.now);
  rig.connect(2);
  rig.enter(2);
  EXPECT_EQ(rig.close(usual_open().triad, kUsualPath, 2), "ok");
}

TEST_F(AdapterClose, ForwardCloseWithAPathLengthThatDoesNotFitIsNamed) {
  ASSERT_EQ(rig.open(usual_open()), "ok");
  // service, path | tick, ticks, triad, path words, pad | path
  EXPECT_EQ(rig.cip("4E 02 20 06 24 01 0A 02 0700 3412 5B69026B 04 00 20 04 2C 96 2C 64"), "13");
  EXPECT_EQ(rig.cip("4E 02 20 06 24 01 0A 02 0700 3412 5B69026B 02 00 20 04 2C 96 2C 64"), "15");
  EXPECT_EQ(rig.cip("4E 02 20 06 24 01 0A 02 0700 3412 5B69026B 03 00 20 04 2C 96 2C 64"), "ok");
}

// ---- Truncation

TEST_F(AdapterTruncation, EveryTruncationOfForwardOpenAndCloseIsRefusedAndChangesNothing) {
  for (const auto* whole :
       {"54 02 20 06 24 01 0A F5 00000000 57DAD0CE 05CB AD0B 51515151 00 000000 50C30000 4248 50C30000 FE28 01 08 "
        "34 04 1D06 2B00 F401 8B 03 20 04 2C 96 2C 64",
        "5B 02 20 06 24 01 0A F5 00000000 57DAD0CE 05CB AD0B 51515151 00 000000 50C30000 42000048 50C30000 FE000028 "
        "01 03 20 04 2C 96 2C 64",
        "4E 02 20 06 24 01 0A F5 05CB AD0B 51515151 03 00 20 04 2C 96 2C 64", "01 02 20 01 24 01",
        "0E 03 20 04 24 64 30 03"}) {
    const auto request = bytes(whole);
    for (std::size_t length = 0; length < request.size(); ++length) {
      EXPECT_THAT(rig.cip(Bytes(request).first(length)), ::testing::AnyOf("encapsulation 03", "13"))
          << whole << ", " << length << " bytes";
    }
  }
  EXPECT_FALSE(rig.adapter.connected());
  EXPECT_EQ(rig.adapter.counters().opens, 0u);
}

TEST_F(AdapterTruncation, EveryTruncationOfTheWholeMessageWaitsAndEveryShorterLengthIsRefused) {
  const auto message = rig.rr(bytes("01 02 20 01 24 01"));
  for (std::size_t length = 0; length < message.size(); ++length) {
    AdapterRig fresh;
    fresh.enter();
    EXPECT_EQ(fresh.tcp(Bytes(message).first(length)), "") << length;
    if (length < kHeaderSize) continue;
    AdapterRig lied_to;
    lied_to.enter();
    auto shorter = message;
    shorter.resize(length);
    shorter[2] = static_cast<std::byte>(length - kHeaderSize);
    EXPECT_EQ(read_header(bytes(lied_to.tcp(shorter))).value().status, 3u) << length;
  }
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
