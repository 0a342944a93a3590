// The way of the originator to an open connection, step by step and byte by byte.
#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/originator_rig.hpp"

namespace meca::ethernet_ip {
namespace {

using namespace test;

bool says(const Rig& rig, std::string_view words) {
  return rig.machine.trouble().find(words) != std::string_view::npos;
}

TEST(Originator, StartsAtOnceAndGoesTheWholeWay) {
  Rig rig;
  EXPECT_EQ(rig.machine.state(), State::kWaiting);
  EXPECT_FALSE(rig.machine.wants_tcp());
  rig.tick();
  EXPECT_EQ(rig.machine.state(), State::kConnecting);
  EXPECT_TRUE(rig.machine.wants_tcp());
  rig.machine.tcp_connected(rig.now, kHost);
  EXPECT_EQ(rig.machine.state(), State::kRegistering);
  EXPECT_EQ(to_hex(rig.take_output()), golden::kRegisterRequest);
  rig.session = 1;
  rig.answer_register();
  EXPECT_EQ(rig.machine.state(), State::kIdentifying);
  EXPECT_EQ(to_hex(rig.take_output()), golden::kIdentityRequest);
  rig.answer_identity();
  EXPECT_EQ(rig.machine.state(), State::kOpening);
  EXPECT_EQ(rig.machine.identity()->serial_number, 123456789u);
  rig.take_open();
  rig.answer_open();
  EXPECT_EQ(rig.machine.state(), State::kRunning);
  EXPECT_FALSE(rig.machine.running()) << "nothing has arrived yet";
  rig.receive(1, 1, 0x5A);
  EXPECT_TRUE(rig.machine.running());
  EXPECT_TRUE(rig.machine.take_fresh());
  EXPECT_FALSE(rig.machine.take_fresh());
  EXPECT_EQ(rig.machine.input()[251], std::byte{0x5A});
  EXPECT_EQ(rig.machine.o_to_t_api_us(), 10'000u);
  EXPECT_EQ(rig.machine.t_to_o_api_us(), 10'000u);
  EXPECT_TRUE(rig.machine.trouble().empty());
  EXPECT_EQ(rig.machine.counters().opens, 1u);
}

// A CIPster adapter of 2026 refuses GetAttributesAll of its identity so.
TEST(Originator, AsksForTheListedIdentityWhereTheIdentityObjectDoesNotGiveItInOnePiece) {
  Rig rig;
  rig.connect();
  rig.take_output();
  rig.session = 1;
  rig.answer_register();
  rig.take_output();
  rig.feed("6F0014000100000000000000000000000000000000000000000000000000020000000000B200040081000800");
  EXPECT_EQ(rig.machine.state(), State::kIdentifying);
  EXPECT_TRUE(rig.machine.trouble().empty());
  EXPECT_EQ(to_hex(rig.take_output()), "630000000100000000000000000000000000000000000000");
  rig.session = 0;  // the answer belongs to none
  rig.feed(rig.encapsulated(Command::kListIdentity, from_hex(golden::kListedIdentity)));
  EXPECT_EQ(rig.machine.state(), State::kOpening);
  EXPECT_EQ(rig.machine.identity()->serial_number, 123456789u);
  rig.take_open();
  rig.session = 1;
  rig.answer_open();
  EXPECT_EQ(rig.machine.state(), State::kRunning);
}

TEST(ForwardOpenRequest, OfTheUsualSettingsIsTheOneOfTheVendorsFiles) {
  Rig rig;
  rig.connect();
  rig.take_output();
  rig.session = 1;
  rig.answer_register();
  rig.take_output();
  rig.answer_identity();
  // As meca1, frame 8, but for 8 bit path segments, 2 s instead of 250 s to answer, and x16.
  EXPECT_EQ(to_hex(rig.take_output()),
            "6F0040000100000000000000000000000000000000000000000000000000020000000000B20030005402200624010A02"
            "0000000001002DDC010034125B69026B0200000010270000424810270000FE48010320042C962C64");
}

TEST(ForwardOpenRequest, AsksForWhatTheSettingsSay) {
  auto settings = usual_settings();
  settings.multicast = true;
  settings.large = true;
  settings.key = KeyPolicy::kCompatible;
  settings.major = 11;
  settings.minor = 3;
  settings.multiplier_code = 4;
  settings.o_to_t_rpi_us = 20'000;
  settings.t_to_o_rpi_us = 50'000;
  Rig rig(settings, 0x0102);
  rig.to_opening();
  EXPECT_TRUE(rig.asked.large);
  EXPECT_EQ(rig.asked.t_to_o.type, ConnectionType::kMulticast);
  EXPECT_EQ(rig.asked.o_to_t.type, ConnectionType::kPointToPoint);
  EXPECT_EQ(rig.asked.multiplier_code, 4);
  EXPECT_EQ(rig.asked.o_to_t_rpi_us, 20'000u);
  EXPECT_EQ(rig.asked.t_to_o_rpi_us, 50'000u);
  EXPECT_EQ(rig.asked.triad, (ConnectionTriad{0x0102, 0x1234, 0x6B02695B}));
  EXPECT_EQ(to_hex(rig.asked.path), "34041D062B00F4018B0320042C962C64");
  rig.answer_open({.t_to_o_id = 7, .t_to_o = SocketAddress{kGroup, 2222}});
  EXPECT_EQ(rig.machine.state(), State::kRunning) << rig.machine.trouble();
}

TEST(ForwardOpenRequest, WithAnExactKeyHasNoCompatibleBit) {
  auto settings = usual_settings();
  settings.key = KeyPolicy::kExact;
  settings.major = 11;
  settings.minor = 3;
  Rig rig(settings);
  rig.to_opening();
  EXPECT_EQ(to_hex(rig.asked.path), "34041D062B00F4010B0320042C962C64");
}

TEST(ForwardOpenRequest, TellsAPortThatIsNot2222) {
  auto settings = usual_settings();
  settings.io_port = 5000;
  Rig rig(settings);
  rig.to_opening();
  const Item* item = rig.items_->find(ItemType::kSocketAddressTToO);
  ASSERT_NE(item, nullptr);
  EXPECT_EQ(read_socket_address(item->data), (SocketAddress{0, 5000}));
  Rig usual;
  usual.to_opening();
  EXPECT_EQ(usual.items_->find(ItemType::kSocketAddressTToO), nullptr);
}

TEST(ConnectionSerial, IsNewForEveryOpenAndNeverZero) {
  Rig rig(usual_settings(), 0xFFFF);
  rig.to_opening();
  EXPECT_EQ(rig.asked.triad.connection_serial, 0xFFFF);
  rig.refuse_open({0x0113});
  EXPECT_TRUE(rig.sent_unregister());
  rig.tick();
  rig.to_opening();
  EXPECT_EQ(rig.asked.triad.connection_serial, 1);
  EXPECT_EQ(rig.asked.t_to_o_id, 0xDC2D0001u);
  Rig zero(usual_settings(), 0);
  zero.to_opening();
  EXPECT_EQ(zero.asked.triad.connection_serial, 1);
}

// ---- TCP is a stream

TEST(TcpStream, ThatComesByteByByteIsUnderstood) {
  Rig rig;
  rig.connect();
  rig.take_output();
  const auto slowly = [&](const std::vector<std::byte>& bytes) {
    for (const std::byte b : bytes) rig.feed(wire::Bytes(&b, 1));
  };
  slowly(rig.encapsulated(Command::kRegisterSession, from_hex("01000000")));
  EXPECT_EQ(rig.machine.state(), State::kIdentifying);
  rig.take_output();
  rig.answer_identity();
  rig.take_open();
  slowly(rig.open_reply());
  EXPECT_EQ(rig.machine.state(), State::kRunning);
}

TEST(TcpStream, WithSeveralMessagesGluedIsUnderstood) {
  Rig rig;
  rig.to_opening();
  auto bytes = rig.encapsulated(Command::kNop, from_hex("010203"));
  const auto unasked = rig.encapsulated(Command::kListServices, {});
  const auto reply = rig.open_reply();
  bytes.insert(bytes.end(), unasked.begin(), unasked.end());
  bytes.insert(bytes.end(), reply.begin(), reply.end());
  bytes.insert(bytes.end(), unasked.begin(), unasked.end());
  rig.feed(bytes);
  EXPECT_EQ(rig.machine.state(), State::kRunning);
}

TEST(TcpStream, OutputGoesAsFarAsTheSocketTakesIt) {
  Rig rig;
  rig.connect();
  const std::size_t all = rig.machine.tcp_output().size();
  rig.machine.tcp_sent(10);
  EXPECT_EQ(rig.machine.tcp_output().size(), all - 10);
  rig.machine.tcp_sent(1000);
  EXPECT_TRUE(rig.machine.tcp_output().empty());
}

TEST(TcpStream, RepliesThatNobodyAskedForChangeNothing) {
  Rig rig;
  rig.to_opening();
  rig.answer_register();
  rig.answer_identity();
  rig.answer_close(rig.asked.triad);
  EXPECT_EQ(rig.machine.state(), State::kOpening);
  EXPECT_TRUE(rig.machine.tcp_output().empty());
  const auto reply = rig.open_reply();
  rig.feed(reply);
  rig.feed(reply);
  EXPECT_EQ(rig.machine.state(), State::kRunning);
  EXPECT_EQ(rig.machine.counters().opens, 1u);
}

TEST(TcpStream, MessagesWithOptionsAreDiscarded) {
  Rig rig;
  rig.to_opening();
  auto reply = rig.open_reply();
  reply[20] = std::byte{1};
  rig.feed(reply);
  EXPECT_EQ(rig.machine.state(), State::kOpening);
}

TEST(TcpStream, AMessageThatIsTooLongEndsTheSessionInWords) {
  Rig rig;
  rig.connect();
  rig.take_output();
  rig.feed("6F00F901 00000000 00000000 0000000000000000 00000000");
  EXPECT_FALSE(rig.machine.wants_tcp());
  EXPECT_EQ(rig.machine.state(), State::kWaiting);
  EXPECT_TRUE(says(rig, "message of 505 bytes over TCP, at most 504")) << rig.machine.trouble();
}

TEST(TcpStream, AMessageThatIsTooLongLeavesARunningConnectionAlone) {
  Rig rig;
  rig.to_receiving();
  rig.feed("6F00FFFF 00000000 00000000 0000000000000000 00000000");
  EXPECT_FALSE(rig.machine.wants_tcp());
  EXPECT_TRUE(rig.machine.running());
}

// ---- Where the packets go

TEST(SocketItems, AbsentOrWithoutAddressMeanTheRobot) {
  for (const auto& item : {std::optional<SocketAddress>{}, std::optional(SocketAddress{0, 2222}),
                           std::optional(SocketAddress{0, 0}), std::optional(SocketAddress{kRobot, 2222})}) {
    Rig rig;
    rig.to_running({.o_to_t = item});
    const auto sent = rig.produce();
    ASSERT_TRUE(sent) << rig.machine.trouble();
    EXPECT_EQ(sent->to, (SocketAddress{kRobot, 2222}));
  }
}

TEST(SocketItems, MayMoveThePortOfTheRobot) {
  Rig rig;
  rig.to_running({.o_to_t = SocketAddress{0, 3333}});
  ASSERT_EQ(rig.machine.state(), State::kRunning);
  EXPECT_EQ(rig.produce()->to, (SocketAddress{kRobot, 3333}));
}

TEST(SocketItems, MayNameUsOrTheRobotForTheInputs) {
  for (const std::uint32_t address : {0u, kRobot, kHost}) {
    Rig rig;
    rig.to_running({.t_to_o = SocketAddress{address, 2222}});
    EXPECT_EQ(rig.machine.state(), State::kRunning) << rig.machine.trouble();
  }
}

TEST(SocketItems, OfAStrangerAreRefusedAndTheConnectionIsClosed) {
  Rig rig;
  rig.to_running({.o_to_t = SocketAddress{kStranger, 2222}});
  EXPECT_EQ(rig.machine.trouble(),
            "the robot 192.168.0.100 wants our outputs sent to 10.0.0.1: refused, we send to nobody but the robot");
  EXPECT_FALSE(rig.produce());
  EXPECT_EQ(rig.take_close(), rig.asked.triad);
  EXPECT_EQ(rig.machine.counters().opens, 0u);

  Rig inputs;
  inputs.to_running({.t_to_o = SocketAddress{kStranger, 2222}});
  EXPECT_TRUE(says(inputs, "send its inputs to 10.0.0.1 instead of us")) << inputs.machine.trouble();
  EXPECT_EQ(inputs.take_close(), inputs.asked.triad);
}

TEST(SocketItems, OfAMulticastGroupAreRefusedWherePointToPointWasAsked) {
  Rig rig;
  rig.to_running({.t_to_o = SocketAddress{kGroup, 2222}});
  EXPECT_EQ(rig.machine.group(), 0u);
  EXPECT_TRUE(says(rig, "239.192.1.64")) << rig.machine.trouble();
}

TEST(SocketItems, WithAnotherPortThanOursAreRefusedInWords) {
  auto settings = usual_settings();
  settings.io_port = 5000;
  Rig rig(settings);
  rig.to_running({.t_to_o = SocketAddress{0, 2222}});
  EXPECT_TRUE(says(rig, "will send to UDP port 2222, but we listen on 5000")) << rig.machine.trouble();
  Rig moved(settings);
  moved.to_running({.t_to_o = SocketAddress{0, 5000}});
  EXPECT_EQ(moved.machine.state(), State::kRunning);
}

TEST(SocketItems, ThatAreMalformedAreRefused) {
  Rig rig;
  rig.to_opening();
  auto reply = rig.open_reply({.o_to_t = SocketAddress{0, 2222}});
  reply[reply.size() - 16] = std::byte{0x0A};  // another address family
  rig.feed(reply);
  EXPECT_TRUE(says(rig, "O->T socket address")) << rig.machine.trouble();
}

TEST(Multicast, JoinsTheGroupOfTheReplyAndLeavesItAtTheEnd) {
  auto settings = usual_settings();
  settings.multicast = true;
  Rig rig(settings);
  rig.connection_id = 0xC6860015;
  rig.to_running({.t_to_o_id = rig.connection_id, .t_to_o = SocketAddress{kGroup, 2222}});
  EXPECT_EQ(rig.machine.group(), kGroup);
  rig.receive(1, 1);
  EXPECT_TRUE(rig.machine.running());
  rig.machine.close(rig.now);
  EXPECT_EQ(rig.machine.group(), 0u);
}

TEST(Multicast, WithoutAGroupIsRefused) {
  auto settings = usual_settings();
  settings.multicast = true;
  for (const auto& item : {std::optional<SocketAddress>{}, std::optional(SocketAddress{0, 2222}),
                           std::optional(SocketAddress{kStranger, 2222})}) {
    Rig rig(settings);
    rig.to_running({.t_to_o = item});
    EXPECT_TRUE(says(rig, "multicast asked, but the robot names no group")) << rig.machine.trouble();
    EXPECT_EQ(rig.machine.group(), 0u);
  }
}

TEST(Multicast, AGroupThatCannotBeJoinedIsAFailedOpen) {
  auto settings = usual_settings();
  settings.multicast = true;
  Rig rig(settings);
  rig.to_running({.t_to_o_id = 7, .t_to_o = SocketAddress{kGroup, 2222}});
  rig.machine.join_failed("no such device", rig.now);
  EXPECT_EQ(rig.machine.trouble(),
            "multicast group 239.192.1.64 cannot be joined: no such device; choose the interface, or ask for "
            "point-to-point");
  EXPECT_EQ(rig.take_close(), rig.asked.triad);
}

}  // namespace
}  // namespace meca::ethernet_ip
