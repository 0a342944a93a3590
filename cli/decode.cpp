#include "cli/decode.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/json.hpp"
#include "cli/plan.hpp"
#include "transports/image/text.hpp"

namespace meca::cli {
namespace {

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

bool is_separator(char c) { return std::string_view(" \t\r\n,:").find(c) != std::string_view::npos; }

std::string shown(char c) {
  return c >= ' ' && c <= '~' ? "'" + std::string(1, c) + "'"
                              : "the byte " + std::to_string(static_cast<int>(static_cast<unsigned char>(c)));
}

bool is_image_size(std::size_t size) { return size == image::kInputSize || size == image::kOutputSize; }

std::vector<std::byte> as_bytes(std::string_view text) {
  std::vector<std::byte> bytes(text.size());
  std::ranges::transform(text, bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

bool looks_like_hex(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return hex_value(c) >= 0 || is_separator(c) || c == 'x' || c == 'X'; });
}

// A file with raw bytes is known by its size; 60 or 252 characters of hex would be 30 or 126 bytes, which is no image.
std::vector<std::byte> parse_content(std::string_view content, const std::string& where) {
  if (is_image_size(content.size()) && !looks_like_hex(content)) return as_bytes(content);
  try {
    return parse_hex(content);
  } catch (const UsageError& error) {
    throw UsageError(where + " has " + std::to_string(content.size()) +
                     " bytes: neither 60 or 252 raw bytes, nor hex digits (" + error.what() + ")");
  }
}

std::string read_all(std::istream& stream) { return {std::istreambuf_iterator<char>(stream), {}}; }

std::vector<image::FieldText> fields(std::span<const std::byte> bytes, image::Format format) {
  if (bytes.size() == image::kInputSize) return image::fields_of_inputs(bytes.first<image::kInputSize>(), format);
  if (bytes.size() == image::kOutputSize) return image::fields_of_outputs(bytes.first<image::kOutputSize>(), format);
  throw UsageError("decode: " + std::to_string(bytes.size()) +
                   " bytes came; an input image (robot -> host) has 252, an output image (host -> robot) 60");
}

// NaN and the infinities are no JSON literals: null.
Json literal(const std::string& value) {
  Json parsed = Json::parse(value, nullptr, false);
  return parsed.is_discarded() ? Json(nullptr) : parsed;
}

std::string as_json(const std::vector<image::FieldText>& rows, image::Format format, bool input) {
  Json json;
  json["image"] = input ? "input" : "output";
  json["layout"] = image::to_string(format.layout);
  json["byte_order"] = format.byte_order == std::endian::big ? "big" : "little";
  for (const auto& row : rows) {
    Json& section = json["sections"][std::string(row.section)];
    Json field;
    field["value"] = literal(row.value);
    if (!row.unit.empty()) field["unit"] = row.unit;
    if (!row.hint.empty()) field["hint"] = row.hint;
    section[std::string(row.name)] = std::move(field);
  }
  return one_line(json) + "\n";
}

std::string as_text(const std::vector<image::FieldText>& rows, image::Format format, bool input) {
  std::size_t width = 0;
  for (const auto& row : rows) width = std::max(width, row.name.size());
  std::ostringstream out;
  out << (input ? "Input image (robot -> host), 252 bytes" : "Output image (host -> robot), 60 bytes") << ", firmware "
      << image::to_string(format.layout) << ", " << (format.byte_order == std::endian::big ? "big" : "little")
      << "-endian\n";
  std::string_view section;
  for (const auto& row : rows) {
    if (row.section != section) out << "\n" << row.section << "\n";
    section = row.section;
    out << "  " << row.name << std::string(width - row.name.size() + 2, ' ') << row.value;
    if (!row.unit.empty()) out << ' ' << row.unit;
    if (!row.hint.empty()) out << "  (" << row.hint << ')';
    out << '\n';
  }
  return out.str();
}

}  // namespace

std::vector<std::byte> parse_hex(std::string_view text) {
  std::vector<std::byte> bytes;
  int high = -1;  // first digit of a byte, when only that has come
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool prefix = c == '0' && high < 0 && i + 1 < text.size() && (text[i + 1] == 'x' || text[i + 1] == 'X');
    if (prefix) {
      ++i;
      continue;
    }
    if (is_separator(c) && high < 0) continue;
    const int digit = hex_value(c);
    if (digit < 0) {
      throw UsageError("character " + std::to_string(i + 1) + ", " + shown(c) + ", " +
                       (is_separator(c) ? "stands in the middle of a byte" : "is not a hex digit"));
    }
    if (high < 0) {
      high = digit;
    } else {
      bytes.push_back(static_cast<std::byte>(high * 16 + digit));
      high = -1;
    }
  }
  if (high >= 0) throw UsageError("the last byte, number " + std::to_string(bytes.size() + 1) + ", has only one digit");
  return bytes;
}

image::Layout parse_firmware(std::string_view text) {
  unsigned major = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), major);
  const bool number = error == std::errc{} && (end == text.data() + text.size() || *end == '.');
  if (number && major <= 11 && image::layout_of(major)) return *image::layout_of(major);
  const std::string why = number && major < 9 ? "has another, smaller image" : "is not known here";
  throw UsageError("--firmware: '" + std::string(text) + "' " + why + "; use 9.x, 10.x or 11.x, as in 11.3");
}

std::vector<std::byte> read_image(const std::string& input) {
  if (input == "-") return parse_content(read_all(std::cin), "standard input");
  std::error_code ignored;
  if (std::filesystem::is_regular_file(input, ignored)) {
    std::ifstream file(input, std::ios::binary);
    if (!file) throw UsageError("--input: the file " + input + " cannot be read");
    return parse_content(read_all(file), input);
  }
  try {
    return parse_hex(input);
  } catch (const UsageError& error) {
    throw UsageError(std::string("--input: no file of that name, and not hex: ") + error.what());
  }
}

std::string render_image(std::span<const std::byte> bytes, image::Format format, bool json) {
  const auto rows = fields(bytes, format);
  const bool input = bytes.size() == image::kInputSize;
  return json ? as_json(rows, format, input) : as_text(rows, format, input);
}

}  // namespace meca::cli
