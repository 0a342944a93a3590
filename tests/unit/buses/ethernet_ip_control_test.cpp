// The promises about control, kept over EtherNet/IP: exactly once, stop on loss, no surprise.
#include "tests/unit/buses/ethernet_ip_wire.hpp"
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

class OverEthernetIp : public testing::TestWithParam<Layout> {};

TEST_P(OverEthernetIp, executed_are_exactly_those_with_a_completed_receipt) {
  Million million(GetParam(), commands(), 1 + static_cast<unsigned>(GetParam()), 1,
                  EthernetIpWire::settings(Million::settings_for_play()));
  const EthernetIpWire wire(million);
  million.allow_unknown(21);  // one for each cut, and the restart
  million.play();
  std::printf("executed and told ABORTED %llu; connections opened %llu, watchdog trips %llu, lost %llu, stale %llu\n",
              static_cast<unsigned long long>(million.figures().unknown),
              static_cast<unsigned long long>(wire.adapter().counters().opens),
              static_cast<unsigned long long>(wire.originator().counters().watchdog_trips),
              static_cast<unsigned long long>(wire.originator().counters().lost),
              static_cast<unsigned long long>(wire.originator().counters().stale));
  EXPECT_GT(wire.adapter().counters().opens, 5U) << "the cuts were no cuts";
}

// What the robot heard last, from the bytes of the last packet it took.
image::Outputs heard(const EthernetIpWire& wire, Layout layout) {
  return image::decode_outputs(wire.adapter().output(), {layout});
}

TEST_P(OverEthernetIp, a_dead_owner_stops_the_arm_within_the_lease_and_two_cycles) {
  SimBench b(GetParam(), EthernetIpWire::settings());
  const EthernetIpWire wire(b);
  b.make_ready();
  b.send(b.motion(image::kSetJointVel, {1}));
  b.move(90);
  b.steps(100);
  b.keep_alive = false;  // its last sign of life was in the step before
  const auto lease_cycles = b.settings.lease / b.settings.cycle;
  b.steps(static_cast<int>(lease_cycles) - 1);
  EXPECT_FALSE(heard(wire, GetParam()).motion_control.pause_motion);
  b.steps(3);
  EXPECT_TRUE(heard(wire, GetParam()).motion_control.pause_motion);
  EXPECT_FALSE(heard(wire, GetParam()).motion_control.set_point);
  b.steps(100);
  EXPECT_FALSE(b.result->record.control.owned);
  EXPECT_TRUE(b.model.inputs().motion_status.eom);
}

TEST_P(OverEthernetIp, after_a_cut_cable_nothing_moves_until_somebody_asks_anew) {
  SimBench b(GetParam(), EthernetIpWire::settings());
  const EthernetIpWire wire(b);
  b.make_ready();
  const auto under_way = b.move(90);
  b.steps(30);
  b.link_up = false;
  b.steps(20);  // longer than the watchdog
  EXPECT_EQ(b.result->record.quality, Quality::kDisconnected);
  EXPECT_FALSE(wire.adapter().connected());
  EXPECT_TRUE(b.until([&] { return b.model.inputs().motion_status.eom; })) << "the robot's own watchdog";
  const float at = b.model.inputs().target_joint_set.joints[0];
  b.link_up = true;
  b.keep_alive = false;
  EXPECT_TRUE(b.until([&] { return b.result->record.quality == Quality::kGood; }));
  for (int i = 0; i < 300; ++i) {
    b.step();
    ASSERT_FALSE(b.out.motion_control.resume_motion);
    ASSERT_FALSE(b.out.motion_control.set_point);
    ASSERT_FALSE(b.out.robot_control.reset_error);
  }
  EXPECT_EQ(b.model.inputs().target_joint_set.joints[0], at);
  EXPECT_NE(b.outcome(under_way).state, kCompleted);
  EXPECT_FALSE(b.result->record.control.owned);
  // And no restart of anything is needed to go on.
  b.keep_alive = true;
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kResumeMotion), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.move(10)), kCompleted, Reason::kNone);
  b.expect_no_violation();
}

TEST_P(OverEthernetIp, a_robot_that_loses_its_power_comes_back_by_itself_and_moves_nothing) {
  SimBench b(GetParam(), EthernetIpWire::settings());
  const EthernetIpWire wire(b);
  b.make_ready();
  b.move(90);
  b.steps(30);
  b.model.power_cycle();
  ASSERT_TRUE(b.until([&] { return b.result->record.quality == Quality::kDisconnected; }));
  ASSERT_TRUE(b.until([&] { return b.result->record.quality == Quality::kGood; }));
  EXPECT_EQ(wire.originator().counters().opens, 2U);
  b.steps(200);
  EXPECT_FALSE(b.model.inputs().robot_status.activated);
  EXPECT_OUTCOME(b.outcome(kTakeControl), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kActivate), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(kHome), kCompleted, Reason::kNone);
  EXPECT_OUTCOME(b.outcome(b.move(5)), kCompleted, Reason::kNone);
}

INSTANTIATE_TEST_SUITE_P(Firmware, OverEthernetIp,
                         testing::Values(Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11),
                         [](const auto& info) {
                           return "firmware_" + std::to_string(9 + static_cast<int>(info.param));
                         });

}  // namespace
}  // namespace meca::test
