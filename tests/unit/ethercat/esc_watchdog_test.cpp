// The process data watchdog of the ESC (spec 5.3, 6.1).
#include "tests/unit/ethercat/esc_wire.hpp"

namespace meca::ethercat {
namespace {

using namespace std::chrono_literals;

class EscWatchdog : public test::EscWire {
 protected:
  EscWatchdog() { configure(); }
  void outputs() { EXPECT_EQ(write(0x1100, std::vector<std::byte>(60)), 1u); }
  bool expired_at(Time time) {
    now = time;
    esc.tick(now);
    return esc.take_watchdog_expiry();
  }
};

TEST_F(EscWatchdog, ExpiresAHundredMillisecondsAfterTheLastWholeOutputsUnlessToldOtherwise) {
  outputs();
  EXPECT_FALSE(expired_at(100ms - 1ns));
  EXPECT_EQ(read(reg::kSmWatchdogStatus, 2).hex(), "01 00");
  EXPECT_TRUE(expired_at(100ms));
  EXPECT_FALSE(expired_at(200ms));
  EXPECT_EQ(read(reg::kSmWatchdogStatus, 2).hex(), "00 00");
  EXPECT_EQ(read(reg::kSmWatchdogExpiries, 2).hex(), "01 00");
}

TEST_F(EscWatchdog, NeverExpiresWhileOutputsCome) {
  for (int i = 0; i < 1000; ++i) {
    outputs();
    now += 99ms;
  }
  esc.tick(now);
  EXPECT_FALSE(esc.take_watchdog_expiry());
}

TEST_F(EscWatchdog, DoesNotRunBeforeTheFirstOutputs) {
  EXPECT_FALSE(expired_at(10s));
  EXPECT_EQ(read(reg::kSmWatchdogStatus, 1).hex(), "00");
}

TEST_F(EscWatchdog, ALateFrameDoesNotHideThatItExpired) {
  outputs();
  now = 150ms;
  outputs();
  EXPECT_TRUE(esc.take_watchdog_expiry());
  EXPECT_FALSE(expired_at(249ms));
  EXPECT_TRUE(expired_at(250ms));
}

TEST_F(EscWatchdog, HalfOutputsDoNotFeedIt) {
  outputs();
  now = 99ms;
  write(0x1100, std::vector<std::byte>(59));
  EXPECT_TRUE(expired_at(100ms));
}

TEST_F(EscWatchdog, IsFedOnlyThroughASyncManagerWithTheTriggerBit) {
  write(reg::sync_manager(2) + 6, "00");
  write(reg::sync_manager(2), "00 11 3C 00 24 00 01 00");  // 64h without 40h
  outputs();
  EXPECT_FALSE(expired_at(10s));
}

TEST_F(EscWatchdog, TimeIsCountTimesDividerPlus2Times40Nanoseconds) {
  write(reg::kWatchdogDivider, "E6 04");  // 1254: 50.24 us
  write(reg::kSmWatchdog, "0A 00");
  outputs();
  EXPECT_FALSE(expired_at(502399ns));
  EXPECT_TRUE(expired_at(502400ns));
}

TEST_F(EscWatchdog, Count0TurnsItOffAndItsStatusIsGood) {
  write(reg::kSmWatchdog, "00 00");
  outputs();
  EXPECT_FALSE(expired_at(100s));
  EXPECT_EQ(read(reg::kSmWatchdogStatus, 1).hex(), "01");
}

TEST_F(EscWatchdog, StopsWithTheProcessData) {
  outputs();
  esc.allow_process_data(false, true);
  EXPECT_FALSE(expired_at(10s));
}

TEST_F(EscWatchdog, CounterStopsAtFfhAndIsClearedByAnyWrite) {
  for (int i = 0; i < 300; ++i) {
    outputs();
    now += 1s;
    esc.tick(now);
  }
  EXPECT_EQ(read(reg::kSmWatchdogExpiries, 1).hex(), "FF");
  EXPECT_EQ(write(reg::kSmWatchdogExpiries, "12 34"), 1u);
  EXPECT_EQ(read(reg::kSmWatchdogExpiries, 2).hex(), "00 00");
}

}  // namespace
}  // namespace meca::ethercat
