// One step of the AL state machine: acknowledges an error that stands, asks for a state, waits until it is reached
// (ETG.1000.6, 6.4; spec 5.5).
#pragma once

#include <array>
#include <cstdint>

#include "transports/ethercat/access_machine.hpp"

namespace meca::ethercat {

class AlRequest final : public AccessMachine {
 public:
  explicit AlRequest(StationCounters& counters) noexcept : counters_(counters) {}

  // INIT is asked for whatever the device says. Other states are asked for from the one before; a device that is in a
  // higher state already has done what is asked.
  void start(AlState target, Time timeout, Time now) noexcept;

  void tick(Time now) noexcept override;
  std::optional<Access> next(Time now) noexcept override;
  void answered(std::uint16_t working_counter, Bytes data, Time now) noexcept override;
  void lost(Time now) noexcept override;
  Time next_event() const noexcept override { return due_; }

  // Last seen since construction; 0: never.
  std::uint16_t status() const noexcept { return status_; }
  std::uint16_t code() const noexcept { return code_; }
  AlState target() const noexcept { return target_; }

 private:
  enum class Step : std::uint8_t { kLook, kAcknowledge, kRequest, kPoll };
  void look(Time now) noexcept;
  void poll(Time now) noexcept;
  Predicate why_not() const noexcept;

  StationCounters& counters_;
  AlState target_ = AlState::kInit;
  Step step_ = Step::kLook;
  bool acknowledged_ = false, heard_ = false;
  std::array<std::byte, 2> control_{};
  std::uint16_t status_ = 0, code_ = 0;
  Time timeout_{}, due_{}, deadline_{};
};

}  // namespace meca::ethercat
