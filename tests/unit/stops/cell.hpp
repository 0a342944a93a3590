// A cell with one robot and the whole way to a person's eyes, without DDS: simulated robot, Cycle, diagnosis, samples,
// and the text that `meca-ctl status` prints. Hands that reach into the cell, and `meca-ctl` commands as they are
// typed.
#pragma once

#include <string>
#include <string_view>

#include "bridge/cycle.hpp"
#include "cli/view.hpp"
#include "sim/robot.hpp"
#include "tests/unit/control/bench.hpp"

namespace meca::test {

class Cell : public Bench {
 public:
  Cell(const CycleSettings& settings, const sim::RobotOptions& options);

  // --- what is read
  cli::RobotView view() const;
  std::string status() const;         // `meca-ctl status`
  std::string why_not_ready() const;  // its line "Ready": "yes", or "no: CAUSE; REMEDY"
  bool ready() const;
  float joint1() const { return result->record.inputs.target_joint_set.joints[0]; }

  // --- what is typed: `meca-ctl VERB`, waited for; control is given back behind it
  Receipt meca_ctl(std::string_view verb);
  // The same from the program that has control, "cell-plc".
  Receipt owner_does(std::string_view verb);
  // Some degrees from here, asked for by the owner or, where there is none, by meca-ctl. Whether the arm got there.
  bool a_command_moves_the_arm();

  // --- what hands and programs do
  void make_ready();                         // activated and homed by meca-ctl; nobody has control
  void owner_moves(double q1 = 90);          // "cell-plc" takes control, and a long move is under way
  void kill_owner() { keep_alive = false; }  // its lease is not renewed any more
  void cut_link(std::string_view detail);    // cable out
  void plug_in() { link_up = true; }
  void power_off(std::string_view detail);  // the robot's power goes, and what it kept in memory
  void lose_images(int cycles);
  void restart_bridge(const CycleSettings& changed);  // SIGTERM, and a new process with this configuration

  sim::RobotOptions options;
  sim::Robot model;

 private:
  CommandRequest typed(std::string_view verb, const ClientName& who, const ParticipantId& from);
  Receipt answer(const CommandRequest& request, bool renews);
  int calls_ = 0;  // of meca-ctl: each is a process with a DDS participant of its own
};

}  // namespace meca::test
