// Bytes <-> image structs, for one firmware layout and one byte order. Total functions: every 60 or 252 bytes decode.
// No allocation, no exceptions; safe on the cycle thread.
#pragma once

#include <bit>
#include <span>

#include "transports/image/image.hpp"

namespace meca::image {

struct Format {
  Layout layout = Layout::kFirmware11;
  std::endian byte_order = std::endian::little;  // EtherCAT, EtherNet/IP: little; PROFINET: not published, an option
  friend bool operator==(const Format&, const Format&) = default;
};

Inputs decode_inputs(std::span<const std::byte, kInputSize> bytes, Format format) noexcept;
Outputs decode_outputs(std::span<const std::byte, kOutputSize> bytes, Format format) noexcept;

// Whether a bit is set that this layout does not give a meaning to: it must be 0 (manual 4.4).
bool sets_reserved_bits(std::span<const std::byte, kOutputSize> outputs, Layout layout) noexcept;

// Reserved bits and fields the layout does not have are written 0.
void encode_inputs(const Inputs& inputs, Format format, std::span<std::byte, kInputSize> bytes) noexcept;
void encode_outputs(const Outputs& outputs, Format format, std::span<std::byte, kOutputSize> bytes) noexcept;

}  // namespace meca::image
