// The device shares the thread of the simulated robot: after construction it must not allocate.
#include "tests/counted_new.hpp"
#include "tests/unit/ethercat/device_rig.hpp"

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

}  // namespace
}  // namespace meca::ethercat::device_test
