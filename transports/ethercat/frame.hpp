// EtherCAT frames: Ethernet header, frame header, datagrams (ETG.1000.4, 5.2 to 5.4; spec 5.1). Everything
// is little endian.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

#include "transports/wire/reader.hpp"

namespace meca::ethercat {

using wire::Bytes;
using Time = std::chrono::nanoseconds;  // monotonic

inline constexpr std::uint16_t kEtherType = 0x88A4;
inline constexpr std::size_t kEthernetHeader = 14, kFrameHeader = 2, kDatagramHeader = 10, kWorkingCounter = 2;
inline constexpr std::size_t kDatagramOverhead = kDatagramHeader + kWorkingCounter;
inline constexpr std::size_t kShortestFrame = 60, kLongestFrame = 1514;  // without FCS
inline constexpr std::size_t kMostData = kLongestFrame - kEthernetHeader - kFrameHeader - kDatagramOverhead;  // 1486

using MacAddress = std::array<std::byte, 6>;
// The first device sets the locally administered bit of the source address; so a reply can be told from what was sent.
inline constexpr std::byte kReplyBit{0x02};

// A: auto-increment (position), F: station address, B: broadcast, L: logical; RD, WR, RW; RMW: the addressed device
// reads, all others write.
enum class Command : std::uint8_t {
  kNop,
  kAprd,
  kApwr,
  kAprw,
  kFprd,
  kFpwr,
  kFprw,
  kBrd,
  kBwr,
  kBrw,
  kLrd,
  kLwr,
  kLrw,
  kArmw,
  kFrmw
};
inline constexpr std::uint8_t kCommands = 15;

// A, F and B commands: ADP in the low, ADO (the register) in the high half; L: the logical address.
constexpr std::uint32_t address_of(std::uint16_t adp, std::uint16_t ado) noexcept {
  return static_cast<std::uint32_t>(ado) << 16 | adp;
}
// The ADP that reaches the device at a position (0 = first) with an A command.
constexpr std::uint16_t auto_increment(std::uint16_t position) noexcept {
  return static_cast<std::uint16_t>(0 - position);
}

// One datagram where it stands in a frame. Byte: std::byte where it may be changed.
template <class Byte>
class BasicDatagram {
 public:
  // `whole`: header, data, working counter. Use DatagramWalk to get one.
  explicit BasicDatagram(std::span<Byte> whole) noexcept : whole_(whole) {}

  std::uint8_t raw_command() const noexcept { return u8(0); }  // may be none of Command
  Command command() const noexcept { return static_cast<Command>(u8(0)); }
  std::uint8_t index() const noexcept { return u8(1); }
  std::uint32_t address() const noexcept { return u16(2) | static_cast<std::uint32_t>(u16(4)) << 16; }
  std::uint16_t adp() const noexcept { return u16(2); }
  std::uint16_t ado() const noexcept { return u16(4); }
  bool circulating() const noexcept { return (u16(6) & 0x4000) != 0; }
  bool more() const noexcept { return (u16(6) & 0x8000) != 0; }
  std::uint16_t irq() const noexcept { return u16(8); }
  std::span<Byte> data() const noexcept { return whole_.subspan(kDatagramHeader, whole_.size() - kDatagramOverhead); }
  std::uint16_t working_counter() const noexcept { return u16(whole_.size() - kWorkingCounter); }

  void set_adp(std::uint16_t adp) noexcept requires(!std::is_const_v<Byte>) { put(2, adp); }
  void set_irq(std::uint16_t irq) noexcept requires(!std::is_const_v<Byte>) { put(8, irq); }
  void set_working_counter(std::uint16_t value) noexcept requires(!std::is_const_v<Byte>) {
    put(whole_.size() - kWorkingCounter, value);
  }

 private:
  std::uint8_t u8(std::size_t at) const noexcept { return std::to_integer<std::uint8_t>(whole_[at]); }
  std::uint16_t u16(std::size_t at) const noexcept { return static_cast<std::uint16_t>(u8(at) | u8(at + 1) << 8); }
  void put(std::size_t at, std::uint16_t value) noexcept {
    whole_[at] = static_cast<std::byte>(value & 0xFF);
    whole_[at + 1] = static_cast<std::byte>(value >> 8);
  }
  std::span<Byte> whole_;
};
using Datagram = BasicDatagram<const std::byte>;
using MutableDatagram = BasicDatagram<std::byte>;

// The datagrams of a frame one after the other, by their own lengths and "more" bits. The length in the frame header is
// not looked at: one public master writes it wrong, and padding is outside of it anyway.
template <class Byte>
class DatagramWalk {
 public:
  // `frame`: from the Ethernet header on. What is not EtherCAT (EtherType, frame type 1) has no datagrams and is not
  // ok().
  explicit DatagramWalk(std::span<Byte> frame) noexcept;
  std::optional<BasicDatagram<Byte>> next() noexcept;
  // False once a datagram was promised that is not there.
  bool ok() const noexcept { return ok_; }

 private:
  std::span<Byte> frame_;
  std::size_t at_ = kEthernetHeader + kFrameHeader;
  bool more_ = true, ok_ = true;
};
extern template class DatagramWalk<const std::byte>;
extern template class DatagramWalk<std::byte>;

// Writes a frame from us: broadcast destination, datagrams, padded to the shortest frame.
class FrameWriter {
 public:
  // `buffer`: kLongestFrame bytes; `source`: our address, its first octet even and without kReplyBit.
  FrameWriter(std::span<std::byte> buffer, const MacAddress& source) noexcept;

  // Room for data in one more datagram.
  std::size_t room() const noexcept;
  // A datagram with `size` zero bytes of data, working counter 0; the data to be filled in. Empty span, and nothing
  // written, when it does not fit (or size is 0).
  std::span<std::byte> add(Command command, std::uint8_t index, std::uint32_t address, std::size_t size) noexcept;
  std::size_t count() const noexcept { return count_; }  // of datagrams
  Bytes finish() noexcept;                               // empty when there is no datagram

 private:
  std::span<std::byte> buffer_;
  std::size_t size_ = kEthernetHeader + kFrameHeader;
  std::size_t last_ = 0;  // where the last datagram begins
  std::size_t count_ = 0;
};

}  // namespace meca::ethercat
