// Time, and what the robot says: the input image.
#include "sim/robot_state.hpp"

#include <algorithm>

#include "sim/error.hpp"

namespace meca::sim {
namespace {

Settings defaults(const RobotOptions& options) noexcept {
  Settings out;
  if (options.product == Product::kMeca500R4) out.joint_velocity_limit = 150;
  return out;
}

// inferred: any start will do, the reference is arbitrary (manual 4.5.8).
constexpr Time kBoot = std::chrono::seconds(100);

}  // namespace

Robot::State::State(const RobotOptions& o)
    : options(o),
      journal(o.journal_capacity),
      tool(o.tool),
      programs(o.programs, o.product, o.layout),
      motion(defaults(o), journal, tool, programs),
      boot(o.boot_time),
      power({o.activation_time, o.homing_time, o.deactivation_time}),
      safety(o.product, o.p_stop2_severity),
      variables(o.variables),
      slots(o.layout) {
  safety.boot(o.reboot_stop);
  report();
}

void Robot::State::advance(Time dt) noexcept {
  dt = std::max(dt, Time(1));
  now += dt;
  ++cycle;
  if (boot.advance(dt)) start_up();
  if (!boot.present()) return;
  if (power.advance(dt)) {
    motion.restore_defaults();
    tool.restore_defaults();
    for (const std::uint32_t type : {20u, 21u, 22u, 24u, 25u, 29u, 31u, 54u}) slots.changed(type);
    paused = false;
    zones.restart();
  }
  if (power.homed()) tool.home();
  if (safety.stops_motion()) paused = true;

  const Joints before = motion.joints();
  if (power.ready()) {
    motion.hold(paused);
    // Recovery mode leaves the user's limits, not the arm's (spec 5.6).
    const JointLimits& l = recovery_mode ? kModelLimits : configuration.joint_limits.effective();
    if (const auto code = motion.advance(now, dt, l, recovery_mode); code != error::kNone) fail(code);
  }
  const double seconds = std::chrono::duration<double>(dt).count();
  for (std::size_t i = 0; i < 6; ++i) {
    const double velocity = (motion.joints()[i] - before[i]) / seconds;
    joint_acceleration[i] = (velocity - joint_velocity[i]) / seconds;
    joint_velocity[i] = velocity;
  }
  watch_zones(dt);
  watch_torques();
  advance_tool(seconds);
  if (motion.moving()) slots.measured_changed();
  report();
}

void Robot::State::lose_power() noexcept {
  power.cut();
  power.forget_homing();
  motion.halt(now);
  tool.cut();
}

void Robot::State::power_cycle() noexcept {
  lose_power();
  boot.cut();
}

// Everything but what the robot saves and where its arm is.
void Robot::State::start_up() noexcept {
  started_at = now;
  safety.boot(options.reboot_stop);
  motion.restart();
  zones.restart();
  tool.restore_defaults();
  slots = DynamicSlots(options.layout);
  error = error::kNone;
  sim_mode = recovery_mode = brakes_released_by_hand = paused = false;
  cleared = true;
  move_id = echo = 0;
  echo_left = 0;
  host_seconds = 0;
  outputs = {};
  refused_in_cyclic_mode = {};
}

void Robot::State::advance_tool(double seconds) noexcept {
  tool.advance(seconds);
  if (tool.take_settings_changed()) slots.changed(23);
  if (tool.take_state_changed()) {
    for (const std::uint32_t type : {52u, 53u}) slots.changed(type);
  }
}

void Robot::State::watch_zones(Time dt) noexcept {
  if (!power.ready() || !Zones::watching(configuration)) return;
  fail(zones.watch(configuration, motion.rest_ahead(dt, recovery_mode)));
}

void Robot::State::report_zones() noexcept {
  const bool collision = zones.collision_watch().event(), work_zone = zones.work_zone_watch().event();
  image::RobotStatus& r = inputs.robot_status;
  if (r.collision_status != collision) slots.changed(37);
  if (r.work_zone_status != work_zone) slots.changed(38);
  r.collision_status = collision;
  r.work_zone_status = work_zone;
}

// inferred: the limits hold while the motors are on, but only motion that is not paused already is stopped. So an error
// can be reset while something still leans on the arm; without the cause gone or the limits raised, it comes back with
// ResumeMotion.
void Robot::State::watch_torques() noexcept {
  const Settings& s = motion.settings();
  excessive_torque = s.torque_severity != severity::kSilent && power.ready() &&
                     excessive(torques(measured()), s, motion.accelerating());
  if (!excessive_torque || paused) return;
  if (s.torque_severity == severity::kPause) paused = true;
  if (s.torque_severity == severity::kError) fail(error::kTorqueLimit);
}

DynamicSource Robot::State::measured() const noexcept {
  return {options,         motion.settings(), configuration,      zones, variables,         tool,
          motion.joints(), joint_velocity,    joint_acceleration, push,  power.activated(), cycle};
}

void Robot::State::report() noexcept {
  image::RobotStatus& r = inputs.robot_status;
  r.busy = power.busy();
  r.activated = power.activated();
  r.homed = power.homed();
  r.sim_activated = sim_mode;
  r.brakes_engaged = !power.activated() && !brakes_released_by_hand;
  r.recovery_mode = recovery_mode;
  r.monitoring_mode = monitoring && options.layout == image::Layout::kFirmware11;
  report_zones();
  r.error_code = error;

  image::MotionStatus& m = inputs.motion_status;
  const bool moving = motion.moving();
  m.checkpoint_reached = motion.checkpoint_reached();
  m.checkpoint_discarded = options.layout == image::Layout::kFirmware11 ? motion.checkpoint_discarded() : 0;
  if (echo_left == 0) {
    echo = move_id;
  } else {
    --echo_left;
  }
  m.move_id = echo;
  m.fifo_space = static_cast<std::uint16_t>(motion.fifo_space());
  m.offline_program_id = motion.running_program();
  m.paused = paused && power.activated();
  m.eom = !moving;
  m.eob = !moving && motion.nothing_to_do();
  m.excessive_torque = excessive_torque;
  m.cleared = (cleared || !power.activated()) && !moving;

  report_pose();
  safety.report(options.layout, inputs);
  const auto since_boot = std::chrono::duration_cast<std::chrono::microseconds>(kBoot + now - started_at).count();
  inputs.robot_timestamp.seconds = static_cast<std::uint32_t>(since_boot / 1'000'000);
  inputs.robot_timestamp.microseconds = static_cast<std::uint32_t>(since_boot % 1'000'000);
  report_dynamic_data();
}

// The pose belongs to the joints as they are published, so that a reader finds both to agree.
void Robot::State::report_pose() noexcept {
  Joints rounded;
  for (std::size_t i = 0; i < 6; ++i) {
    inputs.target_joint_set.joints[i] = static_cast<float>(motion.joints()[i]);
    rounded[i] = inputs.target_joint_set.joints[i];
  }
  const bool settings_changed = shown_settings != motion.settings_version();
  if (settings_changed) {
    for (const std::uint32_t type : {20u, 21u, 22u, 24u, 25u, 29u, 31u}) slots.changed(type);
  }
  if (shown_before && !settings_changed && rounded == shown_joints) return;
  shown_before = true;
  shown_joints = rounded;
  shown_settings = motion.settings_version();

  const Settings& s = motion.settings();
  inputs.target_end_effector_pose = to_image(to_pose(inverse(s.wrf_transform) * forward(rounded) * s.trf_transform));
  inputs.target_wrf = to_image(s.wrf);
  inputs.target_trf = to_image(s.trf);
  const Posture p = posture(rounded);
  image::TargetConfiguration& c = inputs.target_configuration;
  c.shoulder = static_cast<std::int8_t>(p.shoulder);
  c.elbow = static_cast<std::int8_t>(p.elbow);
  c.wrist = static_cast<std::int8_t>(p.wrist);
  c.turn = static_cast<std::int8_t>(turn(rounded[5]));
}

void Robot::State::report_dynamic_data() noexcept {
  const auto types = slots.advance(outputs.dynamic_data_configuration.type_ids);
  const DynamicSource source = measured();
  for (std::size_t i = 0; i < image::kDynamicSlots; ++i) {
    inputs.dynamic_data[i] = {types[i], dynamic_values(types[i], source)};
  }
  inputs.robot_timestamp.dynamic_data_update_count = slots.update_count();
}

}  // namespace meca::sim
