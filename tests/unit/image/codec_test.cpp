// Rules that hold for every image: each bit has one meaning or none, nothing is lost on the way, no value is bent.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/unit/image/support.hpp"
#include "transports/image/field_table.hpp"

namespace meca::image {
namespace {

using test::encoded;
using test::kFormats;
using test::name_of;

auto decoded(const InputBytes& bytes, Format format) { return decode_inputs(bytes, format); }
auto decoded(const OutputBytes& bytes, Format format) { return decode_outputs(bytes, format); }

template <class T>
bool same_bits(const T& a, const T& b) {
  if constexpr (std::is_same_v<T, float>) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
  } else {
    return a == b;
  }
}

// Members of the two structs that differ. Two rows may share a place (in different layouts): counted once.
template <class Image>
std::size_t differences(const auto& fields, Layout layout, const Image& a, const Image& b) {
  return static_cast<std::size_t>(std::ranges::count_if(fields, [&](const Field<Image>& field) {
    return field.layouts.has(layout) &&
           std::visit([&](const auto& place) { return !same_bits(place.read(a), place.read(b)); }, field.place);
  }));
}

template <std::size_t kBits>
bool is_reserved(const std::array<ReservedRange, kBits>& gaps, Layout layout, std::size_t bit) {
  return std::ranges::any_of(gaps, [&](const ReservedRange& gap) {
    return gap.layouts.has(layout) && bit >= gap.first_bit() && bit < gap.first_bit() + gap.bits;
  });
}

// Sets each bit alone and expects it back where it means something, and exactly one field changed; else nothing at all.
// Returns how many bits mean something.
template <class Bytes>
std::size_t walk_bits(const auto& fields, const auto& gaps, Format format) {
  const auto nothing = decoded(Bytes{}, format);
  std::size_t meaningful = 0;
  for (std::size_t bit = 0; bit < 8 * Bytes{}.size(); ++bit) {
    Bytes bytes{};
    bytes[bit / 8] = std::byte{1} << (bit % 8);
    const auto image = decoded(bytes, format);
    const bool reserved = is_reserved(gaps, format.layout, bit);
    EXPECT_EQ(encoded(image, format), reserved ? Bytes{} : bytes) << name_of(format) << ", bit " << bit;
    EXPECT_EQ(differences(fields, format.layout, image, nothing), reserved ? 0U : 1U)
        << name_of(format) << ", bit " << bit;
    meaningful += reserved ? 0 : 1;
  }
  return meaningful;
}

TEST(Codec, EveryOutputBitComesBackInOneFieldOrIsReserved) {
  // 480 less the reserved bits of the manual (25 + 11 + 30), of ESI 10.2.1 (25 + 12 + 30) and 9.3.3 (26 + 12 + 30).
  constexpr std::size_t kMeaningful[] = {412, 413, 414};
  for (const auto format : kFormats) {
    EXPECT_EQ(walk_bits<OutputBytes>(kOutputFields, kOutputReserved, format),
              kMeaningful[static_cast<std::size_t>(format.layout)]);
  }
}

TEST(Codec, EveryInputBitComesBackInOneFieldOrIsReserved) {
  // 2016 less the reserved bits: 11.3 6 + 10 + (1 + 20 + 1 + 20 + 6 + 10); 10.2.1 one more; 9.3.3 9 + 9 + 96.
  constexpr std::size_t kMeaningful[] = {1902, 1941, 1942};
  for (const auto format : kFormats) {
    EXPECT_EQ(walk_bits<InputBytes>(kInputFields, kInputReserved, format),
              kMeaningful[static_cast<std::size_t>(format.layout)]);
  }
}

TEST(Codec, FieldsOfOtherLayoutsStayZero) {
  InputBytes ones;
  ones.fill(std::byte{0xFF});
  const auto v9 = decode_inputs(ones, {Layout::kFirmware9});
  EXPECT_FALSE(v9.robot_status.collision_status || v9.robot_status.work_zone_status || v9.robot_status.monitoring_mode);
  EXPECT_TRUE(v9.motion_status.p_stop2_resettable);
  const auto v10 = decode_inputs(ones, {Layout::kFirmware10});
  EXPECT_TRUE(v10.robot_status.collision_status && v10.robot_status.work_zone_status);
  EXPECT_FALSE(v10.robot_status.monitoring_mode || v10.motion_status.p_stop2_resettable);
  EXPECT_EQ(v10.motion_status.checkpoint_reached, 0xFFFFFFFFU);
  EXPECT_EQ(v10.motion_status.checkpoint_discarded, 0);
  const auto v11 = decode_inputs(ones, {Layout::kFirmware11});
  EXPECT_TRUE(v11.robot_status.monitoring_mode);
  EXPECT_EQ(v11.motion_status.checkpoint_reached, 0xFFFFU);
  EXPECT_EQ(v11.motion_status.checkpoint_discarded, 0xFFFF);
}

// The safety rule of this file: an image that cannot know about stops must never look like one without stops.
TEST(Codec, AnImageOfFirmware9NeverClaimsThatThereIsNoSafetyStop) {
  for (const auto order : {std::endian::little, std::endian::big}) {
    for (const int filling : {0x00, 0xFF}) {
      InputBytes bytes;
      bytes.fill(static_cast<std::byte>(filling));
      const auto safety = decode_inputs(bytes, {Layout::kFirmware9, order}).safety_status;
      EXPECT_EQ(safety, SafetyStatus{}) << "bytes 128 to 139 mean nothing in firmware 9";
      EXPECT_FALSE(safety.known);
    }
  }
  for (const auto layout : {Layout::kFirmware10, Layout::kFirmware11}) {
    EXPECT_TRUE(decode_inputs(InputBytes{}, {layout}).safety_status.known);
  }
}

TEST(Codec, WhatFirmware9CannotCarryIsNotSentToIt) {
  Outputs outputs;
  outputs.robot_control.disable_ethercat = true;
  outputs.motion_control.use_variables = true;
  EXPECT_EQ(encoded(outputs, {Layout::kFirmware9}), OutputBytes{});
  Inputs inputs;
  inputs.safety_status.known = true;
  inputs.safety_status.stop.e_stop = true;
  inputs.safety_status.vmotor_on = true;
  EXPECT_EQ(encoded(inputs, {Layout::kFirmware9}), InputBytes{});
}

TEST(Codec, EncodingLeavesNothingOfWhatTheBufferHeld) {
  for (const auto format : kFormats) {
    InputBytes inputs;
    inputs.fill(std::byte{0xA5});
    encode_inputs({}, format, inputs);
    EXPECT_EQ(inputs, InputBytes{}) << name_of(format);
    OutputBytes outputs;
    outputs.fill(std::byte{0xA5});
    encode_outputs({}, format, outputs);
    EXPECT_EQ(outputs, OutputBytes{}) << name_of(format);
  }
}

TEST(Codec, NanPayloadsInfinitiesAndDenormalsKeepEveryBit) {
  // Quiet, quiet negative with payload, signalling, infinities, smallest denormal, minus zero (IEEE 754 binary32).
  constexpr std::uint32_t kPatterns[] = {0x7FC00000, 0xFFC12345, 0x7F800001, 0xFFBFFFFF,
                                         0x7F800000, 0xFF800000, 0x00000001, 0x80000000};
  for (const auto format : kFormats) {
    for (const auto pattern : kPatterns) {
      for (const auto& field : kInputFields) {
        if (field.type != WireType::kReal) continue;
        InputBytes bytes{};
        for (std::size_t i = 0; i < 4; ++i) {
          const auto place = format.byte_order == std::endian::little ? i : 3 - i;
          bytes[field.byte + place] = static_cast<std::byte>(pattern >> (8 * i));
        }
        const auto inputs = decode_inputs(bytes, format);
        const auto value = std::get<Place<Inputs, float>>(field.place).read(inputs);
        EXPECT_EQ(std::bit_cast<std::uint32_t>(value), pattern) << field.section << " " << field.name;
        EXPECT_EQ(encoded(inputs, format), bytes) << field.section << " " << field.name;
      }
    }
  }
}

TEST(Codec, ImagesAtOddAddressesReadTheSame) {
  std::array<std::byte, kInputSize + 1> buffer{};
  for (std::size_t i = 0; i < buffer.size(); ++i) buffer[i] = static_cast<std::byte>(i % 100);  // no NaN in it
  InputBytes aligned;
  std::copy(buffer.begin() + 1, buffer.end(), aligned.begin());
  const auto odd = std::span(buffer).subspan<1, kInputSize>();
  for (const auto format : kFormats) {
    EXPECT_EQ(decode_inputs(odd, format), decode_inputs(aligned, format)) << name_of(format);
  }
}

template <class Bytes>
void clear_reserved(Bytes& bytes, const auto& gaps, Layout layout) {
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    if (is_reserved(gaps, layout, bit)) bytes[bit / 8] &= ~(std::byte{1} << (bit % 8));
  }
}

template <class Bytes>
void round_trips(const auto& gaps) {
  std::mt19937 random(500);  // a fixed seed: a failure can be repeated
  std::uniform_int_distribution<int> any_byte(0, 255);
  for (const auto format : kFormats) {
    for (int round = 0; round < 500; ++round) {
      Bytes bytes;
      std::ranges::generate(bytes, [&] { return static_cast<std::byte>(any_byte(random)); });
      const auto again = encoded(decoded(bytes, format), format);
      EXPECT_EQ(encoded(decoded(again, format), format), again) << name_of(format) << ", round " << round;
      clear_reserved(bytes, gaps, format.layout);
      EXPECT_EQ(again, bytes) << name_of(format) << ", round " << round;
    }
  }
}

TEST(Codec, AnyOutputBytesComeBackButForReservedBits) { round_trips<OutputBytes>(kOutputReserved); }
TEST(Codec, AnyInputBytesComeBackButForReservedBits) { round_trips<InputBytes>(kInputReserved); }

}  // namespace
}  // namespace meca::image
