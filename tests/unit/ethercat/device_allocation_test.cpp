// The device shares the thread of the simulated robot: after construction it must not allocate.
#include "tests/counted_new.hpp"
#include "tests/unit/ethercat/device_rig.hpp"
#include "transports/ethercat/chain.hpp"

namespace meca::ethercat::device_test {
namespace {

TEST(DeviceAllocation, IsCountedByThisProgram) {
  const auto before = test::allocations;
  static int* volatile sink = nullptr;  // what nobody sees the compiler may leave out
  sink = new int(1);
  delete sink;
  EXPECT_GT(test::allocations, before);
}

// A frame with a cycle, a mail and the fetching of one.
std::vector<std::byte> busy_frame() {
  std::array<std::byte, kLongestFrame> buffer{};
  FrameWriter writer(buffer, DeviceRig::kMaster);
  writer.add(Command::kLrw, 1, 0, kOutputSize + kInputSize);
  const auto mail =
      writer.add(Command::kFpwr, 2, address_of(DeviceRig::kAddress, kSyncManagers[0].start), kMailboxSize);
  const auto request = bytes("0A 00 00 00 00 03 00 20 50 11 1A 00 00 00 00 00");
  std::ranges::copy(request, mail.begin());
  writer.add(Command::kFprd, 3, address_of(DeviceRig::kAddress, kSyncManagers[1].start), kMailboxSize);
  const Bytes frame = writer.finish();
  return {frame.begin(), frame.end()};
}

TEST(DeviceAllocation, NeverHappensAfterConstruction) {
  DeviceRig robot;
  robot.to_op();
  const std::vector<std::byte> request = busy_frame();
  std::vector<std::byte> frame = request;
  const image::InputBytes input{};
  const auto mails = robot.device.counters().mails;

  const auto before = test::allocations;
  for (int i = 0; i < 1000; ++i, robot.now += 1ms) {
    std::ranges::copy(request, frame.begin());
    DatagramWalk<std::byte> walk(frame);
    while (auto datagram = walk.next()) robot.device.esc().process(*datagram, robot.now);
    robot.device.set_input(input);
    robot.device.tick(robot.now);
    robot.device.take_fresh();
    if (i == 500) robot.device.raise_al_error(0x001A, robot.now);
  }
  EXPECT_EQ(test::allocations, before);
  EXPECT_GT(robot.device.counters().mails, mails + 100);
  EXPECT_EQ(robot.al(), "SAFEOP+001A");
}

// Every command at every register, in a ring that is cut and healed and whose devices lose power.
TEST(ChainAllocation, NeverHappensAfterConstruction) {
  Device first(DeviceSettings{}), second(DeviceSettings{});
  Chain chain({&first, &second});
  chain.set_ring(true);
  std::array<std::byte, kLongestFrame> buffer{};
  Time now{};
  std::size_t answers = 0;

  const auto before = test::allocations;
  for (unsigned i = 0; i < 0x3000; ++i, now += 100us) {
    FrameWriter writer(buffer, DeviceRig::kMaster);
    for (std::uint8_t command = 0; command < kCommands; ++command)
      writer.add(static_cast<Command>(command), command, address_of(0, static_cast<std::uint16_t>(i)), 1 + i % 60);
    const auto frame = std::span(buffer).first(writer.finish().size());
    answers += chain.process(i % 2 == 0 ? Chain::Side::kPrimary : Chain::Side::kSecondary, frame, now).has_value();
    if (i % 64 == 0) chain.cut(i / 64 % 3);
    if (i % 64 == 32) chain.heal(i / 64 % 3);
    if (i % 256 == 5) chain.set_powered(i / 256 % 2, false);
    if (i % 256 == 9) chain.set_powered(i / 256 % 2, true);
    first.tick(now);
    second.tick(now);
  }
  EXPECT_EQ(test::allocations, before);
  EXPECT_GT(answers, 0x2000u);
}

}  // namespace
}  // namespace meca::ethercat::device_test
