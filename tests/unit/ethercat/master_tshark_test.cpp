// A whole life on the wire, read by a stranger: tshark decodes what master and devices say to each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "tests/pcap_file.hpp"
#include "tests/tshark.hpp"
#include "tests/unit/ethercat/master_segment.hpp"
#include "tests/unit/net/temporary_directory.hpp"

namespace meca::ethercat::test {
namespace {

using meca::test::kNoTshark;
using meca::test::PcapFile;
using meca::test::tshark;
using meca::test::tshark_is_here;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::UnorderedElementsAre;

// Three robots of different firmware: up to OP, process data, faults of each kind, and down to INIT.
std::size_t live(const std::filesystem::path& path) {
  PcapFile file(path);
  std::vector<DeviceSettings> devices(3);
  devices[1].layout = image::Layout::kFirmware9;
  devices[1].firmware = "9.3.3.5809";
  devices[2].layout = image::Layout::kFirmware10;
  devices[2].firmware = "10.2.1.9876";
  Segment segment(settings_for(3), devices);
  segment.sent = [&](Bytes frame, Chain::Side) { file.add(frame, segment.now()); };
  segment.came_back = [&](Bytes frame) { file.add(frame, segment.now()); };
  EXPECT_TRUE(segment.start()) << segment.master().trouble(0);
  segment.run(20ms);
  segment.fate = [](std::size_t frame) { return Fate{.lost = frame % 7 == 0}; };
  segment.run(20ms);
  segment.fate = {};
  segment.device(1).raise_al_error(0x001B, segment.now());
  segment.device(2).send_emergency({.code = 0x8612, .error_register = 1});
  segment.device(0).power_cycle(segment.now());
  segment.run(50ms);
  EXPECT_TRUE(segment.start()) << segment.master().trouble(0);
  segment.run(600ms, [&] { return segment.master().station(2).counters().emergencies == 2; });
  segment.master().close(segment.now());
  segment.run(100ms, [&] { return segment.master().closed(); });
  file.flush();
  return file.frames();
}

class EthercatSeenByTshark : public testing::Test {
 protected:
  void SetUp() override {
    if (!tshark_is_here()) GTEST_SKIP() << kNoTshark;
    frames = live(file);
  }

  // All values of a field, of frames that pass the filter.
  std::set<std::string> values(const std::string& filter, const std::string& field) {
    std::set<std::string> out;
    for (const std::string& line : tshark(file, "-Y '" + filter + "' -T fields -e " + field)) {
      std::istringstream parts(line);
      for (std::string part; std::getline(parts, part, ',');) out.insert(part);
    }
    return out;
  }

  meca::test::TemporaryDirectory directory;
  std::filesystem::path file = directory / "life.pcap";
  std::size_t frames = 0;
};

TEST_F(EthercatSeenByTshark, EveryFrameIsEthercatAndNoneIsMalformedOrInError) {
  EXPECT_EQ(tshark(file, "-Y ecat").size(), frames);
  constexpr const char* kMalformedOrWarning = "-Y '_ws.malformed || _ws.expert.severity >= 6291456'";
  EXPECT_THAT(tshark(file, kMalformedOrWarning), IsEmpty());
}

TEST_F(EthercatSeenByTshark, EachStateIsAskedForAndReachedAndTheErrorHasItsCode) {
  EXPECT_THAT(values("ecat.reg.alctrl", "ecat.reg.alctrl.ctrl"),
              UnorderedElementsAre("0x0001", "0x0002", "0x0004", "0x0008"));
  EXPECT_THAT(values("ecat.reg.alstatus && ecat.cmd == 4", "ecat.reg.alstatus.status"),
              IsSupersetOf({"0x0001", "0x0002", "0x0004", "0x0008"}));
  EXPECT_THAT(values("ecat.reg.alstatus.err == 1", "ecat.reg.alstatuscode"), IsSupersetOf({"0x001b"}));
}

TEST_F(EthercatSeenByTshark, ProcessDataIsCountedThreeARobotOnItsWayBackAndNotAtAllOnItsWayThere) {
  EXPECT_THAT(values("ecat.cmd == 0x0c && eth.src[0] & 02", "ecat.cnt"), IsSupersetOf({"3"}));
  EXPECT_THAT(values("ecat.cmd == 0x0c && !(eth.src[0] & 02)", "ecat.cnt"), UnorderedElementsAre("0"));
}

TEST_F(EthercatSeenByTshark, TheObjectsOfTheWayUpAreAskedForAndOnlyTheOneThatFirmware9LacksIsRefused) {
  EXPECT_THAT(values("ecat_mailbox.coe.sdoidx", "ecat_mailbox.coe.sdoidx"),
              UnorderedElementsAre("0x1008", "0x100a", "0x1600", "0x1601", "0x1602", "0x1610", "0x1611", "0x1620",
                                   "0x1621", "0x1622", "0x1623", "0x1a00", "0x1a01", "0x1a02", "0x1a03", "0x1a08",
                                   "0x1a09", "0x1a0a", "0x1a10", "0x1a11", "0x1a20", "0x1a21", "0x1a22", "0x1a23",
                                   "0x1c12", "0x1c13", "0x1c32", "0x1c33"));
  EXPECT_THAT(values("ecat_mailbox.coe.abortcode", "ecat_mailbox.coe.abortcode"), UnorderedElementsAre("0x06020000"));
  EXPECT_THAT(values("ecat_mailbox.coe.abortcode", "ecat_mailbox.coe.sdoidx"), UnorderedElementsAre("0x1a11"));
}

TEST_F(EthercatSeenByTshark, LongObjectsComeInSegmentsAndEmergenciesAreSeen) {
  EXPECT_THAT(tshark(file, "-Y 'ecat_mailbox.coe.sdoscsus'"), Not(IsEmpty()));
  EXPECT_THAT(tshark(file, "-Y 'ecat_mailbox.coe.type == 1'"), Not(IsEmpty()));
}

}  // namespace
}  // namespace meca::ethercat::test
