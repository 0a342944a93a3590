#include "cli/scan_ethercat.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace meca::cli {
namespace {

using namespace std::chrono_literals;
using ethercat::DcSupport;
using ethercat::ScannedDevice;
using ethercat::SiiIdentity;
using ::testing::HasSubstr;
using ::testing::Not;

ScannedDevice robot() {
  ScannedDevice d;
  d.answered = true;
  d.station_address = 0x1001;
  d.al_status = 2;
  d.dc = DcSupport::k64Bit;
  for (unsigned p = 0; p < 2; ++p) d.ports[p] = {.exists = true, .link = true, .communication = true};
  d.identity = SiiIdentity{.vendor = ethercat::kMecademicVendor,
                           .product = ethercat::kMeca500Product,
                           .revision = 1,
                           .serial = 4711,
                           .checksum_right = true};
  return d;
}

ScannedDevice coupler() {
  ScannedDevice d = robot();
  d.position = 1;
  d.station_address = 0;
  d.alias = d.identity->alias = 7;
  d.al_status = 0x14;
  d.al_code = 0x001B;
  d.ports[1] = {.exists = true, .loop_closed = true, .invalid_frames = 3, .rx_errors = 255, .lost_links = 1};
  d.processing_errors = 2;
  d.dc = DcSupport::kNone;
  d.identity->vendor = 2;
  d.identity->product = 0x044C2C52;
  d.identity->serial = 0;
  return d;
}

TEST(ChainText, IsATableInTheOrderOfTheCableAndSaysWhatIsWrong) {
  EXPECT_EQ(
      chain_text({"eth1", {robot(), coupler()}, false, ""}),
      "POSITION  ADDRESS  ALIAS  NAME     VENDOR      PRODUCT     REVISION    SERIAL  STATE           LINKS  ERRORS  "
      "DC\n"
      "0         0x1001   -      Meca500  0x00ecade1  0x0004d500  0x00000001  4711    PREOP           0 1    0       "
      "64 "
      "bit\n"
      "1         -        7      -        0x00000002  0x044c2c52  0x00000001  0       SAFEOP + error  0      261     "
      "no\n"
      "eth1: 2 devices, 1 Meca500\n"
      "position 1: SAFEOP with AL status code 0x001b: sync manager watchdog: no outputs arrived in time; the master "
      "stopped, is late, or the cable was pulled\n"
      "position 1, port 1: 3 invalid frames, 255 or more receive errors, 1 lost link\n"
      "position 1: 2 frames it could not process\n"
      "position 1 is in SAFEOP: a master runs this chain; a second one (a bridge, a PLC) would disturb it\n");
  EXPECT_THAT(chain_text({"eth1", {coupler()}, false, ""}), HasSubstr("eth1: 1 device, no Meca500\n"));
}

TEST(ChainText, SaysWhyADeviceIsNotNamedAndWhatItLooksLike) {
  ScannedDevice d = robot();
  d.identity.reset();
  d.identity_trouble = "its SII is busy";
  EXPECT_THAT(chain_text({"eth1", {d}, false, ""}), HasSubstr("position 0: who it is was not read: its SII is busy\n"));
  d.process_data_of_meca500 = true;
  const auto text = chain_text({"eth1", {d}, false, ""});
  EXPECT_THAT(text, HasSubstr("0x1001   -      Meca500?  -"));
  EXPECT_THAT(text, HasSubstr("perhaps a Meca500\n"));
  EXPECT_THAT(text, Not(HasSubstr("no Meca500")));
  EXPECT_THAT(text, HasSubstr("its SII is busy; its process data is laid out as that of a Meca500\n"));
}

TEST(ChainText, NamesAChecksumThatIsWrongAndADeviceThatDoesNotAnswer) {
  ScannedDevice wrong = robot();
  wrong.identity->checksum_right = false;
  ScannedDevice mute;
  mute.position = 1;
  const auto text = chain_text({"eth1", {wrong, mute}, false, ""});
  EXPECT_THAT(text, HasSubstr("position 0: the checksum of its SII is wrong"));
  EXPECT_THAT(text, HasSubstr("1         does not answer"));
  EXPECT_THAT(text, HasSubstr("position 1 was counted and does not answer alone"));
}

TEST(ChainText, SaysThatAnAliasWasChangedAndIsNotInUseYet) {
  ScannedDevice d = robot();
  d.identity->alias = 777;
  EXPECT_THAT(chain_text({"eth1", {d}, false, ""}),
              HasSubstr("position 0: its SII says alias 777, it uses 0 until its power is switched off and on\n"));
}

TEST(ChainText, SaysWhoElseWorksOnTheCableAndHowItIsLaid) {
  EXPECT_THAT(chain_text({"eth1", {robot()}, true, ""}), HasSubstr("frames of another master pass on eth1\n"));
  EXPECT_THAT(chain_text({"eth1", {robot()}, false, "eth2"}),
              HasSubstr("frames sent on eth1 come back on eth2: the cables make a ring\n"));
  EXPECT_THAT(chain_text({"eth1", {robot()}, false, ""}), Not(HasSubstr("master")));
}

TEST(ChainJson, HasEverythingThatWasRead) {
  const auto json = to_json({"eth1", {}, true, ""}, coupler());
  EXPECT_EQ(json["interface"], "eth1");
  EXPECT_EQ(json["position"], 1);
  EXPECT_EQ(json["station_address"], 0);
  EXPECT_EQ(json["alias"], 7);
  EXPECT_EQ(json["meca500"], false);
  EXPECT_EQ(json["product"], 0x044C2C52);
  EXPECT_EQ(json["sii_checksum_right"], true);
  EXPECT_EQ(json["al_state"], "SAFEOP");
  EXPECT_EQ(json["al_error"], true);
  EXPECT_EQ(json["al_status_code"], 27);
  EXPECT_THAT(json["al_status_code_text"], HasSubstr("watchdog"));
  EXPECT_EQ(json["under_a_master"], true);
  EXPECT_EQ(json["frames_of_others"], true);
  EXPECT_EQ(json["dc"], "no");
  EXPECT_EQ(json["ports"].size(), 2u);
  EXPECT_EQ(json["ports"][1]["port"], 1);
  EXPECT_EQ(json["ports"][1]["link"], false);
  EXPECT_EQ(json["ports"][1]["rx_errors"], 255);
  EXPECT_EQ(json["processing_errors"], 2);

  const auto robots = to_json({"eth1", {}, false, ""}, robot());
  EXPECT_EQ(robots["meca500"], true);
  EXPECT_EQ(robots["serial"], 4711);
  EXPECT_FALSE(robots.contains("al_status_code_text"));
}

TEST(ChainJson, SaysWhatWasNotRead) {
  ScannedDevice d = robot();
  d.identity.reset();
  d.identity_trouble = "its SII is busy";
  const auto json = to_json({"eth1", {}, false, ""}, d);
  EXPECT_EQ(json["identity_trouble"], "its SII is busy");
  EXPECT_FALSE(json.contains("vendor"));
  EXPECT_EQ(to_json({"eth1", {}, false, ""}, ScannedDevice{})["answered"], false);
}

TEST(NobodyInChain, SaysWhatToCheck) {
  const auto silence = nobody_in_chain("eth1", 1s, false);
  EXPECT_THAT(silence, HasSubstr("no EtherCAT device answered on eth1 within 1 s"));
  EXPECT_THAT(silence, HasSubstr("power"));
  EXPECT_THAT(silence, HasSubstr("no switch"));
  EXPECT_THAT(silence, HasSubstr("EtherCAT is enabled"));
  EXPECT_THAT(nobody_in_chain("eth1", 1s, true), HasSubstr("there is a loop"));
}

}  // namespace
}  // namespace meca::cli
