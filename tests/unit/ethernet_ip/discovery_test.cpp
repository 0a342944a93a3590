#include "transports/ethernet_ip/discovery.hpp"

#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/golden_messages.hpp"

namespace meca::ethernet_ip {
namespace {

using namespace std::chrono_literals;
using test::from_hex;
using test::to_hex;

constexpr std::uint32_t kFirst = 0xC0A80064, kSecond = 0xC0A80065;

// A reply of the device of golden::kListedIdentity; `serial` in its place.
std::vector<std::byte> reply(std::uint32_t serial = 123456789, std::uint8_t state = 0x03) {
  auto bytes = from_hex("63002F00", kHeaderSize);
  const auto data = from_hex(test::golden::kListedIdentity);
  bytes.insert(bytes.end(), data.begin(), data.end());
  for (std::size_t i = 0; i < 4; ++i) bytes[kHeaderSize + 34 + i] = static_cast<std::byte>(serial >> (8 * i));
  bytes.back() = static_cast<std::byte>(state);
  return bytes;
}

TEST(ListIdentityRequest, IsAHeaderThatTellsHowLongADeviceMayTake) {
  EXPECT_EQ(to_hex(list_identity_request(0ms)), "630000000000000000000000000000000000000000000000");
  EXPECT_EQ(to_hex(list_identity_request(500ms)), "630000000000000000000000F40100000000000000000000");
  EXPECT_EQ(to_hex(list_identity_request(2000ms)), "630000000000000000000000D00700000000000000000000");
  EXPECT_EQ(to_hex(list_identity_request(100'000ms)), "630000000000000000000000FFFF00000000000000000000");
}

TEST(Discovery, FindsAMeca500ByVendorTypeAndProduct) {
  Discovery discovery;
  EXPECT_TRUE(discovery.devices().empty());
  EXPECT_TRUE(discovery.received(kFirst, reply()));
  ASSERT_EQ(discovery.devices().size(), 1u);
  const FoundDevice& device = discovery.devices()[0];
  EXPECT_TRUE(is_meca500(device.identity));
  EXPECT_EQ(device.identity.name(), "Meca500");
  EXPECT_EQ(device.identity.serial_number, 123456789u);
  EXPECT_EQ(device.identity.major, 11);
  EXPECT_EQ(device.identity.minor, 3);
  EXPECT_EQ(device.identity.state, 3);

  for (auto Identity::*part : {&Identity::vendor_id, &Identity::device_type, &Identity::product_code}) {
    Identity other = device.identity;
    ++(other.*part);
    EXPECT_FALSE(is_meca500(other));
  }
}

TEST(Discovery, GoesByTheSenderAndKeepsWhatTheDeviceBelievesAsAHint) {
  Discovery discovery;
  discovery.received(kFirst, reply());
  EXPECT_EQ(discovery.devices()[0].addresses, std::vector{kFirst});
  EXPECT_EQ(discovery.devices()[0].claimed, (SocketAddress{0xAC1C0103, 44818}));
}

TEST(Discovery, TakesADeviceThatAnswersTwiceForOne) {
  Discovery discovery;
  EXPECT_TRUE(discovery.received(kFirst, reply(7, 2)));
  EXPECT_TRUE(discovery.received(kFirst, reply(7, 3)));
  ASSERT_EQ(discovery.devices().size(), 1u);
  EXPECT_EQ(discovery.devices()[0].addresses, std::vector{kFirst});
  EXPECT_EQ(discovery.devices()[0].identity.state, 3) << "the newest";
}

TEST(Discovery, TakesADeviceWithTwoAddressesForOneAndNamesBoth) {
  Discovery discovery;
  discovery.received(kSecond, reply(7));
  discovery.received(kFirst, reply(7));
  ASSERT_EQ(discovery.devices().size(), 1u);
  EXPECT_EQ(discovery.devices()[0].addresses, (std::vector{kSecond, kFirst}));
}

TEST(Discovery, TellsTwoDevicesOfOneAddressApart) {
  Discovery discovery;
  discovery.received(kFirst, reply(7));
  discovery.received(kFirst, reply(8));
  EXPECT_EQ(discovery.devices().size(), 2u);
}

TEST(Discovery, TellsDevicesWithoutSerialNumberApartByAddress) {
  Discovery discovery;
  discovery.received(kFirst, reply(0));
  discovery.received(kSecond, reply(0));
  discovery.received(kSecond, reply(0));
  EXPECT_EQ(discovery.devices().size(), 2u);
}

TEST(Discovery, SortsByAddress) {
  Discovery discovery;
  discovery.received(kSecond, reply(1));
  discovery.received(kFirst, reply(2));
  EXPECT_EQ(discovery.devices()[0].addresses.front(), kFirst);
  EXPECT_EQ(discovery.devices()[1].addresses.front(), kSecond);
}

TEST(Discovery, PassesOverWhatIsNoAnswer) {
  Discovery discovery;
  const auto whole = reply();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(discovery.received(kFirst, wire::Bytes(whole).first(size))) << size << " bytes";
  }
  auto other_command = whole;
  other_command[0] = std::byte{0x04};
  EXPECT_FALSE(discovery.received(kFirst, other_command));
  auto refused = whole;
  refused[8] = std::byte{0x01};
  EXPECT_FALSE(discovery.received(kFirst, refused));
  EXPECT_FALSE(discovery.received(kFirst, list_identity_request(0ms))) << "another asker's broadcast";
  EXPECT_TRUE(discovery.devices().empty());
}

TEST(DeviceState, IsAWord) {
  EXPECT_EQ(device_state_text(3), "operational");
  EXPECT_EQ(device_state_text(5), "major unrecoverable fault");
  EXPECT_EQ(device_state_text(0), "not told");
  EXPECT_EQ(device_state_text(0xFF), "not told");
  EXPECT_EQ(device_state_text(77), "unknown");
}

}  // namespace
}  // namespace meca::ethernet_ip
