#include "transports/ethercat/sii.hpp"

#include <algorithm>

#include "transports/ethercat/registers.hpp"
#include "transports/wire/writer.hpp"

namespace meca::ethercat {
namespace {

constexpr std::size_t kCheckedBytes = 14, kSiiBytes = 2048;

// Words 0 to 6, ConfigData of the vendor's ESI: PDI, sync units, alias (word 4).
constexpr std::array<std::uint8_t, kCheckedBytes> kConfigData{0x80, 0x0E, 0x00, 0xCC, 0x88, 0x13, 0xF0,
                                                              0x00, 0x00, 0x00, 0x00, 0x80, 0x00, 0x00};

void begin_category(wire::Writer& out, sii::Category category, std::uint16_t words) noexcept {
  out.u16(static_cast<std::uint16_t>(category));
  out.u16(words);
}

// What the ESI says of mailbox and ports; no strings, so no names.
void write_general(wire::Writer& out) noexcept {
  begin_category(out, sii::Category::kGeneral, 16);
  out.zeros(5);
  out.u8(0x27);     // CoE: SDO, SDO information, PDO assignment, complete access
  out.zeros(5);     // no FoE, no EoE, nothing of the vendor
  out.u8(0x04);     // the mailbox repeats on request (DataLinkLayer)
  out.zeros(4);     // no E-bus current
  out.u16(0x0011);  // ports 0 and 1 are MII
  out.zeros(14);
}

void write_fmmus(wire::Writer& out) noexcept {
  begin_category(out, sii::Category::kFmmu, 2);
  out.u32(0x00030201);  // outputs, inputs, mailbox state
}

void write_sync_managers(wire::Writer& out) noexcept {
  constexpr std::array<std::uint16_t, 4> kLengths{kMailboxSize, kMailboxSize, 124, 60};  // the last two as on the robot
  begin_category(out, sii::Category::kSyncManager, 16);
  for (unsigned n = 0; n < kSyncManagers.size(); ++n) {
    out.u16(kSyncManagers[n].start);
    out.u16(kLengths[n]);
    out.u8(kSyncManagers[n].control);
    out.u8(0);
    out.u8(1);                                 // enabled
    out.u8(static_cast<std::uint8_t>(n + 1));  // mailbox out, mailbox in, outputs, inputs
  }
}

// inferred: which of the ESI's two modes the one entry is; the one with DC, as the other has nothing to say.
void write_dc(wire::Writer& out) noexcept {
  begin_category(out, sii::Category::kDc, 12);
  out.zeros(12);  // cycle time and shifts: the master's choice
  out.u16(1);     // SYNC1 factor
  out.u16(0x0300);
  out.u16(1);  // SYNC0 factor
  out.zeros(6);
}

}  // namespace

std::uint8_t sii_checksum(Bytes first_14_bytes) noexcept {
  unsigned crc = 0xFF;
  for (const std::byte byte : first_14_bytes) {
    crc ^= std::to_integer<unsigned>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1 ^ ((crc & 0x80) != 0 ? 0x07U : 0U)) & 0xFF;
  }
  return static_cast<std::uint8_t>(crc);
}

std::optional<SiiIdentity> parse_sii_identity(Bytes words) noexcept {
  if (words.size() < 2 * SiiIdentity::kWords) return std::nullopt;
  const auto at = [words](std::uint16_t word) { return wire::Reader(words.subspan(2U * word)); };
  const auto u16 = [&at](std::uint16_t word) { return at(word).u16(); };
  const auto u32 = [&at](std::uint16_t word) { return at(word).u32(); };
  SiiIdentity out;
  out.alias = u16(sii::kAlias);
  out.vendor = u32(sii::kVendor);
  out.product = u32(sii::kProduct);
  out.revision = u32(sii::kRevision);
  out.serial = u32(sii::kSerial);
  out.receive_mailbox = u16(sii::kMailbox);
  out.receive_mailbox_size = u16(sii::kMailbox + 1);
  out.send_mailbox = u16(sii::kMailbox + 2);
  out.send_mailbox_size = u16(sii::kMailbox + 3);
  out.protocols = u16(sii::kProtocols);
  out.checksum_right = (u16(sii::kChecksum) & 0xFF) == sii_checksum(words.first(kCheckedBytes));
  return out;
}

std::vector<std::byte> make_meca500_sii(std::uint16_t alias, std::uint32_t serial) {
  std::vector<std::byte> image(kSiiBytes, std::byte{0xFF});
  const auto from = [&image](std::uint16_t word) { return std::span(image).subspan(2U * word); };

  std::fill_n(image.begin(), 2 * sii::kCategories, std::byte{0});
  wire::Writer(from(0)).bytes(std::as_bytes(std::span(kConfigData)));
  wire::Writer(from(sii::kAlias)).u16(alias);
  wire::Writer(from(sii::kChecksum)).u16(sii_checksum(Bytes(image).first(kCheckedBytes)));

  wire::Writer identity(from(sii::kVendor));
  identity.u32(kMecademicVendor);
  identity.u32(kMeca500Product);
  identity.u32(kMeca500Revision);
  identity.u32(serial);

  wire::Writer mailbox(from(sii::kMailbox));  // no bootstrap mailbox before it
  for (unsigned n = 0; n < 2; ++n) {
    mailbox.u16(kSyncManagers[n].start);
    mailbox.u16(kSyncManagers[n].length);
  }
  mailbox.u16(sii::kCoe);

  wire::Writer size(from(sii::kSize));
  size.u16(kSiiBytes * 8 / 1024 - 1);  // KiBit - 1
  size.u16(1);                         // version of the format

  wire::Writer categories(from(sii::kCategories));
  write_general(categories);
  write_fmmus(categories);
  write_sync_managers(categories);
  write_dc(categories);
  return image;  // what is erased reads FFFFh: the end of the categories
}

}  // namespace meca::ethercat
