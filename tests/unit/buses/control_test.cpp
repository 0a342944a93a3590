// The promises about control, kept over every fieldbus: exactly once, stop on loss, no surprise.
#include <tuple>

#include "tests/unit/buses/buses.hpp"
#include "tests/unit/control/fault_theatre.hpp"
#include "tests/unit/control/million.hpp"
#include "tests/unit/control/sim_bench.hpp"

namespace meca::test {
namespace {

using enum ReceiptState;
using enum CommandKind;

// MECA_COMMANDS=1000000 is ./meca prove million.
std::uint64_t commands() {
  const char* wanted = std::getenv("MECA_COMMANDS");
  return wanted ? std::strtoull(wanted, nullptr, 10) : 60000;
}

class OverABus : public testing::TestWithParam<std::tuple<Bus, Layout>> {
 protected:
  static Bus bus() { return std::get<Bus>(GetParam()); }
  static Layout layout() { return std::get<Layout>(GetParam()); }
};

TEST_P(OverABus, executed_are_exactly_those_with_a_completed_receipt) {
  Million million(layout(), commands(), 1 + static_cast<unsigned>(layout()), 1,
                  settings_on(bus(), Million::settings_for_play()));
  const auto wire = lay_wire(bus(), million);
  million.allow_unknown(21);  // one for each cut, and the restart
  million.play();
  std::printf("executed and told ABORTED %llu; %s\n", static_cast<unsigned long long>(million.figures().unknown),
              wire->figures().c_str());
  EXPECT_GT(wire->connections(), 5U) << "the cuts were no cuts";
  EXPECT_LE(million.figures().unknown, wire->connections()) << "more than one in a lost connection";
}

TEST_P(OverABus, faults_set_nothing_going_that_nobody_asked_for_after_them) {
  Theatre theatre(layout(), 0, 7, settings_on(bus()));
  const auto wire = lay_wire(bus(), theatre);
  theatre.play(fault_sequences(500));
  std::printf("%s\n", wire->figures().c_str());
  EXPECT_GT(wire->connections(), 5U);
}

// A bridge on that bus and a robot that is activated and homed.
class AtWork : public OverABus {
 protected:
  AtWork() : b(layout(), settings_on(bus())), wire(lay_wire(bus(), b)) {}
  void SetUp() override { b.make_ready(); }
  void TearDown() override { b.expect_no_violation(); }

  // What the robot heard last.
  image::Outputs heard() const { return image::decode_outputs(wire->heard(), {layout()}); }
  float joint1() const { return b.model.inputs().target_joint_set.joints[0]; }
  bool link_is(Quality quality) {
    return b.until([&] { return b.result->record.quality == quality; }, 6000);
  }
  // Nothing goes out that could move the arm or take a step towards it.
  void expect_peace(std::chrono::nanoseconds time) {
    const auto commands = b.model.journal().size();
    for (auto i = time / b.settings.cycle; i > 0; --i) {
      b.step();
      ASSERT_FALSE(b.out.motion_control.resume_motion);
      ASSERT_FALSE(b.out.motion_control.set_point);
      ASSERT_FALSE(b.out.robot_control.reset_error);
      ASSERT_FALSE(b.out.robot_control.home);
    }
    EXPECT_EQ(b.model.journal().size(), commands);
    EXPECT_FALSE(b.result->record.control.owned);
  }
  void switch_on() {
    EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(kActivate), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(kHome), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(b.move(5)), kCompleted, Reason::kNone);
  }
  // No restart of anything is needed to go on.
  void resume() {
    b.keep_alive = true;
    EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
    EXPECT_OUTCOME(b.outcome(b.move(10)), kCompleted, Reason::kNone);
  }

  SimBench b;
  std::unique_ptr<BusWire> wire;
};

TEST_P(AtWork, a_path_is_executed_once_and_in_order_whatever_the_cable_loses_and_repeats) {
  std::vector<std::uint64_t> ids;
  for (int i = 0; i < 20; ++i) ids.push_back(b.move(i % 2 ? -1.0 - i : 1.0 + i));
  for (int i = 0; !b.terminal(ids.back()); ++i) {
    ASSERT_LT(i, 100000);
    b.lose_output = i % 7 == 0;
    b.lose_input = i % 5 == 0;
    b.repeat_output = i % 3 == 0;
    b.repeat_input = i % 4 == 0;
    b.step();
  }
  for (const auto id : ids) EXPECT_OUTCOME(b.last(id), kCompleted, Reason::kNone);
  const auto list = b.executed();
  ASSERT_EQ(list.size(), ids.size());
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(list[static_cast<std::size_t>(i)].arguments[0], static_cast<float>(i % 2 ? -1.0 - i : 1.0 + i));
  }
  EXPECT_EQ(wire->connections(), 1U);
}

TEST_P(AtWork, a_dead_owner_stops_the_arm_within_the_lease_and_two_cycles) {
  b.send(b.motion(image::kSetJointVel, {1}));
  b.move(90);
  b.steps(100);
  b.keep_alive = false;  // its last sign of life was in the step before
  const auto lease_cycles = b.settings.lease / b.settings.cycle;
  b.steps(static_cast<int>(lease_cycles) - 1);
  EXPECT_FALSE(heard().motion_control.pause_motion);
  b.steps(3);
  EXPECT_TRUE(heard().motion_control.pause_motion);
  EXPECT_FALSE(heard().motion_control.set_point);
  run(b, 1s);
  EXPECT_FALSE(b.result->record.control.owned);
  EXPECT_TRUE(b.model.inputs().motion_status.eom);
  b.client = ClientName("somebody else");
  resume();
}

TEST_P(AtWork, a_velocity_stream_that_ends_is_zero_on_the_wire_within_its_lease_and_two_cycles) {
  const auto stream = [&] {
    b.pending.push_back(b.velocity(10));
    b.step();
  };
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  for (int i = 0; i < 100; ++i) stream();
  EXPECT_EQ(heard().motion_command.command_id, image::kMoveJointsVel);
  EXPECT_EQ(heard().motion_command.arguments[0], 10.0f);
  EXPECT_GT(joint1(), 0.1f);
  b.steps(static_cast<int>(b.settings.velocity_lease / b.settings.cycle) + 2);
  EXPECT_FALSE(heard().motion_control.set_point);
  EXPECT_EQ(heard().motion_command.arguments[0], 0.0f);
  run(b, 1s);
  const float at = joint1();
  run(b, 1s);
  EXPECT_EQ(joint1(), at);
}

TEST_P(AtWork, after_a_cut_cable_nothing_moves_until_somebody_asks_anew) {
  const auto under_way = b.move(90);
  run(b, 100ms);
  b.link_up = false;
  run(b, 300ms);  // longer than the watchdog
  EXPECT_EQ(b.result->record.quality, Quality::kDisconnected);
  EXPECT_FALSE(wire->connected());
  EXPECT_TRUE(b.until([&] { return b.model.inputs().motion_status.eom; })) << "the robot's own watchdog";
  const float at = joint1();
  b.link_up = true;
  b.keep_alive = false;
  EXPECT_TRUE(link_is(Quality::kGood));
  expect_peace(2s);
  EXPECT_EQ(joint1(), at);
  EXPECT_NE(b.outcome(under_way).state, kCompleted);
  resume();
}

TEST_P(AtWork, a_p_stop_behind_a_cut_cable_is_seen_before_anything_is_sent) {
  b.move(90);
  run(b, 100ms);
  b.link_up = false;
  run(b, 300ms);
  b.model.press_p_stop2();
  b.link_up = true;
  EXPECT_TRUE(link_is(Quality::kGood));
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kRejected, Reason::kSafetyStop);
  b.model.release_p_stop2();
  run(b, 100ms);
  resume();
}

TEST_P(AtWork, a_robot_that_loses_its_power_comes_back_by_itself_and_moves_nothing) {
  b.move(90);
  run(b, 100ms);
  b.model.power_cycle();
  ASSERT_TRUE(link_is(Quality::kDisconnected));
  ASSERT_TRUE(link_is(Quality::kGood));
  EXPECT_EQ(wire->connections(), 2U);
  expect_peace(2s);
  EXPECT_FALSE(b.model.inputs().robot_status.activated);
  switch_on();
}

class OfFirmware11 : public AtWork {};  // older ones have no RebootRobot over the fieldbus

TEST_P(OfFirmware11, a_reboot_is_acknowledged_takes_the_link_down_and_needs_everything_anew) {
  EXPECT_OUTCOME(b.outcome(kDeactivate), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.send(b.motion(image::kRebootRobot, {}))), kCompleted, Reason::kNone);
  ASSERT_TRUE(link_is(Quality::kDisconnected));
  ASSERT_TRUE(link_is(Quality::kGood));
  EXPECT_EQ(b.result->record.inputs.motion_status.move_id, 0);
  expect_peace(1s);
  switch_on();
}

TEST_P(AtWork, a_bridge_that_was_killed_finds_the_robot_again_and_moves_nothing) {
  b.move(90);
  run(b, 100ms);
  b.cycle = std::make_unique<bridge::Cycle>(b.settings);
  b.exchange = {};
  b.pending.clear();
  b.keep_alive = false;
  b.link_up = false;  // nobody is there until it is started again
  run(b, 500ms);
  b.link_up = true;
  ASSERT_TRUE(link_is(Quality::kGood));
  const float at = joint1();
  expect_peace(2s);
  EXPECT_EQ(joint1(), at);
  resume();
}

// Firmware 9 goes on as soon as Pause does not stand; EtherCAT has no idle that would leave it alone until the new
// bridge has seen it.
TEST(OverEthercat, a_paused_robot_that_kept_its_queue_is_not_set_going_by_a_new_bridge) {
  for (const Layout layout : {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11}) {
    SCOPED_TRACE(name_of(layout));
    SimBench b(layout);
    EthercatWire wire(b);
    wire.keep_queue_on_loss();
    b.make_ready();
    b.move(90);
    run(b, 100ms);
    EXPECT_OUTCOME(b.outcome(kPauseMotion), kCompleted, Reason::kNone);
    run(b, 500ms);
    const float at = b.model.inputs().target_joint_set.joints[0];
    b.cycle = std::make_unique<bridge::Cycle>(b.settings);
    b.exchange = {};
    b.keep_alive = false;
    run(b, 3s);
    EXPECT_EQ(b.result->record.quality, Quality::kGood);
    EXPECT_EQ(b.model.inputs().target_joint_set.joints[0], at);
    EXPECT_TRUE(b.model.inputs().motion_status.paused);
    EXPECT_FALSE(b.model.inputs().motion_status.eob) << "it has nothing to go on with, so this proves nothing";
  }
}

const auto kEverywhere =
    testing::Combine(testing::Values(Bus::kEthernetIp, Bus::kEthercat),
                     testing::Values(Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11));
std::string name(const testing::TestParamInfo<std::tuple<Bus, Layout>>& info) {
  return name_of(std::get<Bus>(info.param)) + "_" + name_of(std::get<Layout>(info.param));
}
INSTANTIATE_TEST_SUITE_P(Buses, OverABus, kEverywhere, name);
INSTANTIATE_TEST_SUITE_P(Buses, AtWork, kEverywhere, name);
INSTANTIATE_TEST_SUITE_P(Buses, OfFirmware11,
                         testing::Combine(testing::Values(Bus::kEthernetIp, Bus::kEthercat),
                                          testing::Values(Layout::kFirmware11)),
                         name);

}  // namespace
}  // namespace meca::test
