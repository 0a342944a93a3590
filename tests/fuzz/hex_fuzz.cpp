// Any text given to `meca-ctl decode`: it is bytes, or a UsageError with a sentence; nothing else.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "cli/decode.hpp"
#include "cli/plan.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto bytes = meca::cli::parse_hex(text);
    if (2 * bytes.size() > size) std::abort();  // no byte without two digits
    const auto rendered = meca::cli::render_image(bytes, {}, size % 2 == 0);
    if (rendered.empty()) std::abort();
  } catch (const meca::cli::UsageError& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
  try {
    (void)meca::cli::parse_firmware(text);
  } catch (const meca::cli::UsageError&) {
  }
  return 0;
}
