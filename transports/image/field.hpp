// What a row of the field table (field_table.hpp) is made of: type, position, CoE object, layouts, place in a struct.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "transports/image/image.hpp"

namespace meca::image {

enum class WireType : std::uint8_t { kBool, kUint16, kUdint, kReal, kSint, kUsint };  // IEC 61131-3 names

constexpr std::size_t width_in_bits(WireType type) noexcept {
  switch (type) {
    case WireType::kBool:
      return 1;
    case WireType::kSint:
    case WireType::kUsint:
      return 8;
    case WireType::kUint16:
      return 16;
    case WireType::kUdint:
    case WireType::kReal:
      return 32;
  }
  return 0;
}

// The set of layouts that have a field.
struct Layouts {
  std::uint8_t mask;
  constexpr bool has(Layout layout) const noexcept { return (mask >> static_cast<unsigned>(layout) & 1U) != 0; }
};
inline constexpr Layouts kOnly9{0b001}, kOnly10{0b010}, kUpTo10{0b011}, kFrom10{0b110}, kOnly11{0b100}, kAll{0b111};

// CANopen over EtherCAT: the object that a PDO maps.
struct CoeObject {
  std::uint16_t index;
  std::uint8_t sub;
  friend constexpr bool operator==(const CoeObject&, const CoeObject&) = default;
};

enum class Robots : std::uint8_t { kMeca500, kOthers };  // kOthers: the bit exists, the Meca500 leaves it 0

// Where a value lives in an image struct: one way to it for writing, one for reading.
template <class Image, class T>
struct Place {
  T& (*write)(Image&) noexcept;
  const T& (*read)(const Image&) noexcept;
};

template <class Image>
using AnyPlace = std::variant<Place<Image, bool>, Place<Image, std::uint16_t>, Place<Image, std::uint32_t>,
                              Place<Image, float>, Place<Image, std::int8_t>, Place<Image, std::uint8_t>>;

template <class Image>
struct Field {
  std::string_view section;  // the manual's word, as for the name
  std::string_view name;
  WireType type;
  std::uint16_t byte;
  std::uint8_t bit;  // of a BOOL, 0 = least significant; else 0
  CoeObject coe;     // in the oldest layout that has the field; see coe_object()
  Layouts layouts;
  std::string_view unit;
  AnyPlace<Image> place;
  Robots robots;

  constexpr std::size_t bits() const noexcept { return width_in_bits(type); }
  constexpr std::size_t first_bit() const noexcept { return 8U * byte + bit; }
};

// Bits without a meaning.
struct ReservedRange {
  std::uint16_t byte;
  std::uint8_t bit;
  std::uint16_t bits;
  Layouts layouts;

  constexpr std::size_t first_bit() const noexcept { return 8U * byte + bit; }
};

// The two kinds of rows.
template <class Image>
constexpr Field<Image> bit(std::string_view section, std::string_view name, std::uint16_t byte, std::uint8_t number,
                           CoeObject coe, Layouts layouts, Place<Image, bool> place,
                           Robots robots = Robots::kMeca500) noexcept {
  return {section, name, WireType::kBool, byte, number, coe, layouts, "", place, robots};
}

template <class Image, class T>
constexpr Field<Image> number(std::string_view section, std::string_view name, WireType type, std::uint16_t byte,
                              CoeObject coe, Layouts layouts, std::string_view unit, Place<Image, T> place,
                              Robots robots = Robots::kMeca500) noexcept {
  return {section, name, type, byte, 0, coe, layouts, unit, place, robots};
}

// at<&Inputs::dynamic_data, 2, &DynamicData::type_id>: the place at the end of member pointers and array indices.
namespace detail {

template <class Member>
struct OwnerOf;
template <class Owner, class T>
struct OwnerOf<T Owner::*> {
  using type = Owner;
};

template <auto Step, auto... Rest>
constexpr auto& follow(auto& object) noexcept {
  auto& next = [&object]() -> auto& {
    if constexpr (std::is_integral_v<decltype(Step)>) {
      return object[Step];
    } else {
      return object.*Step;
    }
  }
  ();
  if constexpr (sizeof...(Rest) == 0) {
    return next;
  } else {
    return follow<Rest...>(next);
  }
}

template <auto First, auto... Rest>
constexpr auto make_place() noexcept {
  using Image = typename OwnerOf<decltype(First)>::type;
  using T = std::remove_cvref_t<decltype(follow<First, Rest...>(std::declval<Image&>()))>;
  return Place<Image, T>{[](Image& image) noexcept -> T& { return follow<First, Rest...>(image); },
                         [](const Image& image) noexcept -> const T& { return follow<First, Rest...>(image); }};
}

}  // namespace detail

template <auto... Path>
inline constexpr auto at = detail::make_place<Path...>();

}  // namespace meca::image
