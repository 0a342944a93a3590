// The station against the simulated robot (device.hpp), which is stricter than robots have to be: every layout, both
// kinds of synchronization, every single lost frame, and the faults that it can play.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/unit/ethercat/esc_wire.hpp"
#include "transports/ethercat/device.hpp"
#include "transports/ethercat/sii_reader.hpp"
#include "transports/ethercat/station.hpp"

namespace meca::ethercat::station_test {
namespace {

using namespace std::chrono_literals;
using image::Layout;
using test::Passing;
using testing::AllOf;
using testing::HasSubstr;
using Phase = Station::Phase;

constexpr std::uint16_t kStation = 0x1001;
constexpr Time kCycle = 1ms;
constexpr SiiIdentity kIdentity{
    0, kMecademicVendor, kMeca500Product, kMeca500Revision, 0, 0x1000, 128, 0x1080, 128, 4, true};

DeviceSettings robot(Layout layout, std::string firmware) {
  DeviceSettings settings;
  settings.layout = layout;
  settings.firmware = std::move(firmware);
  return settings;
}

StationSettings station_settings(bool dc) {
  StationSettings settings;
  settings.logical_output = 0;
  settings.logical_input = kOutputSize;
  settings.dc = dc;
  settings.sync0_cycle = kCycle;
  return settings;
}

enum class Loss : std::uint8_t { kNothing, kRequest, kReply };

// One robot, one service access and one frame of process data per cycle.
class Bus {
 public:
  explicit Bus(const DeviceSettings& settings = robot(Layout::kFirmware11, "11.3.3.12637"), bool dc = false)
      : device(settings), station(station_settings(dc)) {
    const std::array address{std::byte{kStation & 0xFF}, std::byte{kStation >> 8}};
    send(Command::kApwr, address_of(0, reg::kStationAddress), address);
    if (dc) station.dc_ready(device.esc().system_time(now), now);
  }

  Device device;
  Station station;
  Time now = 1s;
  std::size_t accesses = 0;
  std::function<Loss(std::size_t, const Access&)> loses;
  bool process_data = true;

  void find() { station.found(kStation, kIdentity, now); }
  void cycle() {
    now += kCycle;
    device.tick(now);
    station.tick(now);
    if (const auto access = station.next(now)) exchange(*access);
    if (process_data && station.wants_process_data()) exchange_image();
    if (++cycles_ % 20 == 0) look_at_state();
  }
  bool run_until(Phase phase, Time limit = 60s) {
    for (const Time end = now + limit; now < end && station.phase() != phase;) cycle();
    return station.phase() == phase;
  }
  void run(Time time) {
    for (const Time end = now + time; now < end;) cycle();
  }
  testing::AssertionResult climbs() {
    find();
    if (run_until(Phase::kOperational)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << station.trouble();
  }
  std::string trouble() const { return std::string(station.trouble()); }

  test::Reply send(Command command, std::uint32_t address, Bytes data) {
    Passing passing(static_cast<std::uint8_t>(command), address, data);
    device.esc().frame_begins(now, std::nullopt);
    device.esc().process(passing.datagram(), now);
    return passing.reply();
  }

 private:
  void exchange(const Access& access) {
    const Loss loss = loses ? loses(accesses, access) : Loss::kNothing;
    ++accesses;
    test::Reply reply;
    if (loss != Loss::kRequest) {
      const std::vector<std::byte> zeros(access.size);
      reply = send(access.write ? Command::kFpwr : Command::kFprd, address_of(kStation, access.address),
                   access.write ? access.data : Bytes(zeros));
    }
    if (loss != Loss::kNothing) return station.lost(now += 4ms);
    station.answered(static_cast<std::uint16_t>(reply.wkc), access.write ? Bytes{} : Bytes(reply.data), now);
  }
  void exchange_image() {
    const std::vector<std::byte> image(kOutputSize + kInputSize);
    if (send(Command::kLrw, 0, image).wkc == 3) station.process_data_exchanged(now);
  }
  void look_at_state() {
    const auto reply = send(Command::kFprd, address_of(kStation, reg::kAlStatus), std::vector<std::byte>(6));
    if (reply.wkc == 0) return;
    const Bytes data(reply.data);
    station.al_status(static_cast<std::uint16_t>(test::number(data.first(2))),
                      static_cast<std::uint16_t>(test::number(data.subspan(4, 2))), now);
  }

  std::size_t cycles_ = 0;
};

struct Kind {
  Layout layout;
  const char* firmware;
  bool dc;
};

class StationWithRobot : public testing::TestWithParam<Kind> {
 protected:
  static Bus bus() { return Bus(robot(GetParam().layout, GetParam().firmware), GetParam().dc); }
};

TEST_P(StationWithRobot, ReachesOpWithoutAnyLiberty) {
  Bus bus = this->bus();
  ASSERT_TRUE(bus.climbs());
  EXPECT_EQ(bus.device.state(), AlState::kOp);
  bus.run(1s);
  EXPECT_TRUE(bus.station.operational()) << bus.trouble();
  EXPECT_EQ(bus.device.counters().strict, 0u);
  EXPECT_EQ(bus.device.counters().duplicate_mails, 0u);
  EXPECT_EQ(bus.device.counters().refused_states, 0u);
  EXPECT_EQ(bus.station.counters().lost_accesses, 0u);
  EXPECT_EQ(bus.station.device_name(), "Meca500");
  EXPECT_EQ(bus.station.firmware().major, GetParam().layout == Layout::kFirmware9    ? 9
                                          : GetParam().layout == Layout::kFirmware10 ? 10
                                                                                     : 11);
}

TEST_P(StationWithRobot, ReachesOpWhateverSingleFrameIsLost) {
  std::size_t all = 0;
  {
    Bus bus = this->bus();
    ASSERT_TRUE(bus.climbs());
    all = bus.accesses;
  }
  for (std::size_t k = 0; k < all; ++k) {
    for (const Loss how : {Loss::kRequest, Loss::kReply}) {
      Bus bus = this->bus();
      bus.loses = [=](std::size_t n, const Access&) { return n == k ? how : Loss::kNothing; };
      ASSERT_TRUE(bus.climbs()) << "access " << k;
      ASSERT_EQ(bus.station.counters().lost_accesses, 1u) << "access " << k;
      ASSERT_EQ(bus.station.counters().operational, 1u) << "access " << k;
      ASSERT_EQ(bus.device.counters().refused_states, 0u) << "access " << k;
    }
  }
}

TEST_P(StationWithRobot, ComesBackAfterACutThatWasTooLong) {
  Bus bus = this->bus();
  ASSERT_TRUE(bus.climbs());
  bus.run(6s);
  for (int i = 0; i < 300; ++i) bus.device.tick(bus.now += 1ms);  // nothing gets there
  EXPECT_EQ(bus.device.state(), AlState::kSafeop);
  ASSERT_TRUE(bus.run_until(Phase::kRecovering));
  EXPECT_THAT(bus.trouble(), HasSubstr(GetParam().dc ? "0x001A" : "0x001B"));
  ASSERT_TRUE(bus.run_until(Phase::kOperational)) << bus.trouble();
  EXPECT_EQ(bus.station.counters().al_errors, 1u);
}

INSTANTIATE_TEST_SUITE_P(OfEveryKind, StationWithRobot,
                         testing::Values(Kind{Layout::kFirmware9, "v9.3.3.5809", false},
                                         Kind{Layout::kFirmware10, "10.2.1", false},
                                         Kind{Layout::kFirmware11, "11.3.3.12637", false},
                                         Kind{Layout::kFirmware11, "11.3.3.12637", true}));

TEST(StationWithRobotFault, RepeatsMailsThatAreLostTwiceInARow) {
  Bus bus;
  std::size_t reads = 0;
  bus.loses = [&reads](std::size_t, const Access& a) {
    return a.address == kSyncManagers[1].start && reads++ % 3 != 2 ? Loss::kReply : Loss::kNothing;
  };
  ASSERT_TRUE(bus.climbs());
  EXPECT_GT(bus.station.counters().mailbox_repeats, 80u);
  EXPECT_EQ(bus.device.counters().duplicate_mails, 0u);
}

TEST(StationWithRobotFault, SurvivesEveryFourthFrameBeingLost) {
  Bus bus;
  bus.loses = [](std::size_t n, const Access&) {
    return n % 4 != 3 ? Loss::kNothing : n % 8 == 3 ? Loss::kReply : Loss::kRequest;
  };
  ASSERT_TRUE(bus.climbs());
}

TEST(StationWithRobotFault, TellsARefusalInWords) {
  Bus bus;
  bus.device.faults().refuse_state = 0x0025;
  bus.find();
  ASSERT_TRUE(bus.run_until(Phase::kPausing));
  EXPECT_THAT(bus.trouble(), AllOf(HasSubstr("AL status code 0x0025"), HasSubstr("invalid output mapping")));
  bus.device.faults().refuse_state.reset();
  ASSERT_TRUE(bus.run_until(Phase::kOperational)) << bus.trouble();
}

TEST(StationWithRobotFault, CountsAnEmergencyInOp) {
  Bus bus;
  ASSERT_TRUE(bus.climbs());
  bus.device.send_emergency({0xFF00, 0x81, {}});
  bus.run(2s);
  EXPECT_EQ(bus.station.counters().emergencies, 1u);
}

TEST(StationWithRobotFault, WithOldSyncManagerTypesIsConfiguredAllTheSame) {
  auto settings = robot(Layout::kFirmware9, "8.4.0");
  settings.old_sync_manager_types = true;
  Bus bus(settings);
  ASSERT_TRUE(bus.climbs());
}

TEST(StationWithRobotClose, LeavesTheRobotInInit) {
  Bus bus;
  ASSERT_TRUE(bus.climbs());
  bus.station.close(bus.now);
  ASSERT_TRUE(bus.run_until(Phase::kClosed));
  EXPECT_EQ(bus.device.state(), AlState::kInit);
}

TEST(StationWithRobotSii, IsReadAndGivenBack) {
  for (const bool eight : {false, true}) {
    auto settings = robot(Layout::kFirmware11, "11.3.3.12637");
    settings.alias = 77;
    settings.serial = 1234;
    settings.esc.sii_reads_8_bytes = eight;
    settings.esc.sii_busy = 300us;
    Bus bus(settings);
    SiiReader reader;
    reader.start(bus.now);
    for (int i = 0; i < 1000 && !reader.done(); ++i, bus.now += 100us) {
      reader.tick(bus.now);
      const auto access = reader.next(bus.now);
      if (!access) continue;
      const std::vector<std::byte> zeros(access->size);
      const auto reply = bus.send(access->write ? Command::kFpwr : Command::kFprd,
                                  address_of(kStation, access->address), access->write ? access->data : Bytes(zeros));
      reader.answered(static_cast<std::uint16_t>(reply.wkc), reply.data, bus.now);
    }
    ASSERT_TRUE(reader.done()) << reader.trouble();
    EXPECT_EQ(reader.identity().alias, 77);
    EXPECT_EQ(reader.identity().serial, 1234u);
    EXPECT_TRUE(reader.identity().checksum_right);
    EXPECT_TRUE(bus.device.esc().sii_belongs_to_pdi());
  }
}

}  // namespace
}  // namespace meca::ethercat::station_test
