#include "transports/image/codec.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>
#include <utility>

#include "transports/image/field_table.hpp"

namespace meca::image {
namespace {

// One function per layout and byte order, each unrolled from the table: positions and types are constants in it.

template <class T>
constexpr T swap_bytes(T value) noexcept {
  if constexpr (sizeof(T) == 1) {
    return value;
  } else if constexpr (sizeof(T) == 2) {
    return static_cast<T>(value << 8 | value >> 8);
  } else {
    static_assert(sizeof(T) == 4);
    return value << 24 | (value & 0xFF00U) << 8 | (value >> 8 & 0xFF00U) | value >> 24;
  }
}

template <class T, std::endian kOrder>
T load(const std::byte* bytes) noexcept {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return kOrder == std::endian::native ? value : swap_bytes(value);
}

template <class T, std::endian kOrder>
void store(T value, std::byte* bytes) noexcept {
  if (kOrder != std::endian::native) value = swap_bytes(value);
  std::memcpy(bytes, &value, sizeof value);
}

// The unsigned integer that carries a type's bits.
template <WireType kType>
auto carrier() noexcept {
  if constexpr (width_in_bits(kType) == 8) {
    return std::uint8_t{};
  } else if constexpr (width_in_bits(kType) == 16) {
    return std::uint16_t{};
  } else {
    return std::uint32_t{};
  }
}
template <WireType kType>
using Carrier = decltype(carrier<kType>());

template <const auto& kFields, std::size_t kIndex, std::endian kOrder>
void decode_field(const std::byte* bytes, auto& image) noexcept {
  constexpr auto& kField = kFields[kIndex];
  constexpr auto kPlace = std::get<kField.place.index()>(kField.place);
  auto& value = kPlace.write(image);
  if constexpr (kField.type == WireType::kBool) {
    value = (bytes[kField.byte] & std::byte{1U << kField.bit}) != std::byte{};
  } else {
    using Value = std::remove_reference_t<decltype(value)>;
    const auto raw = load<Carrier<kField.type>, kOrder>(bytes + kField.byte);
    if constexpr (kField.type == WireType::kReal) {
      value = std::bit_cast<float>(raw);  // not through arithmetic: a NaN keeps its payload
    } else {
      value = static_cast<Value>(raw);
    }
  }
}

template <const auto& kFields, std::size_t kIndex, std::endian kOrder>
void encode_field(const auto& image, std::byte* bytes) noexcept {
  constexpr auto& kField = kFields[kIndex];
  constexpr auto kPlace = std::get<kField.place.index()>(kField.place);
  const auto& value = kPlace.read(image);
  if constexpr (kField.type == WireType::kBool) {
    bytes[kField.byte] |= std::byte{value} << kField.bit;
  } else if constexpr (kField.type == WireType::kReal) {
    store<std::uint32_t, kOrder>(std::bit_cast<std::uint32_t>(value), bytes + kField.byte);
  } else {
    store<Carrier<kField.type>, kOrder>(static_cast<Carrier<kField.type>>(value), bytes + kField.byte);
  }
}

template <const auto& kFields, Layout kLayout, std::endian kOrder>
void decode_all(const std::byte* bytes, auto& image) noexcept {
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    const auto one = [&]<std::size_t kOne>() {
      if constexpr (kFields[kOne].layouts.has(kLayout)) decode_field<kFields, kOne, kOrder>(bytes, image);
    };
    (one.template operator()<kIndex>(), ...);
  }
  (std::make_index_sequence<kFields.size()>{});
}

template <const auto& kFields, Layout kLayout, std::endian kOrder>
void encode_all(const auto& image, std::byte* bytes) noexcept {
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    const auto one = [&]<std::size_t kOne>() {
      if constexpr (kFields[kOne].layouts.has(kLayout)) encode_field<kFields, kOne, kOrder>(image, bytes);
    };
    (one.template operator()<kIndex>(), ...);
  }
  (std::make_index_sequence<kFields.size()>{});
}

// Calls body.operator()<layout, order>() for a format known only at run time.
template <std::endian kOrder>
void with_layout(Layout layout, auto&& body) noexcept {
  switch (layout) {
    case Layout::kFirmware9:
      return body.template operator()<Layout::kFirmware9, kOrder>();
    case Layout::kFirmware10:
      return body.template operator()<Layout::kFirmware10, kOrder>();
    case Layout::kFirmware11:
      return body.template operator()<Layout::kFirmware11, kOrder>();
  }
}

void with_format(Format format, auto&& body) noexcept {
  if (format.byte_order == std::endian::big) return with_layout<std::endian::big>(format.layout, body);
  with_layout<std::endian::little>(format.layout, body);
}

constexpr std::array<std::byte, kOutputSize> reserved_bits(Layout layout) noexcept {
  std::array<std::byte, kOutputSize> mask{};
  for (const ReservedRange& range : kOutputReserved) {
    if (!range.layouts.has(layout)) continue;
    for (std::size_t bit = range.first_bit(); bit < range.first_bit() + range.bits; ++bit) {
      mask[bit / 8] |= std::byte{1} << (bit % 8);
    }
  }
  return mask;
}
constexpr std::array kReservedBits{reserved_bits(Layout::kFirmware9), reserved_bits(Layout::kFirmware10),
                                   reserved_bits(Layout::kFirmware11)};

}  // namespace

Inputs decode_inputs(std::span<const std::byte, kInputSize> bytes, Format format) noexcept {
  Inputs inputs;
  with_format(format, [&]<Layout kLayout, std::endian kOrder>() {
    decode_all<kInputFields, kLayout, kOrder>(bytes.data(), inputs);
    inputs.safety_status.known = has_safety_section(kLayout);
  });
  return inputs;
}

Outputs decode_outputs(std::span<const std::byte, kOutputSize> bytes, Format format) noexcept {
  Outputs outputs;
  with_format(format, [&]<Layout kLayout, std::endian kOrder>() {
    decode_all<kOutputFields, kLayout, kOrder>(bytes.data(), outputs);
  });
  return outputs;
}

void encode_inputs(const Inputs& inputs, Format format, std::span<std::byte, kInputSize> bytes) noexcept {
  std::ranges::fill(bytes, std::byte{});
  with_format(format, [&]<Layout kLayout, std::endian kOrder>() {
    encode_all<kInputFields, kLayout, kOrder>(inputs, bytes.data());
  });
}

void encode_outputs(const Outputs& outputs, Format format, std::span<std::byte, kOutputSize> bytes) noexcept {
  std::ranges::fill(bytes, std::byte{});
  with_format(format, [&]<Layout kLayout, std::endian kOrder>() {
    encode_all<kOutputFields, kLayout, kOrder>(outputs, bytes.data());
  });
}

bool sets_reserved_bits(std::span<const std::byte, kOutputSize> outputs, Layout layout) noexcept {
  const auto& mask = kReservedBits[static_cast<std::size_t>(layout)];
  std::byte set{};
  for (std::size_t i = 0; i < kOutputSize; ++i) set |= outputs[i] & mask[i];
  return set != std::byte{};
}

}  // namespace meca::image
