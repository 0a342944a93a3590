// Frames: what independent masters and devices put on the wire, what is not a frame, and what we write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/unit/ethercat/wire_golden.hpp"
#include "transports/ethercat/frame.hpp"
#include "transports/ethercat/registers.hpp"

namespace meca::ethercat {
namespace {

using golden::from_hex;
using testing::ElementsAre;

constexpr MacAddress kKickcat{std::byte{0xCA}, std::byte{0xDE}, std::byte{0xCA},
                              std::byte{0xDE}, std::byte{0xDE}, std::byte{0xFF}};
constexpr MacAddress kSoem{std::byte{1}, std::byte{1}, std::byte{1}, std::byte{1}, std::byte{1}, std::byte{1}};

// "FPRD 03E9:0805 1 byte, counter 1"
std::string text(const Datagram& datagram) {
  constexpr const char* kNames[] = {"NOP", "APRD", "APWR", "APRW", "FPRD", "FPWR", "FPRW", "BRD",
                                    "BWR", "BRW",  "LRD",  "LWR",  "LRW",  "ARMW", "FRMW"};
  if (datagram.raw_command() >= kCommands) return "unknown";
  std::array<char, 80> out;
  std::snprintf(out.data(), out.size(), "%s %04X:%04X %zu bytes, counter %u", kNames[datagram.raw_command()],
                unsigned{datagram.adp()}, unsigned{datagram.ado()}, datagram.data().size(),
                unsigned{datagram.working_counter()});
  return out.data();
}

struct Walked {
  std::vector<std::string> datagrams;
  bool ok;
};
Walked walk(Bytes frame) {
  DatagramWalk<const std::byte> datagrams(frame);
  Walked out{};
  while (const auto datagram = datagrams.next()) out.datagrams.push_back(text(*datagram));
  out.ok = datagrams.ok();
  return out;
}
std::vector<std::string> names(std::string_view frame) {
  const auto walked = walk(from_hex(frame));
  EXPECT_TRUE(walked.ok);
  return walked.datagrams;
}

TEST(EtherCatFrame, DatagramsOfIndependentStacksAreReadByName) {
  EXPECT_THAT(names(golden::kAcknowledgeAndInit), ElementsAre("BWR 0000:0120 2 bytes, counter 0"));
  EXPECT_THAT(names(golden::kAcknowledgeAndInitReply), ElementsAre("BWR 0001:0120 2 bytes, counter 1"));
  EXPECT_THAT(names(golden::kThreeDevicesReply), ElementsAre("BRD 0003:0000 1 bytes, counter 3"));
  EXPECT_THAT(names(golden::kClockReply), ElementsAre("FRMW 1000:0910 8 bytes, counter 3"));
  EXPECT_THAT(names(golden::kProcessDataReply), ElementsAre("LRW 0000:0000 252 bytes, counter 3"));
}

TEST(EtherCatFrame, SeveralDatagramsFollowEachOtherAndPaddingIsNone) {
  EXPECT_THAT(names(golden::kMailboxStatusReply),
              ElementsAre("FPRD 03E9:0805 1 bytes, counter 1", "FPRD 03E9:080D 1 bytes, counter 1"));
  EXPECT_THAT(names(golden::kSyncManagersAndFmmusReply),
              ElementsAre("FPWR 03E9:0818 8 bytes, counter 1", "FPWR 03E9:0610 16 bytes, counter 1",
                          "FPWR 03E9:0810 8 bytes, counter 1", "FPWR 03E9:0600 16 bytes, counter 1"));
}

TEST(EtherCatFrame, TheWrongFrameLengthOfLibethercatDoesNotMatter) {
  EXPECT_THAT(names(golden::kWrongLengthReply), ElementsAre("FPRD 03E8:0508 4 bytes, counter 1"));
}

TEST(EtherCatFrame, OneDatagramIsReadWhole) {
  const auto frame = from_hex(golden::kSyncManagersAndFmmusReply);
  DatagramWalk<const std::byte> walk(frame);
  const auto first = walk.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->command(), Command::kFpwr);
  EXPECT_EQ(first->index(), 0x39);
  EXPECT_EQ(first->address(), address_of(0x03E9, reg::sync_manager(3)));
  EXPECT_TRUE(first->more());
  EXPECT_FALSE(first->circulating());
  EXPECT_EQ(first->irq(), 0);
  EXPECT_TRUE(std::ranges::equal(first->data(), sync_manager_bytes(3, true)));

  const auto second = walk.next();
  ASSERT_TRUE(second);
  EXPECT_TRUE(std::ranges::equal(second->data(), fmmu_bytes(0, false)));
}

TEST(EtherCatFrame, AFrameThatEndsTooEarlyIsNoticedWhereverItEnds) {
  for (const auto golden : golden::kFrames) {
    const auto whole = from_hex(golden);
    const auto all = walk(whole);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      const auto walked = walk(part);
      EXPECT_EQ(walked.ok, walked.datagrams.size() == all.datagrams.size()) << size << " bytes of " << golden;
      EXPECT_TRUE(std::equal(walked.datagrams.begin(), walked.datagrams.end(), all.datagrams.begin())) << size;
    }
  }
}

TEST(EtherCatFrame, WhatIsNotEtherCatHasNoDatagrams) {
  auto other_protocol = from_hex(golden::kAcknowledgeAndInit);
  other_protocol[13] = std::byte{0xA5};
  auto other_type = from_hex(golden::kAcknowledgeAndInit);
  other_type[15] = std::byte{0x40};  // network variables
  auto mailbox_type = from_hex(golden::kAcknowledgeAndInit);
  mailbox_type[15] = std::byte{0x50};  // mailbox gateway
  for (const auto& frame : {other_protocol, other_type, mailbox_type}) {
    const auto walked = walk(frame);
    EXPECT_FALSE(walked.ok);
    EXPECT_TRUE(walked.datagrams.empty());
  }
}

TEST(EtherCatFrame, ADeviceChangesAddressInterruptAndCounterWhereTheyStand) {
  auto frame = from_hex(golden::kAcknowledgeAndInit);
  DatagramWalk<std::byte> walk(frame);
  auto datagram = walk.next();
  ASSERT_TRUE(datagram);
  datagram->set_adp(1);
  datagram->set_working_counter(1);
  frame[6] |= kReplyBit;
  EXPECT_EQ(frame, from_hex(golden::kAcknowledgeAndInitReply));
  datagram->set_irq(0x8102);
  EXPECT_EQ(datagram->irq(), 0x8102);
  EXPECT_TRUE(std::ranges::equal(datagram->data(), from_hex("11 00")));
}

TEST(EtherCatFrame, PositionsAreCountedDownToZero) {
  EXPECT_EQ(auto_increment(0), 0);
  EXPECT_EQ(auto_increment(1), 0xFFFF);
  EXPECT_EQ(auto_increment(2), 0xFFFE);
}

TEST(EtherCatFrameWriter, WritesWhatKickcatWrites) {
  std::vector<std::byte> buffer(kLongestFrame);
  FrameWriter writer(buffer, kKickcat);
  const auto write = [&writer](std::uint8_t index, std::uint16_t reg, const auto& data) {
    std::ranges::copy(data, writer.add(Command::kFpwr, index, address_of(0x03E9, reg), data.size()).begin());
  };
  write(0x39, reg::sync_manager(3), sync_manager_bytes(3, true));
  write(0x3A, reg::fmmu(1), fmmu_bytes(0, false));
  write(0x3B, reg::sync_manager(2), sync_manager_bytes(2, true));
  write(0x3C, reg::fmmu(0), fmmu_bytes(0, true));
  EXPECT_EQ(writer.count(), 4U);
  EXPECT_TRUE(std::ranges::equal(writer.finish(), from_hex(golden::kSyncManagersAndFmmus)));
}

TEST(EtherCatFrameWriter, AShortFrameIsPaddedAndItsLengthIsThatOfTheDatagrams) {
  std::vector<std::byte> buffer(kLongestFrame, std::byte{0xEE});
  FrameWriter writer(buffer, kSoem);
  const auto data = writer.add(Command::kBwr, 2, address_of(0, reg::kAlControl), 2);
  ASSERT_EQ(data.size(), 2U);
  data[0] = std::byte{0x11};
  auto expected = from_hex(golden::kAcknowledgeAndInit);
  expected.resize(kShortestFrame);
  EXPECT_TRUE(std::ranges::equal(writer.finish(), expected));
}

TEST(EtherCatFrameWriter, TheLongestDatagramFillsTheLongestFrame) {
  std::vector<std::byte> buffer(2000);
  FrameWriter writer(buffer, kSoem);
  EXPECT_EQ(writer.room(), kMostData);
  EXPECT_TRUE(writer.add(Command::kLrw, 0, 0, kMostData + 1).empty());
  EXPECT_EQ(writer.count(), 0U) << "what does not fit leaves no trace";
  EXPECT_EQ(writer.add(Command::kLrw, 0, 0x12345678, kMostData).size(), kMostData);
  EXPECT_EQ(writer.room(), 0U);
  EXPECT_TRUE(writer.add(Command::kNop, 1, 0, 1).empty());
  const Bytes frame = writer.finish();
  EXPECT_EQ(frame.size(), kLongestFrame);
  const auto walked = walk(frame);
  EXPECT_TRUE(walked.ok);
  EXPECT_THAT(walked.datagrams, ElementsAre("LRW 5678:1234 1486 bytes, counter 0"));
}

TEST(EtherCatFrameWriter, WhatDoesNotFitBehindOthersLeavesThemTheLast) {
  std::vector<std::byte> buffer(kLongestFrame);
  FrameWriter writer(buffer, kSoem);
  writer.add(Command::kLrw, 0, 0, 1400);
  EXPECT_EQ(writer.room(), kMostData - 1400 - kDatagramOverhead);
  EXPECT_TRUE(writer.add(Command::kFpwr, 1, 0, 128).empty());
  const auto walked = walk(writer.finish());
  EXPECT_TRUE(walked.ok) << "no datagram more is promised";
  EXPECT_EQ(walked.datagrams.size(), 1U);
}

TEST(EtherCatFrameWriter, ADatagramWithoutDataIsNotWrittenAndAFrameWithoutDatagramIsNone) {
  std::vector<std::byte> buffer(kLongestFrame);
  FrameWriter writer(buffer, kSoem);
  EXPECT_TRUE(writer.add(Command::kNop, 0, 0, 0).empty());
  EXPECT_TRUE(writer.finish().empty());
}

}  // namespace
}  // namespace meca::ethercat
