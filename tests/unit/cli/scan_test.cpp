#include "cli/scan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/plan.hpp"

namespace meca::cli {
namespace {

using namespace std::chrono_literals;
using ethernet_ip::FoundDevice;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<net::Interface> kInterfaces{{"lo", 0x7F000001, 0xFF000000},
                                              {"eth0", 0x0A000005, 0xFFFF0000},
                                              {"eth1", 0xC0A80001, 0xFFFFFF00},
                                              {"eth1", 0xC0A80101, 0xFFFFFF00},
                                              {"tun0", 0x0A080002, 0xFFFFFFFF}};

std::vector<ScanTarget> targets(const std::vector<std::string>& interfaces, const std::string& address = "") {
  Invocation call;
  call.interfaces = interfaces;
  call.address = address;
  return scan_targets(call, kInterfaces);
}
std::string refusal(const std::vector<std::string>& interfaces, const std::string& address = "") {
  try {
    targets(interfaces, address);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "(understood)";
}

TEST(ScanTargets, AreTheBroadcastAddressesOfAnInterfaceByNameOrAddress) {
  EXPECT_THAT(targets({"eth0"}), ElementsAre(ScanTarget{"eth0", 0x0A000005, 0x0A00FFFF}));
  EXPECT_THAT(targets({"192.168.1.1"}), ElementsAre(ScanTarget{"eth1", 0xC0A80101, 0xC0A801FF}));
  EXPECT_THAT(targets({"eth1"}),
              ElementsAre(ScanTarget{"eth1", 0xC0A80001, 0xC0A800FF}, ScanTarget{"eth1", 0xC0A80101, 0xC0A801FF}));
}

TEST(ScanTargets, AreAllInterfacesWithNeighboursWhenNoneIsNamed) {
  EXPECT_THAT(targets({}),
              ElementsAre(ScanTarget{"eth0", 0x0A000005, 0x0A00FFFF}, ScanTarget{"eth1", 0xC0A80001, 0xC0A800FF},
                          ScanTarget{"eth1", 0xC0A80101, 0xC0A801FF}));
}

TEST(ScanTargets, AreOneWhenTheSameNetworkIsMeantTwice) { EXPECT_EQ(targets({"eth0", "10.0.0.5"}).size(), 1u); }

TEST(ScanTargets, AreTheAddressAloneFromTheInterfaceOrFromWhereTheSystemChooses) {
  EXPECT_THAT(targets({}, "192.168.0.100"), ElementsAre(ScanTarget{"", 0, 0xC0A80064}));
  EXPECT_THAT(targets({"eth0"}, "192.168.0.100"), ElementsAre(ScanTarget{"eth0", 0x0A000005, 0xC0A80064}));
}

TEST(ScanTargets, OfAnUnknownInterfaceListTheOnesThereAre) {
  EXPECT_EQ(refusal({"eth7"}),
            "there is no interface 'eth7' that is up and has an IPv4 address; there are: lo (127.0.0.1/8), eth0 "
            "(10.0.0.5/16), eth1 (192.168.0.1/24), eth1 (192.168.1.1/24), tun0 (10.8.0.2/32)");
  EXPECT_THAT(refusal({"eth0", "eth7"}), HasSubstr("'eth7'"));
  EXPECT_THAT(refusal({}, "192.168.0"), HasSubstr("'192.168.0' is no IPv4 address"));
  EXPECT_THAT(refusal({}, "0.0.0.0"), HasSubstr("is no IPv4 address"));
  try {
    scan_targets({}, std::span(kInterfaces).first(1));
    FAIL() << "the loopback alone was taken";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no interface to ask on"));
    EXPECT_THAT(error.what(), HasSubstr("lo (127.0.0.1/8)"));
  }
}

TEST(ScanWait, LeavesTheDevicesWhatIsLeftOfIt) {
  EXPECT_EQ(answer_delay(kScanWait), 2000ms);
  EXPECT_EQ(answer_delay(60s), 2000ms) << "no longer than devices take anyway";
  EXPECT_EQ(answer_delay(1s), 500ms);
  EXPECT_EQ(answer_delay(100ms), 1ms) << "0 would mean: as long as they like";
}

FoundDevice robot() {
  FoundDevice device;
  device.addresses = {0xC0A80064};
  device.claimed = {0xC0A80064, 44818};
  device.identity.vendor_id = 1565;
  device.identity.device_type = 43;
  device.identity.product_code = 500;
  device.identity.major = 11;
  device.identity.minor = 3;
  device.identity.serial_number = 123456789;
  device.identity.state = 3;
  device.identity.set_name("Meca500");
  return device;
}

FoundDevice stranger() {
  FoundDevice device;
  device.addresses = {0xC0A80065, 0xC0A80066};
  device.claimed = {0x0A000001, 44818};
  device.identity.vendor_id = 1;
  device.identity.device_type = 12;
  device.identity.product_code = 65001;
  device.identity.major = 2;
  device.identity.serial_number = 1;
  device.identity.set_name("\x1B[2Jcoupler");
  return device;
}

TEST(ScanText, IsATableThatMarksTheMeca500) {
  EXPECT_EQ(scan_text(std::vector{robot(), stranger()}),
            "ADDRESS                       NAME         VENDOR  TYPE  PRODUCT  REVISION  SERIAL     STATE        "
            "MECA500\n"
            "192.168.0.100                 Meca500      1565    43    500      11.3      123456789  operational  yes\n"
            "192.168.0.101, 192.168.0.102  ?[2Jcoupler  1       12    65001    2.0       1          not told     no\n"
            "2 devices, 1 Meca500\n");
  EXPECT_THAT(scan_text(std::vector{stranger()}), HasSubstr("1 device, no Meca500"));
}

TEST(ScanJson, HasEverythingTheDeviceSaid) {
  const auto json = to_json(stranger());
  EXPECT_EQ(json["addresses"], Json::array({"192.168.0.101", "192.168.0.102"}));
  EXPECT_EQ(json["claimed_address"], "10.0.0.1");
  EXPECT_EQ(json["vendor_id"], 1);
  EXPECT_EQ(json["revision"], "2.0");
  EXPECT_EQ(json["state"], "not told");
  EXPECT_EQ(json["meca500"], false);
  EXPECT_EQ(to_json(robot())["meca500"], true);
  EXPECT_THAT(one_line(json), Not(HasSubstr("\x1B"))) << "escaped";
}

TEST(NobodyAnswered, SaysWhomItAskedAndWhatToCheck) {
  const auto text = nobody_answered(targets({"eth0"}), 2500ms);
  EXPECT_THAT(text, HasSubstr("within 2.5 s (asked: 10.0.255.255 on eth0)"));
  EXPECT_THAT(text, HasSubstr("EtherNet/IP is enabled"));
  EXPECT_THAT(text, HasSubstr("firewall"));
  EXPECT_THAT(nobody_answered(targets({}, "192.168.0.100"), 1s), HasSubstr("within 1 s (asked: 192.168.0.100)"));
}

}  // namespace
}  // namespace meca::cli
