// `meca-ctl decode`: hex digits or raw bytes of a process image -> its fields by name, as text or JSON.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "transports/image/codec.hpp"

namespace meca::cli {

// All throw UsageError with a sentence that names the place.

// Two digits a byte; spaces, newlines, commas, colons and 0x are skipped.
std::vector<std::byte> parse_hex(std::string_view text);

// "11.3", "10.2.1", "9" -> the layout of that generation.
image::Layout parse_firmware(std::string_view text);

// Hex digits, the name of a file (hex or raw bytes), or "-" for standard input.
std::vector<std::byte> read_image(const std::string& input);

// 252 bytes are an input image (robot -> host), 60 an output image. One line per field, or one JSON object.
std::string render_image(std::span<const std::byte> bytes, image::Format format, bool json);

}  // namespace meca::cli
