// Buttons, doors and what the robot itself watches.
#include "tests/unit/stops/situation.hpp"

namespace meca::test {
namespace {

using image::Layout;
using sim::Product;

const Deed kReleasePStop{"release it", [](Cell& c) { c.model.release_p_stop2(); }};
const Deed kReleaseEStop{"release it", [](Cell& c) { c.model.release_e_stop(); }};
const Deed kPressReset{"press Reset on the power supply", [](Cell& c) { c.model.press_reset_button(); }};
const Deed kRestoreConnection{"restore that connection", [](Cell& c) { c.model.restore_connection(); }};

void press_p_stop2(Cell& c) {
  c.make_ready();
  c.model.press_p_stop2();
  c.steps(20);
}
void release_p_stop2_unseen(Cell& c) {
  press_p_stop2(c);
  c.model.release_p_stop2();
  c.steps(20);
}
void press_e_stop(Cell& c) {
  c.make_ready();
  c.model.press_e_stop();
  c.steps(20);
}

sim::RobotOptions p_stop2_pauses() {
  sim::RobotOptions o = robot();
  o.p_stop2_severity = sim::StopSeverity::kPause;
  return o;
}

std::vector<Situation> p_stops() {
  return {
      {"p_stop2_is_pressed_on_a_standing_robot",
       press_p_stop2,
       "P-Stop 2 is active",
       "release it, then 'meca-ctl resume'",
       {kReleasePStop},
       robot()},
      {"p_stop2_is_pressed_while_a_program_moves_the_robot",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.model.press_p_stop2();
         c.steps(1000);
       },
       "P-Stop 2 is active",
       "release it, then 'meca-ctl resume'; 'cell-plc' has control: command from there, or let it release control "
       "first",
       {kReleasePStop},
       robot()},
      {"p_stop2_is_released_but_nobody_has_resumed",
       release_p_stop2_unseen,
       "P-Stop 2 is released and waits for its reset",
       "'meca-ctl resume'",
       {},
       robot()},
      {"p_stop2_only_pauses_by_the_robots_configuration",
       press_p_stop2,
       "P-Stop 2 is active",
       "release it, then 'meca-ctl resume'",
       {kReleasePStop},
       p_stop2_pauses()},
      {"p_stop2_is_pressed_on_firmware_9",
       press_p_stop2,
       "P-Stop 2 is active",
       "release it, then 'meca-ctl resume'",
       {kReleasePStop},
       robot(Layout::kFirmware9)},
      {"p_stop2_is_released_on_firmware_9",
       release_p_stop2_unseen,
       "P-Stop 2 is released and waits for its reset",
       "'meca-ctl resume'",
       {},
       robot(Layout::kFirmware9)},
      {"p_stop2_is_pressed_again_before_it_was_reset",
       [](Cell& c) {
         release_p_stop2_unseen(c);
         c.model.press_p_stop2();
         c.steps(20);
       },
       "P-Stop 2 is active",
       "release it, then 'meca-ctl resume'",
       {kReleasePStop},
       robot()},
      {"p_stop2_is_pressed_on_a_cold_robot",
       [](Cell& c) {
         c.connect();
         c.model.press_p_stop2();
         c.steps(20);
       },
       "the robot is not activated: its motors are off",
       "'meca-ctl activate'",
       {kReleasePStop},
       robot()},
  };
}

std::vector<Situation> e_stops() {
  return {
      {"e_stop_is_pressed_on_an_r4",
       press_e_stop,
       "E-Stop is active",
       "release it, press Reset on the power supply, then 'meca-ctl activate'",
       {kReleaseEStop, kPressReset},
       robot()},
      {"e_stop_is_pressed_on_an_r4_while_it_moves",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.model.press_e_stop();
         c.steps(100);
       },
       "E-Stop is active",
       "release it, press Reset on the power supply, then 'meca-ctl activate'; 'cell-plc' has control",
       {kReleaseEStop, kPressReset},
       robot()},
      {"e_stop_is_released_but_reset_was_not_pressed",
       [](Cell& c) {
         press_e_stop(c);
         c.model.release_e_stop();
         c.steps(20);
       },
       "E-Stop is released and waits for its reset",
       "press Reset on the power supply, then 'meca-ctl activate'",
       {kPressReset},
       robot()},
      {"e_stop_is_pressed_on_firmware_9",
       press_e_stop,
       "E-Stop is active",
       "release it, press Reset on the power supply if it has that button, then 'meca-ctl activate'",
       {kReleaseEStop, kPressReset},
       robot(Layout::kFirmware9)},
      {"e_stop_is_pressed_on_an_r3_which_goes_on_talking",
       press_e_stop,
       "the robot is not activated: its motors are off",
       "release E-Stop if it is pressed (a Meca500 R3 does not report it), then 'meca-ctl activate'",
       {{"release E-Stop if it is pressed", [](Cell& c) { c.model.release_e_stop(); }}},
       robot(Layout::kFirmware11, Product::kMeca500R3)},
      {"e_stop_is_pressed_on_an_r3_which_falls_silent",
       [](Cell& c) {
         c.make_ready();
         c.power_off("no reply");
       },
       "no link to the robot: no reply",
       "check its power (E-Stop takes all power of a Meca500 R3)",
       {{"check its power (E-Stop", [](Cell& c) { c.plug_in(); }}},
       robot(Layout::kFirmware11, Product::kMeca500R3)},
  };
}

std::vector<Situation> other_stops_and_several_at_once() {
  return {
      {"the_robot_lost_a_connection_it_watches",
       [](Cell& c) {
         c.make_ready();
         c.model.drop_connection();
         c.steps(20);
       },
       "a stop because the robot lost a control connection is active",
       "restore that connection or let its program end, then 'meca-ctl resume'",
       {kRestoreConnection},
       robot()},
      {"the_connection_is_back_but_nobody_has_resumed",
       [](Cell& c) {
         c.make_ready();
         c.model.drop_connection();
         c.steps(20);
         c.model.restore_connection();
         c.steps(20);
       },
       "a stop because the robot lost a control connection is over and waits for its reset",
       "'meca-ctl resume'",
       {},
       robot()},
      {"a_cold_robot_has_lost_a_connection_it_watches",
       [](Cell& c) {
         c.connect();
         c.model.drop_connection();
         c.steps(20);
       },
       "the robot is not activated: its motors are off",
       "'meca-ctl activate'",
       {kRestoreConnection},
       robot()},
      {"e_stop_and_p_stop2_are_pressed",
       [](Cell& c) {
         press_p_stop2(c);
         c.model.press_e_stop();
         c.steps(20);
       },
       "E-Stop is active",
       "release it, press Reset on the power supply, then 'meca-ctl activate'",
       {{"release it",
         [](Cell& c) {
           // The one the text is about.
           const bool e_stop = c.model.inputs().safety_status.stop.e_stop;
           e_stop ? c.model.release_e_stop() : c.model.release_p_stop2();
         }},
        kPressReset},
       robot()},
      {"e_stop_is_pressed_on_a_robot_in_error",
       [](Cell& c) {
         c.make_ready();
         c.model.raise_error(3005);
         c.model.press_e_stop();
         c.steps(20);
       },
       "E-Stop is active",
       "release it, press Reset on the power supply",
       {kReleaseEStop, kPressReset},
       robot()},
      {"p_stop2_is_pressed_on_a_robot_in_error",
       [](Cell& c) {
         press_p_stop2(c);
         c.model.raise_error(3005);
         c.steps(20);
       },
       "robot error 3005: the motion failed",
       "free the arm, check payload and path, then 'meca-ctl reset-error'",
       {kReleasePStop},
       robot()},
      {"p_stop2_is_pressed_and_a_connection_is_lost",
       [](Cell& c) {
         press_p_stop2(c);
         c.model.drop_connection();
         c.steps(20);
       },
       "P-Stop 2 is active",
       "release it",
       {kReleasePStop, kRestoreConnection},
       robot()},
      {"the_owner_died_while_p_stop2_was_pressed",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.model.press_p_stop2();
         c.kill_owner();
         c.steps(1000);
       },
       "P-Stop 2 is active",
       "release it, then 'meca-ctl resume'",
       {kReleasePStop},
       robot()},
  };
}

}  // namespace

std::vector<Situation> safety_situations() {
  std::vector<Situation> all = p_stops();
  for (const auto& part : {e_stops(), other_stops_and_several_at_once()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace meca::test
