// The compiler's check of the field table: in every layout, fields and gaps tile the image without overlap or hole, and
// each field lies and fits where it says.
#include "transports/image/field_table.hpp"

#include <array>

namespace meca::image {
namespace {

// How often each bit is spoken for; one bit more, for everything that would stick out.
template <std::size_t kBits>
constexpr void claim(std::array<int, kBits + 1>& claims, std::size_t first, std::size_t bits) {
  for (std::size_t bit = first; bit < first + bits; ++bit) ++claims[bit < kBits ? bit : kBits];
}

template <std::size_t kBytes>
constexpr bool tiles(const auto& fields, const auto& gaps, Layout layout) {
  std::array<int, 8 * kBytes + 1> claims{};
  for (const auto& field : fields) {
    if (field.layouts.has(layout)) claim<8 * kBytes>(claims, field.first_bit(), field.bits());
  }
  for (const auto& gap : gaps) {
    if (gap.layouts.has(layout)) claim<8 * kBytes>(claims, gap.first_bit(), gap.bits);
  }
  for (std::size_t bit = 0; bit < 8 * kBytes; ++bit) {
    if (claims[bit] != 1) return false;
  }
  return claims[8 * kBytes] == 0;
}

template <class Image>
constexpr bool holds(const Field<Image>& field, WireType type) {
  const auto& place = field.place;
  switch (type) {
    case WireType::kBool:
      return std::holds_alternative<Place<Image, bool>>(place);
    case WireType::kUint16:  // the checkpoint, 32 bits before firmware 11, keeps its wider place
      return std::holds_alternative<Place<Image, std::uint16_t>>(place) ||
             std::holds_alternative<Place<Image, std::uint32_t>>(place);
    case WireType::kUdint:
      return std::holds_alternative<Place<Image, std::uint32_t>>(place);
    case WireType::kReal:
      return std::holds_alternative<Place<Image, float>>(place);
    case WireType::kSint:
      return std::holds_alternative<Place<Image, std::int8_t>>(place);
    case WireType::kUsint:
      return std::holds_alternative<Place<Image, std::uint8_t>>(place);
  }
  return false;
}

constexpr bool well_formed(const auto& fields) {
  for (const auto& field : fields) {
    if (!holds(field, field.type)) return false;
    if (field.bit > (field.type == WireType::kBool ? 7 : 0)) return false;
    if (field.section.empty() || field.name.empty()) return false;
  }
  return true;
}

static_assert(8 * kOutputSize == 480 && 8 * kInputSize == 2016);
static_assert(tiles<kOutputSize>(kOutputFields, kOutputReserved, Layout::kFirmware9));
static_assert(tiles<kOutputSize>(kOutputFields, kOutputReserved, Layout::kFirmware10));
static_assert(tiles<kOutputSize>(kOutputFields, kOutputReserved, Layout::kFirmware11));
static_assert(tiles<kInputSize>(kInputFields, kInputReserved, Layout::kFirmware9));
static_assert(tiles<kInputSize>(kInputFields, kInputReserved, Layout::kFirmware10));
static_assert(tiles<kInputSize>(kInputFields, kInputReserved, Layout::kFirmware11));
static_assert(well_formed(kOutputFields) && well_formed(kInputFields));
static_assert(!has_safety_section(Layout::kFirmware9) && has_safety_section(Layout::kFirmware10) &&
              has_safety_section(Layout::kFirmware11));

}  // namespace
}  // namespace meca::image
