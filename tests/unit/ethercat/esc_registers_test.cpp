// Commands, addresses, working counters and registers of the ESC (ETG.1000.4, 5.4 and 6; spec 5.2, 5.3).
#include "tests/unit/ethercat/esc_wire.hpp"

namespace meca::ethercat {
namespace {

using test::hex;
using test::Reply;
using EscCommand = test::EscWire;
using EscRegister = test::EscWire;
using namespace std::chrono_literals;

constexpr std::uint16_t kUserRam = 0x0F80;

// ---- Commands

TEST_F(EscCommand, NopPassesUntouched) {
  const Reply r = send(Command::kNop, address_of(0, reg::kType), hex("AA BB"));
  EXPECT_EQ(r.hex(), "AA BB");
  EXPECT_EQ(r.wkc, 0u);
  EXPECT_EQ(r.adp, 0u);
}

TEST_F(EscCommand, CommandsThatDoNotExistPassUntouched) {
  for (const std::uint8_t command : {15, 16, 0x80, 0xFF}) {
    test::Passing passing(command, address_of(0, reg::kStationAddress), hex("AA BB"));
    esc.process(passing.datagram(), now);
    EXPECT_EQ(passing.reply().hex(), "AA BB");
    EXPECT_EQ(passing.reply().wkc, 0u);
  }
  EXPECT_EQ(esc.station_address(), 0u);
}

TEST_F(EscCommand, AprdReadsTheDeviceThatSeesAdp0AndCountsThePosition) {
  const Reply mine = send(Command::kAprd, address_of(0, reg::kAlStatus), hex("00 00"));
  EXPECT_EQ(mine.hex(), "01 00");
  EXPECT_EQ(mine.wkc, 1u);
  EXPECT_EQ(mine.adp, 1u);
  const Reply next = send(Command::kAprd, address_of(auto_increment(1), reg::kAlStatus), hex("00 00"));
  EXPECT_EQ(next.hex(), "00 00");
  EXPECT_EQ(next.wkc, 0u);
  EXPECT_EQ(next.adp, 0u);
}

TEST_F(EscCommand, ApwrWritesOnlyTheDeviceThatSeesAdp0) {
  EXPECT_EQ(send(Command::kApwr, address_of(auto_increment(3), reg::kStationAddress), hex("04 10")).wkc, 0u);
  EXPECT_EQ(esc.station_address(), 0u);
  EXPECT_EQ(send(Command::kApwr, address_of(0, reg::kStationAddress), hex("01 10")).wkc, 1u);
  EXPECT_EQ(esc.station_address(), 0x1001u);
}

TEST_F(EscCommand, FprdAndFpwrReachTheStationAddressAndLeaveTheAdpAlone) {
  write(reg::kStationAddress, "01 10");
  EXPECT_EQ(send(Command::kFpwr, address_of(0x1001, kUserRam), hex("12 34")).wkc, 1u);
  const Reply r = send(Command::kFprd, address_of(0x1001, kUserRam), hex("00 00"));
  EXPECT_EQ(r.hex(), "12 34");
  EXPECT_EQ(r.wkc, 1u);
  EXPECT_EQ(r.adp, 0x1001u);
  EXPECT_EQ(send(Command::kFprd, address_of(0x1002, kUserRam), hex("00 00")).wkc, 0u);
}

TEST_F(EscCommand, ReadWriteCommandsGiveBackWhatWasThereTakeWhatCameAndCount3) {
  write(reg::kStationAddress, "01 10");
  write(kUserRam, "11 22");
  const Reply ap = send(Command::kAprw, address_of(0, kUserRam), hex("33 44"));
  EXPECT_EQ(ap.hex(), "11 22");
  EXPECT_EQ(ap.wkc, 3u);
  const Reply fp = send(Command::kFprw, address_of(0x1001, kUserRam), hex("55 66"));
  EXPECT_EQ(fp.hex(), "33 44");
  EXPECT_EQ(fp.wkc, 3u);
  EXPECT_EQ(read(kUserRam, 2).hex(), "55 66");
}

TEST_F(EscCommand, BrdPutsTheOrOfAllDevicesIntoTheDatagramAndCountsThemInTheAdp) {
  const Reply r = send(Command::kBrd, address_of(4, reg::kAlStatus), hex("08 10"));
  EXPECT_EQ(r.hex(), "09 10");
  EXPECT_EQ(r.wkc, 1u);
  EXPECT_EQ(r.adp, 5u);
}

TEST_F(EscCommand, BwrWritesEveryDevice) {
  const Reply r = send(Command::kBwr, address_of(7, kUserRam), hex("A5"));
  EXPECT_EQ(r.wkc, 1u);
  EXPECT_EQ(r.adp, 8u);
  EXPECT_EQ(read(kUserRam, 1).hex(), "A5");
}

TEST_F(EscCommand, BrwOrsWhatWasThereAndWritesWhatCame) {
  write(kUserRam, "0F");
  const Reply r = send(Command::kBrw, address_of(0, kUserRam), hex("30"));
  EXPECT_EQ(r.hex(), "3F");
  EXPECT_EQ(r.wkc, 3u);
  EXPECT_EQ(read(kUserRam, 1).hex(), "30");
}

TEST_F(EscCommand, ArmwReadsTheDeviceOfThePositionAndWritesAllOthersEachCounting1) {
  write(kUserRam, "77");
  const Reply mine = send(Command::kArmw, address_of(0, kUserRam), hex("00"));
  EXPECT_EQ(mine.hex(), "77");
  EXPECT_EQ(mine.wkc, 1u);
  EXPECT_EQ(mine.adp, 1u);
  const Reply other = send(Command::kArmw, address_of(1, kUserRam), hex("88"));
  EXPECT_EQ(other.hex(), "88");
  EXPECT_EQ(other.wkc, 1u);
  EXPECT_EQ(read(kUserRam, 1).hex(), "88");
}

TEST_F(EscCommand, FrmwReadsTheDeviceOfTheStationAddressAndWritesAllOthers) {
  write(reg::kStationAddress, "01 10");
  write(kUserRam, "77");
  EXPECT_EQ(send(Command::kFrmw, address_of(0x1001, kUserRam), hex("00")).hex(), "77");
  const Reply other = send(Command::kFrmw, address_of(0x1002, kUserRam), hex("99"));
  EXPECT_EQ(other.wkc, 1u);
  EXPECT_EQ(other.adp, 0x1002u);
  EXPECT_EQ(read(kUserRam, 1).hex(), "99");
}

TEST_F(EscCommand, TheWorkingCounterGrowsFromWhatEarlierDevicesCounted) {
  test::Passing passing(static_cast<std::uint8_t>(Command::kBrd), address_of(0, reg::kType), hex("00"), 41);
  esc.process(passing.datagram(), now);
  EXPECT_EQ(passing.reply().wkc, 42u);
}

TEST_F(EscCommand, DevicesWithoutReadWriteCommandsSayNothingToThem) {
  EscSettings s = test::meca500_settings();
  s.features = 0x01CC | 0x0400 | kFeatureNoLrw;
  esc = Esc(s);
  EXPECT_EQ(send(Command::kAprw, address_of(0, kUserRam), hex("11")).wkc, 0u);
  EXPECT_EQ(send(Command::kBrw, address_of(0, kUserRam), hex("11")).wkc, 0u);
  EXPECT_EQ(send(Command::kArmw, address_of(1, kUserRam), hex("11")).wkc, 1u);
  EXPECT_EQ(send(Command::kLrw, 0, hex("11")).wkc, 0u);
}

TEST_F(EscCommand, BeyondTheMemoryNothingAnswers) {
  EXPECT_EQ(read(0x3000, 4).wkc, 0u);
  EXPECT_EQ(read(0xFFFE, 4).wkc, 0u);
  EXPECT_EQ(write(0x3000, "11"), 0u);
}

TEST_F(EscCommand, OneByteInsideOfTheMemoryIsEnoughToCount) {
  EXPECT_EQ(write(0x2FFF, "5A A5"), 1u);
  const Reply r = send(Command::kAprd, address_of(0, 0x2FFF), hex("EE EE"));
  EXPECT_EQ(r.hex(), "5A EE");
  EXPECT_EQ(r.wkc, 1u);
}

// KickCAT writes zeros over 16 FMMUs and 16 sync managers, ethercrab over the last of them each, of which there are 8.
TEST_F(EscCommand, BroadcastsOverRegistersThatDoNotExistAreCounted) {
  EXPECT_EQ(send(Command::kBwr, address_of(0, 0x0600), std::vector<std::byte>(256)).wkc, 1u);
  EXPECT_EQ(send(Command::kBwr, address_of(0, 0x0800), std::vector<std::byte>(128)).wkc, 1u);
  EXPECT_EQ(send(Command::kBwr, address_of(0, 0x06F0), std::vector<std::byte>(16)).wkc, 1u);
  EXPECT_EQ(send(Command::kBwr, address_of(0, 0x0878), std::vector<std::byte>(8)).wkc, 1u);
}

// ---- Registers

TEST_F(EscRegister, IdentityAfterPowerOn) {
  const Reply r = read(reg::kType, 10);  // KickCAT and IgH read it as one
  EXPECT_NE(r.data[0], std::byte{0});
  EXPECT_EQ(test::text(Bytes(r.data).subspan(4)), "08 08 08 0F CC 01");  // FMMUs, SMs, KiB, ports, features
}

TEST_F(EscRegister, ValuesAfterPowerOn) {
  EXPECT_EQ(read(reg::kStationAddress, 2).hex(), "00 00");
  EXPECT_EQ(read(reg::kDlControl, 4).hex(), "01 00 07 00");
  EXPECT_EQ(read(reg::kDlStatus, 2).hex(), "11 56");  // 5611h: the only device, cable at port 0
  EXPECT_EQ(read(reg::kAlStatus, 6).hex(), "01 00 00 00 00 00");
  EXPECT_EQ(read(reg::kWatchdogDivider, 2).hex(), "C2 09");
  EXPECT_EQ(read(reg::kSmWatchdog, 2).hex(), "E8 03");
}

TEST_F(EscRegister, WhatIsReadOnlyKeepsItsValueThoughTheWriteIsCounted) {
  for (const std::uint16_t at : {reg::kType, reg::kFmmuCount, reg::kFeatures, reg::kStationAlias, reg::kDlStatus,
                                 reg::kAlStatus, reg::kAlStatusCode, reg::kPdiControl, reg::kEcatEvent}) {
    const std::string before = read(at, 2).hex();
    EXPECT_EQ(write(at, "FF FF"), 1u);
    EXPECT_EQ(read(at, 2).hex(), before) << std::hex << at;
  }
}

TEST_F(EscRegister, OnlyBitsThatExistAreKept) {
  const struct {
    std::uint16_t at;
    const char* kept;
  } kRows[] = {
      {reg::kStationAddress, "FF FF"}, {reg::kDlControl, "03 FF 0F 01"}, {reg::kAlControl, "3F 00"},
      {reg::kEcatEventMask, "FF FF"},  {reg::kSiiOwner, "03 00"},        {reg::kDcSpeedStart, "FF 7F"},
      {reg::kDcFilterDepths, "0F 0F"}, {reg::kDcCyclicUnit, "31 FF"},    {reg::kSmWatchdog, "FF FF 00"},
  };
  for (const auto& row : kRows) {
    const auto size = hex(row.kept).size();
    write(row.at, std::vector<std::byte>(size, std::byte{0xFF}));
    EXPECT_EQ(read(row.at, size).hex(), row.kept) << std::hex << row.at;
  }
}

TEST_F(EscRegister, FmmusAndSyncManagersKeepOnlyBitsThatExist) {
  write(reg::fmmu(7), std::vector<std::byte>(16, std::byte{0xFF}));
  EXPECT_EQ(read(reg::fmmu(7), 16).hex(), "FF FF FF FF FF FF 07 07 FF FF 07 03 01 00 00 00");
  write(reg::sync_manager(7), std::vector<std::byte>(8, std::byte{0xFF}));
  EXPECT_EQ(read(reg::sync_manager(7), 5).hex(), "FF FF FF FF 7F");
  EXPECT_EQ(read(reg::sync_manager(7) + 6, 1).hex(), "03");
}

TEST_F(EscRegister, AliasAnswersOnlyOnceItIsEnabled) {
  esc = Esc(test::meca500_settings(0x0123));
  EXPECT_EQ(read(reg::kStationAlias, 2).hex(), "23 01");
  EXPECT_EQ(send(Command::kFprd, address_of(0x0123, reg::kType), hex("00")).wkc, 0u);
  write(reg::kDlAliasEnable, "01");
  EXPECT_EQ(send(Command::kFprd, address_of(0x0123, reg::kType), hex("00")).wkc, 1u);
}

TEST_F(EscRegister, AlControlComesToTheApplicationForEveryWriteWideOrNarrow) {
  EXPECT_FALSE(esc.take_al_control());
  write(reg::kAlControl, "11");  // SOEM 1.4 writes one byte
  EXPECT_EQ(esc.take_al_control(), 0x0011);
  EXPECT_FALSE(esc.take_al_control());
  write(reg::kAlControl, "11 00");
  EXPECT_EQ(esc.take_al_control(), 0x0011);
  EXPECT_EQ(read(reg::kAlControl, 2).hex(), "11 00");
}

TEST_F(EscRegister, AlStatusShowsStateAndCode) {
  esc.set_al_status(0x0014, 0x001B);
  EXPECT_EQ(read(reg::kAlStatus, 6).hex(), "14 00 00 00 1B 00");
  EXPECT_EQ(esc.al_status(), 0x0014);
}

TEST_F(EscRegister, ErrorCountersStopAtFfhAndAnyWriteClearsTheirGroup) {
  for (int i = 0; i < 300; ++i) esc.count_invalid_frame(1);
  EXPECT_EQ(read(reg::kRxErrors, 8).hex(), "00 00 FF 00 00 00 00 00");
  esc.set_ports({{true, true, false, false}});
  esc.set_ports({{true, false, false, false}});
  EXPECT_EQ(read(reg::kLostLinks, 4).hex(), "00 01 00 00");
  EXPECT_EQ(write(reg::kRxErrors, "AB"), 1u);
  EXPECT_EQ(read(reg::kRxErrors, 4).hex(), "00 00 00 00");
  EXPECT_EQ(read(reg::kLostLinks, 4).hex(), "00 01 00 00");
  send(Command::kBwr, address_of(0, reg::kRxErrors), std::vector<std::byte>(reg::kErrorCountersSize));
  EXPECT_EQ(read(reg::kLostLinks, 4).hex(), "00 00 00 00");
}

TEST_F(EscRegister, DlStatusOfADeviceInTheMiddleShowsBothPortsOpen) {
  esc.set_ports({{true, true, false, false}});
  EXPECT_EQ(read(reg::kDlStatus, 2).hex(), "31 5A");
}

TEST_F(EscRegister, EventsThatAreMaskedInGoIntoTheIrqFieldUntilTheirRegisterIsRead) {
  esc.set_al_status(0x0002, 0);
  EXPECT_EQ(read(reg::kType, 1).irq, 0u);
  write(reg::kEcatEventMask, "0C 00");
  EXPECT_EQ(read(reg::kType, 1).irq, 0x0008u);
  EXPECT_EQ(read(reg::kEcatEvent, 2).hex(), "08 00");
  esc.set_ports({{true, true, false, false}});
  EXPECT_EQ(read(reg::kType, 1).irq, 0x000Cu);
  EXPECT_EQ(read(reg::kAlStatus, 2).irq, 0x0004u);
  EXPECT_EQ(read(reg::kDlStatus, 2).irq, 0x0000u);
}

TEST_F(EscRegister, IrqBitsOfEarlierDevicesStay) {
  write(reg::kEcatEventMask, "08 00");
  esc.set_al_status(0x0002, 0);
  test::Passing passing(static_cast<std::uint8_t>(Command::kNop), 0, hex("00"), 0, 0x8001);
  esc.process(passing.datagram(), now);
  EXPECT_EQ(passing.reply().irq, 0x8009u);
}

TEST_F(EscRegister, AlEventShowsAPendingAlControlToTheApplication) {
  write(reg::kAlControl, "02 00");
  EXPECT_EQ(read(reg::kAlEvent, 4).hex(), "01 00 00 00");
  esc.take_al_control();
  EXPECT_EQ(read(reg::kAlEvent, 4).hex(), "00 00 00 00");
}

TEST_F(EscRegister, ThreeWritesOfTheLettersResResetTheDevice) {
  write(reg::kStationAddress, "01 10");
  write(0x0040, "52");
  write(0x0040, "45");
  EXPECT_EQ(read(0x0040, 1).hex(), "02");
  EXPECT_FALSE(esc.take_reset());
  write(0x0040, "53");
  EXPECT_TRUE(esc.take_reset());
  EXPECT_FALSE(esc.take_reset());
  EXPECT_EQ(esc.station_address(), 0u);
  EXPECT_EQ(read(0x0040, 1).hex(), "00");
}

TEST_F(EscRegister, AWrongLetterBetweenStartsTheResetOver) {
  for (const char* letter : {"52", "45", "52", "53"}) write(0x0040, letter);
  EXPECT_FALSE(esc.take_reset());
  for (const char* letter : {"52", "45", "53"}) write(0x0040, letter);
  EXPECT_TRUE(esc.take_reset());
}

TEST_F(EscRegister, APowerCycleForgetsEverythingButTheCables) {
  configure();
  write(reg::kStationAddress, "01 10");
  write(0x2000, "77");
  esc.set_ports({{true, true, false, false}});
  esc.set_al_status(0x0008, 0);
  esc.power_cycle(5s);
  EXPECT_EQ(read(reg::kStationAddress, 2).hex(), "00 00");
  EXPECT_EQ(read(reg::kAlStatus, 2).hex(), "01 00");
  EXPECT_EQ(read(reg::sync_manager(0), 7).hex(), "00 00 00 00 00 00 00");
  EXPECT_EQ(read(0x2000, 1).hex(), "00");
  EXPECT_EQ(read(reg::kDlStatus, 2).hex(), "31 5A");
  EXPECT_EQ(read(reg::kLostLinks, 4).hex(), "00 00 00 00");
}

}  // namespace
}  // namespace meca::ethercat
