// The good-bye of the originator: on request, after a fault, and where the robot does not play along.
#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/originator_rig.hpp"

namespace meca::ethernet_ip {
namespace {

using namespace test;

TEST(Close, OfARunningConnectionIsForwardCloseThenUnregisterSession) {
  Rig rig;
  rig.to_receiving();
  rig.machine.close(rig.now);
  EXPECT_EQ(rig.machine.state(), State::kClosing);
  EXPECT_FALSE(rig.produce()) << "outputs stop with the close";
  EXPECT_EQ(rig.take_close(), rig.asked.triad);
  EXPECT_TRUE(rig.machine.wants_tcp());
  rig.answer_close(rig.asked.triad);
  EXPECT_TRUE(rig.sent_unregister());
  rig.tick();
  EXPECT_EQ(rig.machine.state(), State::kClosed);
  EXPECT_FALSE(rig.machine.wants_tcp());
}

TEST(Close, WritesTheForwardCloseAsRecorded) {
  Rig rig;
  rig.session = 1;
  rig.to_receiving();
  rig.machine.close(rig.now);
  // As meca1, frame 974, but for 8 bit path segments and 2 s to answer.
  EXPECT_EQ(to_hex(rig.take_output()),
            "6F0028000100000000000000000000000000000000000000000000000000020000000000B20018004E02200624010A02"
            "010034125B69026B030020042C962C64");
}

TEST(Close, IsForEver) {
  Rig rig;
  rig.machine.close(rig.now);
  EXPECT_EQ(rig.machine.state(), State::kClosed) << "there was nothing to close";
  for (int i = 0; i < 100; ++i) rig.tick(1s);
  EXPECT_FALSE(rig.machine.wants_tcp());
  rig.machine.tcp_connected(rig.now, kHost);
  EXPECT_TRUE(rig.machine.tcp_output().empty());
  EXPECT_EQ(rig.machine.state(), State::kClosed);
}

TEST(Close, WaitsForTheUnregisterToBeSent) {
  Rig rig;
  rig.to_receiving();
  rig.machine.close(rig.now);
  rig.answer_close(rig.take_close());
  rig.tick(100ms);
  EXPECT_EQ(rig.machine.state(), State::kClosing);
  EXPECT_TRUE(rig.machine.wants_tcp());
  rig.machine.tcp_sent(24);
  rig.tick();
  EXPECT_EQ(rig.machine.state(), State::kClosed);
}

TEST(Close, TakesNoLongerThanAReplyMayWhateverTheRobotDoes) {
  Rig rig;
  rig.to_receiving();
  rig.machine.close(rig.now);
  EXPECT_EQ(rig.until([&] { return rig.machine.state() == State::kClosed; }, 5s), 2s);
}

TEST(Close, OfAConnectionThatTheRobotForgotIsDoneToo) {
  Rig rig;
  rig.to_receiving();
  rig.machine.close(rig.now);
  rig.answer_close(rig.take_close(), 0x0107);
  EXPECT_TRUE(rig.sent_unregister());
  rig.tick();
  EXPECT_EQ(rig.machine.state(), State::kClosed);
}

TEST(Close, OfAConnectionWhoseSessionTheRobotForgotIsDoneToo) {
  Rig rig;
  rig.to_receiving();
  rig.machine.close(rig.now);
  rig.feed(rig.encapsulated(Command::kSendRrData, {}, 0x64));
  EXPECT_EQ(rig.machine.state(), State::kClosed);
}

TEST(Close, OpensASessionOfItsOwnWhereTcpWasLost) {
  Rig rig;
  rig.to_receiving();
  rig.machine.tcp_closed("", rig.now);
  rig.machine.close(rig.now);
  rig.until([&] { return rig.machine.wants_tcp(); }, 10ms);
  rig.machine.tcp_connected(rig.now, kHost);
  EXPECT_EQ(rig.machine.state(), State::kClosing);
  EXPECT_EQ(to_hex(rig.take_output()), golden::kRegisterRequest);
  rig.answer_register();
  EXPECT_EQ(rig.take_close(), rig.asked.triad);
  rig.answer_close(rig.asked.triad);
  EXPECT_TRUE(rig.sent_unregister());
  rig.tick();
  EXPECT_EQ(rig.machine.state(), State::kClosed);
}

TEST(Close, TriesTcpOnceMoreWhereItIsLostWhileClosing) {
  Rig rig;
  rig.to_receiving();
  rig.machine.close(rig.now);
  rig.machine.tcp_closed("", rig.now);
  EXPECT_TRUE(rig.machine.wants_tcp());
  rig.machine.tcp_connected(rig.now, kHost);
  rig.machine.tcp_closed("connection reset", rig.now);
  EXPECT_EQ(rig.machine.state(), State::kClosed);
}

TEST(Close, WhileConnectingOrRegisteringIsDoneAtOnce) {
  Rig connecting;
  connecting.tick();
  connecting.machine.close(connecting.now);
  EXPECT_EQ(connecting.machine.state(), State::kClosed);
  Rig registering;
  registering.connect();
  registering.machine.close(registering.now);
  EXPECT_EQ(registering.machine.state(), State::kClosed);
  EXPECT_FALSE(registering.machine.wants_tcp());
}

TEST(Close, WhileIdentifyingUnregistersOnly) {
  Rig rig;
  rig.connect();
  rig.take_output();
  rig.answer_register();
  rig.take_output();
  rig.machine.close(rig.now);
  EXPECT_TRUE(rig.sent_unregister());
  rig.tick();
  EXPECT_EQ(rig.machine.state(), State::kClosed);
}

TEST(Close, WhileOpeningClosesWhatMayHaveBeenOpened) {
  Rig rig;
  rig.to_opening();
  rig.machine.close(rig.now);
  EXPECT_EQ(rig.take_close(), rig.asked.triad);
  rig.answer_open();  // crossed on the wire
  EXPECT_EQ(rig.machine.state(), State::kClosing);
  rig.answer_close(rig.asked.triad);
  EXPECT_TRUE(rig.sent_unregister());
}

TEST(Close, WhileClosingAfterAFaultEndsThere) {
  Rig rig;
  rig.to_receiving();
  rig.tick(160ms);
  ASSERT_EQ(rig.machine.state(), State::kClosing);
  rig.machine.close(rig.now);
  rig.finish_closing();
  EXPECT_EQ(rig.machine.state(), State::kClosed);
}

TEST(Fault, WithoutTcpIsClosedOverANewSession) {
  Rig rig;
  rig.to_receiving();
  rig.machine.tcp_closed("", rig.now);
  rig.tick(160ms);
  rig.until([&] { return rig.machine.wants_tcp(); }, 10ms);
  rig.machine.tcp_connected(rig.now, kHost);
  rig.take_output();
  rig.answer_register();
  rig.finish_closing();
  EXPECT_EQ(rig.machine.state(), State::kWaiting);
}

TEST(Fault, WhoseCloseFailsKeepsTheFirstTrouble) {
  Rig rig;
  rig.to_receiving();
  rig.machine.tcp_closed("", rig.now);
  rig.tick(160ms);
  const std::string first(rig.machine.trouble());
  rig.until([&] { return rig.machine.wants_tcp(); }, 10ms);
  rig.machine.tcp_closed("connection refused", rig.now);
  EXPECT_EQ(rig.machine.state(), State::kWaiting);
  EXPECT_EQ(rig.machine.trouble(), first);
}

}  // namespace
}  // namespace meca::ethernet_ip
