// The scan against simulated robots: what it tells of them, and that it leaves no trace.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "tests/unit/ethercat/master_segment.hpp"
#include "transports/ethercat/chain.hpp"
#include "transports/ethercat/scan.hpp"

namespace meca::ethercat {
namespace {

using namespace std::chrono_literals;

std::unique_ptr<Device> robot(std::uint32_t serial, std::uint16_t alias = 0) {
  DeviceSettings settings;
  settings.serial = serial;
  settings.alias = alias;
  settings.esc.sii_busy = 300us;
  return std::make_unique<Device>(settings);
}

class Cable {
 public:
  Cable() {
    devices_.push_back(robot(1));
    devices_.push_back(robot(2, 7));
    devices_.push_back(robot(3));
    chain_.emplace(std::vector{devices_[0].get(), devices_[1].get(), devices_[2].get()});
    pass_time(10ms);
  }
  Device& device(std::size_t i) { return *devices_[i]; }
  Chain& chain() { return *chain_; }

  void pass_time(Time span) {
    for (const Time end = now_ + span; now_ < end; now_ += 100us) {
      for (const auto& device : devices_) device->tick(now_);
    }
  }
  void send(Command command, std::uint16_t adp, std::uint16_t ado, std::initializer_list<unsigned> bytes) {
    FrameWriter writer(buffer_, {});
    const auto data = writer.add(command, 0, address_of(adp, ado), bytes.size());
    std::size_t at = 0;
    for (const unsigned b : bytes) data[at++] = static_cast<std::byte>(b);
    ASSERT_TRUE(chain_->process(Chain::Side::kPrimary, buffer_of(writer.finish()), now_));
    pass_time(5ms);
  }
  std::vector<ScannedDevice> scan() {
    Scan scan({}, now_);
    while (!scan.done()) {
      scan.tick(now_);
      const Bytes frame = scan.next_frame(now_);
      if (!frame.empty()) {
        std::ranges::copy(frame, buffer_.begin());
        const auto back = std::span(buffer_).first(frame.size());
        if (chain_->process(Chain::Side::kPrimary, back, now_)) scan.received(back, now_);
      }
      pass_time(100us);
    }
    return {scan.devices().begin(), scan.devices().end()};
  }
  // Registers that say how a device is set up, without those of the SII's access and of the clock.
  std::vector<std::uint8_t> setup_of(std::size_t i) const {
    std::vector<std::uint8_t> out;
    for (std::uint16_t a = 0; a < 0x0900; ++a) {
      if (a < reg::kSiiControl || a > 0x050F) out.push_back(devices_[i]->esc().peek(a));
    }
    return out;
  }

 private:
  std::span<std::byte> buffer_of(Bytes frame) { return std::span(buffer_).first(frame.size()); }

  std::vector<std::unique_ptr<Device>> devices_;
  std::optional<Chain> chain_;
  Time now_ = 1s;
  std::array<std::byte, kLongestFrame> buffer_{};
};

TEST(ScanOfRobots, TellsWhoTheyAreInTheOrderOfTheCable) {
  Cable cable;
  const auto found = cable.scan();
  ASSERT_EQ(found.size(), 3u);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const ScannedDevice& d = found[i];
    ASSERT_TRUE(d.identity) << d.identity_trouble.view();
    EXPECT_TRUE(is_meca500(*d.identity));
    EXPECT_TRUE(d.identity->checksum_right);
    EXPECT_EQ(d.identity->serial, i + 1);
    EXPECT_EQ(d.station_address, 0);
    EXPECT_EQ(d.al_status, 0x0001);
    EXPECT_EQ(d.dc, DcSupport::k64Bit);
    EXPECT_TRUE(d.ports[0].link);
    EXPECT_EQ(d.ports[1].link, i < 2) << "port 1 leads on to the next";
  }
  EXPECT_EQ(found[1].identity->alias, 7);
  EXPECT_EQ(found[1].alias, 7);
}

TEST(ScanOfRobots, ChangesNothing) {
  Cable cable;
  std::array<std::vector<std::uint8_t>, 3> before;
  for (std::size_t i = 0; i < 3; ++i) before[i] = cable.setup_of(i);
  cable.scan();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(cable.setup_of(i), before[i]) << "position " << i;
}

TEST(ScanOfRobots, GivesBackTheSiiThatItFoundWithARobotInInit) {
  Cable cable;
  cable.send(Command::kBwr, 0, reg::kSiiOwner, {1});
  for (const ScannedDevice& d : cable.scan()) {
    EXPECT_TRUE(d.sii_with_device);
    EXPECT_TRUE(d.identity);
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(cable.device(i).esc().sii_belongs_to_pdi());
}

TEST(ScanOfRobots, NamesTheErrorOfOneThatRefusesAState) {
  Cable cable;
  cable.send(Command::kApwr, auto_increment(1), reg::kAlControl, {static_cast<unsigned>(AlState::kOp), 0});
  const auto found = cable.scan();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[1].al_status, 0x0011);
  EXPECT_EQ(found[1].al_code, 0x0011) << "invalid state change";
  EXPECT_EQ(found[2].al_status, 0x0001);
}

TEST(ScanOfRobots, EndsAtACutAndFindsTheLinkThatWasLost) {
  Cable cable;
  cable.chain().cut(2);
  const auto found = cable.scan();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_FALSE(found[1].ports[1].link);
  EXPECT_EQ(found[1].ports[1].lost_links, 1);
  EXPECT_EQ(found[0].ports[1].lost_links, 0);
}

TEST(ScanOfRobots, BesideARunningMasterSaysSoAndDisturbsNothing) {
  test::Segment segment(test::settings_for(3));
  ASSERT_TRUE(segment.start());
  Scan scan({}, segment.now());
  std::array<std::byte, kLongestFrame> buffer{};
  segment.sent = [&](Bytes frame, Chain::Side) { scan.received(frame, segment.now()); };
  segment.every_cycle = [&](test::Segment& s) {
    scan.tick(s.now());
    const Bytes frame = scan.next_frame(s.now());
    if (frame.empty()) return;
    std::ranges::copy(frame, buffer.begin());
    const auto back = std::span(buffer).first(frame.size());
    ASSERT_TRUE(s.chain().process(Chain::Side::kPrimary, back, s.now()));
    s.master().received(Master::Port::kPrimary, back, s.now());  // both sockets see every frame
    scan.received(back, s.now());
  };
  const auto scanned = [&scan] { return scan.done(); };
  ASSERT_TRUE(segment.run(1s, scanned));
  ASSERT_EQ(scan.devices().size(), 3u);
  for (const ScannedDevice& d : scan.devices()) {
    EXPECT_EQ(d.al_status, static_cast<std::uint16_t>(AlState::kOp));
    EXPECT_TRUE(runs_under_a_master(d));
    EXPECT_TRUE(d.process_data_of_meca500);
    EXPECT_GE(d.station_address, 0x1001);
  }
  EXPECT_GT(scan.frames_of_others(), 0u);

  EXPECT_FALSE(segment.run(100ms, [&] { return !segment.all_operational(); })) << "a robot left OP";
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(segment.master().counters(i).working_counter_misses, 0u);
    EXPECT_EQ(segment.master().counters(i).losses, 0u);
  }
  EXPECT_EQ(segment.master().counters().lost_frames, 0u);
}

}  // namespace
}  // namespace meca::ethercat
