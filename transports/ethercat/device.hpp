// The robot's end of EtherCAT: an ESC (esc.hpp) with the application of a Meca500 behind it: AL state machine, CoE with
// its object dictionary, process data; as a machine without I/O. Stricter than devices have to be. What it does in odd
// cases, and what of that is inferred: transports/ethercat/README.md.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "transports/ethercat/esc.hpp"
#include "transports/ethercat/mailbox.hpp"
#include "transports/image/image.hpp"

namespace meca::ethercat {

struct DeviceSettings {
  image::Layout layout = image::Layout::kFirmware11;
  std::string firmware = "11.3.3.12637";  // 100Ah
  std::uint16_t alias = 0;
  std::uint32_t serial = 0;
  std::uint32_t vendor = kMecademicVendor, product = kMeca500Product, revision = kMeca500Revision;
  bool old_sync_manager_types = false;  // 1C00h reads 2, 1, 3, 4 as firmware 8 did
  // The PDOs are assigned from the start, as the ESI has it. Otherwise as on a robot that was just switched on: 1C12h
  // and 1C13h have counts and no entries, and SAFEOP is refused until a master has written them.
  bool assigned = false;
  bool wants_sii = false;  // PREOP is refused (0050h) while the master has not given the SII back
  // How long the application takes. [ROBOT]: an SDO takes 1 to 28 ms, typically 1.8.
  Time transition = std::chrono::milliseconds(2), mailbox_reply = std::chrono::milliseconds(1);
  EscSettings esc;  // `sii`: made from the identity above when empty
};

struct DeviceFaults {
  std::optional<std::uint16_t> refuse_state;  // AL code of every step upwards from PREOP
  int working_counter = 0;                    // added to the WKC of logical datagrams
  bool lose_mailbox_replies = false;          // mails are read by the master but the answer's frame bytes are lost
  bool no_mailbox = false;                    // mails are taken and never answered
  bool frozen_inputs = false;                 // the image stands still
  std::int32_t clock_drift = 0;               // ppm that its clock runs faster than the settings say
};

struct DeviceCounters {
  std::uint64_t outputs = 0;  // complete output images in OP
  std::uint64_t watchdog_expiries = 0, sync_errors = 0, refused_states = 0;
  std::uint64_t mails = 0, duplicate_mails = 0, aborts = 0;
  std::uint64_t strict = 0;  // what a careful master does not do; see README
};

struct DeviceState;

class Device {
 public:
  explicit Device(const DeviceSettings& settings);
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  Esc& esc() noexcept;
  const Esc& esc() const noexcept;

  // AL requests, mails, watchdog, sync errors up to `now`; at least once a millisecond.
  void tick(Time now) noexcept;

  // ---- The robot behind it
  void set_input(const image::InputBytes& input) noexcept;
  // In OP, once for every complete output image.
  bool take_fresh() noexcept;
  const image::OutputBytes& output() const noexcept;
  AlState state() const noexcept;
  bool operational() const noexcept { return state() == AlState::kOp; }
  // An AL error as a robot raises it itself: to SAFEOP (from OP) with this code, or the error bit in the state it is
  // in.
  void raise_al_error(std::uint16_t code, Time now) noexcept;
  void send_emergency(const Emergency& emergency) noexcept;
  void power_cycle(Time now) noexcept;
  // Another device stands in its place, just switched on: this vendor and product in SII and 1018h, the rest as it was.
  void exchange(std::uint32_t vendor, std::uint32_t product, Time now) noexcept;

  DeviceFaults& faults() noexcept;
  const DeviceCounters& counters() const noexcept;

 private:
  std::unique_ptr<DeviceState> state_;
};

}  // namespace meca::ethercat
