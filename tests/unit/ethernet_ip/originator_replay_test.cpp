// What real targets answered, fed to the originator as it was recorded.
#include <gtest/gtest.h>

#include "tests/unit/ethernet_ip/originator_rig.hpp"

namespace meca::ethernet_ip {
namespace {

using namespace test;

constexpr std::uint32_t kTarget = 0xAC1C0103;  // 172.28.1.3
constexpr std::uint32_t kRecordedSession = 1;

OriginatorSettings recorded(std::uint16_t vendor, std::uint32_t serial, std::uint16_t incarnation = 0) {
  OriginatorSettings settings;
  settings.address = kTarget;
  settings.vendor_id = vendor;
  settings.serial_number = serial;
  settings.incarnation = incarnation;
  return settings;
}

class Replay : public Rig {
 public:
  Replay(const OriginatorSettings& settings, std::uint16_t serial, std::string_view answer) : Rig(settings, serial) {
    session = kRecordedSession;
    connect();
    take_output();
    feed(golden::kRegisterReply);
    take_output();
    feed(golden::kIdentityReply);
    take_open();
    feed(answer);
  }
  bool receive_recorded(std::string_view packet, std::size_t size) {
    return machine.io_received({kTarget, 2222}, from_hex(packet, size), now);
  }
};

TEST(OriginatorReplay, OfPointToPointWithOpenerRunsAndCloses) {  // meca1
  Replay rig(recorded(0x1234, 0x6B02695B, 0xDC2D), 1, golden::kOpenReply);
  ASSERT_EQ(rig.machine.state(), State::kRunning) << rig.machine.trouble();
  const auto sent = rig.produce();
  EXPECT_EQ(sent->to, (SocketAddress{kTarget, 2222})) << "the item says 0.0.0.0: the robot";
  EXPECT_EQ(sent->connection_id, 0x3FE60013u);
  rig.receive_recorded(golden::kInputPacket1, 272);
  rig.receive_recorded(golden::kInputPacket3, 272);
  EXPECT_TRUE(rig.machine.running());
  EXPECT_EQ(rig.machine.counters().received, 2u);
  EXPECT_EQ(rig.machine.counters().lost, 1u) << "the second packet was left out here";
  EXPECT_EQ(to_hex(wire::Bytes(rig.machine.input()).subspan(4, 8)), "01000000090A0B0C");
  rig.machine.close(rig.now);
  EXPECT_EQ(rig.take_close(), (ConnectionTriad{1, 0x1234, 0x6B02695B}));
  rig.feed(golden::kCloseReply);
  EXPECT_EQ(to_hex(rig.take_output()), golden::kUnregisterRequest);
}

TEST(OriginatorReplay, OfMulticastJoinsTheRecordedGroup) {  // eeip
  auto settings = recorded(0x00FF, 0xFFFFFFFF);
  settings.multicast = true;
  Replay rig(settings, 0x7C92, golden::kMulticastOpenReply);
  ASSERT_EQ(rig.machine.state(), State::kRunning) << rig.machine.trouble();
  EXPECT_EQ(rig.machine.group(), 0xEFC00140u);
  EXPECT_EQ(rig.produce()->connection_id, 0xC6860014u);
  EXPECT_TRUE(rig.receive_recorded(golden::kMulticastInputPacket1, 272));
  EXPECT_TRUE(rig.machine.running());
}

TEST(OriginatorReplay, OfTheVendorsForwardOpenRuns) {  // vendor, frames 36 and 37
  auto settings = recorded(0x0BAD, 0x51515151);
  settings.multicast = true;
  settings.o_to_t_rpi_us = settings.t_to_o_rpi_us = 50'000;
  settings.key = KeyPolicy::kCompatible;
  settings.major = 11;
  settings.minor = 3;
  Replay rig(settings, 0xCB05, golden::kKeyed113OpenReply);
  ASSERT_EQ(rig.machine.state(), State::kRunning) << rig.machine.trouble();
  EXPECT_EQ(rig.machine.o_to_t_api_us(), 50'000u);
  EXPECT_EQ(rig.machine.group(), 0xEFC00140u);
}

TEST(OriginatorReplay, OfAKeyOfOlderFirmwareIsRefusedInWords) {  // vendor, frames 8 and 9
  auto settings = recorded(0x0BAD, 0x51515151);
  settings.key = KeyPolicy::kCompatible;
  settings.major = 10;
  settings.minor = 2;
  Replay rig(settings, 0xCB03, golden::kKeyRefused);
  EXPECT_EQ(rig.machine.trouble(),
            "Forward Open refused (0x01/0x0116): key compatible with 10.2 asked, the robot is 11.3; the revision does "
            "not fit; correct the key's revision, or set the key to none");
}

TEST(OriginatorReplay, OfARobotThatBelongsToAnotherIsRefusedInWords) {  // wd2, frame 226
  Replay rig(recorded(0x0BAD, 0x51515158), 0x13D6, golden::kOwnedRefused);
  EXPECT_NE(rig.machine.trouble().find("(0x01/0x0106): another controller owns"), std::string_view::npos)
      << rig.machine.trouble();
}

TEST(OriginatorReplay, OfInputsWithARunIdleHeaderIsRefusedInWords) {  // hdr: 258 bytes where 254 are agreed
  Replay rig(recorded(1, 1, 0xF8E6), 1, golden::kHeaderOpenReply);
  ASSERT_EQ(rig.machine.state(), State::kRunning) << rig.machine.trouble();
  EXPECT_TRUE(rig.receive_recorded(golden::kHeaderInputPacket1, 276));
  EXPECT_EQ(rig.machine.counters().malformed, 1u);
  EXPECT_FALSE(rig.machine.running());
  EXPECT_NE(rig.machine.trouble().find("258 bytes, 254 were agreed (does it send a run/idle header?)"),
            std::string_view::npos)
      << rig.machine.trouble();
}

TEST(OriginatorReplay, OfAnyAnswerCutAnywhereIsQuiet) {
  for (const auto answer : golden::kMessages) {
    const auto whole = from_hex(answer);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      Replay rig(recorded(0x1234, 0x6B02695B, 0xDC2D), 1, "");
      rig.feed(wire::Bytes(whole).first(size));
      EXPECT_EQ(rig.machine.state(), State::kOpening) << "half a message is none";
    }
  }
}

}  // namespace
}  // namespace meca::ethernet_ip
