// Every command of Table 8: an example that is let through, and one that is refused with field, value and range.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tests/unit/control/bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;
using image::CommandClass;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Example {
  std::uint32_t id;
  std::vector<double> good;
  std::size_t argument;  // the first that is wrong in `bad`
  std::vector<double> bad;
  double minimum, maximum;  // what the refusal must say
};

// Ranges: robot manual 11.3, chapters of the TCP/IP commands (spec 2.1). Numbers 7001..8000 of checkpoints are the
// bridge's own.
const std::vector<Example> kExamples{
    {1, {175, -70, 70, 170, -115, 36000}, 2, {0, 0, 71, 0, 0, 0}, -135, 70},
    {2, {190, 0, 308, 0, 90, 0}, 3, {190, 0, 308, kNan, 90, 0}, -kInf, kInf},
    {3, {190, 0, 308, 0, 90, 0}, 0, {1e39, 0, 308, 0, 90, 0}, -kInf, kInf},
    {4, {1, 2, 3, 4, 5, 6}, 5, {1, 2, 3, 4, 5, kInf}, -kInf, kInf},
    {5, {1, 2, 3, 4, 5, 6}, 1, {1, -kInf, 3, 4, 5, 6}, -kInf, kInf},
    {6, {0.5}, 0, {-0.1}, 0, kInf},
    {7, {100}, 0, {100.1}, 0, 100},
    {8, {150}, 0, {150.1}, 0.001, 150},
    {9, {0.001}, 0, {0}, 0.001, 150},
    {10, {1000}, 0, {1001}, 0.001, 1000},
    {11, {5000}, 0, {-1}, 0.001, 5000},
    {12, {600}, 0, {600.5}, 0.001, 600},
    {13, {0, 0, 50, 0, 0, 0}, 2, {0, 0, kNan, 0, 0, 0}, -kInf, kInf},
    {14, {0, 0, 50, 0, 0, 0}, 0, {kInf, 0, 50, 0, 0, 0}, -kInf, kInf},
    {15, {1, -1, 1}, 1, {1, 0, 1}, -1, 1},
    {16, {1}, 0, {2}, 0, 1},
    {17, {7000}, 0, {7001}, 1, 7000},
    {18, {1}, 0, {0.5}, 0, 1},
    {19, {5}, 0, {4.9}, 5, 100},
    {20, {100}, 0, {101}, 5, 100},
    {24, {1}, 0, {1.01}, 0.001, 1},
    {25, {-100}, 0, {-101}, -100, 100},
    {26, {0}, 0, {-1}, 0, 1},
    {27, {100, 100, 100, 100, 100, 0.001}, 5, {100, 100, 100, 100, 100, 0}, 0.001, 100},
    {28, {4, 2}, 0, {3, 2}, 0, 4},
    {29, {1, 2, 3, 4, 5, 6}, 0, {200, 0, 0, 0, 0, 0}, -175, 175},
    {30, {-1, 1}, 1, {-1, 2}, -1, 1},
    {31, {0, 5}, 1, {0, -1}, 0, kInf},
    {32, {0}, 0, {-0.5}, 0, kInf},
    {33, {100}, 0, {0}, 0.001, 150},
    {48, {100}, 0, {101}, 0.001, 100},
    {49, {1}, 0, {2}, 0, 1},
    {50, {4}, 0, {2}, 0, 4},
    {51, {3}, 0, {-3}, 0, kInf},
    {60, {0.5, 0, 0, 10}, 0, {-0.5, 0, 0, 10}, 0, kInf},
    {100, {1}, 0, {0}, 1, 65534},
    {150, {2, -60, 80}, 0, {7, -60, 80}, 1, 6},
    {150, {2, -70, 90}, 1, {2, -71, 90}, -70, 65},
    {150, {2, -60, -35}, 2, {2, -60, -36}, -35, 90},
    {150, {6, 0, 0}, 0, {1.5, 0, 0}, 1, 6},
    {151, {1}, 0, {2}, 0, 1},
    {152, {4, 3}, 1, {4, 0}, 1, 3},
    {153, {-500, -500, 0, 500, 500, 500}, 4, {-500, 500, 0, 500, 400, 500}, 500, kInf},
    {153, {0, 0, 0, 0, 0, 0}, 5, {0, 0, 0, 1, 1, 0}, 0, kInf},
    {154, {0}, 0, {3}, 0, 4},
    {155, {0, 0, 50, 20}, 3, {0, 0, 50, -1}, 0, kInf},
    {156, {0}, 0, {-1}, 0, 1},
    {10000, {1}, 0, {kNan}, -kInf, kInf},
    {19999, {1, 2, 3, 4, 5, 6}, 5, {1, 2, 3, 4, 5, kNan}, -kInf, kInf},
};
const std::set<std::uint32_t> kWithoutArguments{0, 200, 1002};

CommandRequest command(Bench& b, std::uint32_t id, const std::vector<double>& arguments) {
  CommandRequest r = b.motion(id, {});
  std::ranges::copy(arguments, r.arguments.begin());
  r.argument_count = static_cast<std::uint8_t>(arguments.size());
  return r;
}

bool for_a_robot_that_is_off(std::uint32_t id) {
  return image::find_motion_command(id)->command_class == CommandClass::kConfiguration || id == image::kRebootRobot;
}

Bench bench_for(std::uint32_t id, CycleSettings settings = {}) {
  Bench b(settings);
  for_a_robot_that_is_off(id) ? b.connect() : b.connect_ready();
  return b;
}

TEST(Commands, all_have_an_example_here_but_those_of_other_robots_and_the_velocities) {
  std::set<std::uint32_t> shown = kWithoutArguments;
  for (const Example& e : kExamples) shown.insert(e.id);
  for (const image::MotionCommandInfo& info : image::motion_commands()) {
    const bool refused =
        info.command_class == CommandClass::kOtherRobots || info.command_class == CommandClass::kVelocity;
    EXPECT_EQ(shown.contains(info.id), !refused) << info.name;
    if (!refused) continue;
    Bench b = bench_for(info.id);
    const std::vector<double> arguments(info.arguments.size(), 1.0);
    EXPECT_OUTCOME(b.outcome(b.send(command(b, info.id, arguments))), kRejected, Reason::kUnknownCommand);
  }
  Bench b = bench_for(image::kMoveJoints);
  for (const std::uint32_t id : {52u, 101u, 157u, 201u, 1000u, 9999u, 20000u, 4294967295u}) {
    EXPECT_OUTCOME(b.outcome(b.send(command(b, id, {}))), kRejected, Reason::kUnknownCommand);
  }
}

TEST(Commands, good_ones_reach_the_robot_as_they_were_asked_for) {
  const auto check = [](std::uint32_t id, const std::vector<double>& arguments) {
    Bench b = bench_for(id);
    EXPECT_OUTCOME(b.outcome(b.send(command(b, id, arguments))), kCompleted, Reason::kNone);
    b.steps(5);
    ASSERT_EQ(b.robot.executed.size(), 1u) << id;
    EXPECT_EQ(b.robot.executed[0].command, id);
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      EXPECT_EQ(b.robot.executed[0].arguments[i], static_cast<float>(arguments[i])) << id;
    }
  };
  for (const Example& e : kExamples) check(e.id, e.good);
  for (const std::uint32_t id : kWithoutArguments) check(id, {});
}

TEST(Commands, bad_ones_are_refused_with_field_value_and_range_and_never_sent) {
  for (const Example& e : kExamples) {
    Bench b = bench_for(e.id);
    const image::MotionCommandInfo& info = *image::find_motion_command(e.id);
    const Receipt r = b.outcome(b.send(command(b, e.id, e.bad)));
    EXPECT_OUTCOME(r, kRejected, Reason::kArgumentRange);
    EXPECT_EQ(r.argument, e.argument) << describe(r);
    const double value = e.bad[e.argument];
    EXPECT_TRUE(r.value == value || (std::isnan(value) && std::isnan(r.value))) << describe(r);
    EXPECT_DOUBLE_EQ(r.minimum, e.minimum) << describe(r);
    EXPECT_DOUBLE_EQ(r.maximum, e.maximum) << describe(r);
    EXPECT_NE(describe(r).find(std::string(info.arguments[e.argument].name)), std::string::npos) << describe(r);
    b.steps(5);
    EXPECT_FALSE(b.out.motion_control.set_point);
    EXPECT_TRUE(b.robot.executed.empty());
    EXPECT_OUTCOME(b.outcome(b.send(command(b, e.id, e.good))), kCompleted, Reason::kNone);  // the session lives on
  }
}

TEST(Commands, with_a_number_that_is_none_are_refused_whichever_argument_it_is) {
  for (const Example& e : kExamples) {
    Bench b = bench_for(e.id);
    for (std::size_t i = 0; i < e.good.size(); ++i) {
      for (const double none : {kNan, kInf, -kInf, 1e39}) {
        auto arguments = e.good;
        arguments[i] = none;
        const Receipt r = b.outcome(b.send(command(b, e.id, arguments)));
        EXPECT_OUTCOME(r, kRejected, Reason::kArgumentRange);
        EXPECT_EQ(r.argument, i) << describe(r);
      }
    }
  }
}

TEST(Commands, with_too_few_or_too_many_arguments_are_refused) {
  const auto check = [](std::uint32_t id, std::vector<double> arguments, bool fewer_may_do) {
    Bench b = bench_for(id);
    if (!arguments.empty() && !fewer_may_do) {
      auto few = arguments;
      few.pop_back();
      const Receipt r = b.outcome(b.send(command(b, id, few)));
      EXPECT_OUTCOME(r, kRejected, Reason::kArgumentCount);
      EXPECT_EQ(r.value, static_cast<double>(few.size()));
      EXPECT_EQ(r.minimum, static_cast<double>(arguments.size()));
    }
    if (arguments.size() == 6 || fewer_may_do) return;
    arguments.push_back(0);
    EXPECT_OUTCOME(b.outcome(b.send(command(b, id, arguments))), kRejected, Reason::kArgumentCount);
  };
  for (const Example& e : kExamples) check(e.id, e.good, e.id >= image::kFirstVariable);
  for (const std::uint32_t id : kWithoutArguments) check(id, {}, false);
  Bench b = bench_for(image::kFirstVariable);
  EXPECT_OUTCOME(b.outcome(b.send(command(b, image::kFirstVariable, {}))), kRejected, Reason::kArgumentCount);
}

TEST(Commands, are_refused_in_the_wrong_state_of_the_robot) {
  for (const Example& e : kExamples) {
    const CommandClass c = image::find_motion_command(e.id)->command_class;
    if (c == CommandClass::kImmediate) continue;
    const auto outcome = [&e](Bench& b) { return b.outcome(b.send(command(b, e.id, e.good))); };
    if (c == CommandClass::kConfiguration) {
      Bench on;
      on.connect_ready();
      EXPECT_OUTCOME(outcome(on), kRejected, Reason::kWrongState);
    } else {
      Bench off;
      off.connect();
      EXPECT_OUTCOME(outcome(off), kRejected, Reason::kNotActivated);
      off.robot.in.robot_status.activated = true;
      off.steps(2);
      EXPECT_OUTCOME(outcome(off), kRejected, Reason::kNotHomed);
      Bench stopped = bench_for(e.id);
      stopped.robot.in.safety_status.stop.p_stop2 = true;
      stopped.steps(2);
      EXPECT_OUTCOME(outcome(stopped), kRejected, Reason::kSafetyStop);
      Bench slow;
      slow.robot.in.robot_status.activated = true;
      slow.connect();
      slow.outcome(kRecoveryMode, {1});
      EXPECT_OUTCOME(outcome(slow), kCompleted, Reason::kNone);  // recovery mode needs no homing
    }
    Bench in_error = bench_for(e.id);
    in_error.robot.raise_error(1016);
    in_error.steps(2);
    EXPECT_OUTCOME(outcome(in_error), kRejected, Reason::kRobotError);
  }
  Bench on = bench_for(image::kMoveJoints);
  EXPECT_OUTCOME(on.outcome(on.send(command(on, image::kRebootRobot, {}))), kRejected, Reason::kWrongState);
}

TEST(Commands, are_refused_by_a_firmware_that_does_not_have_them) {
  for (const Layout layout : {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11}) {
    for (const Example& e : kExamples) {
      Bench b({}, layout);
      for_a_robot_that_is_off(e.id) ? b.connect() : b.connect_ready();
      const bool known = image::find_motion_command(e.id)->since <= layout;
      const Receipt r = b.outcome(b.send(command(b, e.id, e.good)));
      EXPECT_OUTCOME(r, known ? kCompleted : kRejected, known ? Reason::kNone : Reason::kUnknownCommand);
    }
  }
}

TEST(Commands, of_an_r3_go_to_100_percent_where_those_of_an_r4_go_to_150) {
  for (const std::uint32_t id : {image::kSetJointVel, image::kSetJointVelLimit}) {
    Bench b;
    b.robot.product_type = 3;
    b.connect_ready();
    EXPECT_OUTCOME(b.outcome(b.send(command(b, id, {100}))), kCompleted, Reason::kNone);
    const Receipt r = b.outcome(b.send(command(b, id, {101})));
    EXPECT_OUTCOME(r, kRejected, Reason::kArgumentRange);
    EXPECT_EQ(r.maximum, 100);
  }
}

}  // namespace
}  // namespace meca::test
