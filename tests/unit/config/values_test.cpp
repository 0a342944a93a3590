// The notations of the configuration, one by one.
#include "bridge/config_values.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using namespace meca::bridge;
using namespace meca::bridge::config_values;
using namespace std::chrono_literals;

TEST(Duration, IsANumberWithAUnit) {
  EXPECT_EQ(duration("500us"), 500us);
  EXPECT_EQ(duration("1ms"), 1ms);
  EXPECT_EQ(duration("10 ms"), 10ms);
  EXPECT_EQ(duration("2s"), 2s);
  EXPECT_EQ(duration("0.5s"), 500ms);
  EXPECT_EQ(duration("1.5ms"), 1500us);
  EXPECT_EQ(duration("7ns"), 7ns);
  EXPECT_EQ(duration("0ms"), 0ms);
  EXPECT_EQ(duration("86400s"), 24h);
}

TEST(Duration, IsNothingElse) {
  for (const char* text : {"", "1", "ms", "-1ms", "+1ms", " 1ms", "1ms ", "1 m s", "1e3ms", "1msx", "1 min", "0x1ms",
                           "inf s", "nan s", "86401s", "999999999999999999999s", ".5s", "1\tms"}) {
    EXPECT_EQ(duration(text), std::nullopt) << "'" << text << "'";
  }
}

TEST(Duration, IsWrittenInTheLargestUnitThatFits) {
  EXPECT_EQ(to_string(0ns), "0ns");
  EXPECT_EQ(to_string(999ns), "999ns");
  EXPECT_EQ(to_string(500us), "500us");
  EXPECT_EQ(to_string(1ms), "1ms");
  EXPECT_EQ(to_string(1500us), "1.5ms");
  EXPECT_EQ(to_string(1s), "1s");
  EXPECT_EQ(to_string(1h), "3600s");
}

TEST(RateText, IsAWordAPeriodOrAFrequency) {
  EXPECT_EQ(rate("every_cycle")->kind, RateKind::kEveryCycle);
  EXPECT_EQ(rate("on_change")->kind, RateKind::kOnChange);
  EXPECT_EQ(rate("off")->kind, RateKind::kOff);
  EXPECT_EQ(rate("10ms")->kind, RateKind::kPeriod);
  EXPECT_EQ(rate("10ms")->period, 10ms);
  EXPECT_EQ(rate("100Hz")->period, 10ms);
  EXPECT_EQ(rate("0.1 Hz")->period, 10s);
  for (const char* text : {"", "0ms", "0Hz", "100", "100hz", "-1Hz", "Off", "on change", "0.000001Hz"}) {
    EXPECT_FALSE(rate(text).has_value()) << text;
  }
}

TEST(Integer, IsDecimalAndWhole) {
  EXPECT_EQ(integer("0"), 0);
  EXPECT_EQ(integer("-17"), -17);
  EXPECT_EQ(integer("9223372036854775807"), 9223372036854775807);
  for (const char* text : {"", "-", "+1", "1.0", "0x10", " 1", "1 ", "9223372036854775808"}) {
    EXPECT_EQ(integer(text), std::nullopt) << text;
  }
}

TEST(Firmware, IsOneToFourNumbers) {
  EXPECT_EQ(parse_firmware("11"), (meca::transports::FirmwareVersion{11, 0, 0, 0}));
  EXPECT_EQ(parse_firmware("11.3"), (meca::transports::FirmwareVersion{11, 3, 0, 0}));
  EXPECT_EQ(parse_firmware("11.10"), (meca::transports::FirmwareVersion{11, 10, 0, 0}));
  EXPECT_EQ(parse_firmware("11.3.3.12637"), (meca::transports::FirmwareVersion{11, 3, 3, 12637}));
  for (const char* text : {"", ".", "11.", ".3", "11..3", "11.x", "v11", "11.3.3.1.1", "11.65536", "-1", "11.3 "}) {
    EXPECT_EQ(parse_firmware(text), std::nullopt) << text;
  }
}

TEST(Address, IsFourNumbersUpTo255) {
  for (const char* text : {"192.168.0.100", "0.0.0.0", "255.255.255.255"}) EXPECT_TRUE(is_ipv4(text)) << text;
  for (const char* text : {"", "192.168.0", "192.168.0.256", "192.168.0.1.1", "a.b.c.d", "192.168.0.-1", "1.2.3.",
                           "::1", "192.168.0.0001"}) {
    EXPECT_FALSE(is_ipv4(text)) << text;
  }
}

TEST(HostName, IsNoMistypedAddress) {
  for (const char* text : {"meca500", "robot-1.cell7.lan", "10.cell"}) EXPECT_TRUE(is_host_name(text)) << text;
  for (const char* text : {"", "192.168.0.256", "my robot", "-robot", "robot-", "a..b", "a_b", "robot."}) {
    EXPECT_FALSE(is_host_name(text)) << text;
  }
  EXPECT_TRUE(is_host_name(std::string(63, 'a')));
  EXPECT_FALSE(is_host_name(std::string(64, 'a')));
}

TEST(RobotName, HasOneTo63PlainCharacters) {
  EXPECT_TRUE(is_robot_name("a"));
  EXPECT_TRUE(is_robot_name("Arm_1-left"));
  EXPECT_TRUE(is_robot_name(std::string(63, 'x')));
  EXPECT_FALSE(is_robot_name(std::string(64, 'x')));
  for (const char* text : {"", "arm 1", "arm.1", "arm/1", "\xC3\xA4"}) EXPECT_FALSE(is_robot_name(text)) << text;
}

TEST(InterfaceName, IsWhatLinuxTakes) {
  for (const char* text : {"eth0", "enp3s0f1", "br-lan", "abcdefghijklmno"})
    EXPECT_TRUE(is_interface_name(text)) << text;
  for (const char* text : {"", ".", "..", "eth 0", "dev/eth0", "abcdefghijklmnop"}) {
    EXPECT_FALSE(is_interface_name(text)) << text;
  }
}

TEST(StationName, IsLowerCaseLabels) {
  for (const char* text : {"meca500-1", "a", "cell7.meca500"}) EXPECT_TRUE(is_station_name(text)) << text;
  for (const char* text : {"", "Meca500", "meca_500", "-a", "a-", "a..b", "192.168.0.1"}) {
    EXPECT_FALSE(is_station_name(text)) << text;
  }
  EXPECT_FALSE(is_station_name(std::string(64, 'a')));
}

TEST(Nearest, FindsSlipsAndNothingElse) {
  constexpr std::array<std::string_view, 5> kWords{"address", "domain", "cycle", "type", "TargetJointSet"};
  EXPECT_EQ(nearest("adress", kWords), "address");
  EXPECT_EQ(nearest("domian", kWords), "domain");
  EXPECT_EQ(nearest("cylce", kWords), "cycle");
  EXPECT_EQ(nearest("typ", kWords), "type");
  EXPECT_EQ(nearest("targetjointset", kWords), "TargetJointSet");
  EXPECT_EQ(nearest("colour", kWords), "");
  EXPECT_EQ(nearest("", kWords), "");
  EXPECT_EQ(nearest(std::string(10'000, 'a'), kWords), "");
}

}  // namespace
