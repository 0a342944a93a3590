// What the robot itself watches: torques, its work zone, collisions, and the stop after a boot.
#include "tests/unit/stops/situation.hpp"

namespace meca::test {
namespace {

CommandRequest asked(Cell& c, std::uint32_t command, std::initializer_list<double> arguments) {
  CommandRequest request = c.motion(command, {});
  std::copy(arguments.begin(), arguments.end(), request.arguments.begin());
  request.argument_count = static_cast<std::uint8_t>(arguments.size());
  return request;
}

void completed(Cell& c, std::uint32_t command, std::initializer_list<double> arguments) {
  const Receipt receipt = c.outcome(c.send(asked(c, command, arguments)));
  ASSERT_EQ(static_cast<int>(receipt.state), static_cast<int>(ReceiptState::kCompleted)) << describe(receipt);
}

// Something stands where joint 1 brings the flange at about 45 degrees, or the zone ends there.
void move_into_it(Cell& c) {
  c.outcome(CommandKind::kReleaseControl);
  c.make_ready();
  c.move(90);
  c.steps(3000);
  ASSERT_NE(c.model.inputs().robot_status.error_code, 0) << "nothing was in the way";
  c.outcome(CommandKind::kReleaseControl);
  c.steps(200);
}

}  // namespace

std::vector<Situation> watch_situations() {
  sim::RobotOptions boots_into_a_stop = robot();
  boots_into_a_stop.reboot_stop = true;
  return {
      {"the_power_supply_waits_for_reset_after_a_boot",
       [](Cell& c) { c.connect(); },
       "the stop after a reboot",
       "press Reset on the power supply, then 'meca-ctl activate'",
       {{"press Reset on the power supply", [](Cell& c) { c.model.press_reset_button(); }}},
       boots_into_a_stop},
      {"a_joint_is_held_and_its_torque_limit_pauses_the_robot",
       [](Cell& c) {
         c.make_ready();
         completed(c, image::kSetTorqueLimitsCfg, {2, 0});  // pause
         completed(c, image::kSetTorqueLimits, {60, 60, 60, 60, 60, 60});
         c.move(90);
         c.steps(300);
         c.model.push(1, 80);
         c.steps(500);
       },
       "motion is paused: a joint's torque exceeds its limit",
       "free the arm or lower load and speed, then 'meca-ctl resume'",
       {{"free the arm", [](Cell& c) { c.model.push(1, 0); }}},
       robot()},
      {"the_arm_came_to_the_border_of_its_work_zone",
       [](Cell& c) {
         c.connect();
         completed(c, image::kSetWorkZoneLimits, {-1000, -1000, -1000, 1000, 100, 1000});
         completed(c, image::kSetWorkZoneCfg, {4, 1});  // error; the flange's centre point
         move_into_it(c);
       },
       "robot error 3049",
       "'meca-ctl reset-error' and 'meca-ctl resume'",
       {},
       robot()},
      {"something_stands_in_the_arms_way",
       [](Cell& c) {
         c.connect();
         completed(c, image::kSetCollisionCfg, {4});  // error
         c.model.place_obstacle(140, 140, 308, 40);
         move_into_it(c);
       },
       "robot error 3041",
       "'meca-ctl reset-error' and 'meca-ctl resume'",
       {},
       robot()},
  };
}

}  // namespace meca::test
