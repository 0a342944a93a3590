// Any 60 or 252 bytes, in every layout and byte order: they decode, what is encoded again decodes to the same, and the
// text rendering takes them. The first byte chooses the format, the rest (padded with zeros) is the image.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "transports/image/codec.hpp"
#include "transports/image/motion_commands.hpp"
#include "transports/image/text.hpp"

namespace {

using namespace meca::image;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "image_fuzz: %s\n", what);
  std::abort();
}

// Compared as bytes: a NaN in the structs would never equal itself.
void check_outputs(const OutputBytes& bytes, Format format) {
  OutputBytes first, second;
  const auto outputs = decode_outputs(bytes, format);
  encode_outputs(outputs, format, first);
  encode_outputs(decode_outputs(first, format), format, second);
  require(first == second, "outputs change when they are decoded again");
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    require((first[i] & ~bytes[i]) == std::byte{}, "encoding set an output bit that was not there");
  }
  require(!fields_of_outputs(bytes, format).empty(), "outputs without a text");
  if (const auto* command = find_motion_command(outputs.motion_command.command_id)) {
    for (std::size_t i = 0; i < command->arguments.size(); ++i) {
      (void)allows(command->arguments[i], outputs.motion_command.arguments[i]);
    }
  }
}

void check_inputs(const InputBytes& bytes, Format format) {
  InputBytes first, second;
  const auto inputs = decode_inputs(bytes, format);
  encode_inputs(inputs, format, first);
  encode_inputs(decode_inputs(first, format), format, second);
  require(first == second, "inputs change when they are decoded again");
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    require((first[i] & ~bytes[i]) == std::byte{}, "encoding set an input bit that was not there");
  }
  require(inputs.safety_status.known == (format.layout != Layout::kFirmware9), "safety known without a safety section");
  require(!fields_of_inputs(bytes, format).empty(), "inputs without a text");
}

template <std::size_t kSize>
std::array<std::byte, kSize> padded(const std::uint8_t* data, std::size_t size) {
  std::array<std::byte, kSize> bytes{};
  if (size != 0) std::memcpy(bytes.data(), data, std::min(size, kSize));
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Format format{static_cast<Layout>(data[0] % 3), data[0] & 0x80 ? std::endian::big : std::endian::little};
  check_outputs(padded<kOutputSize>(data + 1, size - 1), format);
  check_inputs(padded<kInputSize>(data + 1, size - 1), format);
  return 0;
}
