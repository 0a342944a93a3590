// Reads numbers from bytes of a frame. Sticky: once something was not there, ok() is false, everything read after it is
// zero and nothing outside of the bytes was touched; so a parser reads all its fields and asks once.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace meca::wire {

using Bytes = std::span<const std::byte>;

class Reader {
 public:
  explicit Reader(Bytes bytes, std::endian order = std::endian::little) noexcept : bytes_(bytes), order_(order) {}

  bool ok() const noexcept { return ok_; }
  std::size_t remaining() const noexcept { return ok_ ? bytes_.size() - position_ : 0; }
  std::size_t position() const noexcept { return position_; }

  std::uint8_t u8() noexcept { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() noexcept { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() noexcept { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() noexcept { return number(8); }

  // The next `count` bytes; empty when they are not there.
  Bytes bytes(std::size_t count) noexcept {
    if (!need(count)) return {};
    const Bytes out = bytes_.subspan(position_, count);
    position_ += count;
    return out;
  }
  Bytes rest() noexcept { return bytes(remaining()); }
  void skip(std::size_t count) noexcept { bytes(count); }
  // What was read makes no sense: from here on like a frame that has ended.
  void fail() noexcept { ok_ = false; }

 private:
  bool need(std::size_t count) noexcept {
    ok_ = ok_ && count <= bytes_.size() - position_;
    return ok_;
  }
  std::uint64_t number(std::size_t size) noexcept {
    if (!need(size)) return 0;
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t at = order_ == std::endian::little ? size - 1 - i : i;
      out = out << 8 | std::to_integer<std::uint64_t>(bytes_[position_ + at]);
    }
    position_ += size;
    return out;
  }

  Bytes bytes_;
  std::endian order_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace meca::wire
