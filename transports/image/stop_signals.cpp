#include "transports/image/stop_signals.hpp"

#include <algorithm>

#include "transports/image/field_table.hpp"

namespace meca::image {
namespace {

using Stop = StopSignals;
using enum ResetBy;

// Bits and names: manual 4.5.9, ESI 10.2.1 and EDS 11.3. Status codes: the vendor's Python library (3.0.3), whose codes
// 3080 to 3087 follow the order of the bits. E-Stop, P-Stop 2, Reboot and ConnectionDropped: manual and command
// descriptions. inferred: texts, causes, remedies and resets of the stops that a Meca500 does not have, from their
// names.
constexpr StopInfo kStops[] = {
    {&Stop::e_stop, "EStop", 3070, "E-Stop", "the emergency stop: motors off, brakes on",
     "an E-Stop button is pressed, or its circuit is open", "release it", kResetButton},
    {&Stop::p_stop1, "PStop1", 3069, "P-Stop 1", "the protective stop that takes the motors' supply",
     "a door or light curtain on this input is open", "release it", kResetButton},
    {&Stop::p_stop2, "PStop2", 3032, "P-Stop 2", "the protective stop that halts the arm and leaves its motors on",
     "a door, light curtain or switch on this input is open", "release it", kResume},
    {&Stop::operation_mode_change, "OperationModeChange", 3080, "the stop after a change of operation mode",
     "the robot does not move while its mode changes", "somebody turned the mode switch", "finish changing the mode",
     kResetButton},
    {&Stop::enabling_device_released, "EnablingDeviceReleased", 3081, "the enabling device (released)",
     "the robot moves only while the enabling device is held", "it is let go, or pressed through",
     "hold it in its middle position", kResume},
    {&Stop::voltage_fluctuation, "VoltageFluctuation", 3082, "a voltage fluctuation stop",
     "the supply voltage left its range", "weak mains, or a large load on the same line", "check the mains supply",
     kResetButton},
    {&Stop::reboot, "Reboot", 3083, "the stop after a reboot", "a robot that has just started keeps its motors off",
     "the robot or its power supply was started", "wait until the robot has started", kResetButton},
    {&Stop::redundancy_fault, "RedundancyFault", 3084, "a redundancy fault of the safety inputs",
     "the two channels of a safety input disagree", "a broken wire, or a contact that sticks",
     "check the wiring of both safety channels", kResetButton},
    {&Stop::standstill_fault, "StandstillFault", 3085, "a standstill fault",
     "the arm moved while it was to stand still", "something pushed the arm, or a brake slips",
     "find what moved the arm", kResetButton},
    {&Stop::connection_dropped, "ConnectionDropped", 3086, "a stop because the robot lost a control connection",
     "a connection that the robot was told to watch is gone", "its program ended, hung, or lost the network",
     "restore that connection or let its program end", kResume},
    {&Stop::minor_error, "MinorError", 3087, "a minor error of the power supply", "the power supply has a complaint",
     "the robot's log says which", "read the robot's log", kResetButton},
};

const Field<Inputs>& find_field(std::string_view name, std::string_view ending) noexcept {
  return *std::ranges::find_if(kInputFields, [&](const Field<Inputs>& f) {
    return f.section == rows::kSafety && f.name.starts_with(name) && f.name.substr(name.size()) == ending;
  });
}

}  // namespace

std::span<const StopInfo> stop_signals() noexcept { return kStops; }

const StopInfo& stop_info(bool StopSignals::*bit) noexcept { return *std::ranges::find(kStops, bit, &StopInfo::bit); }

const StopInfo* find_stop_by_code(std::uint16_t status_code) noexcept {
  const auto* found = std::ranges::find(kStops, status_code, &StopInfo::status_code);
  return found != std::ranges::end(kStops) ? found : nullptr;
}

const Field<Inputs>& field_of(const StopInfo& stop) noexcept { return find_field(stop.field, ""); }
const Field<Inputs>& resettable_field_of(const StopInfo& stop) noexcept { return find_field(stop.field, "Resettable"); }

}  // namespace meca::image
