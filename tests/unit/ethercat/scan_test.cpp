#include "transports/ethercat/scan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>

namespace meca::ethercat {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A device as its registers and its SII have it, no more: what is written besides the SII's own registers is kept for
// the tests to see.
struct Registers {
  std::array<std::byte, 0x1000> memory{};
  std::vector<std::byte> sii = make_meca500_sii(0, 4711);
  std::vector<std::uint16_t> written;  // addresses
  std::function<bool()> deaf = [] { return false; };

  void put(std::uint16_t address, std::initializer_list<unsigned> bytes) {
    for (const unsigned b : bytes) memory[address++] = static_cast<std::byte>(b);
  }
  std::uint8_t at(std::uint16_t address) const { return std::to_integer<std::uint8_t>(memory[address]); }

  Registers() {
    put(reg::kType, {0x11, 0, 2, 0, 8, 8, 8, 0x0F, 0xCC, 0x01});
    put(reg::kStationAddress, {0x01, 0x10, 0x07, 0x00});
    put(reg::kDlStatus, {0x11, 0x56});  // link and communication on port 0 only, the other loops closed
    put(reg::kAlStatus, {1, 0, 0, 0, 0, 0});
  }
  void read(std::uint16_t address, std::span<std::byte> data) const {
    std::copy_n(memory.begin() + address, data.size(), data.begin());
  }
  void write(std::uint16_t address, Bytes data) {
    written.push_back(address);
    std::ranges::copy(data, memory.begin() + address);
    const bool reads_sii = address == reg::kSiiControl && data.size() >= 2 && data[1] == std::byte{1};
    if (!reads_sii) return;
    const std::size_t word = at(reg::kSiiAddress) | at(reg::kSiiAddress + 1) << 8;
    for (std::size_t i = 0; i < 4; ++i) memory[reg::kSiiData + i] = sii[2 * word + i];
    put(reg::kSiiControl, {0, 0});
  }
};

struct Rig {
  std::vector<Registers> devices;
  Time now{};
  std::function<bool()> lose = [] { return false; };  // the frame that is on its way
  std::vector<Bytes> before_reply;                    // frames of others that arrive first
  bool loop = false, reply_bit = true;
  std::uint64_t sent = 0;

  explicit Rig(std::size_t count) : devices(count) {}

  void pass(Registers& device, MutableDatagram d) const {
    const bool broadcast = d.command() == Command::kBrd;
    const bool addressed = broadcast || d.adp() == 0;
    d.set_adp(static_cast<std::uint16_t>(d.adp() + 1));
    if (!addressed || (!broadcast && device.deaf())) return;
    if (d.command() == Command::kApwr) {
      device.write(d.ado(), d.data());
    } else {
      device.read(d.ado(), d.data());
    }
    d.set_working_counter(static_cast<std::uint16_t>(d.working_counter() + 1));
  }
  std::vector<std::byte> reply_to(Bytes sent_frame) {
    std::vector<std::byte> frame(sent_frame.begin(), sent_frame.end());
    if (loop) return frame;
    for (Registers& device : devices) {
      DatagramWalk<std::byte> walk(frame);
      while (auto d = walk.next()) pass(device, *d);
    }
    if (reply_bit) frame[6] |= kReplyBit;
    return frame;
  }

  // Runs the scan to its end.
  std::vector<ScannedDevice> scan(Scan& scan) {
    for (int i = 0; i < 100000 && !scan.done(); ++i) {
      scan.tick(now);
      if (scan.done()) break;
      const Bytes frame = scan.next_frame(now);
      if (frame.empty()) {
        now = std::max(now + 1us, std::min(scan.next_event(), now + 1s));
        continue;
      }
      ++sent;
      for (const Bytes other : before_reply) EXPECT_FALSE(scan.received(other, now));
      const auto reply = reply_to(frame);
      if ((devices.empty() && !loop) || lose()) {
        now = scan.next_event();
        continue;
      }
      now += 30us;
      scan.received(reply, now);
    }
    EXPECT_TRUE(scan.done());
    return {scan.devices().begin(), scan.devices().end()};
  }
  std::vector<ScannedDevice> scan() {
    Scan s({}, now);
    return scan(s);
  }
};

TEST(Scan, ReadsWhoStandsInTheChainAndInWhichState) {
  Rig rig(1);
  const auto found = rig.scan();
  ASSERT_EQ(found.size(), 1u);
  const ScannedDevice& d = found[0];
  EXPECT_TRUE(d.answered);
  EXPECT_EQ(d.position, 0);
  EXPECT_EQ(d.station_address, 0x1001);
  EXPECT_EQ(d.alias, 7);
  EXPECT_EQ(d.al_status, 0x0001);
  EXPECT_EQ(d.dc, DcSupport::k64Bit);
  ASSERT_TRUE(d.identity);
  EXPECT_TRUE(is_meca500(*d.identity));
  EXPECT_EQ(d.identity->serial, 4711u);
  EXPECT_TRUE(d.identity->checksum_right);
  EXPECT_FALSE(runs_under_a_master(d));
}

TEST(Scan, TellsPortsAndCountersApart) {
  Rig rig(1);
  rig.devices[0].put(reg::kDlStatus, {0x31, 0x5A});  // links on ports 0 and 1, both open
  rig.devices[0].put(reg::kPortDescriptor, {0x0F});  // two ports
  rig.devices[0].put(reg::kRxErrors, {1, 2, 3, 4});  // invalid frames and errors of ports 0 and 1
  rig.devices[0].put(reg::kForwardedErrors, {5, 6});
  rig.devices[0].put(reg::kProcessingErrors, {7, 8});
  rig.devices[0].put(reg::kLostLinks, {0, 255});
  const auto d = rig.scan().at(0);
  EXPECT_TRUE(d.ports[0].exists);
  EXPECT_TRUE(d.ports[1].exists);
  EXPECT_FALSE(d.ports[2].exists);
  EXPECT_TRUE(d.ports[0].link && d.ports[1].link);
  EXPECT_TRUE(d.ports[0].communication && d.ports[1].communication);
  EXPECT_FALSE(d.ports[0].loop_closed || d.ports[1].loop_closed);
  EXPECT_TRUE(d.ports[2].loop_closed);
  EXPECT_EQ(d.ports[0].invalid_frames, 1);
  EXPECT_EQ(d.ports[0].rx_errors, 2);
  EXPECT_EQ(d.ports[1].invalid_frames, 3);
  EXPECT_EQ(d.ports[1].rx_errors, 4);
  EXPECT_EQ(d.ports[0].forwarded_errors, 5);
  EXPECT_EQ(d.ports[1].lost_links, 255);
  EXPECT_EQ(d.processing_errors, 7);
  EXPECT_EQ(d.pdi_errors, 8);
}

TEST(Scan, FindsOtherDevicesBetweenTheRobotsInTheOrderOfTheCable) {
  Rig rig(3);
  rig.devices[1].sii[2 * sii::kProduct] = std::byte{0x52};
  rig.devices[1].put(reg::kFeatures, {0x00, 0x00});
  rig.devices[2].put(reg::kFeatures, {0x04, 0x00});
  rig.devices[2].put(reg::kAlStatus, {0x14, 0, 0, 0, 0x1B, 0});
  const auto found = rig.scan();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_TRUE(is_meca500(*found[0].identity));
  EXPECT_FALSE(is_meca500(*found[1].identity));
  EXPECT_EQ(found[1].dc, DcSupport::kNone);
  EXPECT_EQ(found[2].position, 2);
  EXPECT_EQ(found[2].al_status, 0x0014);
  EXPECT_EQ(found[2].al_code, 0x001B);
  EXPECT_EQ(found[2].dc, DcSupport::k32Bit);
  EXPECT_TRUE(runs_under_a_master(found[2]));
}

TEST(Scan, WritesNothingButTheAddressOfTheSiiWordsWhereTheSiiIsWithTheMaster) {
  Rig rig(2);
  rig.scan();
  for (const Registers& device : rig.devices) {
    EXPECT_FALSE(device.written.empty());
    for (const auto address : device.written) EXPECT_TRUE(address == reg::kSiiControl || address == reg::kSiiAddress);
    EXPECT_EQ(device.at(reg::kSiiOwner), 0);
  }
}

TEST(Scan, GivesTheSiiBackToADeviceInInitThatHadIt) {
  Rig rig(1);
  rig.devices[0].put(reg::kSiiOwner, {1, 0});
  const auto found = rig.scan();
  EXPECT_TRUE(found[0].sii_with_device);
  ASSERT_TRUE(found[0].identity);
  EXPECT_EQ(rig.devices[0].at(reg::kSiiOwner), 1);
  for (const auto address : rig.devices[0].written) EXPECT_TRUE(address >= 0x0500 && address <= 0x0507) << address;
}

TEST(Scan, GivesTheSiiBackWhenItCannotBeRead) {
  Rig rig(1);
  rig.devices[0].put(reg::kSiiOwner, {1, 0});
  rig.devices[0].sii.resize(0x100);
  int frames = 0;
  // It answers to the first register reads, then to nothing until the reader has given up.
  rig.lose = [&] { return ++frames > 4 && rig.now < 1s; };
  const auto found = rig.scan();
  EXPECT_FALSE(found[0].identity);
  EXPECT_FALSE(found[0].identity_trouble.empty());
  EXPECT_EQ(rig.devices[0].at(reg::kSiiOwner), 1);
}

TEST(Scan, LeavesTheSiiAloneThatADeviceUnderAMasterHas) {
  Rig rig(1);
  rig.devices[0].put(reg::kSiiOwner, {1, 0});
  rig.devices[0].put(reg::kAlStatus, {8, 0});
  for (unsigned n = 2; n < 4; ++n) {
    std::ranges::copy(sync_manager_bytes(n, true), rig.devices[0].memory.begin() + reg::sync_manager(n));
  }
  const auto d = rig.scan().at(0);
  EXPECT_THAT(rig.devices[0].written, IsEmpty());
  EXPECT_FALSE(d.identity);
  EXPECT_THAT(std::string(d.identity_trouble), HasSubstr("left alone"));
  EXPECT_TRUE(d.process_data_of_meca500);
  EXPECT_TRUE(runs_under_a_master(d));
}

TEST(Scan, LeavesTheSiiAloneThatADeviceReadsJustNow) {
  Rig rig(1);
  rig.devices[0].put(reg::kSiiOwner, {1, 1});
  EXPECT_FALSE(rig.scan().at(0).identity);
  EXPECT_THAT(rig.devices[0].written, IsEmpty());
}

TEST(Scan, OfNobodyEndsWhenItsPatienceDoes) {
  Rig rig(0);
  Scan scan({.patience = 1s}, rig.now);
  EXPECT_THAT(rig.scan(scan), IsEmpty());
  EXPECT_EQ(rig.now, 1s);
  EXPECT_EQ(rig.sent, 10u) << "asked again every 100 ms";
  EXPECT_EQ(scan.echoes(), 0u);
  EXPECT_EQ(scan.next_event(), Time::max());
}

TEST(Scan, OfALoopSeesItsOwnFramesAndNoDevice) {
  Rig rig(0);
  rig.loop = true;
  Scan scan;
  rig.now = 0s;
  for (int i = 0; i < 30 && !scan.done(); ++i) {
    const Bytes frame = scan.next_frame(rig.now);
    if (!frame.empty()) scan.received(rig.reply_to(frame), rig.now);
    rig.now = scan.next_event();
    scan.tick(rig.now);
  }
  EXPECT_TRUE(scan.done());
  EXPECT_THAT(scan.devices(), IsEmpty());
  EXPECT_EQ(scan.echoes(), 10u);
}

// KickCAT's simulator does not.
TEST(Scan, TakesAnswersOfDevicesThatDoNotSetTheReplyBit) {
  Rig rig(2);
  rig.reply_bit = false;
  Scan scan;
  EXPECT_EQ(rig.scan(scan).size(), 2u);
  EXPECT_TRUE(scan.devices()[1].identity);
  EXPECT_EQ(scan.echoes(), 0u);
}

TEST(Scan, IgnoresTheFramesOfAMasterBesideIt) {
  std::array<std::byte, kLongestFrame> buffer{};
  MacAddress other{};
  other.fill(std::byte{0x10});
  FrameWriter writer(buffer, other);
  writer.add(Command::kBrd, 1, address_of(0, reg::kType), 1);  // what the scan asks first, too
  const Bytes frame = writer.finish();
  buffer[6] |= kReplyBit;

  Rig rig(2);
  rig.before_reply = {frame};
  Scan scan;
  EXPECT_EQ(rig.scan(scan).size(), 2u);
  EXPECT_EQ(scan.frames_of_others(), rig.sent);
}

TEST(Scan, BearsLostFrames) {
  for (std::uint64_t every = 2; every < 7; ++every) {
    Rig rig(3);
    std::uint64_t frames = 0;
    rig.lose = [&] { return ++frames % every == 0; };
    const auto found = rig.scan();
    ASSERT_EQ(found.size(), 3u);
    for (const auto& device : found) {
      EXPECT_TRUE(device.answered) << "every " << every << "th frame lost";
      EXPECT_TRUE(device.identity) << "every " << every << "th frame lost";
    }
  }
}

TEST(Scan, NamesADeviceThatDoesNotAnswerAloneAndGoesOn) {
  Rig rig(3);
  rig.devices[1].deaf = [] { return true; };
  const auto found = rig.scan();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_FALSE(found[1].answered);
  EXPECT_FALSE(found[1].identity);
  EXPECT_TRUE(found[2].answered);
}

TEST(Scan, TakesNoReplyToAnOlderFrame) {
  Rig rig(1);
  Scan scan;
  const Bytes first = scan.next_frame(rig.now);
  const auto late = rig.reply_to(first);
  rig.now = scan.next_event();
  scan.tick(rig.now);
  ASSERT_FALSE(scan.next_frame(rig.now).empty());
  EXPECT_FALSE(scan.received(late, rig.now));
  EXPECT_THAT(scan.devices(), IsEmpty());
}

TEST(Scan, IsQuietAboutBytesThatAreNoFrame) {
  Rig rig(1);
  Scan scan;
  const auto reply = rig.reply_to(scan.next_frame(rig.now));
  for (std::size_t size = 0; size < kEthernetHeader + kFrameHeader + kDatagramOverhead + 1; ++size) {
    EXPECT_FALSE(scan.received(std::span(reply).first(size), rig.now)) << size;
  }
  EXPECT_TRUE(scan.received(reply, rig.now));
}

}  // namespace
}  // namespace meca::ethercat
