// What the host says: control bits, the MoveID handshake and commands.
#include <array>
#include <bit>

#include "sim/error.hpp"
#include "sim/robot_state.hpp"
#include "transports/image/error_codes.hpp"

namespace meca::sim {

void Robot::State::fail(std::uint16_t code) noexcept {
  if (code == error::kNone || error != error::kNone) return;  // the first cause stays
  error = code;
  paused = true;  // ResetError leaves the robot paused (manual, ResetError)
  cleared = true;
  motion.clear(now);
}

void Robot::State::press_e_stop() noexcept {
  safety.press_e_stop();
  power.cut();
  motion.halt(now);
  tool.relax();
  cleared = true;
  // inferred: an R3 loses all power with its E-Stop, and with it the homing.
  if (options.product != Product::kMeca500R3) return;
  power.forget_homing();
  tool.cut();
}

// inferred: firmware 9, which has no safety section to show it in, knows no such stop that waits for its reset; it
// stops, clears its queue and stays paused.
void Robot::State::drop_connection() noexcept {
  if (options.layout != image::Layout::kFirmware9) return safety.drop_connection();
  if (!power.ready()) return;
  paused = true;
  cleared = true;
  motion.clear(now);
}

void Robot::State::take(const image::Outputs& next) noexcept {
  if (monitoring || !boot.up()) return;
  check_levels(next);
  if (next.host_time.seconds != 0) host_seconds = next.host_time.seconds;
  take_robot_control(next.robot_control);
  if (power.off()) {
    const image::BrakesControl& b = next.brakes_control;
    brakes_released_by_hand = b.brakes_control_allowed && !b.brakes_engaged;
  }
  take_motion_control(next.motion_control);
  take_command(next);
  outputs = next;
}

void Robot::State::take_robot_control(const image::RobotControl& c) noexcept {
  if (c.reset_error && error != error::kNone) {
    const image::ErrorInfo* info = image::find_error_code(error);
    if (info == nullptr || info->resettable) error = error::kNone;
  }
  if (c.deactivate) {
    if (!power.off() && power.state() != Power::State::kDeactivating) {
      power.deactivate();
      motion.halt(now);
      tool.relax();
      cleared = true;
    }
  } else if (c.activate && power.off() && safety.motors_allowed() && error == error::kNone) {
    power.activate();
    brakes_released_by_hand = false;
  }
  if (c.home && power.ready() && !power.homed() && error == error::kNone) power.home();
  if (power.off() && !safety.stops_motion()) sim_mode = c.sim_mode;
  recovery_mode = c.recovery_mode;
}

void Robot::State::take_motion_control(const image::MotionControl& c) noexcept {
  if (c.pause_motion && power.ready()) paused = true;
  if (c.clear_motion && power.ready()) {
    paused = true;
    cleared = true;
    motion.clear(now);
  }
  if (safety.stops_motion()) {
    paused = true;
    if (safety.clears_motion()) {
      cleared = true;
      motion.clear(now);
    }
  }
  if (c.pause_motion || c.clear_motion) return;
  if (options.layout == image::Layout::kFirmware9) {
    // Firmware 9 has ResetPStop2 in place of ResumeMotion, and goes on by itself when both bits are 0.
    if (c.resume_motion) safety.reset_resettable();
    resume_if_possible();
  } else if (c.resume_motion && !outputs.motion_control.resume_motion && !safety.present()) {
    safety.reset_resettable();
    if (error == error::kNone) zones.accept();
    resume_if_possible();
  }
}

void Robot::State::resume_if_possible() noexcept {
  if (!paused || safety.stops_motion() || error != error::kNone || !power.ready()) return;
  paused = false;
  cleared = false;
}

bool Robot::State::takes_no_commands() const noexcept {
  return outputs.motion_control.clear_motion || safety.clears_motion() || motion.clearing();
}

void Robot::State::take_command(const image::Outputs& o) noexcept {
  const image::MotionControl& c = o.motion_control;
  if (!c.set_point) return;
  check_handshake(o);
  const bool cyclic = c.move_id == 0;
  const bool changed = c.move_id != move_id;
  if (changed) echo_left = options.echo_cycles;
  move_id = c.move_id;
  if (!cyclic && !changed) return;
  if (cyclic && o.motion_command.command_id == 0) return;
  outputs.motion_control = c;  // what follows asks whether ClearMotion is set now
  receive({o.motion_command.command_id, c.move_id, o.motion_command.arguments}, c.use_variables, cyclic);
}

void Robot::State::refuse(const Command& command, std::uint16_t code, bool cyclic) noexcept {
  if (cyclic && command == refused_in_cyclic_mode) return;
  if (cyclic) refused_in_cyclic_mode = command;
  journal.add({now, command, Outcome::kRefused, code});
}

void Robot::State::receive(const Command& received, bool use_variables, bool cyclic) noexcept {
  // The error shown stays the first one (inferred); the journal has the 1011. inferred: a reboot is possible, as some
  // errors need it.
  if (error != error::kNone && received.id != image::kRebootRobot)
    return refuse(received, error::kAlreadyInError, cyclic);
  const Verdict verdict = examine(received, use_variables,
                                  {options.product, options.layout, power.off(), power.activated(), power.homed(),
                                   recovery_mode, tool, variables, programs});
  if (verdict.code != error::kNone) {
    refuse(received, verdict.code, cyclic);
    return fail(verdict.code);
  }
  const Command& command = verdict.command;
  using enum image::CommandClass;
  const image::CommandClass kind = verdict.info->command_class;
  if (kind == kImmediate) return execute_now(command);
  if (kind == kConfiguration) return configure(command);
  if (takes_no_commands()) return refuse(command, error::kNotAllowedNow, cyclic);
  if (cyclic && kind == kVelocity) {
    if (paused) return;  // a stream that a pause has stopped is no queue
    cleared = false;
    return motion.repeat_velocity(now, command);
  }
  if (!motion.enqueue(command)) {
    violation("a command was sent while FIFOSpace was 0; it is lost");
    return refuse(command, error::kBufferFull, cyclic);
  }
  cleared = false;
}

void Robot::State::execute_now(const Command& command) noexcept {
  if (command.id == image::kSetTimeScaling) {
    apply(command, motion.joints(), motion.settings());
    slots.changed(54);
  } else if (command.id == image::kClearHoming) {
    power.forget_homing();
    tool.forget_homing();
  } else if (command.id == image::kRebootRobot) {
    lose_power();
    boot.reboot();
  } else if (variables.find(command.id) != nullptr) {
    if (const auto code = variables.set(command); code != error::kNone) {
      refuse(command, code, false);
      return fail(code);
    }
  }
  journal.add({now, command, Outcome::kExecuted, 0});
}

void Robot::State::configure(const Command& command) noexcept {
  if (!sim::configure(command, configuration)) {
    refuse(command, error::kArguments, false);
    return fail(error::kArguments);
  }
  zones.restart();
  for (const std::uint32_t type : shown_by(command.id)) slots.changed(type);
  journal.add({now, command, Outcome::kExecuted, 0});
}

// Whoever does not wait for the echo may lose a command, or have an old one run with new arguments (manual 9.2,
// p. 64).
using MotionCommandBits = std::array<std::uint32_t, sizeof(image::MotionCommand) / 4>;  // a NaN equals itself
void Robot::State::check_handshake(const image::Outputs& next) noexcept {
  if (echo == move_id) return;
  if (next.motion_control.move_id != move_id) {
    violation("MoveID was changed before the robot had echoed it");
  } else if (std::bit_cast<MotionCommandBits>(next.motion_command) !=
             std::bit_cast<MotionCommandBits>(outputs.motion_command)) {
    violation("a command or its arguments were changed before the robot had echoed its MoveID");
  }
}

void Robot::State::check_reserved_bits(bool set) noexcept {
  if (set && !reserved_bits_set) violation("a reserved bit of the output image was set");
  reserved_bits_set = set;
}

// A host that does not wait for the confirmation works by luck on a real robot.
void Robot::State::check_levels(const image::Outputs& next) noexcept {
  const auto fell = [](bool before, bool after) { return before && !after; };
  const image::RobotControl &was = outputs.robot_control, &is = next.robot_control;
  using Power = sim::Power::State;
  if (fell(was.activate, is.activate) && power.state() == Power::kActivating) {
    violation("Activate was dropped before Activated confirmed it");
  }
  if (fell(was.home, is.home) && power.state() == Power::kHoming) {
    violation("Home was dropped before Homed confirmed it");
  }
  if (fell(was.deactivate, is.deactivate) && power.state() == Power::kDeactivating) {
    violation("Deactivate was dropped before Activated confirmed it");
  }
  const bool clear_fell = fell(outputs.motion_control.clear_motion, next.motion_control.clear_motion);
  if (clear_fell && power.ready() && !inputs.motion_status.cleared) {
    violation("ClearMotion was dropped before Cleared confirmed it");
  }
}

}  // namespace meca::sim
