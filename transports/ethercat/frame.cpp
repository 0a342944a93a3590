#include "transports/ethercat/frame.hpp"

#include <algorithm>

namespace meca::ethercat {
namespace {

constexpr std::uint16_t kLengthMask = 0x07FF, kMore = 0x8000, kFrameType = 1;

template <class Byte>
std::uint16_t u16(std::span<Byte> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[at]) | std::to_integer<unsigned>(bytes[at + 1])
                                                                               << 8);
}

void put(std::span<std::byte> bytes, std::size_t at, std::uint16_t value) noexcept {
  bytes[at] = static_cast<std::byte>(value & 0xFF);
  bytes[at + 1] = static_cast<std::byte>(value >> 8);
}

}  // namespace

template <class Byte>
DatagramWalk<Byte>::DatagramWalk(std::span<Byte> frame) noexcept : frame_(frame) {
  ok_ = frame.size() >= at_ && frame[12] == std::byte{kEtherType >> 8} && frame[13] == std::byte{kEtherType & 0xFF} &&
        u16(frame, kEthernetHeader) >> 12 == kFrameType;
}

template <class Byte>
std::optional<BasicDatagram<Byte>> DatagramWalk<Byte>::next() noexcept {
  if (!ok_ || !more_) return std::nullopt;
  const std::size_t left = frame_.size() - at_;
  ok_ = left >= kDatagramOverhead;
  if (!ok_) return std::nullopt;
  const std::uint16_t length = u16(frame_, at_ + 6);
  const std::size_t size = kDatagramOverhead + (length & kLengthMask);
  ok_ = left >= size;
  if (!ok_) return std::nullopt;
  more_ = (length & kMore) != 0;
  const BasicDatagram<Byte> datagram(frame_.subspan(at_, size));
  at_ += size;
  return datagram;
}

template class DatagramWalk<const std::byte>;
template class DatagramWalk<std::byte>;

FrameWriter::FrameWriter(std::span<std::byte> buffer, const MacAddress& source) noexcept
    : buffer_(buffer.first(std::min(buffer.size(), kLongestFrame))) {
  std::fill_n(buffer_.begin(), 6, std::byte{0xFF});
  std::ranges::copy(source, buffer_.begin() + 6);
  buffer_[12] = std::byte{kEtherType >> 8};
  buffer_[13] = std::byte{kEtherType & 0xFF};
}

std::size_t FrameWriter::room() const noexcept {
  const std::size_t left = buffer_.size() - size_;
  return left > kDatagramOverhead ? left - kDatagramOverhead : 0;
}

std::span<std::byte> FrameWriter::add(Command command, std::uint8_t index, std::uint32_t address,
                                      std::size_t size) noexcept {
  if (size == 0 || size > room()) return {};
  if (count_ > 0) put(buffer_, last_ + 6, static_cast<std::uint16_t>(u16(buffer_, last_ + 6) | kMore));
  last_ = size_;
  const auto whole = buffer_.subspan(size_, kDatagramOverhead + size);
  std::ranges::fill(whole, std::byte{0});
  whole[0] = static_cast<std::byte>(command);
  whole[1] = static_cast<std::byte>(index);
  put(whole, 2, static_cast<std::uint16_t>(address & 0xFFFF));
  put(whole, 4, static_cast<std::uint16_t>(address >> 16));
  put(whole, 6, static_cast<std::uint16_t>(size));
  size_ += whole.size();
  ++count_;
  return whole.subspan(kDatagramHeader, size);
}

Bytes FrameWriter::finish() noexcept {
  if (count_ == 0) return {};
  const std::size_t length = size_ - kEthernetHeader - kFrameHeader;
  put(buffer_, kEthernetHeader, static_cast<std::uint16_t>(length | kFrameType << 12));
  while (size_ < kShortestFrame) buffer_[size_++] = std::byte{0};
  return buffer_.first(size_);
}

}  // namespace meca::ethercat
