// The words for faults of meca-sim over real frames: what the bridge sees of each, and that it ends with "faults off".
// Cables and what becomes of commands: recovery_test.cpp; refused states and dead mailboxes: sentences_test.cpp.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/ethercat/cell.hpp"

namespace meca::test {
namespace {

using testing::StartsWith;

using Status = nlohmann::json;

// A word for a robot that is up. `seen`: in its status, now and before the word.
struct Fault {
  std::string words;
  bool (*seen)(const Status& now, const Status& before);
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.words; }

class FaultOfASegment : public EthercatCell, public testing::WithParamInterface<Fault> {};

TEST_P(FaultOfASegment, IsSeenByTheBridgeUntilItIsOff) {
  Simulator& sim = start_robots(1);
  BridgeProcess& bridge = start_bridge(1);
  ASSERT_TRUE(bridge.until_up());
  const Status before = bridge.status();
  ASSERT_THAT(sim.say(GetParam().words), StartsWith("ok: "));
  EXPECT_TRUE(bridge.until([&](const Status& now) { return GetParam().seen(now, before); })) << bridge.status();
  ASSERT_EQ(sim.say("faults off"), "ok: the network is healthy");
  EXPECT_TRUE(bridge.until_up());
}

std::string name_of(const testing::TestParamInfo<Fault>& info) {
  std::string name = info.param.words;
  std::ranges::replace(name, ' ', '_');
  std::ranges::replace(name, '-', 'm');
  return name;
}

template <const char* Name, int More>
bool more(const Status& now, const Status& before) {
  return counter(now, Name) >= counter(before, Name) + More;
}
constexpr char kLost[] = "lost_frames", kLate[] = "late_frames", kUnexpected[] = "unexpected_frames",
               kMalformed[] = "malformed_frames", kMisses[] = "working_counter_misses";

INSTANTIATE_TEST_SUITE_P(
    Words, FaultOfASegment,
    testing::Values(Fault{"lose next 30", more<kLost, 30>}, Fault{"late 3", more<kLate, 20>},
                    Fault{"duplicate", more<kUnexpected, 100>}, Fault{"corrupt", more<kMalformed, 10>},
                    Fault{"working counter -1", more<kMisses, 20>},
                    Fault{"emergency 0xFF00",
                          [](const Status& now, const Status&) { return counter(now, "emergency_code") == 0xFF00; }},
                    Fault{"power off",
                          [](const Status& now, const Status&) {
                            return now["bridge_status"]["link_detail"].get<std::string>().find("no device answers") !=
                                   std::string::npos;
                          }}),
    name_of);

using Segment = EthercatCell;

TEST_F(Segment, ThatLosesMailsDoesNotComeUp) {
  Simulator& sim = start_robots(1, {"--fault", "lose mails"});
  BridgeProcess& bridge = start_bridge(1);
  EXPECT_TRUE(bridge.until_told("SDO")) << bridge.status();
  EXPECT_EQ(sim.say("faults"), "ok: lose mails");
  EXPECT_EQ(sim.say("faults off"), "ok: the network is healthy");
  EXPECT_TRUE(bridge.until_up());
}

TEST_F(Segment, WithAForeignDeviceNamesItAndTakesTheRobotBack) {
  Simulator& sim = start_robots(2);
  BridgeProcess& bridge = start_bridge(2);
  ASSERT_TRUE(bridge.until_up("arm1") && bridge.until_up("arm2"));
  ASSERT_EQ(sim.say("foreign on", "arm2"), "ok: another maker's device is in the robot's place");
  EXPECT_TRUE(bridge.until_told("vendor 0x00000002", "arm2")) << bridge.status("arm2");
  ASSERT_EQ(sim.say("foreign off", "arm2"), "ok: the robot is in its place");
  EXPECT_TRUE(bridge.until_up("arm2")) << bridge.status("arm2");
  EXPECT_EQ(losses("arm1"), 0);
}

TEST_F(Segment, ThatIsFrozenGoesOnWithOldInputs) {
  const Simulator& sim = start_robots(1);
  BridgeProcess& bridge = start_bridge(1);
  ASSERT_TRUE(bridge.until_up());
  ASSERT_EQ(sim.say("freeze"), "ok: no I/O is handled");
  const auto time = [](const Status& now) { return now["target_joint_set"]["header"]["robot_time_us"]; };
  Status first = bridge.status();
  EXPECT_TRUE(bridge.until([&](const Status& now) {
    if (time(now) != time(first)) first = now;
    return images(now) >= images(first) + 100;
  }));
  ASSERT_EQ(sim.say("thaw"), "ok: I/O is handled");
  EXPECT_TRUE(bridge.until([&](const Status& now) { return time(now) != time(first); }));
}

TEST_F(Segment, WhoseCableBackIsCutIsAnOpenRing) {
  Simulator& sim = start_robots(2, {"--redundant-interface", "ring1"});
  BridgeProcess& bridge = start_bridge(2, ", redundant_interface: ring0");
  ASSERT_TRUE(bridge.until_up("arm1") && bridge.until_up("arm2"));
  ASSERT_EQ(sim.say("cut behind", "arm2"), "ok: the cable behind this robot is cut");
  EXPECT_TRUE(bridge.until([](const Status& now) { return counter(now, "ring_open") == 1; }));
  ASSERT_EQ(sim.say("heal behind", "arm2"), "ok: the cable behind this robot is whole");
  EXPECT_TRUE(bridge.until([](const Status& now) { return counter(now, "ring_open") == 0; }));
  EXPECT_EQ(losses("arm1") + losses("arm2"), 0);
}

// 1000 ppm: twice what the control loop of a simulated clock takes up, 0.5 us a cycle remain and are halved every time.
TEST_F(Segment, WithAClockThatDriftsShowsTheDifferenceUntilItIsOver) {
  Simulator& sim = start_robots(2);
  BridgeProcess& bridge = start_bridge(2, ", dc: true");
  const auto difference = [](const Status& now) { return std::abs(counter(now, "dc_difference_ns")); };
  const auto together = [&](const Status& now) { return difference(now) < 200; };
  ASSERT_TRUE(bridge.until_up("arm2") && bridge.until(together, "arm2")) << bridge.status("arm2");
  ASSERT_EQ(sim.say("clock drift 1000", "arm2"), "ok: the clock drifts");
  EXPECT_TRUE(bridge.until([&](const Status& now) { return difference(now) > 500; }, "arm2")) << bridge.status("arm2");
  ASSERT_EQ(sim.say("clock drift 0", "arm2"), "ok: the clock drifts no more than by itself");
  EXPECT_TRUE(bridge.until(together, "arm2")) << bridge.status("arm2");
}

TEST_F(Segment, OfRobotsWhoseButtonsArePressedShowsIt) {
  const Simulator& sim = start_robots(1);
  BridgeProcess& bridge = start_bridge(1);
  ASSERT_TRUE(bridge.until_up());
  ASSERT_EQ(sim.say("press p-stop2"), "ok: P-Stop 2 pressed");
  EXPECT_TRUE(bridge.until([](const Status& now) { return now["safety_status"]["stop"]["p_stop2"] == true; }))
      << bridge.status();
  ASSERT_THAT(sim.say("release p-stop2"), StartsWith("ok: "));
  ASSERT_EQ(sim.say("raise error 1007"), "ok: the robot is in error");
  EXPECT_TRUE(bridge.until([](const Status& now) { return now["robot_status"]["error_code"] == 1007; }));
}

}  // namespace
}  // namespace meca::test
