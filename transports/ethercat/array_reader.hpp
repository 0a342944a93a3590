// Reads an object that is a list (subindex 0: how many; 1..: numbers of the same size) as a whole, or entry by entry
// where a device does not let it be read as a whole.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "transports/ethercat/sdo_client.hpp"

namespace meca::ethercat {

class ArrayReader final : public AccessMachine {
 public:
  static constexpr std::size_t kMostEntries = 254;  // so many subindices there are

  explicit ArrayReader(SdoClient& sdo) noexcept : sdo_(sdo) {}

  // `entry_size`: 2 or 4 bytes.
  void read(std::uint16_t index, std::size_t entry_size, Time now) noexcept;

  void tick(Time now) noexcept override;
  std::optional<Access> next(Time now) noexcept override { return sdo_.next(now); }
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept override;
  void lost(Time now) noexcept override { sdo_.lost(now); }
  Time next_event() const noexcept override { return sdo_.next_event(); }

  std::uint16_t index() const noexcept { return index_; }
  std::span<const std::uint32_t> entries() const noexcept { return std::span(entries_).first(count_); }  // when done

 private:
  void proceed(Time now) noexcept;
  bool take_whole() noexcept;
  void take_entry(Time now) noexcept;
  void ask(std::uint8_t sub, Time now) noexcept;
  std::uint32_t number(std::size_t at) const noexcept;

  SdoClient& sdo_;
  std::uint16_t index_ = 0;
  std::size_t entry_size_ = 0;
  bool whole_ = false;          // what is being asked for
  bool whole_refused_ = false;  // once is enough
  std::array<std::uint32_t, kMostEntries> entries_{};
  std::size_t count_ = 0;
};

}  // namespace meca::ethercat
