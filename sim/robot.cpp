#include "sim/robot.hpp"

#include "sim/robot_state.hpp"
#include "transports/image/codec.hpp"

namespace meca::sim {

Robot::Robot(const RobotOptions& options) : state_(std::make_unique<State>(options)) {}
Robot::~Robot() = default;
Robot::Robot(Robot&&) noexcept = default;
Robot& Robot::operator=(Robot&&) noexcept = default;

void Robot::step(const image::Outputs& outputs, Time dt) noexcept {
  state_->take(outputs);
  state_->advance(dt);
}
void Robot::step(const image::OutputBytes& outputs, std::endian byte_order, Time dt) noexcept {
  const image::Layout layout = state_->options.layout;
  state_->check_reserved_bits(image::sets_reserved_bits(outputs, layout));
  step(image::decode_outputs(outputs, {layout, byte_order}), dt);
}
void Robot::step_without_outputs(Time dt) noexcept { state_->advance(dt); }

const image::Inputs& Robot::inputs() const noexcept { return state_->inputs; }

void Robot::press_e_stop() noexcept { state_->press_e_stop(); }
void Robot::release_e_stop() noexcept { state_->safety.release_e_stop(); }
void Robot::press_reset_button() noexcept { state_->safety.press_reset_button(); }
void Robot::press_p_stop2() noexcept { state_->safety.press_p_stop2(); }
void Robot::release_p_stop2() noexcept { state_->safety.release_p_stop2(); }
void Robot::drop_connection() noexcept { state_->drop_connection(); }
void Robot::restore_connection() noexcept { state_->safety.restore_connection(); }
void Robot::push(int joint, double percent) noexcept {
  if (joint >= 1 && joint <= 6) state_->push[static_cast<std::size_t>(joint - 1)] = percent;
}
void Robot::place_obstacle(double x, double y, double z, double radius) noexcept {
  const Vec3 centre{x, y, z};
  state_->zones.place_obstacle(radius > 0 ? std::optional<Capsule>({centre, centre, radius}) : std::nullopt);
}
void Robot::raise_error(std::uint16_t code) noexcept { state_->fail(code); }
bool Robot::present() const noexcept { return state_->boot.present(); }
void Robot::power_cycle() noexcept { state_->power_cycle(); }
bool Robot::place_part(double width_mm) noexcept { return state_->tool.place_part(width_mm); }
void Robot::set_monitoring(bool monitoring) noexcept { state_->monitoring = monitoring; }

StopSignals Robot::stops() const noexcept { return state_->safety.signals(); }
bool Robot::monitoring() const noexcept { return state_->monitoring; }

const Journal& Robot::journal() const noexcept { return state_->journal; }
const Log<Violation>& Robot::violations() const noexcept { return state_->violations; }

}  // namespace meca::sim
