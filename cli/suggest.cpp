#include "cli/suggest.hpp"

#include <vector>

#include "transports/image/nearest.hpp"

namespace meca::cli {

std::optional<std::string> nearest(std::string_view word, std::span<const std::string> known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string_view best = image::nearest(word, views);
  return best.empty() ? std::nullopt : std::optional<std::string>(best);
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const auto best = nearest(word, known);
  return best ? ", did you mean '" + *best + "'?" : "";
}

}  // namespace meca::cli
