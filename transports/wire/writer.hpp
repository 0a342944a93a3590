// Writes numbers into a buffer of fixed size. Sticky like Reader: what does not fit is not written, and ok() is false.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "transports/wire/reader.hpp"

namespace meca::wire {

class Writer {
 public:
  explicit Writer(std::span<std::byte> buffer, std::endian order = std::endian::little) noexcept
      : buffer_(buffer), order_(order) {}

  bool ok() const noexcept { return ok_; }
  std::size_t size() const noexcept { return size_; }
  Bytes written() const noexcept { return buffer_.first(size_); }

  void u8(std::uint8_t value) noexcept { number(value, 1); }
  void u16(std::uint16_t value) noexcept { number(value, 2); }
  void u32(std::uint32_t value) noexcept { number(value, 4); }
  void u64(std::uint64_t value) noexcept { number(value, 8); }
  void bytes(Bytes value) noexcept {
    if (!room(value.size())) return;
    std::ranges::copy(value, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += value.size();
  }
  void text(std::string_view value) noexcept { bytes(std::as_bytes(std::span(value))); }
  void zeros(std::size_t count) noexcept {
    if (!room(count)) return;
    std::fill_n(buffer_.begin() + static_cast<std::ptrdiff_t>(size_), count, std::byte{0});
    size_ += count;
  }

  // Lengths are known only when what they count has been written: reserve, write, then set.
  std::size_t reserve_u16() noexcept {
    const std::size_t at = size_;
    zeros(2);
    return at;
  }
  void set_u16(std::size_t at, std::uint16_t value) noexcept {
    if (at + 2 <= size_) put(at, value, 2);
  }

 private:
  bool room(std::size_t count) noexcept {
    ok_ = ok_ && count <= buffer_.size() - size_;
    return ok_;
  }
  void number(std::uint64_t value, std::size_t bytes) noexcept {
    if (!room(bytes)) return;
    put(size_, value, bytes);
    size_ += bytes;
  }
  void put(std::size_t at, std::uint64_t value, std::size_t bytes) noexcept {
    for (std::size_t i = 0; i < bytes; ++i) {
      const std::size_t shift = 8 * (order_ == std::endian::little ? i : bytes - 1 - i);
      buffer_[at + i] = static_cast<std::byte>(value >> shift & 0xFF);
    }
  }

  std::span<std::byte> buffer_;
  std::endian order_;
  std::size_t size_ = 0;
  bool ok_ = true;
};

}  // namespace meca::wire
