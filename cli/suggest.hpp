// "Did you mean ...?": the known word nearest to a mistyped one.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace meca::cli {

// Empty when nothing is near enough to be meant: more than a third of the letters would have to change.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string> known);

// ", did you mean 'activate'?" or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace meca::cli
