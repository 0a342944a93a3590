// States and codes in words.
#include <gtest/gtest.h>

#include <string_view>

#include "transports/ethercat/al_status.hpp"
#include "transports/ethercat/mailbox.hpp"

namespace meca::ethercat {
namespace {

TEST(AlStatus, StatesHaveTheNamesOfTheStandardWithOrWithoutError) {
  EXPECT_EQ(al_state_name(1), "INIT");
  EXPECT_EQ(al_state_name(2), "PREOP");
  EXPECT_EQ(al_state_name(3), "BOOT");
  EXPECT_EQ(al_state_name(4), "SAFEOP");
  EXPECT_EQ(al_state_name(8), "OP");
  EXPECT_EQ(al_state_name(0x14), "SAFEOP");
  EXPECT_EQ(al_state_name(0), "an unknown state");
  EXPECT_EQ(al_state_name(6), "an unknown state");
}

TEST(AlStatus, CodesThatMastersCauseSayWhatIsWrong) {
  EXPECT_EQ(al_code_text(0x0025),
            "invalid output mapping: the PDO assignment does not give the length of the output sync manager");
  EXPECT_EQ(al_code_text(0x001B),
            "sync manager watchdog: no outputs arrived in time; the master stopped, is late, or the cable was pulled");
  EXPECT_EQ(al_code_text(0x0000), "no error");
  EXPECT_EQ(al_code_text(0x0010), "not known");
  EXPECT_EQ(al_code_text(0xFFFF), "not known");
}

TEST(AlStatus, EveryCodeThatARobotOrAMasterIsKnownToShowHasAText) {
  constexpr std::uint16_t kCodes[] = {0x11, 0x12, 0x13, 0x16, 0x17, 0x18, 0x19, 0x1A, 0x1B, 0x1C, 0x1D, 0x1E,
                                      0x1F, 0x20, 0x21, 0x22, 0x23, 0x24, 0x25, 0x26, 0x27, 0x28, 0x29, 0x2A,
                                      0x2B, 0x2C, 0x2D, 0x2E, 0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37,
                                      0x41, 0x42, 0x43, 0x44, 0x45, 0x4F, 0x50, 0x51, 0x60, 0x61};
  for (const std::uint16_t code : kCodes) {
    EXPECT_NE(al_code_text(code), "not known") << std::hex << code;
  }
}

TEST(SdoAborts, EveryCodeThatWeSendHasAText) {
  using enum SdoAbort;
  for (const SdoAbort code :
       {kToggle,           kTimeout,          kCommand,    kMemory,      kUnsupportedAccess, kWriteOnly,    kReadOnly,
        kSubindex0NotZero, kNoCompleteAccess, kNoObject,   kNotMappable, kMappingTooLong,    kIncompatible, kLength,
        kTooLong,          kTooShort,         kNoSubindex, kValueRange,  kGeneral,           kState}) {
    EXPECT_NE(abort_text(static_cast<std::uint32_t>(code)), "not known") << std::hex << static_cast<unsigned>(code);
  }
  EXPECT_EQ(abort_text(0x06020000), "object does not exist");
  EXPECT_EQ(abort_text(0x12345678), "not known");
}

}  // namespace
}  // namespace meca::ethercat
