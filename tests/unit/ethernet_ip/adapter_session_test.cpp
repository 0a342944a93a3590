// The encapsulation session of the adapter, as the table in transports/ethernet_ip/README.md has it.
#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace meca::ethernet_ip::adapter_test {
namespace {

constexpr std::string_view kRegister = "65000400 00000000 00000000 70726f6265000000 00000000 0100 0000";
constexpr std::string_view kIdentityReply =  // items of a ListIdentity reply of an independent adapter, state 0
    "0100 0c00 2900 0100 0002af12ac1c0103 0000000000000000 1d06 2b00 f401 0b03 0000 15cd5b07 07 4d656361353030 00";

std::string plain(std::string_view hex_with_spaces) { return hex(bytes(hex_with_spaces)); }

TEST(AdapterSession, RegisterSessionIsAnsweredWithAHandleAndTheSendersContext) {
  AdapterRig rig;
  EXPECT_EQ(rig.tcp(kRegister), plain("65000400 01000000 00000000 70726f6265000000 00000000 0100 0000"));
  EXPECT_EQ(rig.adapter.counters().sessions, 1u);
}

TEST(AdapterSession, EverySessionHasAHandleOfItsOwnAndAnOldOneIsNeverGoodAgain) {
  AdapterRig rig;
  rig.connect(1);
  const auto first = rig.enter(0);
  EXPECT_NE(rig.enter(1), first);
  EXPECT_EQ(rig.cip(bytes("01 02 20 01 24 01"), "", 0, 0), "encapsulation 64");  // session of connection 1
  EXPECT_EQ(rig.cip(bytes("01 02 20 01 24 01"), "", 0, 1), "ok");
  rig.adapter.tcp_closed(1, rig.now);
  rig.connect(1);
  EXPECT_EQ(rig.cip(bytes("01 02 20 01 24 01"), "", 0, 1), "encapsulation 64");
}

TEST(AdapterSession, AsManySessionsAsConnectionsRunSideBySide) {
  AdapterRig rig;
  for (std::size_t id = 0; id < Adapter::kMostConnections; ++id) {
    rig.connect(id);
    EXPECT_NE(rig.enter(id), 0u);
    EXPECT_EQ(rig.cip(bytes("0E 03 20 01 24 01 30 01"), "", 0, id), "ok");
  }
}

TEST(AdapterSession, AnotherVersionOrOptionsOfRegisterSessionAreRefusedWithWhatWeSpeak) {
  AdapterRig rig;
  for (const auto* data : {"0000 0000", "0200 0000", "0100 0100"}) {
    EXPECT_EQ(rig.tcp("65000400 00000000 00000000 0000000000000000 00000000" + std::string(data)),
              plain("65000400 00000000 69000000 0000000000000000 00000000 0100 0000"));
  }
  EXPECT_EQ(rig.adapter.counters().sessions, 0u);
}

TEST(AdapterSession, RegisteringTwiceIsRefusedAndTheFirstHandleStays) {
  AdapterRig rig;
  rig.tcp(kRegister);
  EXPECT_EQ(rig.tcp(kRegister), plain("65000400 01000000 01000000 70726f6265000000 00000000 0100 0000"));
  EXPECT_EQ(rig.adapter.counters().sessions, 1u);
}

TEST(AdapterSession, RegisterSessionOfAnotherLengthIsRefused) {
  AdapterRig rig;
  EXPECT_EQ(rig.tcp("65000200 00000000 00000000 0000000000000000 00000000 0100"),
            plain("65000000 00000000 65000000 0000000000000000 00000000"));
}

TEST(AdapterSession, SendRrDataWithoutASessionIsRefusedWithoutData) {
  AdapterRig rig;
  EXPECT_EQ(rig.tcp("6f001600 99000000 00000000 0102030405060708 00000000 00000000 0000 0200 0000 0000 b200 0600 "
                    "01 02 20 01 24 01"),
            plain("6f000000 99000000 64000000 0102030405060708 00000000"));
  EXPECT_EQ(rig.tcp("70000000 99000000 00000000 0102030405060708 00000000"),
            plain("70000000 99000000 64000000 0102030405060708 00000000"));
}

TEST(AdapterSession, SendUnitDataInASessionIsDiscardedForThereIsNoClass3Connection) {
  AdapterRig rig;
  rig.enter();
  EXPECT_EQ(rig.tcp("70000000 01000000 00000000 0102030405060708 00000000"), "");
  EXPECT_EQ(rig.adapter.counters().discarded, 1u);
}

TEST(AdapterSession, AnUnknownCommandIsRefused) {
  AdapterRig rig;
  EXPECT_EQ(rig.tcp("ff000200 00000000 00000000 0102030405060708 00000000 abcd"),
            plain("ff000000 00000000 01000000 0102030405060708 00000000"));
}

TEST(AdapterSession, MessagesWithOptionsOrAStatusAreDiscarded) {
  AdapterRig rig;
  EXPECT_EQ(rig.tcp("63000000 00000000 00000000 0000000000000000 01000000"), "");
  EXPECT_EQ(rig.tcp("63000000 00000000 01000000 0000000000000000 00000000"), "");
  EXPECT_EQ(rig.adapter.counters().discarded, 2u);
}

TEST(AdapterSession, NopIsNotAnsweredWhateverItCarries) {
  AdapterRig rig;
  EXPECT_EQ(rig.tcp("00000000 00000000 00000000 0000000000000000 00000000"), "");
  EXPECT_EQ(rig.tcp("00000300 00000000 00000000 0000000000000000 00000000 010203"), "");
}

TEST(AdapterSession, UnregisterSessionIsNotAnsweredAndClosesTcp) {
  AdapterRig rig;
  rig.enter();
  EXPECT_EQ(rig.tcp("66000000 01000000 00000000 0000000000000000 00000000"), "");
  EXPECT_TRUE(rig.adapter.wants_closed(0));
  EXPECT_EQ(rig.tcp(kRegister), "");  // over is over
}

TEST(AdapterSession, UnregisterSessionOfAnotherHandleIsIgnored) {
  AdapterRig rig;
  rig.enter();
  EXPECT_EQ(rig.tcp("66000000 02000000 00000000 0000000000000000 00000000"), "");
  EXPECT_FALSE(rig.adapter.wants_closed(0));
  EXPECT_EQ(rig.adapter.counters().discarded, 1u);
}

TEST(AdapterSession, ARequestSplitIntoBytesIsAnsweredWhenItIsComplete) {
  AdapterRig rig;
  const auto message = bytes(kRegister);
  for (std::size_t i = 0; i + 1 < message.size(); ++i) EXPECT_EQ(rig.tcp(Bytes(message).subspan(i, 1)), "") << i;
  EXPECT_EQ(rig.tcp(Bytes(message).last(1)).substr(0, 16), plain("65000400 01000000"));
}

TEST(AdapterSession, RequestsGluedTogetherAreAllAnswered) {
  AdapterRig rig;
  const std::string list = "64000000 00000000 00000000 0000000000000000 00000000";
  EXPECT_EQ(rig.tcp(list + list + list.substr(0, 20)),
            plain("64000200 00000000 00000000 0000000000000000 00000000 0000") +
                plain("64000200 00000000 00000000 0000000000000000 00000000 0000"));
}

TEST(AdapterSession, AMessageTooLongToLookAtIsRefusedSkippedAndTheNextOneUnderstood) {
  AdapterRig rig;
  rig.enter();
  auto message = bytes("6f00ffff 01000000 00000000 0000000000000000 00000000");
  message.resize(message.size() + 0xFFFF, std::byte{0x6F});
  EXPECT_EQ(rig.tcp(message), plain("6f000000 01000000 65000000 0000000000000000 00000000"));
  EXPECT_EQ(rig.cip("01 02 20 01 24 01"), "ok");
}

TEST(AdapterSession, OneWhoAsksWithoutReadingIsClosed) {
  AdapterRig rig;
  const auto list = bytes("63000000 00000000 00000000 0000000000000000 00000000");
  for (int i = 0; i < 100; ++i) rig.adapter.tcp_received(0, list, rig.now);
  EXPECT_TRUE(rig.adapter.wants_closed(0));
}

TEST(AdapterSession, RepliesAreTakenInPieces) {
  AdapterRig rig;
  rig.adapter.tcp_received(0, bytes(kRegister), rig.now);
  const std::string whole = hex(rig.adapter.tcp_output(0));
  rig.adapter.tcp_sent(0, 10);
  EXPECT_EQ(hex(rig.adapter.tcp_output(0)), whole.substr(20));
  rig.adapter.tcp_sent(0, 1000);
  EXPECT_TRUE(rig.adapter.tcp_output(0).empty());
}

TEST(AdapterSession, CpfWithoutNullAddressOrUnconnectedDataIsIncorrectData) {
  AdapterRig rig;
  rig.enter();
  const std::string header = "01000000 00000000 0000000000000000 00000000";
  for (const auto* data : {
           "00000000 0000 0000",                                       // no items
           "00000000 0000 0100 0000 0000",                             // no data item
           "00000000 0000 0200 a100 0400 01000000 b200 0200 01 00",    // connected address
           "00000000 0000 0200 0000 0100 00 b200 0200 01 00",          // null address with data
           "01000000 0000 0200 0000 0000 b200 0600 01 02 20 01 24 01"  // interface handle
       }) {
    char length[8];
    std::snprintf(length, sizeof length, "%02zx00", bytes(data).size());
    EXPECT_EQ(rig.tcp("6f00" + std::string(length) + header + data),
              plain("6f000000 01000000 03000000 0000000000000000 00000000"))
        << data;
  }
}

TEST(AdapterSession, SilentTcpIsClosedAfterTheInactivityTimeout) {
  AdapterRig rig;
  rig.enter();
  EXPECT_EQ(rig.adapter.next_event(), rig.now + 120s);
  rig.adapter.tick(rig.now + 120s - 1ns);
  EXPECT_FALSE(rig.adapter.wants_closed(0));
  rig.adapter.tick(rig.now + 120s);
  EXPECT_TRUE(rig.adapter.wants_closed(0));
}

TEST(AdapterSession, AnInactivityTimeoutOfZeroMeansNever) {
  auto settings = meca500();
  settings.inactivity_timeout = 0s;
  AdapterRig rig(settings);
  EXPECT_EQ(rig.adapter.next_event(), std::nullopt);
  rig.adapter.tick(rig.now + 100h);
  EXPECT_FALSE(rig.adapter.wants_closed(0));
}

// ---- Discovery

TEST(AdapterDiscovery, ListIdentityNeedsNoSessionOnTcpOrUdp) {
  AdapterRig rig;
  const std::string reply = plain("63002f00 00000000 00000000 0000000000000000 00000000") + plain(kIdentityReply);
  EXPECT_EQ(rig.tcp("63000000 00000000 00000000 0000000000000000 00000000"), reply);
  EXPECT_EQ(hex(rig.adapter.udp_received(bytes("63000000 00000000 00000000 0000000000000000 00000000"), false).bytes),
            reply);
}

TEST(AdapterDiscovery, ListServicesNamesCipOverTcpAndClass1OverUdp) {
  AdapterRig rig;
  EXPECT_EQ(hex(rig.adapter.udp_received(bytes("04000000 00000000 00000000 0000000000000000 00000000"), false).bytes),
            plain("04001a00 00000000 00000000 0000000000000000 00000000"
                  "0100 0001 1400 0100 2001 436f6d6d756e69636174696f6e730000"));
}

TEST(AdapterDiscovery, UnicastIsAnsweredAtOnceAndBroadcastWithinWhatTheAskerAllows) {
  AdapterRig rig;
  const auto ask = [&](std::string_view context, bool broadcast) {
    const std::string message = "63000000 00000000 00000000" + std::string(context) + "000000000000 00000000";
    const auto answer = rig.adapter.udp_received(bytes(message), broadcast);
    EXPECT_FALSE(answer.bytes.empty());
    return answer.delay;
  };
  Time longest{}, longest_of_500{};
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(ask("f401", false), Time{});
    longest = std::max(longest, ask("0000", true));
    longest_of_500 = std::max(longest_of_500, ask("f401", true));
  }
  EXPECT_LE(longest, 2000ms);
  EXPECT_GT(longest, 1500ms);
  EXPECT_LE(longest_of_500, 500ms);
  EXPECT_GT(longest_of_500, 350ms);
}

TEST(AdapterDiscovery, WhatIsNotAListCommandIsNotAnsweredByUdp) {
  AdapterRig rig;
  for (const auto* message : {
           "65000400 00000000 00000000 0000000000000000 00000000 0100 0000",  // RegisterSession
           "6f000000 00000000 00000000 0000000000000000 00000000",            // SendRRData
           "ff000000 00000000 00000000 0000000000000000 00000000",            // unknown
           "63000000 00000000 00000000 0000000000000000 01000000",            // options
           "63000100 00000000 00000000 0000000000000000 00000000 00",         // with data
           "63000000 00000000 00000000 0000000000000000 000000",              // short
           "63000000 00000000 00000000 0000000000000000 00000000 00",         // more than its length says
       }) {
    EXPECT_TRUE(rig.adapter.udp_received(bytes(message), false).bytes.empty()) << message;
  }
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
