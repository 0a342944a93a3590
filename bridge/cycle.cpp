#include "bridge/cycle.hpp"

#include <algorithm>

#include "bridge/control/controller.hpp"
#include "bridge/control/firmware.hpp"
#include "bridge/control/joint_limits.hpp"

namespace meca::bridge {
namespace {

using transports::LinkState;

// Stale for this long is a lost link, whatever the transport still says.
Time lost_after(const CycleSettings& s) noexcept { return std::max(s.lease, 20 * s.stale_after); }

control::ControllerSettings controller_settings(const CycleSettings& s) {
  return {s.lease,           s.velocity_lease, s.action_timeout, s.acknowledge_timeout,
          s.monitoring_only, s.allow_brakes,   s.dynamic_data,   s.clients};
}

}  // namespace

struct Cycle::State {
  explicit State(const CycleSettings& s) : settings(s), firmware(s.firmware), controller(controller_settings(s)) {}

  void receive(const transports::Exchange& exchange, Stamp stamp) noexcept;
  Quality quality(const transports::Exchange& exchange, Stamp stamp) const noexcept;
  bool usable(const transports::Exchange& exchange, Stamp stamp) const noexcept;
  void fill(CycleRecord& record, const transports::Exchange& exchange, Stamp stamp) const noexcept;

  CycleSettings settings;
  control::FirmwareProbe firmware;
  control::LimitsProbe limits;
  control::Controller controller;

  std::uint64_t cycle = 0;
  bool link_was_up = false;
  bool has_image = false;  // since the link came up
  bool fresh = false;
  image::InputBytes bytes{};  // of the last fresh image: read again when the layout becomes known
  image::Inputs inputs;
  image::Outputs outputs;
  Time received_at{};
  std::int64_t received_unix_ns = 0;
  CycleCounters counters;
};

void Cycle::State::receive(const transports::Exchange& exchange, Stamp stamp) noexcept {
  const bool up = exchange.link == LinkState::kUp;
  if (link_was_up && !up) ++counters.link_losses;
  if (link_was_up != up) {
    has_image = false;
    firmware.restart(stamp.now);
  }
  link_was_up = up;
  fresh = up && exchange.fresh;
  if (fresh) {
    bytes = exchange.input;
    has_image = true;
    received_at = stamp.now;
    received_unix_ns = stamp.unix_ns;
    ++counters.fresh_images;
  } else if (up) {
    ++counters.stale_cycles;
  }
  if (!firmware.known()) inputs.safety_status.known = false;  // what was last seen is no "no stop" after a lost link
  if (!has_image) return;
  inputs = image::decode_inputs(bytes, {firmware.layout(), settings.byte_order});
  const image::Layout before = firmware.layout();
  firmware.observe({inputs, before, fresh, stamp.now, stamp.unix_ns}, exchange.identity);
  if (firmware.layout() != before) inputs = image::decode_inputs(bytes, {firmware.layout(), settings.byte_order});
  if (!firmware.known()) inputs.safety_status.known = false;  // never "no stop" from bytes we may be misreading
}

bool Cycle::State::usable(const transports::Exchange& exchange, Stamp stamp) const noexcept {
  return exchange.link == LinkState::kUp && has_image && stamp.now - received_at <= lost_after(settings);
}

Quality Cycle::State::quality(const transports::Exchange& exchange, Stamp stamp) const noexcept {
  if (exchange.link != LinkState::kUp || !has_image) return Quality::kDisconnected;
  if (stamp.now - received_at > settings.stale_after) return Quality::kStale;
  return firmware.known() ? Quality::kGood : Quality::kUnknown;
}

void Cycle::State::fill(CycleRecord& record, const transports::Exchange& exchange, Stamp stamp) const noexcept {
  record.cycle = cycle;
  record.receive_unix_ns = received_unix_ns;
  record.quality = quality(exchange, stamp);
  record.link = exchange.link;
  record.link_detail = exchange.link_detail;
  record.transport_counters = exchange.counters;
  record.firmware_known = firmware.known();
  record.firmware_mismatch = firmware.mismatch();
  record.firmware = firmware.version();
  record.layout = firmware.layout();
  record.product_type = firmware.product_type();
  record.serial_number = firmware.serial_number();
  record.inputs = inputs;
  record.outputs = outputs;
  record.control = controller.state();
  record.counters = counters;
}

Cycle::Cycle(const CycleSettings& settings) : state_(std::make_unique<State>(settings)) {}
Cycle::~Cycle() = default;
Cycle::Cycle(Cycle&&) noexcept = default;
Cycle& Cycle::operator=(Cycle&&) noexcept = default;

void Cycle::step(std::span<const control::Request> requests, transports::Exchange& exchange, Stamp stamp,
                 StepResult& result) noexcept {
  State& s = *state_;
  ++s.cycle;
  s.receive(exchange, stamp);

  const control::View view{s.inputs, s.firmware.layout(), s.fresh, stamp.now, stamp.unix_ns};
  const control::LinkFacts link{.up = exchange.link == LinkState::kUp,
                                .usable = s.usable(exchange, stamp),
                                .firmware_known = s.firmware.known() && !s.firmware.mismatch(),
                                .product_type = s.firmware.product_type()};
  s.limits.observe(view, link.usable && link.firmware_known && s.firmware.settled());
  s.controller.step(requests, view, link);

  exchange.output_valid = s.controller.may_command();
  s.outputs = s.controller.outputs();
  // A bus without idle sends this before we have seen the robot. Firmware 9 goes on by itself unless Pause stands.
  const bool may_be_firmware_9 = s.firmware.layout() == image::Layout::kFirmware9 || exchange.identity.major == 9;
  if (s.counters.fresh_images == 0 && may_be_firmware_9) s.outputs.motion_control.pause_motion = true;
  auto& slots = s.outputs.dynamic_data_configuration.type_ids;
  slots = s.limits.slots(s.firmware.slots(s.controller.dynamic_data()));
  image::encode_outputs(s.outputs, {s.firmware.layout(), s.settings.byte_order}, exchange.output);

  s.counters.commands_received = s.controller.ledger().received();
  s.counters.commands_rejected = s.controller.ledger().rejected();
  s.fill(result.record, exchange, stamp);
  result.receipt_count = s.controller.ledger().drain(result.receipts);
}

bool Cycle::finished() const noexcept { return state_->controller.finished(); }

}  // namespace meca::bridge
