// The SII: words of independent devices, the vendor's configuration data, and the image of our robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "tests/unit/ethercat/wire_golden.hpp"
#include "transports/ethercat/registers.hpp"
#include "transports/ethercat/sii.hpp"

namespace meca::ethercat {
namespace {

using golden::from_hex;
using testing::ElementsAre;
using testing::Pair;

// kickcat, frames 49 to 240: KickCAT reads words 0 to 1Fh of an SOES device, two at a time.
constexpr std::string_view kSoesDevice =
    "08 0C 00 6E 00 00 00 00 00 00 00 00 00 00 69 00 E1 AD EC 00 00 D5 04 00 01 00 00 00 39 30 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 10 80 00 80 10 80 00 04 00 00 00 00 00 00 00";
// ConfigData of the vendor's ESI, every firmware: words 0 to 6.
constexpr std::string_view kConfigData = "80 0E 00 CC 88 13 F0 00 00 00 00 80 00 00";

TEST(Sii, TheChecksumIsTheOneThatDevicesHave) {
  EXPECT_EQ(sii_checksum(from_hex(kSoesDevice.substr(0, 3 * 14))), 0x69);
  EXPECT_EQ(sii_checksum({}), 0xFF);
}

TEST(Sii, TheWordsOfADeviceSayWhoItIsAndWhereItsMailboxLies) {
  const auto identity = parse_sii_identity(from_hex(kSoesDevice));
  ASSERT_TRUE(identity);
  const SiiIdentity expected{.alias = 0,
                             .vendor = kMecademicVendor,
                             .product = kMeca500Product,
                             .revision = kMeca500Revision,
                             .serial = 12345,
                             .receive_mailbox = 0x1000,
                             .receive_mailbox_size = 128,
                             .send_mailbox = 0x1080,
                             .send_mailbox_size = 128,
                             .protocols = sii::kCoe,
                             .checksum_right = true};
  EXPECT_EQ(*identity, expected);
}

TEST(Sii, TheTwoMailboxesMayDiffer) {
  auto words = from_hex(kSoesDevice);
  words[2 * (sii::kMailbox + 3)] = std::byte{64};
  const auto identity = parse_sii_identity(words);
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->receive_mailbox_size, 128);
  EXPECT_EQ(identity->send_mailbox_size, 64);
}

TEST(Sii, AChangedWordMakesTheChecksumWrongAndIsReadAllTheSame) {
  auto words = from_hex(kSoesDevice);
  words[2 * sii::kAlias] = std::byte{7};
  const auto identity = parse_sii_identity(words);
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->alias, 7);
  EXPECT_FALSE(identity->checksum_right);
}

TEST(Sii, FewerWordsAreNoIdentity) {
  const auto words = from_hex(kSoesDevice);
  for (std::size_t size = 0; size < words.size(); ++size) EXPECT_FALSE(parse_sii_identity(Bytes(words).first(size)));
}

TEST(SiiOfTheRobot, BeginsWithTheVendorsConfigurationData) {
  const auto image = make_meca500_sii(0, 0);
  EXPECT_EQ(image.size(), 2048U);
  EXPECT_TRUE(std::ranges::equal(Bytes(image).first(14), from_hex(kConfigData)));
  EXPECT_TRUE(std::ranges::equal(Bytes(image).subspan(2 * sii::kSize, 4), from_hex("0F 00 01 00"))) << "16 KiBit";
}

TEST(SiiOfTheRobot, SaysWhoItIsWithTheAliasInTheChecksum) {
  for (const std::uint16_t alias : {std::uint16_t{0}, std::uint16_t{0x1234}}) {
    const auto identity = parse_sii_identity(make_meca500_sii(alias, 77));
    ASSERT_TRUE(identity);
    EXPECT_TRUE(identity->checksum_right);
    EXPECT_EQ(identity->alias, alias);
    EXPECT_EQ(identity->vendor, kMecademicVendor);
    EXPECT_EQ(identity->product, kMeca500Product);
    EXPECT_EQ(identity->revision, kMeca500Revision);
    EXPECT_EQ(identity->serial, 77U);
    EXPECT_EQ(identity->receive_mailbox, 0x1000);
    EXPECT_EQ(identity->send_mailbox, 0x1080);
    EXPECT_EQ(identity->send_mailbox_size, kMailboxSize);
    EXPECT_EQ(identity->protocols, sii::kCoe);
  }
}

std::map<std::uint16_t, std::vector<std::byte>> categories(Bytes image) {
  std::map<std::uint16_t, std::vector<std::byte>> out;
  wire::Reader in(image.subspan(2 * sii::kCategories));
  for (auto type = in.u16(); type != static_cast<std::uint16_t>(sii::Category::kEnd); type = in.u16()) {
    const Bytes data = in.bytes(2U * in.u16());
    EXPECT_TRUE(in.ok()) << "category " << type << " ends outside of the image";
    if (!in.ok()) break;
    out[type].assign(data.begin(), data.end());
  }
  return out;
}

// As `ethercat pdos` and `ethercat sii_read` show a real one (spec 5.4): no strings, no PDOs, and lengths
// of sync managers 2 and 3 that nobody may trust.
TEST(SiiOfTheRobot, HasTheCategoriesOfARealOneWithItsWrongLengths) {
  const auto found = categories(make_meca500_sii(0, 0));
  std::vector<std::pair<std::uint16_t, std::size_t>> sizes;
  for (const auto& [type, data] : found) sizes.emplace_back(type, data.size() / 2);
  EXPECT_THAT(sizes, ElementsAre(Pair(30, 16), Pair(40, 2), Pair(41, 16), Pair(60, 12)));
  EXPECT_EQ(found.at(40), from_hex("01 02 03 00"));
  EXPECT_EQ(found.at(41), from_hex("00 10 80 00 26 00 01 01 80 10 80 00 22 00 01 02"
                                   "00 11 7C 00 64 00 01 03 00 14 3C 00 20 00 01 04"));
  EXPECT_EQ(found.at(60), from_hex("00 00 00 00 00 00 00 00 00 00 00 00 01 00 00 03 01 00 00 00 00 00 00 00"));
  EXPECT_EQ(found.at(30)[5], std::byte{0x27}) << "SDO, SDO information, PDO assignment, complete access";
}

}  // namespace
}  // namespace meca::ethercat
