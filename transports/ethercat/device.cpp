#include "transports/ethercat/device.hpp"

#include <utility>

#include "transports/ethercat/device_state.hpp"
#include "transports/ethercat/sii.hpp"

namespace meca::ethercat {
namespace {

void write_identity(const DeviceSettings& settings, std::span<std::byte> sii_image) noexcept {
  wire::Writer identity(sii_image.subspan(2U * sii::kVendor));  // the checksum does not reach so far
  identity.u32(settings.vendor);
  identity.u32(settings.product);
  identity.u32(settings.revision);
}

std::vector<std::byte> sii_of(const DeviceSettings& settings) {
  std::vector<std::byte> image = make_meca500_sii(settings.alias, settings.serial);
  write_identity(settings, image);
  return image;
}

EscSettings esc_settings(const DeviceSettings& settings) {
  EscSettings out = settings.esc;
  if (out.sii.empty()) out.sii = sii_of(settings);
  return out;
}

// What the application knew before the ESC was without power.
void forget(DeviceState& s) noexcept {
  s.objects.reset();
  s.objects.set_number({0x1018, 1}, s.settings.vendor);
  s.objects.set_number({0x1018, 2}, s.settings.product);
  s.transition.reset();
  s.outputs_arrived = s.fresh = false;
  s.output = {};
  reset_mailbox(s);
}

}  // namespace

DeviceState::DeviceState(const DeviceSettings& s)
    : settings(s), esc(esc_settings(s)), objects(make_meca500_dictionary(s)) {}

Device::Device(const DeviceSettings& settings) : state_(std::make_unique<DeviceState>(settings)) {}
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

Esc& Device::esc() noexcept { return state_->esc; }
const Esc& Device::esc() const noexcept { return state_->esc; }

void Device::tick(Time now) noexcept {
  DeviceState& s = *state_;
  s.esc.faults() = {.working_counter = s.faults.working_counter,
                    .lose_mailbox_reads = s.faults.lose_mailbox_replies,
                    .clock_drift = s.faults.clock_drift};
  if (s.esc.take_reset()) forget(s);
  s.esc.tick(now);
  s.objects.set_number({0x10F8, 0}, s.esc.system_time(now));
  serve_al_control(s, now);
  watch_configuration(s);
  serve_process_data(s, now);
  advance_transition(s, now);
  serve_mailbox(s, now);
}

void Device::set_input(const image::InputBytes& input) noexcept {
  state_->objects.input = input;
  if (!state_->faults.frozen_inputs) state_->esc.set_inputs(input);
}

bool Device::take_fresh() noexcept { return std::exchange(state_->fresh, false); }
const image::OutputBytes& Device::output() const noexcept { return state_->output; }
AlState Device::state() const noexcept { return state_of(*state_); }

void Device::raise_al_error(std::uint16_t code, Time) noexcept {
  const AlState state = state_of(*state_);
  al_error(*state_, state == AlState::kOp ? AlState::kSafeop : state, code);
}

void Device::send_emergency(const Emergency& emergency) noexcept { queue_emergency(*state_, emergency); }

void Device::power_cycle(Time now) noexcept {
  DeviceState& s = *state_;
  s.esc.power_cycle(now);
  forget(s);
}

void Device::exchange(std::uint32_t vendor, std::uint32_t product, Time now) noexcept {
  DeviceState& s = *state_;
  s.settings.vendor = vendor;
  s.settings.product = product;
  write_identity(s.settings, s.esc.sii());
  power_cycle(now);
}

DeviceFaults& Device::faults() noexcept { return state_->faults; }
const DeviceCounters& Device::counters() const noexcept { return state_->counters; }

}  // namespace meca::ethercat
