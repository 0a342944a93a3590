// An EtherCAT slave controller (ESC) of a simulated robot, as a machine without I/O: registers, FMMUs, sync managers,
// SII, watchdog and clock as a master sees them through datagrams, and the other side (PDI) as the robot's application
// (device.hpp) sees them. ETG.1000.4; spec 5.3 and 6. No clock; allocates only in the constructor.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "transports/ethercat/frame.hpp"
#include "transports/ethercat/registers.hpp"

namespace meca::ethercat {

struct EscSettings {
  std::vector<std::byte> sii;                      // the image; beyond it reads FFFFh
  bool sii_reads_8_bytes = false;                  // 4 bytes a read otherwise
  Time sii_busy = std::chrono::microseconds(100);  // a read takes so long
  std::uint16_t features = 0x01CC;                 // register 0008
  std::int32_t clock_ppm = 0;                      // its clock runs faster than `now`
  std::uint64_t clock_start = 0;                   // local time at Time 0, ns
};

// What a port of the device sees; the chain (chain.hpp) says.
struct EscPorts {
  std::array<bool, 4> link{};  // port 0 towards the master, 1 away from it
};

// What goes wrong in it, for tests of a master.
struct EscFaults {
  int working_counter = 0;          // added to the WKC of logical datagrams that it takes part in
  bool lose_mailbox_reads = false;  // a read empties the mailbox of sync manager 1, but bytes and WKC do not arrive
  std::int32_t clock_drift = 0;     // ppm that its clock runs faster than the settings say, from the next access on
};

struct EscState;

class Esc {
 public:
  static constexpr unsigned kFmmus = 8, kSyncManagers = 8;
  static constexpr std::size_t kMemory = 0x3000;  // registers and 8 KiB of process RAM

  explicit Esc(const EscSettings& settings);
  ~Esc();
  Esc(Esc&&) noexcept;
  Esc& operator=(Esc&&) noexcept;

  // ---- The wire
  // A frame reaches the device (once per frame, before its datagrams), for the DC receive times of its ports: `now` at
  // port 0, `returned` at port 1 where there is a device behind it.
  void frame_begins(Time now, std::optional<Time> returned) noexcept;
  // One datagram passes: ADP, data, working counter and IRQ change as the device changes them.
  void process(MutableDatagram datagram, Time now) noexcept;
  void set_ports(const EscPorts& ports) noexcept;  // DL status; a link that goes counts in the lost link counters
  void count_invalid_frame(unsigned port) noexcept;
  // As after power-on: registers, RAM, station address, clock. The SII stays as it was written.
  void power_cycle(Time now) noexcept;

  // ---- The PDI
  void tick(Time now) noexcept;                             // watchdogs
  std::optional<std::uint16_t> take_al_control() noexcept;  // every write to 0120h, also of the same value
  void set_al_status(std::uint16_t status, std::uint16_t code) noexcept;  // code first
  std::uint16_t al_status() const noexcept;
  // Mailbox of sync manager 0: a complete mail, once; its buffer is free again afterwards.
  // The bytes stay until the next datagram passes; so do those of take_outputs().
  std::optional<Bytes> take_mail() noexcept;
  // Into sync manager 1, filled up with zeros; false when the last one was not fetched yet, when it is longer than the
  // mailbox, or when sync manager 1 is no enabled mailbox.
  bool post_mail(Bytes mail) noexcept;
  bool mail_fetched() noexcept;         // since the last call: the master has read what was posted
  bool take_repeat_request() noexcept;  // activate bit 1 of sync manager 1 was toggled: post the last mail again
  void acknowledge_repeat() noexcept;   // PDI control bit 1 follows
  // Outputs of sync manager 2: complete ones since the last call (three buffers: the newest whole one).
  std::optional<Bytes> take_outputs() noexcept;
  // Of sync manager 3. Before the first ones since it was enabled and allowed, reading them gives no WKC.
  void set_inputs(Bytes bytes) noexcept;
  struct SyncManagerSetting {
    std::uint16_t start = 0, length = 0;
    std::uint8_t control = 0;
    bool enabled = false;
  };
  SyncManagerSetting sync_manager(unsigned n) const noexcept;
  void allow_process_data(bool outputs, bool inputs) noexcept;  // off (INIT, PREOP): no WKC from SM2 and SM3
  bool take_watchdog_expiry() noexcept;                         // of the process data, since the last call
  bool sync0_active() const noexcept;                           // 0981: cyclic operation and SYNC0
  Time last_sync0_cycle() const noexcept;                       // 09A0
  std::uint64_t system_time(Time now) const noexcept;           // local clock + offset, ns
  bool sii_belongs_to_pdi() const noexcept;
  std::uint16_t station_address() const noexcept;
  bool take_reset() noexcept;  // "RES" was written to 0040 since the last call: it has done a power_cycle()

  EscFaults& faults() noexcept;
  std::span<std::byte> sii() noexcept;  // the image

  // Raw registers, for tests and the scan's pictures; masks do not apply.
  std::uint8_t peek(std::uint16_t address) const noexcept;

 private:
  std::unique_ptr<EscState> state_;
};

}  // namespace meca::ethercat
