// The way between the bridge and the robot, and what the bridge was told about it.
#include "tests/unit/stops/situation.hpp"

namespace meca::test {
namespace {

const Deed kPlugIn{"check its power", [](Cell& c) { c.plug_in(); }};

CycleSettings expecting(transports::FirmwareVersion firmware) {
  CycleSettings s;
  s.firmware = firmware;
  return s;
}
CycleSettings monitoring_only() {
  CycleSettings s;
  s.monitoring_only = true;
  return s;
}

// As the transport says it before the first image.
void show_link(Cell& c, LinkState link, std::string_view detail) {
  c.step();
  c.exchange.link = link;
  c.exchange.link_detail = detail;
  c.step_bridge();
}

std::vector<Situation> no_way_to_the_robot() {
  return {
      {"the_cable_is_out_since_the_start",
       [](Cell& c) { c.cut_link("no reply to Forward Open"); },
       "no link to the robot: no reply to Forward Open",
       "check its power",
       {kPlugIn},
       robot()},
      {"the_cable_was_pulled_while_the_robot_stood",
       [](Cell& c) {
         c.make_ready();
         c.cut_link("time-out");
       },
       "no link to the robot: time-out",
       "check its power",
       {kPlugIn},
       robot()},
      {"the_cable_was_pulled_while_a_program_moved_the_robot",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.cut_link("time-out");
       },
       "no link to the robot: time-out",
       "check its power",
       {kPlugIn},
       robot()},
      {"the_cable_was_pulled_and_plugged_in_again_while_a_program_moved_the_robot",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.cut_link("time-out");
         c.plug_in();
         c.steps(1000);
       },
       "the bridge holds the robot (PauseMotion is set): 'cell-plc' was in control when the link was lost",
       "'meca-ctl resume'",
       {},
       robot()},
      {"the_robot_lost_its_power_and_got_it_back",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.power_off("time-out");
         c.plug_in();
         c.steps(1000);
       },
       "the robot is not activated: its motors are off",
       "'meca-ctl activate', then 'meca-ctl home'",
       {},
       robot()},
      {"the_bridge_is_still_connecting",
       [](Cell& c) { show_link(c, LinkState::kConnecting, "SAFE_OP"); },
       "connecting to the robot: SAFE_OP",
       "wait; when it stays like this, check which fieldbus the robot has switched on, and the cables",
       {{"wait;", [](Cell& c) { c.plug_in(); }}},
       robot()},
      {"the_link_is_up_and_no_image_has_come",
       [](Cell& c) { show_link(c, LinkState::kUp, ""); },
       "no image from the robot yet",
       "wait; when it stays like this, check cable and protocol",
       {{"wait;", [](Cell& c) { c.plug_in(); }}},
       robot()},
      {"images_come_late",
       [](Cell& c) {
         c.make_ready();
         c.lose_images(10);
       },
       "no fresh image from the robot: what is shown is old",
       "check the cables and the load of network and machine",
       {{"check the cables and the load of network and machine", [](Cell& c) { c.steps(1); }}},
       robot()},
      {"images_stayed_away_for_longer_than_a_program_that_moved_the_robot_could_bear",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.lose_images(300);
       },
       "no fresh image from the robot: what is shown is old",
       "check the cables and the load of network and machine",
       {{"check the cables and the load of network and machine", [](Cell& c) { c.steps(1000); }}},
       robot()},
  };
}

std::vector<Situation> what_the_bridge_was_told() {
  return {
      {"the_firmware_is_not_known_yet",
       [](Cell& c) {
         c.plug_in();
         ASSERT_TRUE(c.until([&] { return c.result->record.quality == Quality::kUnknown; }));
       },
       "the robot's firmware is not known yet",
       "wait until the robot has reported it",
       {},
       robot()},
      {"the_configuration_names_another_firmware",
       [](Cell& c) {
         c.plug_in();
         c.steps(200);
       },
       "firmware mismatch: the robot reports 11.3.0.1 and is not what the configuration expects",
       "correct 'firmware' of this robot in the configuration, or write auto, and restart the bridge",
       {{"or write auto, and restart the bridge", [](Cell& c) { c.restart_bridge({}); }}},
       robot(),
       expecting({10, 2, 1, 8120})},
      {"the_configuration_lets_the_bridge_only_monitor",
       [](Cell& c) {
         c.plug_in();
         c.steps(200);
       },
       "this bridge is configured to monitor this robot only",
       "to command it from here, set control: {enabled: true} for this robot and restart the bridge",
       {{"set control: {enabled: true} for this robot and restart the bridge", [](Cell& c) { c.restart_bridge({}); }}},
       robot(),
       monitoring_only()},
      {"the_robot_lets_this_connection_only_monitor",
       [](Cell& c) {
         c.make_ready();
         c.model.set_monitoring(true);
         c.steps(20);
       },
       "the robot lets this connection only monitor",
       "end the other control connection",
       {{"end the other control connection", [](Cell& c) { c.model.set_monitoring(false); }}},
       robot()},
      {"another_connection_has_taken_the_robot_from_a_program_that_moved_it",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.model.set_monitoring(true);
         c.steps(2000);
       },
       "the robot lets this connection only monitor",
       "end the other control connection",
       {{"end the other control connection", [](Cell& c) { c.model.set_monitoring(false); }}},
       robot()},
      {"the_bridge_was_restarted_while_a_program_moved_the_robot",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.restart_bridge(c.settings);
         c.steps(100);
       },
       "the bridge holds the robot (PauseMotion is set)",
       "'meca-ctl resume'",
       {},
       robot()},
  };
}

}  // namespace

std::vector<Situation> link_situations() {
  std::vector<Situation> all = no_way_to_the_robot();
  const std::vector<Situation> more = what_the_bridge_was_told();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace meca::test
