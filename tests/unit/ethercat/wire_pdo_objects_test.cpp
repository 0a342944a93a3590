// The PDO objects against the vendor's ESI (skipped, visibly, where it is not), and golden entries of each firmware.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/unit/ethercat/wire_golden.hpp"
#include "tests/unit/image/esi.hpp"
#include "tests/unit/image/support.hpp"
#include "transports/ethercat/mailbox.hpp"
#include "transports/ethercat/pdo_objects.hpp"

namespace meca::ethercat {
namespace {

using image::Layout;
using testing::ElementsAre;
using testing::ElementsAreArray;

constexpr Layout kLayouts[] = {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11};

const Pdo& find(const std::vector<Pdo>& pdos, std::uint16_t index) {
  for (const Pdo& pdo : pdos) {
    if (pdo.index == index) return pdo;
  }
  throw std::out_of_range("no such PDO");
}

std::uint32_t bits(const std::vector<Pdo>& pdos) {
  std::uint32_t sum = 0;
  for (const Pdo& pdo : pdos) sum += pdo.bits();
  return sum;
}

std::vector<std::uint16_t> indices(const std::vector<Pdo>& pdos) {
  std::vector<std::uint16_t> out;
  for (const Pdo& pdo : pdos) out.push_back(pdo.index);
  return out;
}

TEST(PdoObjects, TileOutputsAndInputsOfEveryFirmware) {
  for (const Layout layout : kLayouts) {
    EXPECT_EQ(bits(rx_pdos(layout)), 8 * image::kOutputSize) << to_string(layout);
    EXPECT_EQ(bits(tx_pdos(layout)), 8 * image::kInputSize) << to_string(layout);
  }
}

TEST(PdoObjects, AreAssignedInTheOrderOfTheImage) {
  EXPECT_THAT(rx_assignment(), ElementsAre(0x1600, 0x1601, 0x1602, 0x1610, 0x1611, 0x1620, 0x1621, 0x1622, 0x1623));
  EXPECT_THAT(tx_assignment(true), ElementsAre(0x1A00, 0x1A01, 0x1A02, 0x1A03, 0x1A08, 0x1A09, 0x1A0A, 0x1A10, 0x1A11,
                                               0x1A20, 0x1A21, 0x1A22, 0x1A23));
  EXPECT_THAT(tx_assignment(false), ElementsAre(0x1A00, 0x1A01, 0x1A02, 0x1A03, 0x1A08, 0x1A09, 0x1A0A, 0x1A10, 0x1A20,
                                                0x1A21, 0x1A22, 0x1A23));
  for (const Layout layout : kLayouts) {
    EXPECT_THAT(indices(rx_pdos(layout)), ElementsAreArray(rx_assignment()));
    EXPECT_THAT(indices(tx_pdos(layout)), ElementsAreArray(tx_assignment(has_safety_section(layout))));
  }
}

TEST(PdoObjects, MapBitsNumbersAndGaps) {
  const auto outputs = rx_pdos(Layout::kFirmware10);
  EXPECT_THAT(find(outputs, 0x1600).entries, ElementsAre(0x72000101, 0x72000201, 0x72000301, 0x72000401, 0x72000501,
                                                         0x72000601, 0x72000701, 0x00000019));
  EXPECT_THAT(find(outputs, 0x1602).entries,
              ElementsAre(0x73050020, 0x73060120, 0x73060220, 0x73060320, 0x73060420, 0x73060520, 0x73060620));
  EXPECT_THAT(find(outputs, 0x1623).entries, ElementsAre(0x74230120));
  EXPECT_THAT(find(tx_pdos(Layout::kFirmware10), 0x1A00).entries,
              ElementsAre(0x60100201, 0x60100301, 0x60100401, 0x60100501, 0x60100601, 0x60100701, 0x60100801,
                          0x60100901, 0x60100A01, 0x00000007, 0x60100110));
}

TEST(PdoObjects, OnFirmware9TheBytesOfTheLaterSafetySectionAreGapsBehindTheTimestamp) {
  EXPECT_THAT(find(tx_pdos(Layout::kFirmware9), 0x1A10).entries,
              ElementsAre(0x60600120, 0x60600220, 0x60600320, 0x00000020, 0x00000020, 0x00000020));
  EXPECT_THAT(find(tx_pdos(Layout::kFirmware10), 0x1A10).entries, ElementsAre(0x60600120, 0x60600220, 0x60600320));
}

TEST(PdoObjects, OnFirmware11TheSecondCheckpointMovesTheRestUp) {
  EXPECT_THAT(find(tx_pdos(Layout::kFirmware11), 0x1A01).entries,
              ElementsAre(0x60150110, 0x60150210, 0x60150310, 0x60150410, 0x60150601, 0x60150701, 0x60150801,
                          0x60150901, 0x60150A01, 0x60150B01, 0x0000000A, 0x60150510));
}

// An SOES device with the vendor's 10.2.1 dictionary, read whole by SOEM: subindex 0 padded to 2 bytes, then entries.
TEST(PdoObjects, TheSafetyMappingIsTheOneThatADeviceWithTheVendorsDictionaryGives) {
  std::vector<std::byte> object;
  for (const auto golden : {golden::kSafetyMapping, golden::kSafetyMappingLast}) {
    const auto memory = golden::from_hex(golden);
    const auto sdo = parse_sdo(CoeService::kSdoResponse, Bytes(memory).subspan(kMailboxHeader + kCoeHeader));
    ASSERT_TRUE(sdo);
    object.insert(object.end(), sdo->data.begin(), sdo->data.end());
  }
  wire::Reader in(object);
  std::vector<MappingEntry> entries(in.u16());
  for (MappingEntry& entry : entries) entry = in.u32();
  EXPECT_TRUE(in.ok());
  EXPECT_EQ(in.remaining(), 0U);
  EXPECT_EQ(entries, find(tx_pdos(Layout::kFirmware10), kSafetyPdo).entries);
}

// ---- The vendor's ESI

std::vector<Pdo> esi_pdos(const std::string& xml, const std::string& direction) {
  using image::test::element, image::test::elements, image::test::number_of;
  std::vector<Pdo> out;
  for (const auto& pdo : elements(xml, direction)) {
    out.push_back({static_cast<std::uint16_t>(number_of(element(pdo, "Index"))), {}});
    for (const auto& entry : elements(pdo, "Entry")) {
      const auto sub = element(entry, "SubIndex");
      out.back().entries.push_back(number_of(element(entry, "Index")) << 16 | (sub.empty() ? 0 : number_of(sub)) << 8 |
                                   number_of(element(entry, "BitLen")));
    }
  }
  return out;
}

void expect_same(const std::vector<Pdo>& ours, const std::vector<Pdo>& esi) {
  ASSERT_FALSE(esi.empty());
  ASSERT_EQ(indices(ours), indices(esi));
  for (std::size_t i = 0; i < esi.size(); ++i) {
    EXPECT_EQ(ours[i].entries, esi[i].entries) << std::hex << "PDO " << esi[i].index;
  }
}

void expect_esi(const std::string& xml, Layout layout) {
  expect_same(rx_pdos(layout), esi_pdos(xml, "RxPdo"));
  expect_same(tx_pdos(layout), esi_pdos(xml, "TxPdo"));
}

TEST(PdoObjectsAndVendor, Firmware9IsAsTheEsi933HasIt) {
  MECA_SHARED_OR_SKIP(file, "esi/Meca500_EtherCAT_ESI_v9.3.3.5809_device.xml");
  expect_esi(image::test::contents(file), Layout::kFirmware9);
}

TEST(PdoObjectsAndVendor, Firmware10IsAsTheEsi1021HasIt) {
  MECA_SHARED_OR_SKIP(file, "esi/Meca500_EtherCAT_ESI_v10.2.1.8120_device.xml");
  expect_esi(image::test::contents(file), Layout::kFirmware10);
}

}  // namespace
}  // namespace meca::ethercat
