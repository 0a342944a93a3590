// Class 1 I/O of the adapter: what it takes, when it gives up, and when it sends.
#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace meca::ethernet_ip::adapter_test {
namespace {

class AdapterIo : public ::testing::Test {
 protected:
  AdapterIo() {
    rig.enter();
    EXPECT_EQ(rig.open(usual_open()), "ok");
  }
  const AdapterCounters& counters() const { return rig.adapter.counters(); }
  std::byte output() const { return rig.adapter.output()[0]; }
  AdapterRig rig;
};

// ---- O->T

TEST_F(AdapterIo, AnOToTPacketBecomesTheOutputs) {
  EXPECT_FALSE(rig.adapter.run());
  // Sequence 1, count 1, run, 60 bytes; form as EIPScanner sends it.
  std::string packet = "0200 0280 0800 " + hex(written([&](wire::Writer& out) { out.u32(rig.opened.o_to_t_id); })) +
                       "01000000 b100 4200 0100 01000000";
  for (int i = 1; i <= 60; ++i)
    packet += hex(written([&](wire::Writer& out) { out.u8(static_cast<std::uint8_t>(i)); }));
  rig.adapter.io_received({kOriginator, 58323}, bytes(packet), rig.now);
  EXPECT_TRUE(rig.adapter.run());
  EXPECT_TRUE(rig.adapter.take_fresh());
  EXPECT_FALSE(rig.adapter.take_fresh());
  for (int i = 0; i < 60; ++i) EXPECT_EQ(rig.adapter.output()[static_cast<std::size_t>(i)], std::byte(i + 1));
  EXPECT_EQ(counters().consumed, 1u);
}

TEST_F(AdapterIo, TheSourcePortDoesNotMatterTheSourceAddressDoes) {
  rig.io({.from = {kOriginator, 40000}});
  EXPECT_EQ(counters().consumed, 1u);
  rig.io({.from = {kStranger, 2222}});
  EXPECT_EQ(counters().foreign, 1u);
  EXPECT_EQ(counters().consumed, 1u);
}

TEST_F(AdapterIo, AnotherConnectionIdIsForeign) {
  rig.io({.id = rig.opened.o_to_t_id + 1});
  rig.io({.id = rig.opened.t_to_o_id});
  EXPECT_EQ(counters().foreign, 2u);
  EXPECT_FALSE(rig.adapter.run());
}

TEST_F(AdapterIo, TheFirstSequenceMayBeAnythingAndOldOnesAreDropped) {
  rig.io({.sequence = 0x80000000u, .count = 0x8000});
  rig.io({.sequence = 0x80000000u, .count = 0x8001, .fill = 0x22});
  rig.io({.sequence = 0x7FFFFFFFu, .count = 0x8002, .fill = 0x22});
  rig.io({.sequence = 0x00000001u, .count = 0x8003, .fill = 0x22});  // half the range behind
  EXPECT_EQ(counters().consumed, 1u);
  EXPECT_EQ(counters().stale, 3u);
  EXPECT_EQ(output(), std::byte{0x11});
}

TEST_F(AdapterIo, BothNumbersWrap) {
  rig.io({.sequence = 0xFFFFFFFEu, .count = 0xFFFE});
  rig.io({.sequence = 0xFFFFFFFFu, .count = 0xFFFF});
  rig.io({.sequence = 0, .count = 0});
  rig.io({.sequence = 1, .count = 1, .fill = 0x22});
  EXPECT_EQ(counters().consumed, 4u);
  EXPECT_EQ(output(), std::byte{0x22});
}

TEST_F(AdapterIo, ARepeatedCountIsAliveButNoNewData) {
  rig.io({.count = 5});
  rig.adapter.take_fresh();
  rig.now += 30ms;
  rig.io({.count = 5, .fill = 0x22});
  rig.io({.count = 4, .fill = 0x22});
  EXPECT_EQ(counters().repeated, 2u);
  EXPECT_FALSE(rig.adapter.take_fresh());
  EXPECT_EQ(output(), std::byte{0x11});
  rig.now += 39ms;
  rig.adapter.tick(rig.now);
  EXPECT_TRUE(rig.adapter.connected());
}

TEST_F(AdapterIo, AWrongLengthOrAMissingHeaderIsIgnored) {
  for (const std::size_t length : {0, 2, 62, 65, 67, 70}) rig.io({.length = length});
  EXPECT_EQ(counters().malformed, 6u);
  EXPECT_EQ(counters().consumed, 0u);
}

TEST_F(AdapterIo, EveryTruncationOfAPacketIsMalformed) {
  const auto whole = written([&](wire::Writer& out) {
    write_io_packet(out, rig.opened.o_to_t_id, 1, 66);
    out.zeros(66);
  });
  for (std::size_t length = 0; length < whole.size(); ++length) {
    rig.adapter.io_received({kOriginator, 2222}, Bytes(whole).first(length), rig.now);
  }
  EXPECT_EQ(counters().malformed, whole.size());
  EXPECT_EQ(counters().consumed, 0u);
}

TEST_F(AdapterIo, IdleFeedsTheWatchdogButItsDataAreNotOutputs) {
  rig.io({.fill = 0x11});
  rig.adapter.take_fresh();
  rig.now += 30ms;
  rig.io({.header = 0, .fill = 0x22});
  EXPECT_FALSE(rig.adapter.run());
  EXPECT_FALSE(rig.adapter.take_fresh());
  EXPECT_EQ(output(), std::byte{0x11});
  EXPECT_EQ(counters().idle, 1u);
  rig.now += 39ms;
  rig.adapter.tick(rig.now);
  EXPECT_TRUE(rig.adapter.connected());
  rig.io({.header = 0xFFFFFFFE});  // only bit 0 says run
  EXPECT_FALSE(rig.adapter.run());
  rig.io({.header = 1, .fill = 0x33});
  EXPECT_TRUE(rig.adapter.run());
  EXPECT_EQ(output(), std::byte{0x33});
}

TEST_F(AdapterIo, WithoutAConnectionPacketsAreForeign) {
  ASSERT_EQ(rig.close(usual_open().triad), "ok");
  rig.io();
  EXPECT_EQ(counters().foreign, 1u);
  EXPECT_FALSE(rig.adapter.run());
}

TEST_F(AdapterIo, ANewConnectionStartsWithoutOutputs) {
  rig.io({.fill = 0x11});
  ASSERT_EQ(rig.close(usual_open().triad), "ok");
  ASSERT_EQ(rig.open(usual_open()), "ok");
  EXPECT_EQ(output(), std::byte{0});
  EXPECT_FALSE(rig.adapter.run());
  EXPECT_FALSE(rig.adapter.take_fresh());
}

// ---- Watchdog

TEST_F(AdapterIo, TheFirstPacketHasTenSeconds) {
  rig.adapter.tick(rig.now + 10s - 1ns);
  EXPECT_TRUE(rig.adapter.connected());
  rig.adapter.tick(rig.now + 10s);
  EXPECT_FALSE(rig.adapter.connected());
  EXPECT_EQ(counters().timeouts, 1u);
}

TEST_F(AdapterIo, AfterTheFirstPacketItIsApiTimesMultiplier) {
  rig.io();
  rig.adapter.tick(rig.now + 40ms - 1ns);
  EXPECT_TRUE(rig.adapter.connected());
  EXPECT_EQ(rig.adapter.next_event(), rig.now);  // T->O, due since the open
  rig.adapter.tick(rig.now + 40ms);
  EXPECT_FALSE(rig.adapter.connected());
  EXPECT_FALSE(rig.adapter.run());
  EXPECT_EQ(rig.adapter.produce(rig.now + 40ms), std::nullopt);
}

TEST(AdapterWatchdog, IsApiTimesEveryMultiplierAndNeverLessThanTenSecondsForTheFirstPacket) {
  for (std::uint8_t code = 0; code <= kMaxMultiplierCode; ++code) {
    AdapterRig rig;
    rig.enter();
    auto f = usual_open();
    f.o_to_t_rpi_us = 50'000;
    f.multiplier_code = code;
    ASSERT_EQ(rig.open(f), "ok");
    const Time watchdog = 50ms * (4 << code);
    const Time first = std::max<Time>(10s, watchdog);
    rig.adapter.tick(rig.now + first - 1ns);
    EXPECT_TRUE(rig.adapter.connected()) << int(code);
    rig.now += first - 1ns;
    rig.io();
    rig.adapter.tick(rig.now + watchdog - 1ns);
    EXPECT_TRUE(rig.adapter.connected()) << int(code);
    rig.adapter.tick(rig.now + watchdog);
    EXPECT_FALSE(rig.adapter.connected()) << int(code);
  }
}

TEST_F(AdapterIo, NeitherStaleNorForeignNorMalformedPacketsFeedTheWatchdog) {
  rig.io();
  rig.now += 39ms;
  rig.io({.sequence = 1});
  rig.io({.sequence = 3, .from = {kStranger, 2222}});
  rig.io({.sequence = 4, .length = 65});
  rig.now += 1ms;
  rig.adapter.tick(rig.now);
  EXPECT_FALSE(rig.adapter.connected());
}

TEST_F(AdapterIo, APacketAfterTheTimeoutDoesNotBringTheConnectionBack) {
  rig.io();
  rig.now += 40ms;
  rig.io();  // nobody ticked in between
  EXPECT_FALSE(rig.adapter.connected());
  EXPECT_EQ(counters().timeouts, 1u);
  EXPECT_EQ(counters().foreign, 1u);
}

TEST_F(AdapterIo, IoGoesOnWithoutTcp) {
  rig.tcp("66000000 01000000 00000000 0000000000000000 00000000");  // UnregisterSession
  rig.adapter.tcp_closed(0, rig.now);
  for (int i = 0; i < 10; ++i) {
    rig.io();
    EXPECT_EQ(rig.run_for(10ms).size(), 1u);
  }
  EXPECT_TRUE(rig.adapter.run());
}

// ---- T->O

TEST_F(AdapterIo, TToOStartsRightAfterTheReplyAndCarriesTheInput) {
  image::InputBytes input{};
  for (std::size_t i = 0; i < input.size(); ++i) input[i] = static_cast<std::byte>(i);
  rig.adapter.set_input(input);
  const auto d = rig.adapter.produce(rig.now);
  ASSERT_TRUE(d);
  EXPECT_EQ(d->bytes.size(), 272u);
  // Connection id of the opener, sequence 1, 254 bytes: count 1 and the image; no run/idle header.
  EXPECT_EQ(hex(d->bytes),
            "020002800800"
            "0100ed5e"
            "01000000"
            "b100fe00"
            "0100" +
                hex(input));
  EXPECT_EQ(rig.adapter.produce(rig.now), std::nullopt);
  EXPECT_EQ(rig.adapter.next_event(), rig.now + 10ms);
}

TEST_F(AdapterIo, TToOKeepsItsDeadlinesWhateverTheCallerDoes) {
  std::vector<Time> at;
  for (const Time t : {0ms, 9ms, 13ms, 19ms, 20ms, 29ms, 30ms}) {
    if (rig.adapter.produce(rig.now + t)) at.push_back(t);
  }
  EXPECT_THAT(at, ::testing::ElementsAre(0ms, 13ms, 20ms, 30ms));
}

TEST_F(AdapterIo, MissedPeriodsAreSkippedNotSentInABurst) {
  rig.adapter.produce(rig.now);
  EXPECT_TRUE(rig.adapter.produce(rig.now + 95ms));
  EXPECT_EQ(rig.adapter.produce(rig.now + 95ms), std::nullopt);
  EXPECT_EQ(rig.adapter.produce(rig.now + 99ms), std::nullopt);
  const auto d = rig.adapter.produce(rig.now + 100ms);
  ASSERT_TRUE(d);
  EXPECT_EQ(read_io_packet(d->bytes).value().sequence, 3u);
}

TEST_F(AdapterIo, EachDirectionHasItsOwnInterval) {
  ASSERT_EQ(rig.close(usual_open().triad), "ok");
  auto f = usual_open();
  f.o_to_t_rpi_us = 100'000;
  f.t_to_o_rpi_us = 20'000;
  ASSERT_EQ(rig.open(f), "ok");
  rig.io();
  EXPECT_EQ(rig.run_for(400ms).size(), 20u);
  rig.adapter.tick(rig.now);
  EXPECT_FALSE(rig.adapter.connected());
}

TEST_F(AdapterIo, SequenceAndCountOfTToOAdvanceTogether) {
  const auto sent = rig.run_for(50ms);
  ASSERT_EQ(sent.size(), 5u);
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(sent[i].packet().sequence, i + 1);
    EXPECT_EQ(wire::Reader(sent[i].packet().data).u16(), i + 1);
  }
  EXPECT_EQ(counters().produced, 5u);
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
