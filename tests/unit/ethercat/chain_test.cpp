// Devices in a row: which of them a frame passes, where it comes out, and what devices see of their cables
// (ETG.1000.4, 4; spec 5.2, 5.9, 6.1).
#include <memory>

#include "tests/unit/ethercat/esc_wire.hpp"
#include "transports/ethercat/chain.hpp"

namespace meca::ethercat {
namespace {

using test::hex;
using test::Reply;
using namespace std::chrono_literals;
using Side = Chain::Side;

constexpr MacAddress kSource{std::byte{0x10}, std::byte{0x10}, std::byte{0x10},
                             std::byte{0x10}, std::byte{0x10}, std::byte{0x10}};

class EthercatChain : public testing::Test {
 protected:
  EthercatChain() { make(3); }

  void make(std::size_t count) {
    devices.clear();
    std::vector<Device*> row;
    for (std::size_t i = 0; i < count; ++i)
      row.push_back(devices.emplace_back(std::make_unique<Device>(DeviceSettings{})).get());
    chain.emplace(row);
  }
  Esc& esc(std::size_t k) { return devices[k]->esc(); }

  struct Answer {
    std::optional<Side> side;
    Reply reply;
    std::byte source{};
  };
  Answer send(Side side, Command command, std::uint32_t address, Bytes data) {
    std::array<std::byte, kLongestFrame> buffer{};
    FrameWriter writer(buffer, kSource);
    std::ranges::copy(data, writer.add(command, 0, address, data.size()).begin());
    const auto frame = std::span(buffer).first(writer.finish().size());
    Answer answer;
    answer.side = chain->process(side, frame, now);
    const auto d = *DatagramWalk<std::byte>(frame).next();
    answer.reply = {{d.data().begin(), d.data().end()}, d.working_counter(), d.adp(), d.irq()};
    answer.source = frame[6];
    return answer;
  }
  Answer primary(Command command, std::uint32_t address, std::string_view data) {
    return send(Side::kPrimary, command, address, hex(data));
  }
  Answer secondary(Command command, std::uint32_t address, std::string_view data) {
    return send(Side::kSecondary, command, address, hex(data));
  }
  unsigned count(Side side) { return send(side, Command::kBrd, 0, hex("00")).reply.wkc; }
  std::uint64_t value(std::size_t k, std::uint16_t at, std::size_t size) {
    std::uint64_t v = 0;
    for (std::size_t i = size; i-- > 0;) v = v << 8 | esc(k).peek(static_cast<std::uint16_t>(at + i));
    return v;
  }

  std::vector<std::unique_ptr<Device>> devices;
  std::optional<Chain> chain;
  Time now{};
};

TEST_F(EthercatChain, AFramePassesAllDevicesAndComesBack) {
  const Answer a = primary(Command::kBrd, address_of(0, reg::kAlStatus), "00 00");
  EXPECT_EQ(a.side, Side::kPrimary);
  EXPECT_EQ(a.reply.wkc, 3u);
  EXPECT_EQ(a.reply.adp, 3u);
  EXPECT_EQ(a.reply.hex(), "01 00");
}

TEST_F(EthercatChain, PositionsReachOneDeviceEach) {
  for (std::uint16_t k = 0; k < 3; ++k)
    EXPECT_EQ(send(Side::kPrimary, Command::kApwr, address_of(auto_increment(k), reg::kStationAddress),
                   test::little_endian(0x1001u + k, 2))
                  .reply.wkc,
              1u);
  for (std::uint16_t k = 0; k < 3; ++k) EXPECT_EQ(esc(k).station_address(), 0x1001 + k);
  EXPECT_EQ(primary(Command::kFprd, address_of(0x1002, reg::kStationAddress), "00 00").reply.hex(), "02 10");
}

TEST_F(EthercatChain, TheReplyCarriesTheLocallyAdministeredBit) {
  EXPECT_EQ(primary(Command::kBrd, 0, "00").source, std::byte{0x12});
}

TEST_F(EthercatChain, OtherProtocolsAndPiecesAreNotAnswered) {
  std::array<std::byte, kLongestFrame> buffer{};
  FrameWriter writer(buffer, kSource);
  writer.add(Command::kBrd, 0, 0, 1);
  const auto frame = std::span(buffer).first(writer.finish().size());
  const auto answers = [&](auto change) {
    std::vector<std::byte> copy(frame.begin(), frame.end());
    change(copy);
    return chain->process(Side::kPrimary, copy, now).has_value();
  };
  EXPECT_TRUE(answers([](auto&) {}));
  EXPECT_FALSE(answers([](auto& f) { f[13] = std::byte{0xA3}; }));  // EtherType
  EXPECT_FALSE(answers([](auto& f) { f[15] = std::byte{0x40}; }));  // frame type 4: network variables
  EXPECT_FALSE(answers([](auto& f) { f.resize(16 + 12); }));        // the datagram ends too early
  EXPECT_FALSE(answers([](auto& f) { f.clear(); }));
}

// KickCAT sends from CA:DE:CA:DE:DE:FF, and many a virtual interface has a locally administered address.
TEST_F(EthercatChain, AMasterWhoseOwnAddressHasTheReplyBitIsAnsweredToo) {
  std::array<std::byte, kLongestFrame> buffer{};
  FrameWriter writer(buffer, MacAddress{std::byte{0xCA}, std::byte{0xDE}});
  writer.add(Command::kBrd, 0, 0, 1);
  const auto frame = std::span(buffer).first(writer.finish().size());
  EXPECT_EQ(chain->process(Side::kPrimary, frame, now), Side::kPrimary);
  EXPECT_EQ(frame[6], std::byte{0xCA});
  EXPECT_EQ(DatagramWalk<const std::byte>(frame).next()->working_counter(), 3u);
}

// libethercat counts 16 bytes too many into the frame header's length.
TEST_F(EthercatChain, TheLengthOfTheFrameHeaderIsNotLookedAt) {
  std::array<std::byte, kLongestFrame> buffer{};
  FrameWriter writer(buffer, kSource);
  writer.add(Command::kBrd, 0, 0, 2);
  auto frame = std::span(buffer).first(writer.finish().size());
  frame[14] = std::byte{0x1E};
  EXPECT_TRUE(chain->process(Side::kPrimary, frame.first(16 + 14), now));  // and shorter than 60 bytes
  EXPECT_EQ(DatagramWalk<std::byte>(frame).next()->working_counter(), 3u);
}

TEST_F(EthercatChain, EveryDatagramOfAFrameIsServedAndABrokenTailIsLeftAlone) {
  std::array<std::byte, kLongestFrame> buffer{};
  FrameWriter writer(buffer, kSource);
  for (std::uint8_t i = 0; i < 3; ++i) writer.add(Command::kBrd, i, 0, 20);
  const auto frame = std::span(buffer).first(writer.finish().size());
  EXPECT_TRUE(chain->process(Side::kPrimary, frame.first(16 + 2 * 32 + 31), now));
  DatagramWalk<std::byte> walk(frame);
  EXPECT_EQ(walk.next()->working_counter(), 3u);
  EXPECT_EQ(walk.next()->working_counter(), 3u);
  EXPECT_EQ(walk.next()->working_counter(), 0u);
}

// ---- What breaks

TEST_F(EthercatChain, BehindACutThereIsNobody) {
  chain->cut(2);
  EXPECT_EQ(count(Side::kPrimary), 2u);
  EXPECT_TRUE(chain->reached(1, Side::kPrimary));
  EXPECT_FALSE(chain->reached(2, Side::kPrimary));
  chain->heal(2);
  EXPECT_EQ(count(Side::kPrimary), 3u);
}

TEST_F(EthercatChain, WithoutTheFirstCableOrDeviceNothingComesBack) {
  chain->cut(0);
  EXPECT_FALSE(primary(Command::kBrd, 0, "00").side);
  chain->heal(0);
  chain->set_powered(0, false);
  EXPECT_FALSE(primary(Command::kBrd, 0, "00").side);
  chain->set_powered(0, true);
  EXPECT_EQ(count(Side::kPrimary), 3u);
}

TEST_F(EthercatChain, ADeviceWithoutPowerEndsTheChainBeforeIt) {
  chain->set_powered(1, false);
  EXPECT_EQ(count(Side::kPrimary), 1u);
  chain->set_powered(1, true);
  EXPECT_EQ(count(Side::kPrimary), 3u);
}

TEST_F(EthercatChain, WithoutASecondCableTheSecondarySideIsDead) {
  EXPECT_FALSE(secondary(Command::kBrd, 0, "00").side);
  EXPECT_FALSE(chain->reached(2, Side::kSecondary));
}

// ---- Ring

TEST_F(EthercatChain, AWholeRingIsPassedFromThePrimarySideAndLeftAtTheOther) {
  chain->set_ring(true);
  const Answer a = primary(Command::kBrd, 0, "00");
  EXPECT_EQ(a.side, Side::kSecondary);
  EXPECT_EQ(a.reply.wkc, 3u);
}

TEST_F(EthercatChain, AWholeRingPassesFramesOfTheSecondarySideUntouched) {
  chain->set_ring(true);
  const Answer a = secondary(Command::kBrd, 0, "00");
  EXPECT_EQ(a.side, Side::kPrimary);
  EXPECT_EQ(a.reply.wkc, 0u);
  EXPECT_EQ(a.reply.adp, 0u);
  EXPECT_EQ(a.source, std::byte{0x10});
  EXPECT_FALSE(chain->reached(0, Side::kSecondary));
}

TEST_F(EthercatChain, ACutRingIsTwoChainsOfWhichTheSecondBeginsBehindTheCut) {
  chain->set_ring(true);
  chain->cut(1);
  const Answer one = primary(Command::kBrd, 0, "00");
  EXPECT_EQ(one.side, Side::kPrimary);
  EXPECT_EQ(one.reply.wkc, 1u);
  const Answer two = secondary(Command::kBrd, 0, "00");
  EXPECT_EQ(two.side, Side::kSecondary);
  EXPECT_EQ(two.reply.wkc, 2u);
  EXPECT_EQ(two.source, std::byte{0x12});
  EXPECT_EQ(secondary(Command::kApwr, address_of(0, reg::kStationAddress), "77 00").reply.wkc, 1u);
  EXPECT_EQ(esc(1).station_address(), 0x0077);
  EXPECT_EQ(esc(2).station_address(), 0u);
  EXPECT_TRUE(chain->reached(1, Side::kSecondary));
  EXPECT_FALSE(chain->reached(0, Side::kSecondary));
}

TEST_F(EthercatChain, ARingWithoutItsSecondCableIsAChain) {
  chain->set_ring(true);
  chain->cut(3);
  EXPECT_EQ(primary(Command::kBrd, 0, "00").side, Side::kPrimary);
  EXPECT_FALSE(secondary(Command::kBrd, 0, "00").side);
}

TEST_F(EthercatChain, ARingWithoutItsFirstCableIsReachedFromTheOtherSide) {
  chain->set_ring(true);
  chain->cut(0);
  EXPECT_FALSE(primary(Command::kBrd, 0, "00").side);
  EXPECT_EQ(count(Side::kSecondary), 3u);
}

TEST_F(EthercatChain, ADeviceWithoutPowerInARingLeavesItsNeighboursReached) {
  chain->set_ring(true);
  chain->set_powered(1, false);
  EXPECT_EQ(count(Side::kPrimary), 1u);
  EXPECT_EQ(count(Side::kSecondary), 1u);
}

// ---- What devices see

TEST_F(EthercatChain, DlStatusShowsWhereTheChainGoesOn) {
  EXPECT_EQ(value(0, reg::kDlStatus, 2), 0x5A31u);
  EXPECT_EQ(value(1, reg::kDlStatus, 2), 0x5A31u);
  EXPECT_EQ(value(2, reg::kDlStatus, 2), 0x5611u);
  chain->set_ring(true);
  EXPECT_EQ(value(2, reg::kDlStatus, 2), 0x5A31u);
}

TEST_F(EthercatChain, ACutCountsALostLinkAtBothOfItsEnds) {
  chain->cut(1);
  EXPECT_EQ(value(0, reg::kDlStatus, 2), 0x5611u);
  EXPECT_EQ(value(1, reg::kDlStatus, 2), 0x5921u);  // port 0 closed, port 1 open
  EXPECT_EQ(value(0, reg::kLostLinks, 4), 0x0100u);
  EXPECT_EQ(value(1, reg::kLostLinks, 4), 0x0001u);
  EXPECT_EQ(value(2, reg::kLostLinks, 4), 0u);
  chain->heal(1);
  EXPECT_EQ(value(0, reg::kDlStatus, 2), 0x5A31u);
  EXPECT_EQ(value(0, reg::kLostLinks, 4), 0x0100u);
}

TEST_F(EthercatChain, ALostDeviceCountsALostLinkAtItsNeighbours) {
  chain->set_powered(1, false);
  EXPECT_EQ(value(0, reg::kLostLinks, 4), 0x0100u);
  EXPECT_EQ(value(2, reg::kLostLinks, 4), 0x0001u);
}

TEST_F(EthercatChain, ReceiveTimesTellTheDelayOfEveryCable) {
  now = 1ms;
  primary(Command::kBwr, address_of(0, reg::kDcReceiveTimes), "00 00 00 00");
  // Port 0, and port 1 when the frame comes back: the wire takes 1 us each way and device.
  EXPECT_EQ(value(0, reg::kDcReceiveTimes, 4), 1'000'000u);
  EXPECT_EQ(value(0, reg::kDcReceiveTimes + 4, 4), 1'004'000u);
  EXPECT_EQ(value(1, reg::kDcReceiveTimes, 4), 1'001'000u);
  EXPECT_EQ(value(1, reg::kDcReceiveTimes + 4, 4), 1'003'000u);
  EXPECT_EQ(value(2, reg::kDcReceiveTimes, 4), 1'002'000u);
  EXPECT_EQ(value(2, reg::kDcReceiveTimes + 4, 4), 0u);
}

TEST_F(EthercatChain, FromTheSecondarySideTheFarPortSeesTheFrameFirst) {
  chain->set_ring(true);
  chain->cut(1);
  now = 1ms;
  secondary(Command::kBwr, address_of(0, reg::kDcReceiveTimes), "00 00 00 00");
  EXPECT_EQ(value(2, reg::kDcReceiveTimes + 4, 4), 1'000'000u);
  EXPECT_EQ(value(1, reg::kDcReceiveTimes + 4, 4), 1'001'000u);
  EXPECT_EQ(value(1, reg::kDcReceiveTimes, 4), 1'001'000u);  // turned round
  EXPECT_EQ(value(2, reg::kDcReceiveTimes, 4), 1'002'000u);
}

// The whole of DC start-up as masters do it: offsets, delays, then the reference's time in every cycle.
TEST_F(EthercatChain, FollowersAgreeWithTheReferenceTimeAtTheSameMoment) {
  devices.clear();
  std::vector<Device*> row;
  for (const int ppm : {0, 40, -60}) {
    DeviceSettings s;
    s.esc.clock_ppm = ppm;
    s.esc.clock_start = static_cast<std::uint64_t>(1'000'000'000 + ppm * 1'000'000);
    row.push_back(devices.emplace_back(std::make_unique<Device>(s)).get());
  }
  chain.emplace(row);
  primary(Command::kBwr, address_of(0, reg::kDcReceiveTimes), "00 00 00 00");
  for (std::uint16_t k = 0; k < 3; ++k) {
    const std::uint64_t unit = value(k, reg::kDcReceiveTimePu, 8);
    const auto delay = static_cast<std::uint64_t>(1000 * k);
    send(Side::kPrimary, Command::kApwr, address_of(auto_increment(k), reg::kDcOffset),
         test::little_endian(5'000'000'000 + delay - unit, 8));
    send(Side::kPrimary, Command::kApwr, address_of(auto_increment(k), reg::kDcDelay), test::little_endian(delay, 4));
  }
  send(Side::kPrimary, Command::kBwr, address_of(0, reg::kDcSpeedStart), test::little_endian(0x1000, 2));
  for (int i = 0; i < 2000; ++i) {
    now += 1ms;
    const Answer a = send(Side::kPrimary, Command::kArmw, address_of(0, reg::kDcSystemTime), std::vector<std::byte>(8));
    ASSERT_EQ(a.reply.wkc, 3u);
  }
  const auto reference = static_cast<std::int64_t>(esc(0).system_time(now));
  for (const std::size_t k : {1u, 2u}) {
    EXPECT_LE(std::abs(static_cast<std::int64_t>(esc(k).system_time(now)) - reference), 20) << k;
  }
}

// ---- Faults of a device that show on the wire

TEST_F(EthercatChain, AWorkingCounterFaultOfADeviceShowsInLogicalDatagrams) {
  send(Side::kPrimary, Command::kApwr, address_of(0, reg::fmmu(0)),
       hex("00 00 00 00 01 00 00 07 00 20 00 01 01 00 00 00"));
  EXPECT_EQ(primary(Command::kLrd, 0, "00").reply.wkc, 1u);
  devices[0]->faults().working_counter = -1;
  EXPECT_EQ(primary(Command::kLrd, 0, "00").reply.wkc, 0u);
}

TEST_F(EthercatChain, MailboxRepliesThatAreLostEmptyTheMailbox) {
  send(Side::kPrimary, Command::kApwr, address_of(0, reg::sync_manager(1)), sync_manager_bytes(1, true));
  devices[0]->faults().lose_mailbox_replies = true;
  ASSERT_TRUE(esc(0).post_mail(hex("01")));
  EXPECT_EQ(send(Side::kPrimary, Command::kAprd, address_of(0, 0x1080), std::vector<std::byte>(128)).reply.wkc, 0u);
  EXPECT_TRUE(esc(0).post_mail(hex("01")));
}

TEST_F(EthercatChain, PlacesThatDoNotExistAreIgnored) {
  chain->cut(4);
  chain->heal(99);
  chain->set_powered(3, false);
  EXPECT_EQ(count(Side::kPrimary), 3u);
  EXPECT_FALSE(chain->reached(3, Side::kPrimary));
}

TEST_F(EthercatChain, WithoutDevicesNothingAnswers) {
  make(0);
  EXPECT_FALSE(primary(Command::kBrd, 0, "00").side);
  chain->set_ring(true);
  EXPECT_FALSE(secondary(Command::kBrd, 0, "00").side);
  EXPECT_EQ(chain->size(), 0u);
}

}  // namespace
}  // namespace meca::ethercat
