// The slave information (SII, the "EEPROM"): words that say who a device is and how its mailbox lies (ETG.1000.6, 5.4;
// ETG.2010; spec 5.4).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "transports/ethercat/frame.hpp"

namespace meca::ethercat {

namespace sii {
// Word addresses.
inline constexpr std::uint16_t kAlias = 0x04, kChecksum = 0x07, kVendor = 0x08, kProduct = 0x0A, kRevision = 0x0C,
                               kSerial = 0x0E, kMailbox = 0x18, kProtocols = 0x1C, kSize = 0x3E, kCategories = 0x40;
inline constexpr std::uint16_t kCoe = 0x0004;  // of the protocols
enum class Category : std::uint16_t {
  kStrings = 10,
  kGeneral = 30,
  kFmmu = 40,
  kSyncManager = 41,
  kTxPdo = 50,
  kRxPdo = 51,
  kDc = 60,
  kEnd = 0xFFFF
};
}  // namespace sii

// CRC-8 of words 0 to 6 (polynomial 0x07, initial 0xFF); stands in the low byte of word 7.
std::uint8_t sii_checksum(Bytes first_14_bytes) noexcept;

// Words 0 to 1Fh: everything a master of this robot needs to know of a device before it talks to it.
struct SiiIdentity {
  static constexpr std::size_t kWords = 0x20;
  std::uint16_t alias = 0;
  std::uint32_t vendor = 0, product = 0, revision = 0, serial = 0;
  std::uint16_t receive_mailbox = 0, receive_mailbox_size = 0;  // standard mailbox, master -> device
  std::uint16_t send_mailbox = 0, send_mailbox_size = 0;
  std::uint16_t protocols = 0;
  bool checksum_right = false;
  friend bool operator==(const SiiIdentity&, const SiiIdentity&) = default;
};
// Empty for fewer than 2 x kWords bytes.
std::optional<SiiIdentity> parse_sii_identity(Bytes words) noexcept;

// The image of a Meca500 as a real one has it [ROBOT, spec 5.4]: categories 30, 40, 41 and 60 only, and wrong default
// lengths in 41 (124 and 60). `serial` 0 is what is not published. 2048 bytes, valid checksum.
std::vector<std::byte> make_meca500_sii(std::uint16_t alias, std::uint32_t serial);

}  // namespace meca::ethercat
