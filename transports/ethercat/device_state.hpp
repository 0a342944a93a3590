// The inside of the device, for its own files (device*.cpp) only: what it remembers, and which file does what.
#pragma once

#include <array>
#include <optional>

#include "transports/ethercat/coe_server.hpp"
#include "transports/ethercat/device.hpp"
#include "transports/ethercat/object_dictionary.hpp"

namespace meca::ethercat {

// An AL request that is being worked at.
struct Transition {
  std::uint16_t asked = 0;  // the low nibble of AL control
  Time done{};              // when the application is ready
  Time give_up{};           // of waiting for outputs on the way to OP
};

struct OutgoingMail {
  std::array<std::byte, kMailboxSize> bytes{};
  std::size_t size = 0;  // 0: none
  Bytes view() const noexcept { return Bytes(bytes).first(size); }
};

struct MailboxState {
  OutgoingMail reply, before;     // the last mail and the one before it, for a repetition
  bool again = false;             // `before`, as soon as there is room
  bool waiting = false;           // the reply is not yet posted
  Time ready{};                   // then it is
  bool blamed = false;            // of a mail that was written while a reply was there
  std::uint8_t counter = 0;       // of what we send
  std::uint8_t last_request = 0;  // counter of the last mail from the master
  std::array<Emergency, 4> emergencies{};
  std::size_t emergency_count = 0;
};

struct DeviceState {
  explicit DeviceState(const DeviceSettings& s);

  DeviceSettings settings;
  Esc esc;
  DeviceFaults faults;
  DeviceCounters counters;
  ObjectDictionary objects;
  CoeServer coe;
  MailboxState mailbox;

  std::optional<Transition> transition;
  bool outputs_arrived = false;    // since SAFEOP, and not so long ago that the watchdog ran out
  bool distributed_clock = false;  // SYNC0 was active on the way to SAFEOP
  std::uint32_t missed_sync = 0;   // SYNC0 cycles without outputs: up for each one, down for a good one
  Time next_sync{};
  bool outputs_in_cycle = false;
  bool fresh = false;
  image::OutputBytes output{};
};

AlState state_of(const DeviceState& s) noexcept;
bool has_error(const DeviceState& s) noexcept;

// ---- device_states.cpp: AL state machine
void serve_al_control(DeviceState& s, Time now) noexcept;
void advance_transition(DeviceState& s, Time now) noexcept;
void watch_configuration(DeviceState& s) noexcept;  // falls when the sync managers are changed under it
void al_error(DeviceState& s, AlState state, std::uint16_t code) noexcept;  // enters the state with the error bit

// ---- device_mailbox.cpp
void serve_mailbox(DeviceState& s, Time now) noexcept;
void reset_mailbox(DeviceState& s) noexcept;
void queue_emergency(DeviceState& s, const Emergency& emergency) noexcept;

// ---- device_process_data.cpp: outputs, watchdog, SYNC0
void serve_process_data(DeviceState& s, Time now) noexcept;
// Whether two FMMUs write the outputs, or read the inputs: then the working counter and the data are anyone's guess.
bool maps_twice(const Esc& esc) noexcept;

namespace al {  // ETG.1020; spec 5.5
inline constexpr std::uint16_t kInvalidChange = 0x0011, kUnknownState = 0x0012, kNoBoot = 0x0013,
                               kMailboxConfiguration = 0x0016, kSyncManagerConfiguration = 0x0017, kSyncError = 0x001A,
                               kWatchdog = 0x001B, kOutputConfiguration = 0x001D, kInputConfiguration = 0x001E,
                               kInputMapping = 0x0024, kOutputMapping = 0x0025, kNoSync = 0x002D, kSyncCycle = 0x0035,
                               kNoSiiAccess = 0x0050;
}

}  // namespace meca::ethercat
