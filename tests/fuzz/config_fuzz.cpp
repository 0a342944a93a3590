// Any bytes as a configuration: an answer, never a crash, and either a configuration or at least one letter.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "bridge/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const meca::bridge::ConfigResult result = meca::bridge::parse_config(text, "fuzz.yaml");
  if (result.config.has_value() == !result.errors.empty()) std::abort();
  int line = 0;
  for (const meca::bridge::ConfigError& error : result.errors) {
    if (error.line < line || error.message.empty()) std::abort();
    line = error.line;
  }
  if (result.config && result.config->robots.empty()) std::abort();
  return 0;
}
