// Everything that can go wrong on the way to an open connection, and what the person reads.
#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/originator_rig.hpp"

namespace meca::ethernet_ip {
namespace {

using namespace test;

bool says(const Rig& rig, std::string_view words) {
  return rig.machine.trouble().find(words) != std::string_view::npos;
}

TEST(Trouble, NobodyAnswersOnTcp) {
  Rig rig;
  rig.tick();
  EXPECT_EQ(rig.until([&] { return !rig.machine.wants_tcp(); }, 3s), 2s);
  EXPECT_EQ(rig.machine.trouble(),
            "no answer from 192.168.0.100 on TCP port 44818 for 2 s; check address, cable, and that EtherNet/IP is "
            "enabled on the robot");
}

TEST(Trouble, TcpIsRefused) {
  Rig rig;
  rig.tick();
  rig.machine.tcp_closed("connection refused", rig.now);
  EXPECT_EQ(rig.machine.state(), State::kWaiting);
  EXPECT_EQ(rig.machine.trouble(),
            "TCP connection to 192.168.0.100 port 44818 failed: connection refused; check address, cable, and that "
            "EtherNet/IP is enabled on the robot");
}

TEST(Trouble, TcpIsLostOnTheWay) {
  Rig rig;
  rig.connect();
  rig.machine.tcp_closed("", rig.now);
  EXPECT_EQ(rig.machine.trouble(),
            "TCP connection to 192.168.0.100 lost before the connection was open: closed by the "
            "robot");
  EXPECT_EQ(rig.machine.state(), State::kWaiting);
}

TEST(Trouble, AnyRequestWithoutAnswerIsNamed) {
  Rig rig;
  rig.connect();
  rig.until([&] { return rig.machine.state() == State::kWaiting; }, 3s);
  EXPECT_TRUE(says(rig, "no answer to RegisterSession from 192.168.0.100 for 2 s")) << rig.machine.trouble();

  rig.connect();
  rig.take_output();
  rig.answer_register();
  rig.until([&] { return rig.machine.state() == State::kClosing; }, 3s);
  EXPECT_TRUE(says(rig, "no answer to GetAttributesAll of the identity")) << rig.machine.trouble();
}

TEST(Trouble, AForwardOpenWithoutAnswerIsClosedForItMayBeOpen) {
  Rig rig;
  rig.to_opening();
  EXPECT_EQ(rig.until([&] { return rig.machine.state() == State::kClosing; }, 3s), 2s);
  EXPECT_TRUE(says(rig, "no answer to Forward Open")) << rig.machine.trouble();
  EXPECT_EQ(rig.take_close(), rig.asked.triad);
  rig.answer_open();  // late
  EXPECT_EQ(rig.machine.state(), State::kClosing);
  rig.answer_close(rig.asked.triad);
  EXPECT_TRUE(rig.sent_unregister());
}

TEST(Trouble, TheEncapsulationRefuses) {
  Rig rig;
  rig.connect();
  rig.take_output();
  rig.feed(rig.encapsulated(Command::kRegisterSession, from_hex("01000000"), 0x69));
  EXPECT_EQ(rig.machine.trouble(),
            "RegisterSession not taken (encapsulation status 0x69): the device does not speak version 1 of the "
            "encapsulation protocol; restart the robot's EtherNet/IP if it stays so");

  Rig open;
  open.to_opening();
  open.feed(open.encapsulated(Command::kSendRrData, {}, 0x64));
  EXPECT_TRUE(says(open, "Forward Open not taken (encapsulation status 0x64): the session handle"))
      << open.machine.trouble();
  EXPECT_TRUE(open.sent_unregister()) << "nothing was opened, nothing is closed";
}

TEST(Trouble, TheSessionHasNoHandleOrIsNotOurs) {
  Rig none;
  none.connect();
  none.session = 0;
  none.answer_register();
  EXPECT_TRUE(says(none, "RegisterSession answered without a session")) << none.machine.trouble();

  Rig other;
  other.to_opening();
  other.session = 0xBAD;
  other.answer_open();
  EXPECT_TRUE(says(other, "for session 0x00000BAD, ours is 0x00C0FFEE")) << other.machine.trouble();
}

TEST(Trouble, TheAnswerIsMalformed) {
  Rig rig;
  rig.to_opening();
  rig.feed(rig.encapsulated(Command::kSendRrData, from_hex("0000000000000200")));
  EXPECT_TRUE(says(rig, "answer to Forward Open is malformed (8 bytes)")) << rig.machine.trouble();

  Rig brief;
  brief.to_opening();
  brief.feed(brief.unconnected(from_hex("D4000000 0102")));
  EXPECT_TRUE(says(brief, "answer to Forward Open is too short (2 bytes)")) << brief.machine.trouble();

  Rig identity;
  identity.connect();
  identity.answer_register();
  identity.feed(identity.unconnected(from_hex("81000000 1D06")));
  EXPECT_TRUE(says(identity, "identity is malformed")) << identity.machine.trouble();
}

TEST(Trouble, ItIsAnotherDevice) {
  Rig rig;
  rig.connect();
  rig.answer_register();
  rig.answer_identity(47, 3);
  EXPECT_EQ(
      rig.machine.trouble(),
      "another device at 192.168.0.100: found vendor 47, type 43, product 3 'Meca500', expected vendor 1565, type "
      "43, product 500 (Meca500); check the address");
  EXPECT_EQ(rig.machine.identity()->vendor_id, 47);
  EXPECT_EQ(rig.machine.state(), State::kClosing);
  EXPECT_EQ(rig.machine.counters().refusals, 0u) << "the robot was not asked to open";
}

TEST(Trouble, TheIdentityIsRefused) {
  Rig rig;
  rig.connect();
  rig.answer_register();
  rig.feed(rig.unconnected(from_hex("81000200")));
  EXPECT_TRUE(says(rig, "GetAttributesAll of the identity refused (0x02)")) << rig.machine.trouble();
}

TEST(Trouble, TheIdentityThatWasListedIsMalformedOrOfAnotherDeviceOrDoesNotCome) {
  const auto listing = [](Rig& rig) {
    rig.connect();
    rig.answer_register();
    rig.feed(rig.unconnected(from_hex("81000800")));
  };
  Rig malformed;
  listing(malformed);
  malformed.feed(malformed.encapsulated(Command::kListIdentity, from_hex("0000")));
  EXPECT_TRUE(says(malformed, "identity is malformed")) << malformed.machine.trouble();

  Rig another;
  listing(another);
  auto data = from_hex(golden::kListedIdentity);
  data[24] = std::byte{47};  // vendor
  another.feed(another.encapsulated(Command::kListIdentity, data));
  EXPECT_TRUE(says(another, "another device at 192.168.0.100: found vendor 1583")) << another.machine.trouble();

  Rig silent;
  listing(silent);
  silent.tick(2s);
  EXPECT_TRUE(says(silent, "no answer to ListIdentity")) << silent.machine.trouble();

  Rig refused;
  listing(refused);
  refused.feed(refused.encapsulated(Command::kListIdentity, {}, 0x01));
  EXPECT_TRUE(says(refused, "ListIdentity not taken (encapsulation status 0x01)")) << refused.machine.trouble();
}

TEST(Trouble, TheAnswerIsForAnotherConnection) {
  Rig rig;
  rig.to_running({.triad = ConnectionTriad{0x0777, 0x1234, 0x6B02695B}});
  EXPECT_TRUE(says(rig, "for connection 0x0777 of 0x1234/0x6B02695B, asked was 0x0001")) << rig.machine.trouble();
  EXPECT_EQ(rig.take_close(), rig.asked.triad);
}

TEST(Trouble, AnIntervalOfZeroCannotBeKept) {
  Rig rig;
  rig.to_running({.o_to_t_api_us = 0});
  EXPECT_TRUE(says(rig, "packet intervals of 0 and 10000 us")) << rig.machine.trouble();
  EXPECT_FALSE(rig.produce());
}

struct Refusal {
  std::initializer_list<std::uint16_t> extended;
  std::string_view words;
};

TEST(Refusal, OfAForwardOpenSaysWhatWasAskedAndWhatToDoAndBacksOff) {
  for (const auto& [extended, words] : std::initializer_list<Refusal>{
           {{0x0106}, "(0x01/0x0106): another controller owns the robot's outputs"},
           {{0x0111}, "(0x01/0x0111): RPI 10 ms O->T, 10 ms T->O asked"},
           {{0x0113}, "(0x01/0x0113): the robot has no connection left"},
           {{0x0114}, "(0x01/0x0114): no key asked; vendor or product code differs"},
           {{0x0124}, "(0x01/0x0124): T->O fixed point-to-point asked"},
           {{0x0127, 66}, "(0x01/0x0127 0x0042): O->T size 66 asked, the robot expects 66"},
           {{0x0128, 258}, "(0x01/0x0128 0x0102): T->O size 254 asked, the robot expects 258"},
           {{0x012B}, "(0x01/0x012B): points O->T 150, T->O 100 asked"},
           {{0x0133}, "(0x01/0x0133): multiplier code 2 asked"},
           {{0x0315}, "(0x01/0x0315): points O->T 150, T->O 100 asked"},
           {{0x4321}, "(0x01/0x4321): a status that no document names"},
       }) {
    Rig rig;
    rig.to_opening();
    rig.refuse_open(extended);
    EXPECT_TRUE(says(rig, words)) << rig.machine.trouble();
    EXPECT_EQ(rig.machine.counters().refusals, 1u);
    EXPECT_TRUE(rig.sent_unregister()) << "nothing is open, nothing is closed";
    rig.tick();
    EXPECT_EQ(rig.machine.state(), State::kWaiting);
  }
}

TEST(Refusal, OfAGeneralStatusIsReadToo) {
  Rig rig;
  rig.to_opening();
  rig.refuse_open({}, 0x02);
  EXPECT_TRUE(says(rig, "(0x02): the robot has no resources left")) << rig.machine.trouble();
}

TEST(Refusal, OfALargeForwardOpenIsUnderstood) {
  auto settings = usual_settings();
  settings.large = true;
  Rig rig(settings);
  rig.to_opening();
  rig.refuse_open({}, 0x08);
  EXPECT_TRUE(says(rig, "Forward Open refused (0x08)")) << rig.machine.trouble();
}

TEST(Refusal, BecauseTheConnectionIsOpenAlreadyClosesItAndOpensAnother) {
  Rig rig;
  rig.to_opening();
  const auto first = rig.asked.triad;
  rig.refuse_open({0x0100});
  EXPECT_EQ(rig.machine.state(), State::kOpening);
  EXPECT_TRUE(says(rig, "0x0100"));
  EXPECT_EQ(rig.take_close(), first);
  rig.answer_close(first);
  EXPECT_EQ(rig.take_open().triad.connection_serial, first.connection_serial + 1);
  rig.answer_open();
  rig.receive(1, 1);
  EXPECT_TRUE(rig.machine.running());
  EXPECT_TRUE(rig.machine.trouble().empty());
}

TEST(Refusal, BecauseTheConnectionIsOpenAlreadyIsTriedOnceAndThenBacksOff) {
  Rig rig;
  rig.to_opening();
  rig.refuse_open({0x0100});
  rig.answer_close(rig.take_close(), 0x0107);
  rig.take_open();
  rig.refuse_open({0x0100});
  EXPECT_EQ(rig.machine.state(), State::kClosing);
  rig.finish_closing();
  EXPECT_EQ(rig.machine.state(), State::kWaiting);
  EXPECT_EQ(rig.machine.counters().refusals, 2u);
}

TEST(BackOff, DoublesUpToItsLimit) {
  Rig rig;
  Time waited[8];
  for (Time& w : waited) {
    rig.until([&] { return rig.machine.state() == State::kConnecting; }, 20s);
    rig.machine.tcp_closed("connection refused", rig.now);
    w = rig.until([&] { return rig.machine.wants_tcp(); }, 20s);
  }
  const Time expected[] = {200ms, 400ms, 800ms, 1600ms, 3200ms, 6400ms, 10s, 10s};
  EXPECT_TRUE(std::ranges::equal(waited, expected));
}

TEST(BackOff, StaysAtItsLimitForDays) {
  Rig rig;
  for (int i = 0; i < 100; ++i) {
    rig.tick(11s);
    rig.tick(1ms);
    ASSERT_EQ(rig.machine.state(), State::kConnecting) << i;
    rig.machine.tcp_closed("connection refused", rig.now);
  }
}

TEST(BackOff, BeginsAnewAfterAGoodRunButNotAfterAShortOne) {
  const auto waits = [](Time run) {
    Rig rig;
    for (int i = 0; i < 5; ++i) {
      rig.until([&] { return rig.machine.state() == State::kConnecting; }, 20s);
      rig.machine.tcp_closed("connection refused", rig.now);
    }
    rig.to_receiving();
    std::uint16_t n = 1;
    for (const Time end = rig.now + run; rig.now < end; rig.tick(10ms)) {
      ++n;
      rig.receive(n, n);
    }
    rig.until([&] { return rig.machine.state() == State::kClosing; }, 1s);
    rig.finish_closing();
    return rig.until([&] { return rig.machine.wants_tcp(); }, 20s);
  };
  EXPECT_EQ(waits(1s), 6400ms);
  EXPECT_EQ(waits(10s), 200ms);
}

TEST(Replacement, OfATcpConnectionShowsAsOneLookThatIsFalse) {
  auto settings = usual_settings();
  settings.shortest_backoff = 0ms;
  Rig rig(settings);
  rig.connect();
  rig.take_output();
  rig.feed("6F00F901 00000000 00000000 0000000000000000 00000000");
  rig.tick();
  EXPECT_FALSE(rig.machine.wants_tcp());
  rig.tick();
  EXPECT_TRUE(rig.machine.wants_tcp());
  EXPECT_EQ(rig.machine.state(), State::kConnecting);
}

}  // namespace
}  // namespace meca::ethernet_ip
