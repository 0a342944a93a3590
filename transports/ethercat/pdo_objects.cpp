#include "transports/ethercat/pdo_objects.hpp"

#include <algorithm>
#include <array>

namespace meca::ethercat {
namespace {

using image::Layout;

// The PDOs of the ESI in the order of the image. Each begins where its first object lies and ends where the next
// begins.
struct Start {
  std::uint16_t pdo, object;
};
constexpr std::array kRx = std::to_array<Start>({{0x1600, 0x7200},
                                                 {0x1601, 0x7310},
                                                 {0x1602, 0x7305},
                                                 {0x1610, 0x7400},
                                                 {0x1611, 0x7410},
                                                 {0x1620, 0x7420},
                                                 {0x1621, 0x7421},
                                                 {0x1622, 0x7422},
                                                 {0x1623, 0x7423}});
constexpr std::array kTx = std::to_array<Start>({{0x1A00, 0x6010},
                                                 {0x1A01, 0x6015},
                                                 {0x1A02, 0x6030},
                                                 {0x1A03, 0x6031},
                                                 {0x1A08, 0x6046},
                                                 {0x1A09, 0x6050},
                                                 {0x1A0A, 0x6051},
                                                 {0x1A10, 0x6060},
                                                 {kSafetyPdo, 0x6065},
                                                 {0x1A20, 0x6070},
                                                 {0x1A21, 0x6071},
                                                 {0x1A22, 0x6072},
                                                 {0x1A23, 0x6073}});

template <std::size_t kSize>
constexpr std::array<std::uint16_t, kSize> indices(const std::array<Start, kSize>& starts) noexcept {
  std::array<std::uint16_t, kSize> out{};
  std::transform(starts.begin(), starts.end(), out.begin(), [](const Start& start) { return start.pdo; });
  return out;
}
constexpr auto kRxAssignment = indices(kRx);
constexpr auto kTxAssignment = indices(kTx);
constexpr auto kTxAssignmentWithoutSafety = [] {
  std::array<std::uint16_t, kTx.size() - 1> out{};
  std::copy_if(kTxAssignment.begin(), kTxAssignment.end(), out.begin(), [](auto index) { return index != kSafetyPdo; });
  return out;
}();

struct Piece {
  std::size_t first_bit, bits;
  image::CoeObject object;  // {0, 0}: a gap
};

// Fields and reserved bits of a layout in the order of the image. A bit that only other robots have is a gap of its
// own.
std::vector<Piece> pieces_of(const auto& fields, const auto& reserved, Layout layout) {
  std::vector<Piece> pieces;
  for (const auto& field : fields) {
    if (!field.layouts.has(layout)) continue;
    const bool mapped = field.robots == image::Robots::kMeca500;
    pieces.push_back({field.first_bit(), field.bits(), mapped ? coe_object(field, layout) : image::CoeObject{}});
  }
  for (const auto& gap : reserved) {
    if (gap.layouts.has(layout)) pieces.push_back({gap.first_bit(), gap.bits, {}});
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.first_bit < b.first_bit; });
  return pieces;
}

bool is_gap(MappingEntry entry) noexcept { return entry >> 8 == 0; }

// As the vendor's ESI does it: what follows the last object of a PDO is one gap, but none is wider than 32 bits. So on
// firmware 9 the bytes of the later safety section are three gaps behind the timestamp.
void join_last_gaps(std::vector<MappingEntry>& entries) {
  constexpr std::uint32_t kWidest = 32;
  std::uint32_t bits = 0;
  while (!entries.empty() && is_gap(entries.back())) {
    bits += bits_of(entries.back());
    entries.pop_back();
  }
  for (; bits > 0; bits -= std::min(bits, kWidest)) entries.push_back(std::min(bits, kWidest));
}

template <std::size_t kSize>
std::vector<Pdo> pdos(const std::array<Start, kSize>& starts, const std::vector<Piece>& pieces) {
  std::vector<Pdo> out;
  for (const Piece& piece : pieces) {
    const image::CoeObject object = piece.object;
    const auto start = std::find_if(starts.begin(), starts.end(),
                                    [&object](const Start& candidate) { return candidate.object == object.index; });
    if (start != starts.end() && (out.empty() || out.back().index != start->pdo)) out.push_back({start->pdo, {}});
    out.back().entries.push_back(static_cast<MappingEntry>(object.index) << 16 | MappingEntry{object.sub} << 8 |
                                 static_cast<MappingEntry>(piece.bits));
  }
  for (auto& pdo : out) join_last_gaps(pdo.entries);
  return out;
}

}  // namespace

std::uint32_t Pdo::bits() const noexcept {
  std::uint32_t sum = 0;
  for (const MappingEntry entry : entries) sum += bits_of(entry);
  return sum;
}

std::vector<Pdo> rx_pdos(Layout layout) {
  return pdos(kRx, pieces_of(image::kOutputFields, image::kOutputReserved, layout));
}

std::vector<Pdo> tx_pdos(Layout layout) {
  return pdos(kTx, pieces_of(image::kInputFields, image::kInputReserved, layout));
}

std::span<const std::uint16_t> rx_assignment() noexcept { return kRxAssignment; }

std::span<const std::uint16_t> tx_assignment(bool safety) noexcept {
  if (safety) return kTxAssignment;
  return kTxAssignmentWithoutSafety;
}

}  // namespace meca::ethercat
