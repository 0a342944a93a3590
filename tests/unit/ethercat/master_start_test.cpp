// The way up of whole chains, and which device is which robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/ethercat/master_segment.hpp"

namespace meca::ethercat::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

image::OutputBytes output_of(std::uint8_t value) {
  image::OutputBytes out;
  out.fill(static_cast<std::byte>(value));
  return out;
}

class MasterStart : public testing::TestWithParam<std::size_t> {};

TEST_P(MasterStart, EveryRobotBecomesOperationalAndImagesPassBothWays) {
  const std::size_t count = GetParam();
  Segment segment(settings_for(count));
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  for (std::size_t i = 0; i < count; ++i) segment.master().set_output(i, output_of(static_cast<std::uint8_t>(i + 1)));
  segment.run(5ms);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(segment.device(i).output(), output_of(static_cast<std::uint8_t>(i + 1)));
    EXPECT_EQ(segment.master().input(i)[251], static_cast<std::byte>(0x10 + i));
    EXPECT_TRUE(segment.master().take_fresh(i));
    EXPECT_FALSE(segment.master().take_fresh(i));
    EXPECT_EQ(segment.master().trouble(i), "");
    EXPECT_EQ(segment.master().counters(i).working_counter_misses, 0u);
  }
  EXPECT_EQ(segment.master().counters().lost_frames, 0u);
  EXPECT_EQ(segment.master().counters().unexpected_frames, 0u);
  EXPECT_EQ(segment.master().counters().scans, 1u);
}
INSTANTIATE_TEST_SUITE_P(Robots, MasterStart, testing::Values(1, 3, 8, 32));

TEST(MasterStart, OneFrameACycleCarriesFourRobotsAndFiveTakeTwo) {
  for (const auto& [robots, frames] : {std::pair{4u, 1u}, std::pair{5u, 2u}}) {
    Segment segment(settings_for(robots));
    ASSERT_TRUE(segment.start());
    unsigned with_process_data = 0;
    segment.sent = [&](Bytes frame, Chain::Side) {
      DatagramWalk<const std::byte> walk(frame);
      bool found = false;
      while (const auto datagram = walk.next()) found = found || datagram->command() == Command::kLrw;
      with_process_data += found;
    };
    segment.run(10ms);
    EXPECT_EQ(with_process_data, 10 * frames) << robots;
  }
}

TEST(MasterStart, ManyRobotsStartTogetherAndNotOneAfterTheOther) {
  Segment segment(settings_for(32));
  std::array<Time, 32> up{};
  segment.every_cycle = [&](Segment& of) {
    for (std::size_t i = 0; i < up.size(); ++i)
      if (up[i] == Time{} && of.master().station(i).operational()) up[i] = of.now();
  };
  ASSERT_TRUE(segment.start());
  segment.run(1ms);
  const auto [first, last] = std::ranges::minmax(up);
  EXPECT_LT(last, first * 2);
}

TEST(MasterStart, SendsZerosBeforeTheFirstOutputs) {
  Segment segment(settings_for(1));
  ASSERT_TRUE(segment.start());
  segment.run(3ms);
  EXPECT_EQ(segment.device(0).output(), output_of(0));
  segment.master().set_output(0, output_of(7));
  segment.run(3ms);
  EXPECT_EQ(segment.device(0).output(), output_of(7));
}

void expect_separate(Segment& segment) {
  bool lrw = false, lrd = false, lwr = false;
  segment.sent = [&](Bytes frame, Chain::Side) {
    DatagramWalk<const std::byte> walk(frame);
    while (const auto datagram = walk.next()) {
      lrw = lrw || datagram->command() == Command::kLrw;
      lrd = lrd || datagram->command() == Command::kLrd;
      lwr = lwr || datagram->command() == Command::kLwr;
    }
  };
  ASSERT_TRUE(segment.start());
  segment.master().set_output(0, output_of(5));
  segment.run(10ms);
  EXPECT_FALSE(lrw);
  EXPECT_TRUE(lrd && lwr);
  EXPECT_EQ(segment.device(0).output(), output_of(5));
  EXPECT_TRUE(segment.master().take_fresh(0));
  EXPECT_EQ(segment.master().counters(0).working_counter_misses, 0u);
}

TEST(MasterStart, SeparateReadsAndWritesOnRequest) {
  MasterSettings settings = settings_for(2);
  settings.separate = true;
  Segment segment(settings);
  expect_separate(segment);
}

TEST(MasterStart, ADeviceThatCannotReadAndWriteInOneGetsSeparateDatagrams) {
  std::vector<DeviceSettings> devices(1);
  devices[0].esc.features |= kFeatureNoLrw;
  Segment segment(settings_for(1), devices);
  expect_separate(segment);
}

TEST(MasterStart, EveryLayoutBecomesOperational) {
  for (const auto& [layout, firmware, major] : {std::tuple{image::Layout::kFirmware9, "9.3.3.5809", 9},
                                                std::tuple{image::Layout::kFirmware10, "10.2.1.9000", 10},
                                                std::tuple{image::Layout::kFirmware11, "11.3.3.12637", 11}}) {
    std::vector<DeviceSettings> devices(1);
    devices[0].layout = layout;
    devices[0].firmware = firmware;
    Segment segment(settings_for(1), devices);
    ASSERT_TRUE(segment.start()) << firmware << ": " << segment.master().trouble(0);
    EXPECT_EQ(segment.master().station(0).firmware().major, major);
  }
}

TEST(MasterStart, TheAliasFindsARobotWhereverItStands) {
  MasterSettings settings;
  settings.robots = {{0, 7}, {0, 5}};
  std::vector<DeviceSettings> devices(2);
  devices[0].alias = 5;
  devices[1].alias = 7;
  Segment segment(settings, devices);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(0);
  segment.run(5ms);
  EXPECT_EQ(segment.master().input(0)[0], std::byte{0x11});
  EXPECT_EQ(segment.master().input(1)[0], std::byte{0x10});
}

TEST(MasterStart, AMissingAliasIsNamedAndADoubleOneToo) {
  MasterSettings settings;
  settings.robots = {{0, 7}, {0, 5}};
  std::vector<DeviceSettings> devices(2);
  devices[0].alias = devices[1].alias = 7;
  Segment segment(settings, devices);
  segment.run(2s);
  EXPECT_EQ(segment.master().trouble(0), "alias 7 is there twice, at positions 0 and 1; give each robot its own");
  EXPECT_THAT(segment.master().trouble(1), StartsWith("no robot with alias 5 is there: 2 devices answer; "));
}

TEST(MasterStart, AnAliasWithAWrongChecksumIsNotBelieved) {
  std::vector<DeviceSettings> devices(2);
  devices[1].esc.sii = make_meca500_sii(5, 1);
  devices[1].esc.sii[2 * sii::kChecksum] ^= std::byte{1};
  MasterSettings settings;
  settings.robots = {{0, 5}};
  Segment segment(settings, devices);
  segment.run(1s);
  EXPECT_EQ(
      segment.master().trouble(0),
      "no robot with alias 5 is there: 2 devices answer, and the checksum of the SII at position 1 is wrong, so that "
      "its alias is not believed; write that SII anew, or name its position");
  settings.robots = {{1, std::nullopt}};
  Segment by_position(settings, devices);
  EXPECT_TRUE(by_position.start()) << by_position.master().trouble(0);
}

TEST(MasterStart, ARobotIsNotTwoInTheConfiguration) {
  std::vector<DeviceSettings> devices(2);
  devices[1].alias = 5;
  MasterSettings settings;
  settings.robots = {{0, 5}, {1, std::nullopt}};
  Segment segment(settings, devices);
  segment.run(2s);
  EXPECT_TRUE(segment.master().station(0).operational()) << segment.master().trouble(0);
  EXPECT_FALSE(segment.master().station(1).operational());
  EXPECT_EQ(segment.master().trouble(1),
            "position 1 is the robot with alias 5, which is another one in the configuration");
}

// It was once "at position 0", wherever it stood.
TEST(MasterStart, ARobotWithAnAliasIsCalledByItInEverySentence) {
  std::vector<DeviceSettings> devices(2);
  devices[1].alias = 5;
  MasterSettings settings;
  settings.robots = {{0, 5}};
  Segment segment(settings, devices);
  segment.device(1).faults().refuse_state = 0x0025;
  segment.run(3s, [&] { return segment.master().station(0).phase() == Station::Phase::kPausing; });
  EXPECT_THAT(segment.master().trouble(0),
              StartsWith("the robot with alias 5 refuses SAFEOP: AL status code 0x0025, "));
}

TEST(MasterStart, ARobotThatIsNotThereIsSaidToBeBehindTheLastThatIs) {
  Segment segment(settings_for(3), std::vector<DeviceSettings>(2));
  segment.run(3s);
  EXPECT_TRUE(segment.master().station(0).operational());
  EXPECT_TRUE(segment.master().station(1).operational());
  EXPECT_EQ(segment.master().trouble(2),
            "position 2 is not there: 2 devices answer; check cable and power behind position 1");
}

TEST(MasterStart, AForeignDeviceInTheMiddleIsLeftAloneAndItsNeighboursRun) {
  std::vector<DeviceSettings> devices(3);
  devices[1].vendor = 2;
  devices[1].product = 0x044C2C52;
  Segment segment(settings_for(3), devices);
  segment.run(3s);
  EXPECT_TRUE(segment.master().station(0).operational());
  EXPECT_TRUE(segment.master().station(2).operational());
  EXPECT_THAT(
      segment.master().trouble(1),
      HasSubstr("position 1 is vendor 0x00000002, product 0x044C2C52, not a Meca500 (vendor 0x00ECADE1, product "
                "0x0004D500): it is left alone"));
  EXPECT_EQ(segment.device(1).state(), AlState::kInit);
}

// In less time than the watchdog, so that nobody was out of reach meanwhile.
TEST(MasterStart, ARobotInThePlaceOfAForeignDeviceIsFound) {
  MasterSettings settings = settings_for(1);
  settings.watchdog = 1s;
  std::vector<DeviceSettings> devices(2);
  devices[0].vendor = 2;
  Segment segment(settings, devices);
  segment.chain() = Chain({&segment.device(0)});
  segment.run(2s);
  ASSERT_THAT(segment.master().trouble(0), HasSubstr("not a Meca500"));
  segment.fate = [](std::size_t) { return Fate{.lost = true}; };
  segment.run(500ms);
  segment.fate = {};
  segment.chain() = Chain({&segment.device(1)});
  EXPECT_TRUE(segment.start()) << segment.master().trouble(0);
}

TEST(MasterStart, AnotherRobotOfTheSameMakerIsNamed) {
  std::vector<DeviceSettings> devices(1);
  devices[0].product = 0x04DC5500;
  Segment segment(settings_for(1), devices);
  segment.run(1s);
  EXPECT_THAT(segment.master().trouble(0), HasSubstr("product 0x04DC5500 (MCS500), not a Meca500"));
}

// The same robots, in another order, under a master that knows nothing: 1003h, 1001h and 1002h stand in them.
TEST(MasterStart, RobotsThatKeepTheAddressesOfAnotherMasterGetNewOnes) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  Master second(settings_for(3));
  segment.go_on_with(second);
  segment.chain() = Chain({&segment.device(2), &segment.device(0), &segment.device(1)});
  ASSERT_TRUE(segment.start()) << second.trouble(0);
  EXPECT_EQ(segment.device(2).esc().station_address(), 0x1001);
  EXPECT_EQ(segment.device(0).esc().station_address(), 0x1002);
  EXPECT_EQ(segment.device(1).esc().station_address(), 0x1003);
}

TEST(MasterStart, RobotsThatChangeTheirPlacesAreTakenForWhoStandsThere) {
  Segment segment(settings_for(3));
  ASSERT_TRUE(segment.start());
  segment.chain().cut(1);
  segment.run(200ms);
  segment.chain() = Chain({&segment.device(0), &segment.device(2), &segment.device(1)});
  segment.run(50ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
  segment.run(5ms);
  EXPECT_EQ(segment.master().input(1)[0], std::byte{0x12});
  EXPECT_EQ(segment.master().input(2)[0], std::byte{0x11});
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
}

// As another master left it, perhaps: the address of a neighbour.
TEST(MasterStart, ARobotThatIsExchangedForOneWithTheAddressOfItsNeighbourDoesNotDisturbThatOne) {
  Segment segment(settings_for(3), std::vector<DeviceSettings>(4));
  ASSERT_TRUE(segment.start());
  std::array<std::byte, kLongestFrame> buffer;
  FrameWriter writer(buffer, MacAddress{});
  std::ranges::copy(std::array{std::byte{0x03}, std::byte{0x10}},
                    writer.add(Command::kApwr, 0, address_of(0, reg::kStationAddress), 2).begin());
  const std::size_t size = writer.finish().size();
  Chain({&segment.device(3)}).process(Chain::Side::kPrimary, std::span(buffer).first(size), segment.now());
  ASSERT_EQ(segment.device(3).esc().station_address(), segment.device(2).esc().station_address());
  segment.chain() = Chain({&segment.device(0), &segment.device(3), &segment.device(2)});
  segment.run(50ms);
  ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
  EXPECT_EQ(segment.device(2).esc().station_address(), 0x1003);
  EXPECT_NE(segment.device(3).esc().station_address(), 0x1003);
  EXPECT_EQ(segment.master().counters(0).losses, 0u);
  EXPECT_EQ(segment.master().counters(2).losses, 0u);
}

TEST(MasterStart, RobotsWithAliasesKeepTheirNamesWhenTheyChangeTheirPlaces) {
  MasterSettings settings;
  settings.robots = {{0, 5}, {0, 7}};
  std::vector<DeviceSettings> devices(2);
  devices[0].alias = 5;
  devices[1].alias = 7;
  Segment segment(settings, devices);
  ASSERT_TRUE(segment.start());
  segment.chain().cut(0);
  segment.run(200ms);
  segment.chain() = Chain({&segment.device(1), &segment.device(0)});
  ASSERT_TRUE(segment.start()) << segment.master().trouble(1);
  segment.run(5ms);
  EXPECT_EQ(segment.master().input(0)[0], std::byte{0x10});
  EXPECT_EQ(segment.master().input(1)[0], std::byte{0x11});
}

TEST(MasterStart, FramesInBetweenStayShortHoweverManyWantSomething) {
  Segment segment(settings_for(32));
  std::size_t longest = 0;
  segment.sent = [&](Bytes frame, Chain::Side) {
    DatagramWalk<const std::byte> walk(frame);
    bool cyclic = false;
    while (const auto datagram = walk.next())
      cyclic = cyclic || datagram->command() == Command::kLrw || datagram->command() == Command::kBrd;
    if (!cyclic) longest = std::max(longest, frame.size());
  };
  ASSERT_TRUE(segment.start());
  EXPECT_LE(longest, 900u);
}

// In OP under another master, at the logical addresses that this one gives to somebody else.
TEST(MasterStart, ARobotThatAnotherMasterLeftRunningDoesNotTakeOutputsOfOthers) {
  Segment first(settings_for(2));
  ASSERT_TRUE(first.start());
  first.master().set_output(0, output_of(1));
  first.run(3ms);
  MasterSettings settings;
  settings.robots = {{1, std::nullopt}};
  Master second(settings);
  second.set_output(0, output_of(2));
  first.go_on_with(second);
  ASSERT_TRUE(first.run(20s, [&] { return second.station(0).operational(); })) << second.trouble(0);
  first.run(1s);
  EXPECT_EQ(first.device(1).output(), output_of(2));
  EXPECT_NE(first.device(0).output(), output_of(2));
  EXPECT_FALSE(first.device(0).operational());
  EXPECT_EQ(second.counters(0).working_counter_misses, 0u);
}

TEST(MasterStart, WithoutAnybodyItSaysThatNobodyAnswersAndFindsThemWhenTheyCome) {
  Segment segment(settings_for(2));
  segment.chain().cut(0);
  segment.run(500ms);
  EXPECT_EQ(segment.master().trouble(0), "no device answers; check the cable to the first robot and its power");
  segment.chain().heal(0);
  EXPECT_TRUE(segment.start());
}

// Once it took another 1.8 s: half a second until its SII was given up, and a second until the chain was looked through
// again.
TEST(MasterStart, ARobotThatIsRestartedWhileTheChainIsLookedThroughIsWaitedForNoLonger) {
  for (Time when{}; when < 60ms; when += 1ms) {
    Segment segment(settings_for(3));
    segment.run(when);
    segment.device(1).power_cycle(segment.now());
    segment.run(20ms);
    EXPECT_TRUE(segment.start(600ms)) << when.count() << ": " << segment.master().trouble(1);
  }
}

TEST(MasterStart, ADeviceThatCannotBeReadIsAskedLessAndLessOften) {
  std::vector<DeviceSettings> devices(2);
  devices[1].esc.sii_busy = 1h;
  Segment segment(settings_for(1), devices);
  std::vector<Time> scans;
  segment.every_cycle = [&](Segment& s) {
    if (s.master().counters().scans > scans.size()) scans.push_back(s.now());
  };
  segment.run(10s);
  EXPECT_TRUE(segment.all_operational());
  ASSERT_GT(scans.size(), 6u);
  for (std::size_t i = 2; i < scans.size(); ++i) EXPECT_GE(scans[i] - scans[i - 1], scans[i - 1] - scans[i - 2] - 10ms);
  EXPECT_GE(scans.back() - scans[scans.size() - 2], 1s);
  segment.device(1).power_cycle(segment.now());  // another one, perhaps with an SII that can be read
  segment.run(600ms);
  const auto before = segment.master().counters().scans;
  segment.run(800ms);
  EXPECT_GT(segment.master().counters().scans, before);
}

TEST(MasterStart, SlowSiiWithEightBytesAReadIsReadToo) {
  std::vector<DeviceSettings> devices(2);
  for (DeviceSettings& device : devices) {
    device.esc.sii_reads_8_bytes = true;
    device.esc.sii_busy = 3ms;
  }
  Segment segment(settings_for(2), devices);
  EXPECT_TRUE(segment.start());
}

}  // namespace
}  // namespace meca::ethercat::test
