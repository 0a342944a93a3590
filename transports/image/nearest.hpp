// "Did you mean ...?": the known word nearest to a mistyped one, for every text that people write to us.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace meca::image {

// Edits (insert, delete, replace, swap neighbours) between two words, without regard to case.
std::size_t edit_distance(std::string_view a, std::string_view b);

// Empty when none is near enough to be what was meant (more than a third of the letters would have to change), and for
// words of more than 64 bytes.
std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

}  // namespace meca::image
