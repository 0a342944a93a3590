// Who may open the connection, and what is said to the others: the table in
// transports/ethernet_ip/README.md, row by row. Outcomes are general status and extended words.
#include "tests/unit/ethernet_ip/adapter_rig.hpp"

namespace meca::ethernet_ip::adapter_test {
namespace {

class AdapterConnection : public ::testing::Test {
 protected:
  AdapterConnection() { rig.enter(); }
  // Opens, and closes again if it came to that.
  std::string outcome(const ForwardOpen& f, std::string_view path = kUsualPath) {
    const std::string result = rig.open(f, path);
    return result == "ok" ? rig.close(f.triad) : result;
  }
  template <class Change>
  std::string with(Change change) {
    ForwardOpen f = usual_open();
    change(f);
    return outcome(f);
  }
  std::string with_path(std::string_view path) { return outcome(usual_open(), path); }
  std::string with_key(std::string_view key) { return with_path(std::string(key) + " 20 04 2C 96 2C 64"); }

  AdapterRig rig;
};

TEST_F(AdapterConnection, TheUsualRequestIsAcceptedWithOurOToTIdTheirTToOIdAndTheRpiAsApi) {
  ASSERT_EQ(rig.open(usual_open()), "ok");
  EXPECT_NE(rig.opened.o_to_t_id, 0u);
  EXPECT_EQ(rig.opened.t_to_o_id, 0x5EED0001u);
  EXPECT_EQ(rig.opened.triad, usual_open().triad);
  EXPECT_EQ(rig.opened.o_to_t_api_us, 10'000u);
  EXPECT_EQ(rig.opened.t_to_o_api_us, 10'000u);
  EXPECT_TRUE(rig.adapter.connected());
  EXPECT_EQ(rig.adapter.counters().opens, 1u);
}

TEST_F(AdapterConnection, LargeForwardOpenIsAcceptedToo) {
  EXPECT_EQ(with([](ForwardOpen& f) { f.large = true; }), "ok");
  EXPECT_EQ(with([](ForwardOpen& f) {
              f.large = true;
              f.t_to_o.size = 1000;
            }),
            "01 0128 00FE");
}

TEST_F(AdapterConnection, ConnectionIdsOfOursAreNeverUsedTwice) {
  ASSERT_EQ(rig.open(usual_open()), "ok");
  const auto first = rig.opened.o_to_t_id;
  ASSERT_EQ(rig.close(usual_open().triad), "ok");
  ASSERT_EQ(rig.open(usual_open()), "ok");
  EXPECT_NE(rig.opened.o_to_t_id, first);
}

TEST_F(AdapterConnection, MultiplierCodesAboveSevenAreRefused) {
  for (std::uint8_t code = 0; code <= 7; ++code) EXPECT_EQ(with([&](auto& f) { f.multiplier_code = code; }), "ok");
  EXPECT_EQ(with([](auto& f) { f.multiplier_code = 8; }), "01 0133");
}

TEST_F(AdapterConnection, OnlyCyclicClass1FromAClientIsSupported) {
  EXPECT_EQ(with([](auto& f) { f.transport = 0x00; }), "01 011C");  // class 0
  EXPECT_EQ(with([](auto& f) { f.transport = 0x02; }), "01 011C");
  EXPECT_EQ(with([](auto& f) { f.transport = 0xA3; }), "01 011C");  // class 3, as for explicit messages
  EXPECT_EQ(with([](auto& f) { f.transport = 0x11; }), "01 011D");  // change of state
  EXPECT_EQ(with([](auto& f) { f.transport = 0x21; }), "01 011D");  // application
  EXPECT_EQ(with([](auto& f) { f.transport = 0x31; }), "01 011D");  // reserved
  EXPECT_EQ(with([](auto& f) { f.transport = 0x81; }), "01 011E");  // server
}

TEST_F(AdapterConnection, EveryPriorityIsAccepted) {
  for (const auto priority : {Priority::kLow, Priority::kHigh, Priority::kScheduled, Priority::kUrgent}) {
    EXPECT_EQ(with([&](auto& f) { f.o_to_t.priority = f.t_to_o.priority = priority; }), "ok");
  }
}

TEST_F(AdapterConnection, RedundantOwnersAndVariableSizesAreRefused) {
  EXPECT_EQ(with([](auto& f) { f.o_to_t.redundant_owner = true; }), "01 0125");
  EXPECT_EQ(with([](auto& f) { f.t_to_o.redundant_owner = true; }), "01 0125");
  EXPECT_EQ(with([](auto& f) { f.o_to_t.variable_size = true; }), "01 011F");
  EXPECT_EQ(with([](auto& f) { f.t_to_o.variable_size = true; }), "01 0120");
}

TEST_F(AdapterConnection, OutputsComePointToPointAndInputsGoPointToPointOrMulticast) {
  using enum ConnectionType;
  EXPECT_EQ(with([](auto& f) { f.o_to_t.type = f.t_to_o.type = kNull; }), "01 0132");  // null Forward Open
  EXPECT_EQ(with([](auto& f) { f.o_to_t.type = kNull; }), "01 0123");
  EXPECT_EQ(with([](auto& f) { f.o_to_t.type = kMulticast; }), "01 0123");
  EXPECT_EQ(with([](auto& f) { f.o_to_t.type = kReserved; }), "01 0123");
  EXPECT_EQ(with([](auto& f) { f.t_to_o.type = kNull; }), "01 0124");
  EXPECT_EQ(with([](auto& f) { f.t_to_o.type = kReserved; }), "01 0124");
  EXPECT_EQ(with([](auto& f) { f.t_to_o.type = kMulticast; }), "ok");
}

TEST_F(AdapterConnection, RpiIsTenMillisecondsToTenSeconds) {
  for (const std::uint32_t rpi : {10'000u, 12'345u, 10'000'000u}) {
    EXPECT_EQ(with([&](auto& f) { f.o_to_t_rpi_us = f.t_to_o_rpi_us = rpi; }), "ok") << rpi;
    EXPECT_EQ(rig.opened.o_to_t_api_us, rpi);
    EXPECT_EQ(rig.opened.t_to_o_api_us, rpi);
  }
  for (const std::uint32_t rpi : {0u, 1u, 1'000u, 7'500u, 9'999u, 10'000'001u, 60'000'000u}) {
    EXPECT_EQ(with([&](auto& f) { f.o_to_t_rpi_us = rpi; }), "01 0111") << rpi;
    EXPECT_EQ(with([&](auto& f) { f.t_to_o_rpi_us = rpi; }), "01 0111") << rpi;
  }
}

TEST(AdapterLenient, TakesOneMillisecondAndAnHour) {
  auto settings = meca500();
  settings.lenient_rpi = true;
  AdapterRig rig(settings);
  rig.enter();
  for (const std::uint32_t rpi : {1'000u, 7'500u, 3'600'000'000u}) {
    auto f = usual_open();
    f.o_to_t_rpi_us = f.t_to_o_rpi_us = rpi;
    EXPECT_EQ(rig.open(f), "ok") << rpi;
    EXPECT_EQ(rig.opened.t_to_o_api_us, rpi);
    EXPECT_EQ(rig.close(f.triad), "ok");
  }
  auto f = usual_open();
  f.t_to_o_rpi_us = 999;
  EXPECT_EQ(rig.open(f), "01 0111");
}

TEST_F(AdapterConnection, AWrongSizeIsAnsweredWithTheRightOne) {
  for (const std::uint16_t size : {0, 60, 62, 64, 65, 67}) {
    EXPECT_EQ(with([&](auto& f) { f.o_to_t.size = size; }), "01 0127 0042") << size;
  }
  for (const std::uint16_t size : {0, 252, 253, 255, 258}) {
    EXPECT_EQ(with([&](auto& f) { f.t_to_o.size = size; }), "01 0128 00FE") << size;
  }
}

TEST_F(AdapterConnection, ThePathNamesThePointsOfTheRobot) {
  EXPECT_EQ(with_path("20 04 24 00 2C 96 2C 64"), "ok");              // configuration instance 0: none
  EXPECT_EQ(with_path("21 00 04 00 2D 00 96 00 2D 00 64 00"), "ok");  // 16 bit segments
  EXPECT_EQ(with_path("20 04 24 01 2C 96 2C 64"), "01 0129");
  EXPECT_EQ(with_path("20 04 2C 64 2C 96"), "01 012A");  // swapped
  EXPECT_EQ(with_path("20 04 2C 97 2C 64"), "01 012A");
  EXPECT_EQ(with_path("20 04 2C 96 2C 65"), "01 012B");
  EXPECT_EQ(with_path("20 04 2C 96 2C 64 80 01 00 00"), "01 0126");  // configuration data
}

TEST_F(AdapterConnection, APathThatIsNoneIsRefused) {
  for (const auto* path : {"", "20 04 2C 96", "20 04", "2C 96 2C 64", "20 99 2C 96 2C 64", "20 04 2C 96 2C 64 2C 01",
                           "20 04 2C 96 2C 64 44 00", "20 04 2C 96 2C 64 21 00", "20 02 24 01"}) {
    EXPECT_EQ(with_path(path), "01 0315") << path;
  }
}

TEST_F(AdapterConnection, InputOnlyAndListenOnlyAreNotModelled) {
  ForwardOpen f = usual_open();
  f.o_to_t.size = 2;
  EXPECT_EQ(outcome(f, "20 04 2C 98 2C 64"), "01 012F");
  EXPECT_EQ(outcome(f, "20 04 2C 99 2C 64"), "01 012F");
}

TEST_F(AdapterConnection, APathLengthThatDoesNotFitIsNamed) {
  const auto f = usual_open();
  const auto request = [&](int words) {
    return written([&](wire::Writer& out) {
      write_request(out, Service::kForwardOpen, kConnectionManagerClass, 1);
      write_forward_open(out, f);
      out.u8(static_cast<std::uint8_t>(words));
      write_connection_points(out, 150, 100);
    });
  };
  EXPECT_EQ(rig.cip(request(4)), "13");
  EXPECT_EQ(rig.cip(request(2)), "15");
}

TEST_F(AdapterConnection, ARefusalCarriesTheTriadOfTheRequest) {
  EXPECT_EQ(with([](auto& f) { f.transport = 0; }), "01 011C");
  EXPECT_EQ(rig.last_data, "070034125b69026b0000");
  EXPECT_EQ(rig.adapter.counters().refusals, 1u);
}

// ---- Electronic keys; the device is 1565, 43, 500, 11.3

TEST_F(AdapterConnection, KeysNameVendorProductTypeAndRevision) {
  EXPECT_EQ(with_key("34 04 0000 0000 0000 00 00"), "ok");
  EXPECT_EQ(with_key("34 04 1d06 2b00 f401 0b 03"), "ok");
  EXPECT_EQ(with_key("34 04 1d06 2b00 f401 0b 00"), "ok");
  EXPECT_EQ(with_key("34 04 1d06 2b00 f401 00 00"), "ok");
  EXPECT_EQ(with_key("34 04 1e06 2b00 f401 0b 03"), "01 0114");
  EXPECT_EQ(with_key("34 04 1d06 2b00 f501 0b 03"), "01 0114");
  EXPECT_EQ(with_key("34 04 1d06 2c00 f401 0b 03"), "01 0115");
  EXPECT_EQ(with_key("34 04 1d06 2b00 f401 0a 03"), "01 0116");
  EXPECT_EQ(with_key("34 04 1d06 2b00 f401 0b 02"), "01 0116");
  EXPECT_EQ(with_key("34 05 1d06 2b00 f401 0b 03"), "01 0315");  // another format
}

struct KeyCase {
  AdapterKeyPolicy policy;
  const char *same, *older_minor, *newer_minor, *older_major, *newer_major, *exact_older_minor;
};

class AdapterKeys : public ::testing::TestWithParam<KeyCase> {};

TEST_P(AdapterKeys, ACompatibleKeyIsReadAsThePolicySays) {
  auto settings = meca500();
  settings.key_policy = GetParam().policy;
  const auto with = [&](const char* revision) {
    AdapterRig rig(settings);
    rig.enter();
    return rig.open(usual_open(), std::string("34 04 1d06 2b00 f401 ") + revision + " 20 04 2C 96 2C 64");
  };
  EXPECT_EQ(with("8b 03"), GetParam().same);
  EXPECT_EQ(with("8b 01"), GetParam().older_minor);
  EXPECT_EQ(with("8b 04"), GetParam().newer_minor);
  EXPECT_EQ(with("8a 02"), GetParam().older_major);
  EXPECT_EQ(with("8c 01"), GetParam().newer_major);
  EXPECT_EQ(with("0b 01"), GetParam().exact_older_minor);
}

std::string name_of_case(const ::testing::TestParamInfo<KeyCase>& tested) {
  constexpr const char* kNames[] = {"Exact", "SameMajor", "AnyOlder", "Off"};
  return kNames[static_cast<std::size_t>(tested.param.policy)];
}

constexpr const char *kOk = "ok", *kNo = "01 0116";
INSTANTIATE_TEST_SUITE_P(Policies, AdapterKeys,
                         ::testing::Values(KeyCase{AdapterKeyPolicy::kExact, kOk, kNo, kNo, kNo, kNo, kNo},
                                           KeyCase{AdapterKeyPolicy::kCompatibleSameMajor, kOk, kOk, kNo, kNo, kNo,
                                                   kNo},
                                           KeyCase{AdapterKeyPolicy::kCompatibleAnyOlder, kOk, kOk, kNo, kOk, kNo, kNo},
                                           KeyCase{AdapterKeyPolicy::kOff, kOk, kOk, kOk, kOk, kOk, kOk}),
                         name_of_case);

// ---- Ownership

TEST_F(AdapterConnection, TheSameTriadIsRefusedAsDuplicateAndAnyOtherAsOwned) {
  ASSERT_EQ(rig.open(usual_open()), "ok");
  EXPECT_EQ(rig.open(usual_open()), "01 0100");
  auto again = usual_open();
  ++again.triad.connection_serial;
  EXPECT_EQ(rig.open(again), "01 0106");
  auto other = usual_open();
  ++other.triad.originator_serial;
  EXPECT_EQ(rig.open(other), "01 0106");
}

TEST_F(AdapterConnection, AfterCloseOrTimeoutAnybodyMayBecomeOwner) {
  auto other = usual_open();
  ++other.triad.originator_serial;
  ASSERT_EQ(rig.open(usual_open()), "ok");
  ASSERT_EQ(rig.close(usual_open().triad), "ok");
  ASSERT_EQ(rig.open(other), "ok");
  rig.run_for(10s + 1ms);
  EXPECT_FALSE(rig.adapter.connected());
  EXPECT_EQ(rig.open(usual_open()), "ok");
}

TEST(AdapterOwnership, KeptAfterATimeoutItIsOnlyForTheOriginatorThatVanished) {
  auto settings = meca500();
  settings.ownership = OwnershipPolicy::kKeep;
  AdapterRig rig(settings);
  rig.enter();
  auto other = usual_open();
  ++other.triad.originator_serial;
  ASSERT_EQ(rig.open(usual_open()), "ok");
  rig.run_for(11s);
  ASSERT_FALSE(rig.adapter.connected());
  EXPECT_EQ(rig.open(other), "01 0106");
  auto back = usual_open();
  ++back.triad.connection_serial;
  EXPECT_EQ(rig.open(back), "ok");
  EXPECT_EQ(rig.close(back.triad), "ok");
  EXPECT_EQ(rig.open(other), "ok");  // an orderly close gives it up

  rig.run_for(11s);
  rig.adapter.power_cycle();
  rig.connect(0);
  rig.enter();
  EXPECT_EQ(rig.open(usual_open()), "ok");  // and a restart of the robot too
}

}  // namespace
}  // namespace meca::ethernet_ip::adapter_test
