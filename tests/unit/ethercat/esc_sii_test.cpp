// The SII in all shapes in which masters reach for it (ETG.1000.4, 6.4; spec 5.4, 6.1).
#include "tests/unit/ethercat/esc_wire.hpp"

namespace meca::ethercat {
namespace {

using test::hex;
using test::Reply;
using namespace std::chrono_literals;

class EscSii : public test::EscWire {
 protected:
  static constexpr auto kAccess = 100us;

  std::uint16_t status() { return static_cast<std::uint16_t>(read(reg::kSiiControl, 2).value()); }
  void command(std::uint16_t command, std::uint32_t word) {
    auto b = test::little_endian(command, 2);
    for (const std::byte byte : test::little_endian(word, 4)) b.push_back(byte);
    EXPECT_EQ(write(reg::kSiiControl, b), 1u);
  }
  std::string read_word(std::uint32_t word) {
    command(0x0100, word);
    now += kAccess;
    return read(reg::kSiiData, 4).hex();
  }
  void write_word(std::uint32_t word, std::uint16_t value) {
    write(reg::kSiiData, test::little_endian(value, 2));
    command(0x0201, word);
    now += kAccess;
  }
};

constexpr std::uint16_t kBusy = 0x8000, kWriteEnableError = 0x4000, kCommandError = 0x2000, kNotLoaded = 0x1000,
                        kChecksumError = 0x0800;

// SOEM, KickCAT, ethercrab: command and address in one write of 6 bytes.
TEST_F(EscSii, ReadsFourBytesAtAWordAddressAndIsBusyMeanwhile) {
  command(0x0100, sii::kVendor);
  EXPECT_EQ(status(), kBusy | 0x0100);
  now += kAccess - 1us;
  EXPECT_EQ(status() & kBusy, kBusy);
  now += 1us;
  EXPECT_EQ(status(), 0x0000);
  EXPECT_EQ(read(reg::kSiiData, 8).hex(), "E1 AD EC 00 00 00 00 00");
}

TEST_F(EscSii, ReadsEightBytesWhereBit6SaysSo) {
  EscSettings s = test::meca500_settings();
  s.sii_reads_8_bytes = true;
  esc = Esc(s);
  EXPECT_EQ(status(), 0x0040);
  command(0x0100, sii::kVendor);
  now += kAccess;
  EXPECT_EQ(read(reg::kSiiData, 8).hex(), "E1 AD EC 00 00 D5 04 00");
}

// libethercat: 4 bytes of address, then 2 of command.
TEST_F(EscSii, TakesAddressFirstAndCommandSecond) {
  EXPECT_EQ(write(reg::kSiiAddress, "0A 00 00 00"), 1u);
  EXPECT_EQ(write(reg::kSiiControl, "00 01"), 1u);
  now += kAccess;
  EXPECT_EQ(read(reg::kSiiData, 4).hex(), "00 D5 04 00");
}

// IgH: 80 01 and 2 bytes of address; then 10 bytes from 0502 on until neither command nor busy stands in the second.
TEST_F(EscSii, TakesTheShortWriteOfIghAndAnswersItsTenBytes) {
  EXPECT_EQ(write(reg::kSiiControl, "80 01 08 00"), 1u);
  EXPECT_EQ(read(reg::kSiiControl, 10).data[1], std::byte{0x81});
  now += kAccess;
  EXPECT_EQ(read(reg::kSiiControl, 10).hex(), "00 00 08 00 00 00 E1 AD EC 00");
}

TEST_F(EscSii, BroadcastReadsEveryDevice) {
  EXPECT_EQ(send(Command::kBwr, address_of(0, reg::kSiiControl), hex("00 01 08 00 00 00")).wkc, 1u);
  now += kAccess;
  EXPECT_EQ(read(reg::kSiiData, 4).hex(), "E1 AD EC 00");
}

TEST_F(EscSii, BeyondTheImageItReadsFfh) {
  EXPECT_EQ(read_word(1023).substr(6), "FF FF");
  EXPECT_EQ(read_word(1024), "FF FF FF FF");
  EXPECT_EQ(read_word(0xFFFFFFFF), "FF FF FF FF");
  EXPECT_EQ(status(), 0u);
}

TEST_F(EscSii, WhileItIsBusyItsRegistersHoldStill) {
  command(0x0100, sii::kVendor);
  command(0x0100, sii::kProduct);
  now += kAccess;
  EXPECT_EQ(read(reg::kSiiAddress, 4).hex(), "08 00 00 00");
  EXPECT_EQ(read(reg::kSiiData, 4).hex(), "E1 AD EC 00");
}

TEST_F(EscSii, WritesOneWordWithTheWriteEnableBit) {
  write_word(0x20, 0x1234);
  EXPECT_EQ(status(), 0u);
  EXPECT_EQ(read_word(0x20).substr(0, 5), "34 12");
  EXPECT_EQ(read_word(0x1F), "00 00 34 12");
}

// IgH: command, address and data in one write.
TEST_F(EscSii, WritesAWordInTheEightBytesOfIgh) {
  EXPECT_EQ(write(reg::kSiiControl, "81 02 20 00 00 00 34 12"), 1u);
  now += kAccess;
  EXPECT_EQ(read_word(0x20).substr(0, 5), "34 12");
}

TEST_F(EscSii, WritesNothingWithoutTheWriteEnableBit) {
  const std::string before = read_word(0x20);
  write(reg::kSiiData, "34 12");
  command(0x0200, 0x20);
  EXPECT_EQ(status(), kWriteEnableError);
  EXPECT_EQ(read_word(0x20), before);
}

TEST_F(EscSii, AWriteBeyondTheImageIsNotAcknowledged) {
  write_word(1024, 0x1234);
  EXPECT_EQ(status(), kCommandError);
}

TEST_F(EscSii, ACommandThatDoesNotExistIsAnErrorUntilTheNextCommand) {
  command(0x0300, 0);
  EXPECT_EQ(status(), kCommandError);
  command(0x0000, 0);
  EXPECT_EQ(status(), 0u);
}

TEST_F(EscSii, InTheHandsOfTheApplicationItIgnoresTheMaster) {
  EXPECT_FALSE(esc.sii_belongs_to_pdi());
  EXPECT_EQ(write(reg::kSiiOwner, "01"), 1u);
  EXPECT_TRUE(esc.sii_belongs_to_pdi());
  EXPECT_EQ(write(reg::kSiiControl, "00 01 08 00 00 00"), 1u);
  EXPECT_EQ(status(), 0u);
  EXPECT_EQ(read(reg::kSiiAddress, 4).hex(), "00 00 00 00");
  // Forced back, in one and in two bytes.
  write(reg::kSiiOwner, "02");
  write(reg::kSiiOwner, "00 00");
  EXPECT_FALSE(esc.sii_belongs_to_pdi());
  EXPECT_EQ(read_word(sii::kVendor), "E1 AD EC 00");
}

// ---- What the ESC itself takes from it

TEST_F(EscSii, ConfiguresTheDeviceAtPowerOn) {
  const auto image = make_meca500_sii(0, 0);
  EXPECT_EQ(read(reg::kPdiControl, 2).hex(), test::text(Bytes(image).first(2)));
  EXPECT_EQ(read(reg::kDlStatus, 1).value() & 1, 1u);
}

TEST_F(EscSii, AWrongChecksumLeavesTheDeviceUnconfigured) {
  EscSettings s = test::meca500_settings(0x0123);
  s.sii[14] ^= std::byte{1};
  esc = Esc(s);
  EXPECT_EQ(status(), kChecksumError | kNotLoaded);
  EXPECT_EQ(read(reg::kPdiControl, 2).hex(), "00 00");
  EXPECT_EQ(read(reg::kStationAlias, 2).hex(), "00 00");
  EXPECT_EQ(read(reg::kDlStatus, 1).value() & 1, 0u);
  EXPECT_EQ(read_word(sii::kVendor), "E1 AD EC 00");  // it can be read and repaired all the same
  EXPECT_EQ(status(), kChecksumError | kNotLoaded);
}

TEST_F(EscSii, AnEmptyImageIsNotLoadedEither) {
  esc = Esc(EscSettings{});
  EXPECT_EQ(status(), kChecksumError | kNotLoaded);
}

TEST_F(EscSii, AnAliasThatIsWrittenIsTakenAtTheNextPowerOnNotByAReload) {
  const auto image = make_meca500_sii(0x0777, 0);
  write_word(sii::kAlias, 0x0777);
  write_word(sii::kChecksum, static_cast<std::uint16_t>(test::number(Bytes(image).subspan(14, 2))));
  command(0x0400, 0);
  EXPECT_EQ(status() & kBusy, kBusy);
  now += kAccess;
  EXPECT_EQ(status(), 0u);
  EXPECT_EQ(read(reg::kStationAlias, 2).hex(), "00 00");
  esc.power_cycle(now);
  EXPECT_EQ(read(reg::kStationAlias, 2).hex(), "77 07");
}

TEST_F(EscSii, AReloadSeesAChecksumThatIsWrongNow) {
  write_word(sii::kAlias, 0x0777);
  command(0x0400, 0);
  now += kAccess;
  EXPECT_EQ(status(), kChecksumError | kNotLoaded);
}

}  // namespace
}  // namespace meca::ethercat
