// Registers of a device written one after the other, each until it was counted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "transports/ethercat/access_machine.hpp"

namespace meca::ethercat {

class RegisterWrites final : public AccessMachine {
 public:
  enum class Need : std::uint8_t {
    kMust,
    kMay,  // that nobody counts it is an answer too: the device does not have the register
  };

  RegisterWrites(Time timeout, StationCounters& counters) noexcept : timeout_(timeout), counters_(counters) {}

  // The list, then start. At most kMost writes of together kMostBytes.
  void clear() noexcept { count_ = size_ = 0; }
  void add(std::uint16_t address, Bytes data, Need need = Need::kMust) noexcept;
  void add_u16(std::uint16_t address, std::uint16_t value, Need need = Need::kMust) noexcept;
  void add_zeros(std::uint16_t address, std::size_t size) noexcept;
  void start(Time now) noexcept;

  void tick(Time now) noexcept override;
  std::optional<Access> next(Time now) noexcept override;
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept override;
  void lost(Time now) noexcept override;
  Time next_event() const noexcept override { return due_; }

 private:
  static constexpr std::size_t kMost = 12, kMostBytes = 256;
  struct Write {
    std::uint16_t address, at, size;
    Need need;
  };

  Time timeout_;
  StationCounters& counters_;
  std::array<Write, kMost> writes_{};
  std::array<std::byte, kMostBytes> bytes_{};
  std::size_t count_ = 0, size_ = 0, at_ = 0;
  bool heard_ = false;  // a reply to this write came, though nobody counted
  Time due_{}, deadline_{};
};

}  // namespace meca::ethercat
