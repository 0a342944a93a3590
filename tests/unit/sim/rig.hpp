// A simulated robot on the bench: time moves when the test says so, and the host's part of a conversation is one line.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "sim/robot.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::sim {

using namespace std::chrono_literals;

class Rig {
 public:
  explicit Rig(RobotOptions options = quick()) : robot(options) {}

  // Activation and homing take no time to speak of, actual values no noise.
  static RobotOptions quick() {
    RobotOptions o;
    o.activation_time = o.homing_time = o.deactivation_time = 2ms;
    o.noise = false;
    return o;
  }
  static RobotOptions quick(image::Layout layout, Product product = Product::kMeca500R4) {
    RobotOptions o = quick();
    o.layout = layout;
    o.product = product;
    return o;
  }

  const image::Inputs& step(Time dt = 1ms) {
    robot.step(out, dt);
    return robot.inputs();
  }
  const image::Inputs& run(Time total, Time dt = 1ms) {
    for (Time t{}; t < total; t += dt) step(dt);
    return robot.inputs();
  }
  // Steps until `done(inputs)`; returns how long it took, or fails after `limit`.
  template <class Done>
  Time run_until(Done done, Time limit = 60s, Time dt = 1ms) {
    Time t{};
    while (!done(robot.inputs())) {
      step(dt);
      t += dt;
      if (t > limit) {
        ADD_FAILURE() << "did not happen within " << limit.count() / 1000000 << " ms of robot time";
        break;
      }
    }
    return t;
  }

  void activate() {
    out.robot_control.activate = true;
    run_until([](const auto& in) { return in.robot_status.activated; });
    out.robot_control.activate = false;
    step();
  }
  void home() {
    out.robot_control.home = true;
    run_until([](const auto& in) { return in.robot_status.homed; });
    out.robot_control.home = false;
    step();
  }
  void make_ready() {
    activate();
    home();
  }

  // The MoveID handshake: one cycle, then the echo must be there.
  void send(std::uint32_t id, const std::vector<double>& arguments = {}) {
    out.motion_command.command_id = id;
    out.motion_command.arguments = {};
    std::size_t i = 0;
    for (const double a : arguments) out.motion_command.arguments[i++] = static_cast<float>(a);
    out.motion_control.set_point = true;
    out.motion_control.move_id = next_id_++;
    step();
    EXPECT_EQ(robot.inputs().motion_status.move_id, out.motion_control.move_id);
  }
  // Sends, and waits until the arm rests with an empty queue.
  Time perform(std::uint32_t id, const std::vector<double>& arguments = {}) {
    send(id, arguments);
    return 1ms + run_until([](const auto& in) { return in.motion_status.eob || in.robot_status.error_code != 0; });
  }
  void resume() {
    out.motion_control.resume_motion = true;
    step();
    out.motion_control.resume_motion = false;
    step();
  }
  void reset_error() {
    out.robot_control.reset_error = true;
    step();
    out.robot_control.reset_error = false;
    step();
  }

  std::uint16_t error() const { return robot.inputs().robot_status.error_code; }
  const image::MotionStatus& motion() const { return robot.inputs().motion_status; }
  double joint(int number) const {
    return robot.inputs().target_joint_set.joints[static_cast<std::size_t>(number - 1)];
  }

  Robot robot;
  image::Outputs out;

 private:
  std::uint16_t next_id_ = 1;
};

}  // namespace meca::sim
