// Helpers of the image tests: hex in, every format, reading the shared reference files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/hex.hpp"
#include "transports/image/codec.hpp"
#include "transports/image/image.hpp"

namespace meca::image::test {

inline constexpr Format kFormats[] = {
    {Layout::kFirmware9, std::endian::little},  {Layout::kFirmware9, std::endian::big},
    {Layout::kFirmware10, std::endian::little}, {Layout::kFirmware10, std::endian::big},
    {Layout::kFirmware11, std::endian::little}, {Layout::kFirmware11, std::endian::big},
};

inline std::string name_of(Format format) {
  constexpr std::string_view kGenerations[] = {"9", "10", "11"};
  return "firmware " + std::string(kGenerations[static_cast<std::size_t>(format.layout)]) +
         (format.byte_order == std::endian::big ? ", big endian" : ", little endian");
}

// "2A 00 ..." -> bytes; throws unless it is exactly kSize of them.
template <std::size_t kSize>
std::array<std::byte, kSize> from_hex(std::string_view text) {
  const auto given = meca::test::from_hex(text);
  if (given.size() != kSize) throw std::invalid_argument("golden hex of the wrong length");
  std::array<std::byte, kSize> bytes{};
  std::ranges::copy(given, bytes.begin());
  return bytes;
}

inline InputBytes encoded(const Inputs& inputs, Format format) {
  InputBytes bytes;
  encode_inputs(inputs, format, bytes);
  return bytes;
}

inline OutputBytes encoded(const Outputs& outputs, Format format) {
  OutputBytes bytes;
  encode_outputs(outputs, format, bytes);
  return bytes;
}

// The folder with the reference files that are not part of the project: $MECA_SHARED, or `shared` beside the sources or
// above. Empty where there is none: tests then skip, visibly.
inline std::filesystem::path shared_file(std::string_view name) {
  const auto in = [name](const std::filesystem::path& folder) { return folder / "spec/data" / name; };
  if (const char* set = std::getenv("MECA_SHARED")) return exists(in(set)) ? in(set) : "";
  auto folder = std::filesystem::path(MECA_SOURCE_DIR);
  for (int up = 0; up < 3; ++up) {
    folder = folder.parent_path();
    if (exists(in(folder / "shared"))) return in(folder / "shared");
  }
  return {};
}

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace meca::image::test

#define MECA_SHARED_OR_SKIP(variable, name)                     \
  const auto variable = ::meca::image::test::shared_file(name); \
  if (variable.empty()) GTEST_SKIP() << "reference file " << (name) << " is not here; set MECA_SHARED to its folder"
