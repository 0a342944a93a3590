// The other end of LineServer: says a line, waits for the answer.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "transports/net/file.hpp"

namespace meca::net {

class LineClient {
 public:
  static std::optional<LineClient> connect(const std::filesystem::path& path) noexcept;  // empty: nobody listens there

  // The answer without the empty line that ends it; empty when none came in time, or the server hung up before its end.
  // `line` without '\n'.
  std::optional<std::string> ask(std::string_view line, std::chrono::milliseconds timeout);

 private:
  explicit LineClient(File socket) noexcept : socket_(std::move(socket)) {}
  File socket_;
};

}  // namespace meca::net
