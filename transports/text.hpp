// Text of fixed memory, for sentences that are made where nothing may be allocated.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string_view>

namespace meca {

template <std::size_t N>
class FixedText {
 public:
  constexpr FixedText() = default;
  constexpr FixedText(std::string_view text) noexcept : size_(std::min(text.size(), N)) {
    std::copy_n(text.data(), size_, bytes_.data());
  }
  constexpr FixedText(const char* text) noexcept : FixedText(std::string_view(text)) {}
  // printf; what does not fit is cut.
  template <class... Arguments>
  static FixedText format(const char* format, Arguments... arguments) noexcept {
    FixedText out;
    std::array<char, N + 1> buffer;
    const int length = std::snprintf(buffer.data(), buffer.size(), format, arguments...);
    out.size_ = length < 0 ? 0 : std::min(static_cast<std::size_t>(length), N);
    std::copy_n(buffer.data(), out.size_, out.bytes_.data());
    return out;
  }

  constexpr std::string_view view() const noexcept { return {bytes_.data(), size_}; }
  constexpr operator std::string_view() const noexcept { return view(); }
  constexpr bool empty() const noexcept { return size_ == 0; }
  friend constexpr bool operator==(const FixedText& a, const FixedText& b) noexcept { return a.view() == b.view(); }

 private:
  std::array<char, N> bytes_{};
  std::size_t size_ = 0;
};

}  // namespace meca
