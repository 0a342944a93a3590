// The bytes of a fuzz input, read as numbers and byte strings; zeros when it has ended.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace meca::fuzz {

class Source {
 public:
  Source(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool empty() const { return size_ == 0; }
  template <typename T>
  T take() {
    T value{};
    const std::size_t n = std::min(sizeof(T), size_);
    if (n != 0) std::memcpy(&value, data_, n);
    data_ += n;
    size_ -= n;
    return value;
  }
  std::vector<std::byte> take_bytes(std::size_t most) {
    const auto all = std::as_bytes(std::span(data_, std::min(most, size_)));
    data_ += all.size();
    size_ -= all.size();
    return {all.begin(), all.end()};  // of exactly this size: ASan sees a byte too far
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace meca::fuzz
