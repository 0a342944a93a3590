#include "transports/ethercat/register_writes.hpp"

#include <algorithm>

namespace meca::ethercat {

void RegisterWrites::add(std::uint16_t address, Bytes data, Need need) noexcept {
  if (count_ == kMost || data.size() > kMostBytes - size_) return;
  writes_[count_++] = {address, static_cast<std::uint16_t>(size_), static_cast<std::uint16_t>(data.size()), need};
  std::ranges::copy(data, bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += data.size();
}

void RegisterWrites::add_u16(std::uint16_t address, std::uint16_t value, Need need) noexcept {
  const std::array bytes{static_cast<std::byte>(value & 0xFF), static_cast<std::byte>(value >> 8)};
  add(address, bytes, need);
}

void RegisterWrites::add_zeros(std::uint16_t address, std::size_t size) noexcept {
  static constexpr std::array<std::byte, Access::kMost> kZeros{};
  add(address, Bytes(kZeros).first(size));
}

void RegisterWrites::start(Time now) noexcept {
  begin();
  at_ = 0;
  heard_ = false;
  due_ = now;
  deadline_ = now + timeout_;
  if (count_ == 0) done();
}

void RegisterWrites::tick(Time now) noexcept {
  if (!running() || now < deadline_) return;
  fail(heard_ ? Predicate::format("does not take what is written to register 0x%04X; restart it",
                                  unsigned{writes_[at_].address})
              : Predicate("does not answer; check its power and the cables to it"));
}

std::optional<Access> RegisterWrites::next(Time now) noexcept {
  if (!running() || now < due_) return std::nullopt;
  due_ = deadline_;
  const Write& write = writes_[at_];
  return Access{write.address, write.size, true, Bytes(bytes_).subspan(write.at, write.size)};
}

void RegisterWrites::answered(std::uint16_t working_counter, Bytes, Time now) noexcept {
  due_ = now;
  if (working_counter == 0 && writes_[at_].need == Need::kMust) {
    heard_ = true;
    ++counters_.lost_accesses;
    return;
  }
  heard_ = false;
  if (++at_ == count_) done();
}

void RegisterWrites::lost(Time now) noexcept {
  due_ = now;
  ++counters_.lost_accesses;
}

}  // namespace meca::ethercat
