#include "transports/ethercat/esc.hpp"

#include "transports/ethercat/esc_state.hpp"

namespace meca::ethercat {
using namespace esc;

EscState::EscState(const EscSettings& s) : settings(s) { power_on(Time{}, s.clock_start); }

// Values after reset. Type and revision are those of an ET1100: which ESC a Meca500 has is not known.
void EscState::power_on(Time now, std::uint64_t local) noexcept {
  memory.fill(std::byte{0});
  put(reg::kType, 1, 0x11);
  put(reg::kType + 2u, 2, 0x0002);  // build
  put(reg::kFmmuCount, 1, Esc::kFmmus);
  put(reg::kSyncManagerCount, 1, Esc::kSyncManagers);
  put(reg::kRamSize, 1, (Esc::kMemory - kRegisters) / 1024);
  put(reg::kPortDescriptor, 1, 0x0F);  // ports 0 and 1: MII
  put(reg::kFeatures, 2, settings.features);
  put(reg::kDlControl, 4, 0x00070001);
  put(reg::kAlStatus, 2, static_cast<std::uint16_t>(AlState::kInit));
  put(reg::kAlControl, 2, static_cast<std::uint16_t>(AlState::kInit));
  put(reg::kWatchdogDivider, 2, 2498);  // 100 us
  put(reg::kPdiWatchdog, 2, 1000);      // 100 ms
  put(reg::kSmWatchdog, 2, 1000);
  put(reg::kDcSpeedStart, 2, 0x1000);
  put(reg::kDcFilterDepths, 2, 0x0C04);
  // The application has not allowed process data yet.
  for (const unsigned n : {2u, 3u}) set_bits(reg::sync_manager(n) + kSmPdiControl, kSmDeactivate, true);
  for (unsigned n = 0; n < Esc::kFmmus; ++n) decode_fmmu(n);
  for (unsigned n = 0; n < Esc::kSyncManagers; ++n) {
    sync_managers[n] = {};
    configure_sync_manager(n);
  }
  dl_status_event = al_status_event = repeat_requested = watchdog_expired = false;
  al_control.reset();
  reset_progress = 0;
  sii_command_running = 0;
  clock_anchor = now;
  clock_anchor_local = local;
  clock_loop_ppb = 0;
  mean_difference = 0;
  last_comparison.reset();
  watchdog_fed.reset();
  sii_load(true);
  show_ports();
}

// DL status: 4 + port: link; 8 + 2 x port: loop closed; 9 + 2 x port: communication.
void EscState::show_ports() noexcept {
  unsigned status = u8(reg::kDlStatus) & 1u;
  for (unsigned port = 0; port < ports.link.size(); ++port)
    status |= ports.link[port] ? 0x0010u << port | 0x0200u << 2 * port : 0x0100u << 2 * port;
  put(reg::kDlStatus, 2, status);
}

void EscState::catch_up(Time now) noexcept {
  follow_drift(now);
  if (sii_busy() && now >= sii_ready) sii_finish();
  check_watchdog(now);
}

Esc::Esc(const EscSettings& settings) : state_(std::make_unique<EscState>(settings)) {}
Esc::~Esc() = default;
Esc::Esc(Esc&&) noexcept = default;
Esc& Esc::operator=(Esc&&) noexcept = default;

void Esc::process(MutableDatagram datagram, Time now) noexcept {
  state_->catch_up(now);
  state_->process(datagram, now);
}

void Esc::set_ports(const EscPorts& ports) noexcept {
  for (unsigned port = 0; port < ports.link.size(); ++port) {
    if (state_->ports.link[port] == ports.link[port]) continue;
    state_->dl_status_event = true;
    if (!ports.link[port]) state_->count(static_cast<std::uint16_t>(reg::kLostLinks + port));
  }
  state_->ports = ports;
  state_->show_ports();
}

void Esc::count_invalid_frame(unsigned port) noexcept {
  state_->count(static_cast<std::uint16_t>(reg::kRxErrors + 2 * port));
}

void Esc::power_cycle(Time now) noexcept { state_->power_on(now, 0); }
bool Esc::take_reset() noexcept { return std::exchange(state_->reset, false); }

void Esc::tick(Time now) noexcept { state_->catch_up(now); }

std::optional<std::uint16_t> Esc::take_al_control() noexcept { return std::exchange(state_->al_control, std::nullopt); }

void Esc::set_al_status(std::uint16_t status, std::uint16_t code) noexcept {
  state_->put(reg::kAlStatusCode, 2, code);
  if (al_status() != status) state_->al_status_event = true;
  state_->put(reg::kAlStatus, 2, status);
}

std::uint16_t Esc::al_status() const noexcept { return state_->u16(reg::kAlStatus); }
std::uint16_t Esc::station_address() const noexcept { return state_->u16(reg::kStationAddress); }
EscFaults& Esc::faults() noexcept { return state_->faults; }
std::span<std::byte> Esc::sii() noexcept { return state_->settings.sii; }
std::uint8_t Esc::peek(std::uint16_t address) const noexcept { return address < kMemory ? state_->u8(address) : 0; }

}  // namespace meca::ethercat
