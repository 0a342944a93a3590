// Robot errors: those a command brings about, those that happen in the cell, and those a reset does not clear.
#include "tests/unit/stops/situation.hpp"

namespace meca::test {
namespace {

std::function<void(Cell&)> ready_then_error(std::uint16_t code) {
  return [code](Cell& c) {
    c.make_ready();
    c.model.raise_error(code);
    c.steps(20);
  };
}

// A command that the bridge cannot judge and the robot refuses.
std::function<void(Cell&)> refused_by_the_robot(std::uint32_t command, std::initializer_list<double> arguments) {
  return [command, list = std::vector<double>(arguments)](Cell& c) {
    c.make_ready();
    CommandRequest request = c.motion(command, {});
    std::copy(list.begin(), list.end(), request.arguments.begin());
    request.argument_count = static_cast<std::uint8_t>(list.size());
    c.outcome(c.send(request));
    c.outcome(CommandKind::kReleaseControl);
    c.steps(200);
  };
}

const Deed kPowerCycle{"power the robot off and on again", [](Cell& c) {
                         c.power_off("no reply");
                         c.steps(500);
                         c.plug_in();
                       }};

}  // namespace

std::vector<Situation> error_situations() {
  return {
      {"the_arm_hit_something_while_a_program_moved_it",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.model.raise_error(3005);
         c.steps(200);
       },
       "robot error 3005: the motion failed (likely: a collision, a blocked joint or an overload)",
       "free the arm, check payload and path, then 'meca-ctl reset-error' and 'meca-ctl resume'; 'cell-plc' has "
       "control",
       {},
       robot()},
      {"an_error_is_there_and_nobody_has_control",
       ready_then_error(3029),
       "robot error 3029: a joint exceeded its torque limit",
       "free the arm, check payload and torque limits, then 'meca-ctl reset-error' and 'meca-ctl resume'",
       {},
       robot()},
      {"a_pose_was_out_of_reach",
       refused_by_the_robot(image::kMovePose, {2000, 0, 300, 0, 90, 0}),
       "robot error 1016: the target is beyond the arm's reach",
       "'meca-ctl reset-error' and 'meca-ctl resume', then check target, WRF and TRF, and move the target closer",
       {},
       robot()},
      {"a_gripper_command_came_to_a_robot_without_one",
       refused_by_the_robot(image::kMoveGripper, {2}),
       "robot error 1038: no gripper is connected",
       "connect the gripper, then 'meca-ctl reset-error'",
       {},
       robot()},
      {"an_error_that_no_document_names",
       ready_then_error(4999),
       "robot error 4999, which no document names",
       "read the robot's log, then try 'meca-ctl reset-error' and 'meca-ctl resume'",
       {},
       robot()},
      {"the_activation_failed",
       [](Cell& c) {
         c.connect();
         c.model.raise_error(1013);
         c.steps(20);
       },
       "robot error 1013: the robot could not be activated",
       "clear all safety stops, then 'meca-ctl reset-error', then activate again",
       {},
       robot()},
      {"the_homing_failed",
       [](Cell& c) {
         c.connect();
         c.meca_ctl("activate");
         c.model.raise_error(1014);
         c.steps(20);
       },
       "robot error 1014: homing did not succeed",
       "free the arm and the gripper, then 'meca-ctl reset-error' and 'meca-ctl resume', then home again",
       {},
       robot()},
      {"the_drives_do_not_answer_and_a_reset_does_not_help",
       ready_then_error(3006),
       "robot error 3006: the robot lost contact with its drives",
       "power the robot off and on again; contact the vendor's support when it persists; reset-error does not "
       "clear",
       {kPowerCycle},
       robot()},
      {"an_error_is_there_on_firmware_9",
       ready_then_error(3005),
       "robot error 3005: the motion failed",
       "free the arm, check payload and path, then 'meca-ctl reset-error' and 'meca-ctl resume'",
       {},
       robot(image::Layout::kFirmware9)},
      {"the_error_was_reset_but_nobody_has_resumed",
       [](Cell& c) {
         ready_then_error(3005)(c);
         c.meca_ctl("reset-error");
         c.steps(20);
       },
       "motion is paused and the queue was cleared",
       "'meca-ctl resume'",
       {},
       robot()},
  };
}

}  // namespace meca::test
