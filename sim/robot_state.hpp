// The inside of the simulated robot: one struct that its parts meet in, and the order in which a cycle runs through
// them.
#pragma once

#include "sim/boot.hpp"
#include "sim/configuration.hpp"
#include "sim/dynamic_data.hpp"
#include "sim/dynamic_values.hpp"
#include "sim/motion.hpp"
#include "sim/power.hpp"
#include "sim/programs.hpp"
#include "sim/reception.hpp"
#include "sim/robot.hpp"
#include "sim/safety.hpp"
#include "sim/tool.hpp"
#include "sim/variables.hpp"
#include "sim/zones.hpp"

namespace meca::sim {

struct Robot::State {
  explicit State(const RobotOptions& o);

  // One cycle: what the host says, then time, then what the robot says.
  void take(const image::Outputs& outputs) noexcept;
  void advance(Time dt) noexcept;

  void fail(std::uint16_t code) noexcept;  // enters the error state
  void press_e_stop() noexcept;
  void drop_connection() noexcept;
  void check_reserved_bits(bool set) noexcept;
  void power_cycle() noexcept;

  const RobotOptions options;
  Time now{};
  std::uint64_t cycle = 0;
  Journal journal;
  Log<Violation> violations{64};
  ExternalTool tool;
  Programs programs;
  Motion motion;
  Boot boot;
  Power power;
  Safety safety;
  Configuration configuration;  // survives deactivation and a reboot
  Zones zones;
  Variables variables;
  DynamicSlots slots;
  Joints push{};  // % of each motor's torque
  std::uint16_t error = 0;
  bool monitoring = false, sim_mode = false, recovery_mode = false;
  bool brakes_released_by_hand = false;  // while deactivated
  bool paused = false;                   // until resumed
  bool cleared = true;                   // until a command is queued or motion is resumed
  std::uint16_t move_id = 0;             // received last
  int echo_left = 0;                     // steps until it is shown
  bool reserved_bits_set = false;        // in the last image
  std::uint16_t echo = 0;                // shown: `move_id`, once it has been echoed
  std::uint32_t host_seconds = 0;        // for the robot's log only
  image::Outputs outputs;                // as received last
  image::Inputs inputs;

 private:
  void take_robot_control(const image::RobotControl& control) noexcept;
  void take_motion_control(const image::MotionControl& control) noexcept;
  void take_command(const image::Outputs& o) noexcept;
  void resume_if_possible() noexcept;
  void receive(const Command& command, bool use_variables, bool cyclic) noexcept;
  void refuse(const Command& command, std::uint16_t code, bool cyclic) noexcept;
  void execute_now(const Command& command) noexcept;
  void lose_power() noexcept;
  void start_up() noexcept;
  void configure(const Command& command) noexcept;
  bool takes_no_commands() const noexcept;
  void check_levels(const image::Outputs& next) noexcept;
  void check_handshake(const image::Outputs& next) noexcept;
  void violation(std::string_view what) noexcept { violations.add({now, what}); }

  void advance_tool(double seconds) noexcept;
  void watch_zones(Time dt) noexcept;
  void watch_torques() noexcept;
  DynamicSource measured() const noexcept;

  void report() noexcept;
  void report_zones() noexcept;
  void report_pose() noexcept;
  void report_dynamic_data() noexcept;

  Time started_at{};                              // when the robot came up last
  Joints shown_joints{};                          // as published: rounded to binary32
  Joints joint_velocity{}, joint_acceleration{};  // target, deg/s and deg/s^2
  bool excessive_torque = false;
  std::uint32_t shown_settings = 0;
  bool shown_before = false;
  Command refused_in_cyclic_mode;  // so that the journal is not flooded with it
};

}  // namespace meca::sim
