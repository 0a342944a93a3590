// The four dynamic data slots (manual 4.4.6, 4.5.10; types: manual table 12).
#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "sim/kinematics.hpp"
#include "tests/unit/sim/rig.hpp"
#include "transports/image/dynamic_data_types.hpp"

namespace meca::sim {
namespace {

using image::Layout;

class Slots : public testing::Test {
 protected:
  // Asks for `type` in slot 2 and gives its values once the slot shows it.
  std::array<float, 6> values(std::uint32_t type) {
    rig.out.dynamic_data_configuration.type_ids[2] = type;
    rig.step();
    rig.step();
    EXPECT_EQ(rig.robot.inputs().dynamic_data[2].type_id, type);
    return rig.robot.inputs().dynamic_data[2].values;
  }
  Rig rig;
};

using Six = std::array<float, 6>;

TEST_F(Slots, ARequestTakesEffectOneCycleLater) {
  rig.out.dynamic_data_configuration.type_ids = {1, 2, 3, 40};
  rig.step();
  rig.step();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rig.robot.inputs().dynamic_data[i].type_id, rig.out.dynamic_data_configuration.type_ids[i]);
  }
  rig.out.dynamic_data_configuration.type_ids[0] = 12;
  EXPECT_EQ(rig.step().dynamic_data[0].type_id, 1u);
  EXPECT_EQ(rig.step().dynamic_data[0].type_id, 12u);
}

TEST_F(Slots, TellFirmwareProductAndSerialNumber) {
  RobotOptions o = Rig::quick(Layout::kFirmware10, Product::kMeca500R3);
  o.firmware_minor = 2;
  o.firmware_patch = 1;
  o.firmware_build = 8120;
  o.serial_number = 0x12345679;  // more than 24 bits
  rig = Rig(o);
  EXPECT_EQ(values(1), (Six{10, 2, 1, 8120}));
  EXPECT_EQ(values(2), (Six{3}));
  EXPECT_EQ(std::bit_cast<std::uint32_t>(values(3)[1]), 0x12345679u);
}

TEST_F(Slots, TellJointLimitsInTheOrderOfTheFirmware) {
  EXPECT_EQ(values(12), (Six{-175, -70, -135, 175, 90, 70}));
  EXPECT_EQ(values(13), (Six{-170, -115, -36000, 170, 115, 36000}));
  EXPECT_EQ(values(14), (Six{-175, -70, -135, 175, 90, 70}));
  rig = Rig(Rig::quick(Layout::kFirmware9));
  EXPECT_EQ(values(14), (Six{-175, 175, -70, 90, -135, 70}));  // manual 9.2: minimum and maximum of each joint
}

TEST_F(Slots, TellTheDefaultsAfterActivation) {
  rig.make_ready();
  EXPECT_EQ(values(21), (Six{100, 0.05f}));
  EXPECT_EQ(values(22), (Six{25, 80, 150, 45, 50, 150}));
  EXPECT_EQ(values(25), (Six{100, 100, 100, 100, 100, 100}));
  EXPECT_EQ(values(54), (Six{100}));
  for (const std::size_t i : {0u, 1u, 2u, 3u}) EXPECT_TRUE(std::isnan(values(20)[i])) << i;  // automatic
}

TEST_F(Slots, TellWhatTheSetCommandsSet) {
  rig.make_ready();
  rig.perform(image::kSetBlending, {30});
  rig.perform(image::kSetVelTimeout, {0.5});
  rig.perform(image::kSetJointVel, {11});
  rig.perform(image::kSetJointAcc, {12});
  rig.perform(image::kSetCartLinVel, {13});
  rig.perform(image::kSetCartAngVel, {14});
  rig.perform(image::kSetCartAcc, {15});
  rig.perform(image::kSetJointVelLimit, {16});
  rig.perform(image::kSetConf, {1, -1, 1});
  rig.perform(image::kSetConfTurn, {-2});
  rig.perform(image::kSetPayload, {0.25, 1, 2, 3});
  EXPECT_EQ(values(21), (Six{30, 0.5f}));
  EXPECT_EQ(values(22), (Six{11, 12, 13, 14, 15, 16}));
  EXPECT_EQ(values(20), (Six{1, -1, 1, -2}));
  EXPECT_EQ(values(31), (Six{0.25f, 1, 2, 3}));
}

TEST_F(Slots, SettingsComeBackToTheirDefaultsWithTheNextActivation) {
  rig.make_ready();
  rig.perform(image::kSetBlending, {30});
  rig.perform(image::kSetTrf, {0, 0, 40, 0, 0, 0});
  rig.out.robot_control.deactivate = true;
  rig.run(10ms);
  rig.out.robot_control.deactivate = false;
  rig.activate();
  EXPECT_EQ(values(21)[0], 100);
  EXPECT_EQ(rig.robot.inputs().target_trf.z, 0);
}

TEST_F(Slots, ShowSpeedsWhileTheArmMoves) {
  rig.make_ready();
  rig.out.dynamic_data_configuration.type_ids = {32, 34, 40, 42};
  rig.send(image::kMoveJoints, {90, 0, 0, 0, 0, 0});
  rig.run(1s);
  const auto& d = rig.robot.inputs().dynamic_data;
  EXPECT_NEAR(d[0].values[0], 37.5, 0.01);  // 25 % of 150 deg/s
  const double speed = std::hypot(d[1].values[0], d[1].values[1]);
  EXPECT_NEAR(speed, 190 * 37.5 * 3.14159265 / 180, 0.1);  // the flange is 190 mm from axis 1
  EXPECT_NEAR(d[1].values[5], 37.5, 0.01);
  EXPECT_NEAR(d[2].values[0], rig.joint(1), 1e-4);  // without noise the actual joints are the targets
  EXPECT_NEAR(d[3].values[0], 37.5, 0.01);
}

TEST_F(Slots, FeelGravityInLink5) {
  const auto upright = values(46);
  EXPECT_NEAR(upright[2], -16000, 1);
  rig.make_ready();
  rig.perform(image::kMoveJoints, {0, 0, 0, 0, 90, 0});  // link 5 looks down: its x axis points along gravity
  EXPECT_NEAR(values(46)[0], 16000, 1);
}

TEST_F(Slots, GiveZerosForTypesNobodyKnows) {
  for (const std::uint32_t type : {4u, 35u, 55u, 63u, 72u, 9999u, 10000u, 0xFFFFFFFFu}) EXPECT_EQ(values(type), Six{});
}

TEST_F(Slots, NoiseIsSmallSeededAndCanBeSwitchedOff) {
  RobotOptions o = Rig::quick();
  o.noise = true;
  o.seed = 5;
  const auto record = [&](std::uint64_t seed) {
    o.seed = seed;
    rig = Rig(o);
    std::vector<Six> out;
    for (int i = 0; i < 100; ++i) out.push_back(values(40));
    return out;
  };
  const auto a = record(5), again = record(5), other = record(6);
  EXPECT_EQ(a, again);
  EXPECT_NE(a, other);
  std::set<float> seen;
  for (const Six& v : a) {
    seen.insert(v[0]);
    for (const float q : v) ASSERT_LE(std::abs(q), 0.0011f);
  }
  EXPECT_GT(seen.size(), 90u);
  o.noise = false;
  rig = Rig(o);
  EXPECT_EQ(values(40), Six{});
}

TEST(AutomaticSlots, ShowEveryTypeTheRobotHasInOneRoundAndCountIt) {
  for (const Layout layout : {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11}) {
    Rig rig(Rig::quick(layout));
    std::set<std::uint32_t> seen;
    for (const auto& slot : rig.robot.inputs().dynamic_data) seen.insert(slot.type_id);
    while (rig.robot.inputs().robot_timestamp.dynamic_data_update_count == 0) {
      for (const auto& slot : rig.step().dynamic_data) seen.insert(slot.type_id);
      ASSERT_LT(seen.size(), 64u);
    }
    for (const image::DynamicDataInfo& info : image::dynamic_data_types()) {
      if (layout != Layout::kFirmware11 || !info.on_meca500 || info.values.empty() || info.id >= 64) continue;
      EXPECT_TRUE(seen.contains(info.id) || info.name == "reserved" || info.id == 16) << info.id << " " << info.name;
    }
    EXPECT_GE(seen.size(), layout == Layout::kFirmware9 ? 26u : 34u);
  }
}

TEST(AutomaticSlots, NeverShowOneTypeTwiceInACycle) {
  Rig rig;
  for (int i = 0; i < 500; ++i) {
    std::set<std::uint32_t> seen;
    for (const auto& slot : rig.step().dynamic_data) seen.insert(slot.type_id);
    ASSERT_EQ(seen.size(), 4u);
  }
}

TEST(AutomaticSlots, ShowAChangedSettingWithinAFewCycles) {
  Rig rig;
  rig.make_ready();
  rig.run(200ms);
  rig.send(image::kSetBlending, {33});
  const auto shown = [&] {
    for (const auto& slot : rig.robot.inputs().dynamic_data) {
      if (slot.type_id == 21 && slot.values[0] == 33) return true;
    }
    return false;
  };
  for (int cycles = 1; !shown(); ++cycles) {
    ASSERT_LT(cycles, 5);  // the manual says 3 to 5 typically
    rig.step();
  }
}

TEST(AutomaticSlots, KeepMeasuredValuesFreshDuringAMoveAndStillGoAround) {
  Rig rig;
  rig.make_ready();
  rig.send(image::kMoveJoints, {150, 0, 0, 0, 0, 0});
  rig.run(200ms);
  const auto before = rig.robot.inputs().robot_timestamp.dynamic_data_update_count;
  std::map<std::uint32_t, int> last, gap;
  for (int i = 1; i <= 400; ++i) {
    for (const auto& slot : rig.step().dynamic_data) {
      gap[slot.type_id] = std::max(gap[slot.type_id], i - last[slot.type_id]);
      last[slot.type_id] = i;
    }
  }
  ASSERT_FALSE(rig.motion().eom);
  for (const std::uint32_t type : {32u, 34u, 40u, 41u, 42u, 43u, 44u, 45u, 46u}) EXPECT_LE(gap[type], 6) << type;
  EXPECT_GT(rig.robot.inputs().robot_timestamp.dynamic_data_update_count, before + 2);
}

TEST(FixedSlots, DoNotCountRounds) {
  Rig rig;
  rig.out.dynamic_data_configuration.type_ids = {1, 2, 3, 40};
  rig.step();
  const auto before = rig.step().robot_timestamp.dynamic_data_update_count;
  EXPECT_EQ(rig.run(500ms).robot_timestamp.dynamic_data_update_count, before);
}

}  // namespace
}  // namespace meca::sim
