// The built-in transport: simulated robots behind the interface of a bus.
#include "transports/builtin/builtin.hpp"

#include "tests/unit/sim/rig.hpp"
#include "transports/image/codec.hpp"

namespace meca::transports {
namespace {

using namespace std::chrono_literals;
using sim::Rig;

class BuiltinBus : public testing::Test {
 protected:
  void cycle(image::Format format = {}) {
    for (std::size_t i = 0; i < 2; ++i) {
      image::encode_outputs(outputs[i], format, exchanges[i].output);
      exchanges[i].output_valid = true;
    }
    now += 1ms;
    bus->exchange(now, exchanges);
    for (std::size_t i = 0; i < 2; ++i) inputs[i] = image::decode_inputs(exchanges[i].input, format);
  }
  std::unique_ptr<Transport> bus = make_builtin({Rig::quick(), Rig::quick()});
  std::array<Exchange, 2> exchanges{};
  std::array<image::Outputs, 2> outputs{};
  std::array<image::Inputs, 2> inputs{};
  Time now = 5h;
};

TEST_F(BuiltinBus, IsUpAtOnceAndGivesAFreshImageInEveryCycle) {
  bus->open(now);
  cycle();
  for (const Exchange& e : exchanges) {
    EXPECT_EQ(e.link, LinkState::kUp);
    EXPECT_TRUE(e.fresh);
    EXPECT_EQ(e.identity, FirmwareVersion{});  // the bridge has to read dynamic data type 1
  }
  EXPECT_EQ(inputs[0].motion_status.fifo_space, 13000);
  EXPECT_EQ(bus->byte_order(), std::endian::little);
}

TEST_F(BuiltinBus, EachRobotHearsItsOwnOutputs) {
  bus->open(now);
  outputs[1].robot_control.activate = true;
  for (int i = 0; i < 10; ++i) cycle();
  EXPECT_FALSE(inputs[0].robot_status.activated);
  EXPECT_TRUE(inputs[1].robot_status.activated);
}

TEST_F(BuiltinBus, LetsRobotTimePassLikeBusTimeButNeverMoreThan100MillisecondsAtOnce) {
  bus->open(now);
  cycle();
  const auto microseconds = [&] {
    return inputs[0].robot_timestamp.seconds * 1'000'000LL + inputs[0].robot_timestamp.microseconds;
  };
  const auto start = microseconds();
  for (int i = 0; i < 100; ++i) cycle();
  EXPECT_EQ(microseconds() - start, 100'000);
  now += 1h;  // a debugger held the process
  cycle();
  EXPECT_EQ(microseconds() - start, 200'000);
}

TEST_F(BuiltinBus, OutputsThatAreNotValidAreNotObeyed) {
  bus->open(now);
  outputs[0].robot_control.activate = true;
  image::encode_outputs(outputs[0], {}, exchanges[0].output);
  exchanges[0].output_valid = false;
  for (int i = 0; i < 10; ++i) {
    now += 1ms;
    bus->exchange(now, exchanges);
  }
  EXPECT_FALSE(image::decode_inputs(exchanges[0].input, {}).robot_status.activated);
}

TEST_F(BuiltinBus, SpeaksTheLayoutOfTheFirmwareItPlays) {
  auto nine = Rig::quick(image::Layout::kFirmware9);
  bus = make_builtin({nine, nine});
  bus->open(now);
  outputs[0].dynamic_data_configuration.type_ids = {1, 0, 0, 0};
  const image::Format format{image::Layout::kFirmware9, std::endian::little};
  for (int i = 0; i < 3; ++i) cycle(format);
  EXPECT_EQ(inputs[0].dynamic_data[0].type_id, 1u);
  EXPECT_EQ(inputs[0].dynamic_data[0].values[0], 9.0f);
  EXPECT_FALSE(inputs[0].safety_status.known);
}

TEST_F(BuiltinBus, SaysThatARobotIsBootingAndLeavesTheOthersAlone) {
  sim::RobotOptions quick = Rig::quick();
  quick.boot_time = 50ms;
  bus = make_builtin({quick, quick});
  bus->open(now);
  cycle();
  outputs[0].motion_control = {.move_id = 1, .set_point = true};
  outputs[0].motion_command.command_id = image::kRebootRobot;
  const auto count = [&](LinkState state, std::size_t robot, int cycles) {
    int found = 0;
    for (int i = 0; i < cycles; ++i) {
      cycle();
      outputs[0] = {};
      found += exchanges[robot].link == state && exchanges[robot].fresh == (state == LinkState::kUp) ? 1 : 0;
      EXPECT_EQ(exchanges[robot].link_detail.empty(), exchanges[robot].link == LinkState::kUp);
    }
    return found;
  };
  EXPECT_EQ(count(LinkState::kUp, 0, 90), 90) << "it says first that it has heard";
  EXPECT_EQ(inputs[0].motion_status.move_id, 1);
  EXPECT_EQ(count(LinkState::kDown, 0, 100), 50);
  EXPECT_EQ(exchanges[0].link, LinkState::kUp);
  EXPECT_EQ(inputs[0].motion_status.move_id, 0);
  EXPECT_GT(inputs[1].robot_timestamp.seconds + inputs[1].robot_timestamp.microseconds,
            inputs[0].robot_timestamp.seconds + inputs[0].robot_timestamp.microseconds);
}

TEST_F(BuiltinBus, DoesNotMindFewerOrMoreExchangesThanRobots) {
  bus->open(now);
  bus->exchange(now + 1ms, std::span(exchanges).first(1));
  std::array<Exchange, 3> three{};
  bus->exchange(now + 2ms, three);
  EXPECT_TRUE(three[1].fresh);
  EXPECT_FALSE(three[2].fresh);
}

}  // namespace
}  // namespace meca::transports
