// The safety stops the robot may show in SafetyStatus, with text, likely cause, remedy and what resets them, in our own
// words. Where each bit stands is in the field table.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "transports/image/field.hpp"
#include "transports/image/image.hpp"

namespace meca::image {

enum class ResetBy : std::uint8_t {
  kResetButton,  // Reset on the power supply; the motors have lost their supply and are to be activated anew
  kResume,       // ResumeMotion, once the cause is gone; the motors keep their supply
};

struct StopInfo {
  bool StopSignals::*bit;     // in SafetyStatus.stop, and its twin in SafetyStatus.resettable
  std::string_view field;     // the row of the field table, section SafetyStatus; the twin's is field + "Resettable"
  std::uint16_t status_code;  // of this stop in the robot's log and text interface
  std::string_view name;      // "P-Stop 2", as in a sentence
  std::string_view text;      // what it does, a sentence without full stop
  std::string_view cause;     // likely cause
  std::string_view remedy;    // what ends the cause; then `reset_by`
  ResetBy reset_by;
};

std::span<const StopInfo> stop_signals() noexcept;                      // in the order of the bits
const StopInfo& stop_info(bool StopSignals::*bit) noexcept;             // of a bit that StopSignals has
const StopInfo* find_stop_by_code(std::uint16_t status_code) noexcept;  // nullptr: no stop has this code
const Field<Inputs>& field_of(const StopInfo& stop) noexcept;           // position, and whether a Meca500 has it
const Field<Inputs>& resettable_field_of(const StopInfo& stop) noexcept;

}  // namespace meca::image
