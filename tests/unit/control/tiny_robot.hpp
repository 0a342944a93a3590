// A robot of one page for the control tests: bits confirm after a few cycles, commands take one cycle each, everything
// it executed is listed. It knows nothing of the machines under test; its rules are those of spec sections 5.2 to 5.7.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "transports/image/dynamic_data_types.hpp"
#include "transports/image/image.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::test {

struct Executed {
  std::uint16_t move_id;
  std::uint32_t command;
  std::array<float, 6> arguments;
};

class TinyRobot {
 public:
  explicit TinyRobot(image::Layout layout = image::Layout::kFirmware11) : layout_(layout) {
    in.robot_status.brakes_engaged = true;
    in.motion_status.fifo_space = 13000;
    in.motion_status.eob = in.motion_status.eom = in.motion_status.cleared = true;
    in.safety_status.known = layout != image::Layout::kFirmware9;
    major = layout == image::Layout::kFirmware9 ? 9 : layout == image::Layout::kFirmware10 ? 10 : 11;
  }

  // What a test may turn.
  bool answers_actions = true;  // false: status bits never confirm
  bool echoes = true;           // false: MoveIDs are taken but never acknowledged
  bool executes = true;         // false: the queue stands still
  bool knows_firmware = true;   // false: dynamic data type 1 is never shown
  std::uint16_t major = 11;
  std::vector<float> joint_limits;  // types 14 and 15, twelve numbers; empty: not reported
  float product_type = 4;           // 3 = R3, 4 = R4
  int busy_cycles = 5;

  image::Inputs in;
  std::vector<Executed> executed;  // what left the queue by being done
  std::vector<std::string> violations;
  std::array<float, 6> velocity{};  // what the arm is doing because of commands 21-23

  void raise_error(std::uint16_t code) {
    in.robot_status.error_code = code;
    drop_queue();
    in.motion_status.paused = true;
  }
  void ready() {  // activated and homed, without the walk
    in.robot_status.activated = in.robot_status.homed = true;
    in.robot_status.brakes_engaged = false;
    in.motion_status.cleared = false;
  }
  // A command that did not come through the bridge under test.
  void sneak_in(const Executed& e) { queue_.push_back(e); }
  // Everything queued is done within one cycle.
  void skip_to_end() {
    executes = true;
    while (!queue_.empty()) run();
  }
  std::size_t queued() const { return queue_.size(); }

  // No image arrived: the robot goes on with what it has.
  void step_without_outputs() {
    image::Outputs last = previous_;
    last.motion_control.set_point = false;
    step(last);
  }

  void step(const image::Outputs& out) {
    actions(out);
    motion_levels(out);
    receive(out);
    run();
    dynamic_data(out);
    in.motion_status.fifo_space = static_cast<std::uint16_t>(13000 - queue_.size());
    in.motion_status.eob = queue_.empty();
    in.motion_status.eom = queue_.empty() || in.motion_status.paused;
    const bool refuses = !in.robot_status.activated || (answers_actions && out.motion_control.clear_motion) ||
                         in.robot_status.error_code != 0;
    if (refuses) in.motion_status.cleared = true;
    previous_ = out;
    ++cycles_;
  }

 private:
  void drop_queue() {
    for (const Executed& e : queue_) {
      if (e.command == image::kSetCheckpoint && layout_ == image::Layout::kFirmware11) {
        in.motion_status.checkpoint_discarded = static_cast<std::uint16_t>(e.arguments[0]);
      }
    }
    queue_.clear();
    in.motion_status.cleared = true;
    velocity = {};
  }

  void actions(const image::Outputs& out) {
    image::RobotStatus& s = in.robot_status;
    const image::RobotControl& c = out.robot_control;
    if (!answers_actions) return;
    if (c.reset_error && s.error_code != 0) s.error_code = 0;
    if (!s.activated && s.sim_activated != c.sim_mode) s.sim_activated = c.sim_mode;
    s.recovery_mode = c.recovery_mode;
    if (busy_ > 0 && --busy_ == 0) {
      s.busy = false;
      if (pending_ == 'a') s.activated = true, s.brakes_engaged = false;
      if (pending_ == 'h') s.homed = true;
      if (pending_ == 'd') s.activated = false, s.brakes_engaged = true;
    }
    if (busy_ == 0) {
      if (c.deactivate && s.activated) {
        drop_queue();
        begin('d');
      } else if (c.activate && !c.deactivate && !s.activated && s.error_code == 0) {
        begin('a');
      } else if (c.home && s.activated && !s.homed && s.error_code == 0) {
        begin('h');
      }
    }
    if (out.brakes_control.brakes_control_allowed && !s.activated) s.brakes_engaged = out.brakes_control.brakes_engaged;
  }
  void begin(char what) {
    pending_ = what;
    busy_ = busy_cycles;
    in.robot_status.busy = true;
  }

  void motion_levels(const image::Outputs& out) {
    image::MotionStatus& m = in.motion_status;
    const image::MotionControl& c = out.motion_control;
    if (!answers_actions) return;
    if (c.clear_motion) {
      drop_queue();
      m.paused = true;
    }
    if (c.pause_motion) m.paused = true;
    const bool edge = c.resume_motion && !previous_.motion_control.resume_motion;
    const bool free = !c.pause_motion && !c.clear_motion && in.robot_status.error_code == 0;
    if (layout_ == image::Layout::kFirmware9) {
      if (c.resume_motion && m.p_stop2_resettable) m.p_stop2 = m.p_stop2_resettable = false;
      if (free && !m.p_stop2) m.paused = false;
    } else if (edge && free) {
      m.paused = false;
      if (in.safety_status.resettable.p_stop2) {
        in.safety_status.stop.p_stop2 = in.safety_status.resettable.p_stop2 = m.p_stop2 = false;
      }
    } else if (edge && (c.pause_motion || c.clear_motion)) {
      violations.push_back("ResumeMotion while Pause or Clear stands");
    }
  }

  void receive(const image::Outputs& out) {
    const image::MotionControl& c = out.motion_control;
    image::MotionStatus& m = in.motion_status;
    velocity = {};
    if (!c.set_point) return;
    const std::uint32_t id = out.motion_command.command_id;
    if (c.move_id == 0) {
      m.move_id = 0;
      if (id >= 21 && id <= 23 && !m.paused) velocity = out.motion_command.arguments;
      if (id != 0 && (id < 21 || id > 23)) violations.push_back("a queued command in cyclic mode");
      return;
    }
    if (c.move_id == taken_) return;
    if (previous_.motion_control.set_point && previous_.motion_control.move_id != 0 &&
        previous_.motion_control.move_id != m.move_id) {
      violations.push_back("MoveID changed before its echo");
    }
    taken_ = c.move_id;
    if (echoes) m.move_id = c.move_id;
    const bool takes = !c.clear_motion && in.robot_status.error_code == 0 && queue_.size() < 13000;
    if (!takes) return;
    if (in.robot_status.activated) {
      queue_.push_back({c.move_id, id, out.motion_command.arguments});
      m.cleared = false;
    } else {
      executed.push_back({c.move_id, id, out.motion_command.arguments});  // configuration, immediate
    }
  }

  void run() {
    if (!executes || queue_.empty() || in.motion_status.paused || !in.robot_status.activated) return;
    const Executed e = queue_.front();
    queue_.pop_front();
    executed.push_back(e);
    if (e.command == image::kSetCheckpoint) {
      in.motion_status.checkpoint_reached = static_cast<std::uint32_t>(e.arguments[0]);
    }
  }

  void dynamic_data(const image::Outputs& out) {
    for (std::size_t slot = 0; slot < image::kDynamicSlots; ++slot) {
      std::uint32_t type = out.dynamic_data_configuration.type_ids[slot];
      if (type == image::kDynAutomatic) type = static_cast<std::uint32_t>(40 + (cycles_ + slot) % 4);
      if (type == image::kDynFirmwareVersion && !knows_firmware) type = 40;
      image::DynamicData& d = in.dynamic_data[slot];
      d = {type, {}};
      if (type == image::kDynFirmwareVersion) d.values = {static_cast<float>(major), 3, 1, 200, 0, 0};
      if (type == image::kDynProductType) d.values[0] = product_type;
      if (type == image::kDynSerialNumber) d.values[0] = 4711;
      const bool limits = type == 14 || type == 15;
      if (limits && joint_limits.empty()) d.type_id = 40;
      if (limits && !joint_limits.empty()) {
        const std::size_t first = type == 14 ? 0 : 6;
        for (std::size_t i = 0; i < 6; ++i) d.values[i] = joint_limits[first + i];
      }
    }
  }

  image::Layout layout_;
  image::Outputs previous_;
  std::deque<Executed> queue_;
  std::uint16_t taken_ = 0;
  int busy_ = 0;
  char pending_ = ' ';
  std::uint64_t cycles_ = 0;
};

}  // namespace meca::test
