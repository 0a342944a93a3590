// What tshark says of a capture.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace meca::test {

inline constexpr const char* kNoTshark = "needs the program tshark";

inline bool tshark_is_here() { return std::system("tshark --version >/dev/null 2>&1") == 0; }

// Its lines for `tshark -r FILE WORDS`.
inline std::vector<std::string> tshark(const std::filesystem::path& file, const std::string& words) {
  const std::string command = "tshark -n -r '" + file.string() + "' " + words + " 2>/dev/null";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("no pipe for " + command);
  std::vector<std::string> lines;
  std::string line;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c != '\n') {
      line += static_cast<char>(c);
      continue;
    }
    lines.push_back(std::exchange(line, {}));
  }
  if (::pclose(pipe) != 0) throw std::runtime_error("does not end well: " + command);
  return lines;
}

}  // namespace meca::test
