// The test bench with the simulated Meca500, which records what it did and every rule a host breaks.
#pragma once

#include <vector>

#include "sim/robot.hpp"
#include "tests/unit/control/bench.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::test {

struct SimBench : Bench {
  explicit SimBench(Layout layout = Layout::kFirmware11, CycleSettings s = {}) : SimBench(options(layout), s) {}
  explicit SimBench(const sim::RobotOptions& o, CycleSettings s = {}) : Bench(s, o.layout), model(o) { sim = &model; }
  static sim::RobotOptions options(Layout layout) {
    sim::RobotOptions o;
    o.layout = layout;
    o.activation_time = 200ms;
    o.homing_time = 300ms;
    o.deactivation_time = 50ms;
    o.boot_time = 500ms;
    o.noise = false;
    return o;
  }
  void make_ready() {
    connect();
    ASSERT_EQ(outcome(CommandKind::kActivate).state, ReceiptState::kCompleted);
    ASSERT_EQ(outcome(CommandKind::kHome).state, ReceiptState::kCompleted);
  }
  // What clients asked for and the robot did: without the bridge's own checkpoints and what programs did by themselves.
  std::vector<sim::Command> executed() const {
    std::vector<sim::Command> list;
    for (auto i = model.journal().first(); i < model.journal().size(); ++i) {
      const sim::JournalEntry& e = model.journal()[i];
      const bool own = e.command.id == image::kSetCheckpoint && e.command.arguments[0] > 7000;
      if (e.outcome == sim::Outcome::kExecuted && !own && e.command.program == 0) list.push_back(e.command);
    }
    return list;
  }
  void expect_no_violation() const {
    for (auto i = model.violations().first(); i < model.violations().size(); ++i) {
      ADD_FAILURE() << model.violations()[i].what;
    }
  }
  sim::Robot model;
};

}  // namespace meca::test
