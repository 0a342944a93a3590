// The PDOs of a Meca500 as objects: which are assigned (1C12h, 1C13h), what each maps (16xxh, 1Axxh), in the order in
// which they tile the 60 and 252 bytes. Everything follows from the field table (transports/image/field_table.hpp) and
// the list of PDO indices in the vendor's ESI.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transports/image/field_table.hpp"

namespace meca::ethercat {

inline constexpr std::uint16_t kRxPdoAssignment = 0x1C12, kTxPdoAssignment = 0x1C13, kSafetyPdo = 0x1A11;

// One entry of a mapping object: index << 16 | sub << 8 | bits; gaps have index and sub 0.
using MappingEntry = std::uint32_t;
constexpr std::uint8_t bits_of(MappingEntry entry) noexcept { return static_cast<std::uint8_t>(entry & 0xFF); }

struct Pdo {
  std::uint16_t index;  // 1600h.., 1A00h..
  std::vector<MappingEntry> entries;
  std::uint32_t bits() const noexcept;
};

// In the order of the image. 9 RxPDOs (480 bits); TxPDOs (2016 bits): 12 on firmware 9, 13 from 10 on. On firmware 9
// the 12 bytes of the later safety section are a gap at the end of 1A10h (as the ESI 9.3.3 has it; see the .cpp).
std::vector<Pdo> rx_pdos(image::Layout layout);
std::vector<Pdo> tx_pdos(image::Layout layout);

// The indices alone, without allocation. `safety`: the device has 1A11h, which is so from firmware 10 on.
std::span<const std::uint16_t> rx_assignment() noexcept;
std::span<const std::uint16_t> tx_assignment(bool safety) noexcept;

}  // namespace meca::ethercat
