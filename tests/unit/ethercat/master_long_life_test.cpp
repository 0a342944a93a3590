// A long bad day: cables, power and frames come and go at random. When it is over, all robots run; and while it lasts,
// nobody writes a station address to a robot that has one of this master.
#include <gtest/gtest.h>

#include <random>

#include "tests/unit/ethercat/master_segment.hpp"

namespace meca::ethercat::test {
namespace {

class BadDay {
 public:
  BadDay(MasterSettings settings, unsigned seed) : robots_(settings.robots.size()), segment_(settings), random_(seed) {
    segment_.fate = [this](std::size_t) {
      return Fate{
          .lost = chance(100), .doubled = chance(100), .held_up = chance(50) ? Time(random_() % 6000 * 1us) : Time{}};
    };
  }

  void pass(int events) {
    for (int i = 0; i < events; ++i) {
      happen();
      segment_.run(Time(random_() % 400 * 1ms));
      look_at_addresses();
    }
    segment_.fate = {};
    for (std::size_t i = 0; i <= robots_; ++i) segment_.chain().heal(i);
    for (std::size_t i = 0; i < robots_; ++i) set_power(i, true);
    segment_.run(300ms);
  }
  Segment& segment() { return segment_; }

 private:
  bool chance(unsigned one_in) { return random_() % one_in == 0; }
  void set_power(std::size_t robot, bool on) {
    if (on && !powered_[robot]) {
      segment_.device(robot).power_cycle(segment_.now());
      address_[robot] = 0;
    }
    powered_[robot] = on;
    segment_.chain().set_powered(robot, on);
  }
  void happen() {
    const std::size_t robot = random_() % robots_;
    switch (random_() % 6) {
      case 0:
        return segment_.chain().cut(random_() % (robots_ + 1));
      case 1:
        return segment_.chain().heal(random_() % (robots_ + 1));
      case 2:
        return set_power(robot, false);
      case 3:
        return set_power(robot, true);
      case 4:
        return segment_.device(robot).raise_al_error(0x001A, segment_.now());
      default:
        return segment_.pause(Time(random_() % 200 * 1ms));
    }
  }
  // An address changes only by the robot's power.
  void look_at_addresses() {
    for (std::size_t i = 0; i < robots_; ++i) {
      const std::uint16_t address = segment_.device(i).esc().station_address();
      if (segment_.device(i).operational() && address_[i] != 0) {
        EXPECT_EQ(address, address_[i]) << "robot " << i;
      }
      address_[i] = segment_.device(i).operational() ? address : 0;
      for (std::size_t k = 0; k < i; ++k) {
        const bool both = segment_.device(i).operational() && segment_.device(k).operational();
        EXPECT_FALSE(both && address == segment_.device(k).esc().station_address()) << i << " and " << k;
      }
    }
  }

  std::size_t robots_;
  Segment segment_;
  std::mt19937 random_;
  std::array<bool, 8> powered_{true, true, true, true, true, true, true, true};
  std::array<std::uint16_t, 8> address_{};
};

class MasterLongLife : public testing::TestWithParam<unsigned> {};

TEST_P(MasterLongLife, AfterABadDayOfALineAllRobotsRun) {
  BadDay day(settings_for(4), GetParam());
  day.pass(200);
  ASSERT_TRUE(day.segment().start(30s)) << day.segment().master().trouble(0) << day.segment().master().trouble(3);
}

TEST_P(MasterLongLife, AfterABadDayOfARingAllRobotsRun) {
  MasterSettings settings = settings_for(4);
  settings.redundant = true;
  BadDay day(settings, GetParam());
  day.pass(200);
  ASSERT_TRUE(day.segment().start(30s)) << day.segment().master().trouble(0) << day.segment().master().trouble(3);
}

TEST_P(MasterLongLife, AfterABadDayWithClocksAllRobotsRun) {
  MasterSettings settings = settings_for(4);
  settings.dc = true;
  BadDay day(settings, GetParam());
  day.pass(200);
  ASSERT_TRUE(day.segment().start(30s)) << day.segment().master().trouble(0) << day.segment().master().trouble(3);
}
INSTANTIATE_TEST_SUITE_P(Seeds, MasterLongLife, testing::Range(1u, 5u));

}  // namespace
}  // namespace meca::ethercat::test
