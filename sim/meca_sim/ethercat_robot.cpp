#include "sim/meca_sim/ethercat_robot.hpp"

#include <algorithm>

namespace meca::sim {
namespace {

constexpr Time kLongestSilence = std::chrono::milliseconds(100);
constexpr Time kShortestStep = std::chrono::microseconds(1);
// The device's application looks at mails, AL control and watchdogs so often without a frame.
constexpr Time kTick = std::chrono::milliseconds(1);
// Another maker's device: an EK1100, as its public ESI has it, the coupler of terminals that is often met in front of a
// robot.
constexpr std::uint32_t kForeignVendor = 2, kForeignProduct = 0x044C'2C52;

}  // namespace

EthercatRobot::EthercatRobot(const RobotOptions& model, const ethercat::DeviceSettings& device, bool foreign,
                             ConnectionLoss on_loss, Time now)
    : robot_(model),
      device_(device),
      format_{model.layout, std::endian::little},
      on_loss_(on_loss),
      lived_until_(now),
      next_tick_(now + kTick) {
  faults_.bus = Fieldbus::kEthercat;
  faults_.foreign = foreign;
  if (foreign) exchange_device(now);
  show_inputs();
}

void EthercatRobot::advance(Time now) noexcept {
  carry_faults(now);
  device_.tick(now);
  next_tick_ = now + kTick;
  watch_connection();
  live(now);
  watch_power(now);
}

Time EthercatRobot::next_event() const noexcept { return std::min(next_cycle(), next_tick_); }

void EthercatRobot::carry_faults(Time now) noexcept {
  ethercat::DeviceFaults& to = device_.faults();
  to.refuse_state = faults_.refuse_state;
  to.working_counter = faults_.working_counter;
  to.lose_mailbox_replies = faults_.lose_mails;
  to.no_mailbox = faults_.no_mailbox;
  to.frozen_inputs = faults_.frozen;
  to.clock_drift = faults_.clock_drift;
  if (faults_.events.al_errors != seen_.al_errors) device_.raise_al_error(faults_.events.al_error, now);
  if (faults_.events.emergencies != seen_.emergencies) device_.send_emergency({.code = faults_.events.emergency});
  seen_ = faults_.events;
  // At once, so that nothing of it is left when the power is back. An exchange takes time too: the place is empty
  // meanwhile.
  if ((faults_.without_power && !without_power_) || faults_.foreign != foreign_) robot_.power_cycle();
  without_power_ = faults_.without_power;
  if (faults_.foreign != foreign_) exchange_device(now);
}

void EthercatRobot::exchange_device(Time now) noexcept {
  foreign_ = faults_.foreign;
  device_.exchange(foreign_ ? kForeignVendor : ethercat::kMecademicVendor,
                   foreign_ ? kForeignProduct : ethercat::kMeca500Product, now);
  was_operational_ = false;
}

void EthercatRobot::live(Time now) noexcept {
  const bool fresh = device_.take_fresh() && !faults_.frozen && powered() && !foreign_;
  if (!fresh && now < next_cycle()) return;
  if (fresh) {
    const Time dt = std::clamp(now - lived_until_, kShortestStep, kLongestSilence);
    robot_.step(device_.output(), format_.byte_order, dt);
    lived_until_ = now;
  } else {
    lived_until_ = std::max(lived_until_, now - kLongestSilence);
    for (; lived_until_ + kCycle <= now; lived_until_ += kCycle) {
      if (!without_power_) robot_.step_without_outputs(kCycle);
    }
  }
  follows_host_ = fresh;
  show_inputs();
}

// What was connected is forgotten, and is no loss to the robot: it starts up without a memory of it.
void EthercatRobot::watch_power(Time now) noexcept {
  if (powered() == was_powered_) return;
  was_powered_ = powered();
  device_.power_cycle(now);
  was_operational_ = false;
}

void EthercatRobot::watch_connection() noexcept {
  if (device_.operational() == was_operational_) return;
  was_operational_ = device_.operational();
  if (on_loss_ == ConnectionLoss::kContinue) return;
  if (was_operational_) robot_.restore_connection();
  if (!was_operational_) robot_.drop_connection();
}

void EthercatRobot::show_inputs() noexcept {
  image::InputBytes input{};
  image::encode_inputs(robot_.inputs(), format_, input);
  device_.set_input(input);
}

}  // namespace meca::sim
