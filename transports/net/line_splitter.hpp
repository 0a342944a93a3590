// Bytes of a stream to lines of bounded length.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace meca::net {

class LineSplitter {
 public:
  explicit LineSplitter(std::size_t longest) : longest_(longest) {}

  struct Line {
    std::string text;       // without '\n'; empty when it was too long
    bool too_long = false;  // said once per line, as soon as it is known
  };

  void add(std::string_view bytes) { bytes_ += bytes; }
  // The next line that is complete or too long. Keeps at most one unfinished line of `longest` bytes once it is empty.
  std::optional<Line> next() {
    for (;;) {
      const std::size_t end = bytes_.find('\n');
      const bool complete = end != std::string::npos;
      if (skipping_) {
        bytes_.erase(0, complete ? end + 1 : bytes_.size());
        if (!complete) return std::nullopt;
        skipping_ = false;
        continue;
      }
      if (std::min(end, bytes_.size()) > longest_) {
        skipping_ = true;
        return Line{.text = {}, .too_long = true};
      }
      if (!complete) return std::nullopt;
      Line line{.text = bytes_.substr(0, end), .too_long = false};
      bytes_.erase(0, end + 1);
      return line;
    }
  }
  // At the end of the stream: what is left without '\n'.
  std::optional<Line> rest() {
    if (skipping_ || bytes_.empty()) return std::nullopt;
    return Line{.text = std::exchange(bytes_, {}), .too_long = false};
  }

 private:
  std::size_t longest_;
  std::string bytes_;
  bool skipping_ = false;  // the rest of a line that was too long
};

}  // namespace meca::net
