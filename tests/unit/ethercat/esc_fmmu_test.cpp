// Logical addressing of the ESC: FMMUs by bytes and by bits (ETG.1000.4, 6.6; spec 5.6, 6.1).
#include "tests/unit/ethercat/esc_wire.hpp"

namespace meca::ethercat {
namespace {

using test::hex;
using test::Reply;

std::vector<std::byte> bytes(std::size_t size, unsigned char value) {
  return std::vector<std::byte>(size, std::byte{value});
}

class EscFmmu : public test::EscWire {
 protected:
  EscFmmu() {
    configure();
    esc.set_inputs(bytes(252, 0x1D));
  }
  void map(unsigned n, std::uint32_t logical, bool outputs) { write(reg::fmmu(n), fmmu_bytes(logical, outputs)); }
  // One run of `length` bytes to `physical`, from and to any bit.
  void map_bits(unsigned n, std::uint32_t logical, std::uint16_t length, unsigned first, unsigned last,
                std::uint16_t physical, unsigned physical_bit, unsigned type) {
    auto b = test::little_endian(logical, 4);
    for (const auto& part :
         {test::little_endian(length, 2), test::little_endian(first | last << 8, 2), test::little_endian(physical, 2),
          test::little_endian(physical_bit | type << 8, 2), test::little_endian(1, 4)})
      b.insert(b.end(), part.begin(), part.end());
    write(reg::fmmu(n), b);
  }
  Reply lrw(std::uint32_t address, Bytes data) { return send(Command::kLrw, address, data); }
};

// SOEM: outputs at 0, inputs behind them.
TEST_F(EscFmmu, LrwTakesOutputsBringsInputsAndCounts3) {
  map(0, 0, true);
  map(1, 60, false);
  const Reply r = lrw(0, bytes(312, 0x77));
  EXPECT_EQ(r.wkc, 3u);
  EXPECT_TRUE(std::ranges::equal(Bytes(r.data).first(60), bytes(60, 0x77)));
  EXPECT_TRUE(std::ranges::equal(Bytes(r.data).subspan(60), bytes(252, 0x1D)));
  EXPECT_TRUE(std::ranges::equal(*esc.take_outputs(), bytes(60, 0x77)));
}

// KickCAT: both at 0, in two datagrams.
TEST_F(EscFmmu, LrdReadsAndLwrWritesEachCounting1) {
  map(0, 0, true);
  map(1, 0, false);
  EXPECT_EQ(send(Command::kLwr, 0, bytes(60, 1)).wkc, 1u);
  EXPECT_TRUE(esc.take_outputs());
  const Reply r = send(Command::kLrd, 0, bytes(252, 0));
  EXPECT_EQ(r.wkc, 1u);
  EXPECT_EQ(r.data, bytes(252, 0x1D));
  EXPECT_FALSE(esc.take_outputs());
}

// libethercat: both at 10000h, in one datagram.
TEST_F(EscFmmu, InputsOverOutputsLeaveTheOutputsAsTheyCameIn) {
  map(0, 0x10000, true);
  map(1, 0x10000, false);
  const Reply r = lrw(0x10000, bytes(252, 0x77));
  EXPECT_EQ(r.wkc, 3u);
  EXPECT_EQ(r.data, bytes(252, 0x1D));
  EXPECT_TRUE(std::ranges::equal(*esc.take_outputs(), bytes(60, 0x77)));
}

TEST_F(EscFmmu, TheOrderOfTheFmmusDoesNotMatter) {
  map(0, 0x10000, false);
  map(1, 0x10000, true);
  EXPECT_EQ(lrw(0x10000, bytes(252, 0x77)).wkc, 3u);
  EXPECT_TRUE(std::ranges::equal(*esc.take_outputs(), bytes(60, 0x77)));
}

TEST_F(EscFmmu, ADatagramInTheNeighbourhoodIsNotTouched) {
  map(0, 1000, true);
  map(1, 1060, false);
  EXPECT_EQ(lrw(0, bytes(1000, 0)).wkc, 0u);
  EXPECT_EQ(lrw(1312, bytes(100, 0)).wkc, 0u);
  EXPECT_EQ(lrw(0xFFFFFF00, bytes(256, 0)).wkc, 0u);
}

TEST_F(EscFmmu, DatagramsMayCutTheProcessDataInTwo) {
  map(0, 0, true);
  map(1, 60, false);
  const Reply head = lrw(0, bytes(100, 0x77));
  EXPECT_EQ(head.wkc, 3u);
  EXPECT_TRUE(std::ranges::equal(Bytes(head.data).subspan(60), bytes(40, 0x1D)));
  esc.set_inputs(bytes(252, 0x2E));
  const Reply tail = lrw(100, bytes(212, 0));
  EXPECT_EQ(tail.wkc, 1u);
  EXPECT_EQ(tail.data, bytes(212, 0x1D));
}

TEST_F(EscFmmu, OutputsWithoutTheirLastByteAreCountedButNotTaken) {
  map(0, 0, true);
  EXPECT_EQ(send(Command::kLwr, 0, bytes(59, 1)).wkc, 1u);
  EXPECT_FALSE(esc.take_outputs());
}

TEST_F(EscFmmu, InputsOnlyCount1AndOutputsOnly2InAnLrw) {
  map(0, 0, true);
  map(1, 60, false);
  esc.allow_process_data(false, true);
  EXPECT_EQ(lrw(0, bytes(312, 0)).wkc, 1u);
  esc.allow_process_data(true, false);
  EXPECT_EQ(lrw(0, bytes(312, 0)).wkc, 2u);
  esc.allow_process_data(false, false);
  EXPECT_EQ(lrw(0, bytes(312, 0)).wkc, 0u);
}

TEST_F(EscFmmu, ADeviceCountsOnceHoweverManyOfItsFmmusMatch) {
  for (unsigned n = 0; n < 8; ++n) map_bits(n, n, 1, 0, 7, static_cast<std::uint16_t>(0x2000 + n), 0, 3);
  EXPECT_EQ(lrw(0, bytes(8, 0x0F)).wkc, 3u);
  EXPECT_EQ(send(Command::kLrd, 0, bytes(8, 0)).wkc, 1u);
}

TEST_F(EscFmmu, InactiveOrWithoutLengthItMapsNothing) {
  map(0, 0, true);
  write(reg::fmmu(0) + 0xC, "00");
  EXPECT_EQ(send(Command::kLwr, 0, bytes(60, 1)).wkc, 0u);
  write(reg::fmmu(0) + 0xC, "01");
  EXPECT_EQ(send(Command::kLwr, 0, bytes(60, 1)).wkc, 1u);
  write(reg::fmmu(0) + 4, "00 00");
  EXPECT_EQ(send(Command::kLwr, 0, bytes(60, 1)).wkc, 0u);
}

TEST_F(EscFmmu, AtTheEndOfTheLogicalAddressSpaceNothingWraps) {
  map_bits(0, 0xFFFFFFFE, 4, 0, 7, 0x2000, 0, 2);
  EXPECT_EQ(send(Command::kLwr, 0xFFFFFFFE, hex("11 22")).wkc, 1u);
  EXPECT_EQ(send(Command::kLwr, 0, hex("33 44")).wkc, 0u);
  EXPECT_EQ(read(0x2000, 4).hex(), "11 22 00 00");
}

// ---- Mailbox state

// SOEM 2: the whole status byte of sync manager 1.
TEST_F(EscFmmu, BringsTheMailboxStateAsAByte) {
  write(reg::fmmu(2), "38 01 00 00 01 00 00 07 0D 08 00 01 01 00 00 00");
  EXPECT_EQ(send(Command::kLrd, 0x138, hex("FF")).hex(), "00");
  esc.post_mail(hex("01"));
  const Reply r = send(Command::kLrd, 0x138, hex("00"));
  EXPECT_EQ(r.wkc, 1u);
  EXPECT_EQ(r.hex(), "09");
}

// libethercat: bit 3 of it onto bit 0.
TEST_F(EscFmmu, BringsTheMailboxStateAsOneBitAndLeavesTheOthers) {
  write(reg::fmmu(3), "00 00 00 09 01 00 00 00 0D 08 03 01 01 00 00 00");
  EXPECT_EQ(send(Command::kLrd, 0x09000000, hex("F1")).hex(), "F0");
  esc.post_mail(hex("01"));
  const Reply r = send(Command::kLrd, 0x09000000, hex("F0"));
  EXPECT_EQ(r.wkc, 1u);
  EXPECT_EQ(r.hex(), "F1");
}

// ---- Bits

TEST_F(EscFmmu, WritesOnlyTheBitsThatItMaps) {
  write(0x2000, "FF 00");
  map_bits(0, 0x10, 1, 2, 4, 0x2000, 6, 2);                 // logical bits 2..4 onto 2000h bits 6, 7 and 2001h bit 0
  EXPECT_EQ(send(Command::kLwr, 0x10, hex("14")).wkc, 1u);  // 1 0 1
  EXPECT_EQ(read(0x2000, 2).hex(), "7F 01");
  EXPECT_EQ(send(Command::kLwr, 0x10, hex("EB")).wkc, 1u);  // 0 1 0
  EXPECT_EQ(read(0x2000, 2).hex(), "BF 00");
}

TEST_F(EscFmmu, ReadsBitsAcrossBytes) {
  write(0x2000, "80 07");
  map_bits(0, 0x10, 2, 6, 3, 0x2000, 6, 1);  // 6 bits from logical bit 6 on
  EXPECT_EQ(send(Command::kLrd, 0x10, hex("00 00")).hex(), "80 07");
  EXPECT_EQ(send(Command::kLrd, 0x11, hex("F0")).hex(), "F7");  // the second byte on its own
}

TEST_F(EscFmmu, BitsOfTwoDevicesShareAByte) {
  write(0x2000, "01");
  map_bits(0, 0x10, 1, 0, 0, 0x2000, 0, 1);
  Esc second(test::meca500_settings());
  const auto fmmu = read(reg::fmmu(0), 16).data;
  const auto to_second = [&](Command command, std::uint32_t address, Bytes data) {
    test::Passing passing(static_cast<std::uint8_t>(command), address, data);
    second.process(passing.datagram(), now);
    return passing.reply();
  };
  to_second(Command::kApwr, address_of(0, reg::fmmu(0)), fmmu);
  to_second(Command::kApwr, address_of(0, reg::fmmu(0) + 6), hex("05 05"));
  to_second(Command::kApwr, address_of(0, 0x2000), hex("01"));
  const Reply first = send(Command::kLrd, 0x10, hex("00"));
  EXPECT_EQ(to_second(Command::kLrd, 0x10, first.data).hex(), "21");
}

TEST_F(EscFmmu, BitsOfProcessDataOpenAndCloseItsBuffersAsBytesDo) {
  map_bits(0, 0, 60, 0, 6, 0x1100, 0, 2);  // all but the last bit
  EXPECT_EQ(send(Command::kLwr, 0, bytes(60, 0xFF)).wkc, 1u);
  const auto outputs = esc.take_outputs();
  ASSERT_TRUE(outputs);
  EXPECT_EQ((*outputs)[0], std::byte{0xFF});
  EXPECT_EQ((*outputs)[59], std::byte{0x7F});
}

TEST_F(EscFmmu, ARunThatEndsBeforeItBeginsMapsNothing) {
  map_bits(0, 0x10, 1, 5, 2, 0x2000, 0, 3);
  EXPECT_EQ(lrw(0x10, hex("FF")).wkc, 0u);
}

// The fuzzer's: bit by bit onto the FMMU's own registers, which then pointed out of the datagram in the middle of it.
TEST_F(EscFmmu, AnFmmuThatIsMappedOntoItselfServesTheDatagramAsItWasBefore) {
  map_bits(0, 0x10, 16, 0, 6, reg::fmmu(0), 0, 2);
  auto moved = read(reg::fmmu(0), 16).data;
  moved[1] = moved[2] = moved[3] = std::byte{0x7F};  // its logical address
  EXPECT_EQ(send(Command::kLwr, 0x10, moved).wkc, 1u);
  EXPECT_EQ(read(reg::fmmu(0), 16).data, moved);
  EXPECT_EQ(send(Command::kLwr, 0x10, moved).wkc, 0u);
}

// ---- A fault for tests of masters

TEST_F(EscFmmu, AWorkingCounterFaultCountsInLogicalDatagramsOfTheDeviceOnly) {
  map(0, 0, true);
  map(1, 60, false);
  esc.faults().working_counter = -1;
  EXPECT_EQ(lrw(0, bytes(312, 0)).wkc, 2u);
  EXPECT_EQ(lrw(400, bytes(10, 0)).wkc, 0u);
  EXPECT_EQ(read(reg::kType, 1).wkc, 1u);
}

}  // namespace
}  // namespace meca::ethercat
