// Sync managers of the ESC: mailboxes and process data (ETG.1000.4, 6.7; spec 5.6, 6.1).
#include "tests/unit/ethercat/esc_wire.hpp"

namespace meca::ethercat {
namespace {

using test::hex;
using test::Reply;
using namespace std::chrono_literals;

constexpr std::uint16_t kMailOut = 0x1000, kMailIn = 0x1080, kOutputs = 0x1100, kInputs = 0x1400;
constexpr std::uint16_t kSm0Status = 0x0805, kSm1Status = 0x080D, kSm1Activate = 0x080E, kSm1Pdi = 0x080F;

std::vector<std::byte> bytes(std::size_t size, unsigned char value) {
  return std::vector<std::byte>(size, std::byte{value});
}

class EscMailbox : public test::EscWire {
 protected:
  EscMailbox() { configure(); }
};
class EscProcessData : public EscMailbox {};

// ---- From the master

TEST_F(EscMailbox, AWholeMailComesToTheApplicationOnce) {
  EXPECT_FALSE(esc.take_mail());
  auto mail = bytes(128, 0x5A);
  mail[0] = std::byte{0x0A};
  EXPECT_EQ(write(kMailOut, mail), 1u);
  const auto taken = esc.take_mail();
  ASSERT_TRUE(taken);
  EXPECT_TRUE(std::ranges::equal(*taken, mail));
  EXPECT_FALSE(esc.take_mail());
}

TEST_F(EscMailbox, AFullMailboxRefusesTheNextMailWithWkc0AndKeepsTheFirst) {
  EXPECT_EQ(write(kMailOut, bytes(128, 1)), 1u);
  EXPECT_EQ(read(kSm0Status, 1).hex(), "09");  // full; written
  EXPECT_EQ(write(kMailOut, bytes(128, 2)), 0u);
  EXPECT_EQ((*esc.take_mail())[0], std::byte{1});
  EXPECT_EQ(read(kSm0Status, 1).hex(), "02");  // free; read
  EXPECT_EQ(write(kMailOut, bytes(128, 3)), 1u);
}

TEST_F(EscMailbox, TheLastByteClosesTheMailWhateverCameBetween) {
  EXPECT_EQ(write(kMailOut, bytes(16, 7)), 1u);
  EXPECT_FALSE(esc.take_mail());
  EXPECT_EQ(write(kMailOut + 127, "00"), 1u);
  EXPECT_TRUE(esc.take_mail());
}

TEST_F(EscMailbox, WithoutItsFirstByteAMailboxStaysClosed) {
  EXPECT_EQ(write(kMailOut + 1, bytes(127, 7)), 0u);
  EXPECT_EQ(write(kMailOut + 127, "00"), 0u);
  EXPECT_FALSE(esc.take_mail());
}

TEST_F(EscMailbox, TheDirectionIsOneWay) {
  EXPECT_EQ(read(kMailOut, 128).wkc, 0u);
  EXPECT_EQ(write(kMailIn, bytes(128, 1)), 0u);
}

// ---- To the master

TEST_F(EscMailbox, AnEmptyMailboxReadsWithWkc0) {
  const Reply r = send(Command::kAprd, address_of(0, kMailIn), bytes(128, 0xEE));
  EXPECT_EQ(r.wkc, 0u);
  EXPECT_EQ(r.data, bytes(128, 0xEE));
}

TEST_F(EscMailbox, APostedMailIsFilledUpWithZerosAndReadOnce) {
  EXPECT_TRUE(esc.post_mail(hex("01 02 03")));
  EXPECT_EQ(read(kSm1Status, 2).hex(), "09 01");
  EXPECT_FALSE(esc.mail_fetched());
  const Reply r = send(Command::kAprd, address_of(0, kMailIn), bytes(128, 0xEE));
  EXPECT_EQ(r.wkc, 1u);
  auto expected = bytes(128, 0);
  std::ranges::copy(hex("01 02 03"), expected.begin());
  EXPECT_EQ(r.data, expected);
  EXPECT_TRUE(esc.mail_fetched());
  EXPECT_FALSE(esc.mail_fetched());
  EXPECT_EQ(read(kSm1Status, 1).hex(), "02");
  EXPECT_EQ(read(kMailIn, 128).wkc, 0u);
}

TEST_F(EscMailbox, AMailThatWasNotFetchedIsNotOverwritten) {
  EXPECT_TRUE(esc.post_mail(hex("01")));
  EXPECT_FALSE(esc.post_mail(hex("02")));
  EXPECT_EQ(read(kMailIn, 128).data[0], std::byte{1});
  EXPECT_TRUE(esc.post_mail(hex("02")));
}

TEST_F(EscMailbox, AMailLongerThanTheMailboxIsNotPosted) {
  EXPECT_FALSE(esc.post_mail(bytes(129, 1)));
  EXPECT_TRUE(esc.post_mail(bytes(128, 1)));
}

TEST_F(EscMailbox, ReadingTheHeadLeavesTheMailThere) {
  esc.post_mail(hex("01 02 03"));
  EXPECT_EQ(read(kMailIn, 6).hex(), "01 02 03 00 00 00");
  EXPECT_FALSE(esc.mail_fetched());
  EXPECT_EQ(read(kMailIn, 128).wkc, 1u);
  EXPECT_TRUE(esc.mail_fetched());
}

TEST_F(EscMailbox, DisablingEmptiesItOnBothSides) {
  write(kMailOut, bytes(128, 1));
  esc.post_mail(hex("01"));
  for (const unsigned n : {0u, 1u}) {
    write(reg::sync_manager(n) + 6, "00");
    write(reg::sync_manager(n) + 6, "01");
  }
  EXPECT_FALSE(esc.take_mail());
  EXPECT_EQ(read(kMailIn, 128).wkc, 0u);
  EXPECT_EQ(write(kMailOut, bytes(128, 2)), 1u);
  EXPECT_TRUE(esc.post_mail(hex("02")));
}

TEST_F(EscMailbox, WhileItIsDisabledNothingIsPostedAndItsMemoryIsPlain) {
  write(reg::sync_manager(1) + 6, "00");
  EXPECT_FALSE(esc.post_mail(hex("01")));
  EXPECT_EQ(write(kMailIn, "AB"), 1u);
  EXPECT_EQ(read(kMailIn, 1).hex(), "AB");
}

TEST_F(EscMailbox, WhileItIsEnabledItDoesNotMove) {
  EXPECT_EQ(write(reg::sync_manager(0), "00 20 10 00 26 00 01 00"), 1u);
  EXPECT_EQ(read(reg::sync_manager(0), 8).hex(), "00 10 80 00 26 00 01 00");
  write(reg::sync_manager(0), "00 20 10 00 26 00 00 00");
  EXPECT_EQ(read(reg::sync_manager(0), 8).hex(), "00 10 80 00 26 00 00 00");
  write(reg::sync_manager(0), "00 20 10 00 26 00 01 00");
  EXPECT_EQ(esc.sync_manager(0).start, 0x2000u);
  EXPECT_EQ(esc.sync_manager(0).length, 0x0010u);
  EXPECT_EQ(esc.sync_manager(0).control, 0x26u);
  EXPECT_TRUE(esc.sync_manager(0).enabled);
}

TEST_F(EscMailbox, RepeatIsAskedByTogglingBit1AndAnsweredByTheSameBit) {
  EXPECT_FALSE(esc.take_repeat_request());
  write(kSm1Activate, "03");
  EXPECT_TRUE(esc.take_repeat_request());
  EXPECT_FALSE(esc.take_repeat_request());
  EXPECT_EQ(read(kSm1Pdi, 1).hex(), "00");
  esc.acknowledge_repeat();
  EXPECT_EQ(read(kSm1Pdi, 1).hex(), "02");
  write(kSm1Activate, "01");
  EXPECT_TRUE(esc.take_repeat_request());
  esc.acknowledge_repeat();
  EXPECT_EQ(read(kSm1Pdi, 1).hex(), "00");
}

TEST_F(EscMailbox, EnablingIsNoRepeatRequest) {
  write(kSm1Activate, "00");
  write(kSm1Activate, "03");
  EXPECT_FALSE(esc.take_repeat_request());
  EXPECT_EQ(read(kSm1Pdi, 1).hex(), "02");
}

TEST_F(EscMailbox, ALostReadEmptiesTheMailboxThoughNothingArrives) {
  esc.faults().lose_mailbox_reads = true;
  esc.post_mail(hex("01"));
  const Reply r = send(Command::kAprd, address_of(0, kMailIn), bytes(128, 0xEE));
  EXPECT_EQ(r.wkc, 0u);
  EXPECT_EQ(r.data, bytes(128, 0xEE));
  EXPECT_TRUE(esc.mail_fetched());
}

TEST_F(EscMailbox, EventsOfBothSidesFollowTheirControlBits) {
  EXPECT_EQ(read(reg::kAlEvent, 4).hex(), "00 00 00 00");
  write(kMailOut, bytes(128, 1));
  EXPECT_EQ(read(reg::kAlEvent, 4).hex(), "00 01 00 00");  // control bit 5 of sync manager 0
  esc.take_mail();
  EXPECT_EQ(read(reg::kAlEvent, 4).hex(), "00 00 00 00");
  write(kSm1Activate, "00");
  write(reg::sync_manager(1) + 4, "32");  // 22h and bit 4: to the master
  write(kSm1Activate, "01");
  write(reg::kEcatEventMask, "20 00");
  esc.post_mail(hex("01"));
  EXPECT_EQ(read(reg::kType, 1).irq, 0x0020u);
  read(kMailIn, 128);
  EXPECT_EQ(read(reg::kType, 1).irq, 0u);
}

// ---- Process data

TEST_F(EscProcessData, OutputsAreTakenWholeAndOnce) {
  EXPECT_FALSE(esc.take_outputs());
  EXPECT_EQ(write(kOutputs, bytes(60, 0x11)), 1u);
  const auto outputs = esc.take_outputs();
  ASSERT_TRUE(outputs);
  EXPECT_TRUE(std::ranges::equal(*outputs, bytes(60, 0x11)));
  EXPECT_FALSE(esc.take_outputs());
}

TEST_F(EscProcessData, HalfOfTheOutputsIsNoOutputs) {
  write(kOutputs, bytes(60, 0x11));
  esc.take_outputs();
  EXPECT_EQ(write(kOutputs, bytes(30, 0x22)), 1u);
  EXPECT_FALSE(esc.take_outputs());
  EXPECT_EQ(write(kOutputs + 30, bytes(30, 0x33)), 1u);
  const auto outputs = esc.take_outputs();
  ASSERT_TRUE(outputs);
  EXPECT_EQ((*outputs)[29], std::byte{0x22});
  EXPECT_EQ((*outputs)[30], std::byte{0x33});
}

TEST_F(EscProcessData, TheNewestOutputsWinAndWhatTheApplicationHoldsDoesNotChange) {
  write(kOutputs, bytes(60, 1));
  const auto held = *esc.take_outputs();
  for (unsigned char i = 2; i < 10; ++i) {
    write(kOutputs, bytes(60, i));
    EXPECT_EQ(held[0], std::byte{1});
  }
  EXPECT_EQ((*esc.take_outputs())[59], std::byte{9});
}

TEST_F(EscProcessData, OutputsCannotBeReadNorInputsWritten) {
  write(kOutputs, bytes(60, 1));
  EXPECT_EQ(read(kOutputs, 60).wkc, 0u);
  esc.set_inputs(bytes(252, 1));
  EXPECT_EQ(write(kInputs, bytes(252, 2)), 0u);
}

TEST_F(EscProcessData, InputsGiveNoWkcBeforeTheFirstOnes) {
  EXPECT_EQ(read(kInputs, 252).wkc, 0u);
  EXPECT_EQ(read(reg::sync_manager(3) + 5, 1).hex(), "30");  // no buffer written
  esc.set_inputs(bytes(252, 0x42));
  const Reply r = read(kInputs, 252);
  EXPECT_EQ(r.wkc, 1u);
  EXPECT_EQ(r.data, bytes(252, 0x42));
  EXPECT_EQ(read(kInputs, 252).wkc, 1u);  // as often as one likes
}

TEST_F(EscProcessData, InputsThatChangeBetweenTwoHalvesStayTheOldOnesUntilTheLastByte) {
  esc.set_inputs(bytes(252, 1));
  EXPECT_EQ(read(kInputs, 100).data, bytes(100, 1));
  esc.set_inputs(bytes(252, 2));
  esc.set_inputs(bytes(252, 3));
  EXPECT_EQ(read(kInputs + 100, 152).data, bytes(152, 1));
  EXPECT_EQ(read(kInputs, 252).data, bytes(252, 3));
}

TEST_F(EscProcessData, ShortInputsAreFilledUpWithZerosAndLongOnesCut) {
  esc.set_inputs(bytes(252, 0xFF));
  esc.set_inputs(bytes(300, 0xFF));
  esc.set_inputs(hex("01 02"));
  auto expected = bytes(252, 0);
  std::ranges::copy(hex("01 02"), expected.begin());
  EXPECT_EQ(read(kInputs, 252).data, expected);
}

TEST_F(EscProcessData, TheSecondAndThirdBufferAreOutOfReach) {
  EXPECT_EQ(write(kOutputs + 60, bytes(120, 1)), 0u);
  EXPECT_EQ(write(kOutputs + 180, "01"), 1u);
}

TEST_F(EscProcessData, GivesNoWkcWhileTheApplicationDoesNotAllowIt) {
  esc.set_inputs(bytes(252, 1));
  esc.allow_process_data(false, true);
  EXPECT_EQ(write(kOutputs, bytes(60, 1)), 0u);
  EXPECT_EQ(read(kInputs, 252).wkc, 1u);
  esc.allow_process_data(false, false);
  EXPECT_EQ(read(kInputs, 252).wkc, 0u);
  EXPECT_EQ(read(reg::sync_manager(2) + 7, 1).hex(), "01");  // deactivated
  esc.allow_process_data(true, true);
  EXPECT_EQ(write(kOutputs, bytes(60, 1)), 1u);
  EXPECT_EQ(read(kInputs, 252).wkc, 0u);  // what was set before is gone
}

TEST_F(EscProcessData, IsNotAllowedAfterPowerOn) {
  esc.power_cycle(now);
  for (unsigned n = 0; n < 4; ++n) write(reg::sync_manager(n), sync_manager_bytes(n, true));
  EXPECT_EQ(write(kOutputs, bytes(60, 1)), 0u);
  EXPECT_EQ(write(kMailOut, bytes(128, 1)), 1u);
}

TEST_F(EscProcessData, OutsideOfTheMemoryGivesNoWkcThere) {
  write(reg::sync_manager(2) + 6, "00");
  write(reg::sync_manager(2), "00 2F 80 00 64 00 01 00");  // three times 128 bytes from 2F00h
  EXPECT_EQ(write(0x2F00, bytes(128, 1)), 0u);
  EXPECT_FALSE(esc.take_outputs());
}

TEST_F(EscProcessData, AReservedModeGivesNoWkc) {
  write(reg::sync_manager(3) + 6, "00");
  write(reg::sync_manager(3), "00 14 FC 00 21 00 01 00");
  esc.set_inputs(bytes(252, 1));
  EXPECT_EQ(read(kInputs, 252).wkc, 0u);
}

}  // namespace
}  // namespace meca::ethercat
