// SDO transfers of the device, byte by byte: CoE header (service in the upper 4 bits), command, index, subindex, data.
#include "tests/unit/ethercat/device_coe_rig.hpp"

namespace meca::ethercat::device_test {
namespace {

TEST(DeviceCoe, UploadsUpToFourBytesExpedited) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 20 40 09 10 00 00 00 00 00"), "00 30 4F 09 10 00 33 00 00 00");
  EXPECT_EQ(robot.ask("00 20 40 F1 10 02 00 00 00 00"), "00 30 4B F1 10 02 04 00 00 00");
  EXPECT_EQ(robot.ask("00 20 40 18 10 01 00 00 00 00"), "00 30 43 18 10 01 E1 AD EC 00");
}

TEST(DeviceCoe, UploadsMoreInTheSameMail) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 20 40 08 10 00 00 00 00 00"), "00 30 41 08 10 00 07 00 00 00 4D 65 63 61 35 30 30");
}

TEST(DeviceCoe, UploadsByCompleteAccess) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 20 50 00 1C 00 00 00 00 00"), "00 30 51 00 1C 00 06 00 00 00 04 00 01 02 03 04");
}

// 1A11h is the one object of a Meca500 that is longer than a mail: 122 bytes, 112 of them fit.
TEST(DeviceCoe, UploadsTheSafetyMappingInSegments) {
  CoeRig robot;
  const std::string first = robot.ask("00 20 50 11 1A 00 00 00 00 00");
  EXPECT_THAT(first, testing::StartsWith("00 30 51 11 1A 00 7A 00 00 00 1E 00 01 02 65 60"));
  EXPECT_EQ(first.size(), 3 * 122u - 1);
  // The other half of entry 28 (ResetReady), VMotorOn, 22 bits of nothing.
  EXPECT_EQ(robot.ask("00 20 60 00 00 00 00 00 00 00"), "00 30 01 65 60 01 19 65 60 16 00 00 00");
}

TEST(DeviceCoe, AlternatesTheToggleBitOfSegments) {
  DeviceSettings settings = meca500();
  settings.firmware = std::string(300, 'x');
  CoeRig robot(settings);
  EXPECT_THAT(robot.ask("00 20 40 0A 10 00 00 00 00 00"), testing::StartsWith("00 30 41 0A 10 00 2C 01 00 00 78"));
  const std::string second = robot.ask("00 20 60 00 00 00 00 00 00 00");
  EXPECT_THAT(second, testing::StartsWith("00 30 00 78"));
  EXPECT_EQ(second.size(), 3 * 122u - 1);
  const std::string third = robot.ask("00 20 70 00 00 00 00 00 00 00");
  EXPECT_THAT(third, testing::StartsWith("00 30 11 78"));  // 112 + 119 + 69
  EXPECT_EQ(third.size(), 3 * (3 + 69u) - 1);
  EXPECT_EQ(robot.ask("00 20 60 00 00 00 00 00 00 00"), "00 20 80 0A 10 00 01 00 04 05");
}

TEST(DeviceCoe, AbortsASegmentWithTheWrongToggleBit) {
  CoeRig robot;
  robot.ask("00 20 50 11 1A 00 00 00 00 00");
  EXPECT_EQ(robot.ask("00 20 70 00 00 00 00 00 00 00"), "00 20 80 11 1A 00 00 00 03 05");
  EXPECT_EQ(robot.ask("00 20 60 00 00 00 00 00 00 00"), "00 20 80 11 1A 00 01 00 04 05");
  EXPECT_EQ(robot.server.aborts(), 2u);
}

TEST(DeviceCoe, DownloadsUpToFourBytesExpedited) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 20 2F 12 1C 00 00 00 00 00"), "00 30 60 12 1C 00 00 00 00 00");
  EXPECT_EQ(robot.ask("00 20 2B 12 1C 01 00 16 00 00"), "00 30 60 12 1C 01 00 00 00 00");
  EXPECT_EQ(robot.ask("00 20 2F 12 1C 00 01 00 00 00"), "00 30 60 12 1C 00 00 00 00 00");
  EXPECT_EQ(robot.upload(0x1C12, 0, true), "01 00 00 16");
}

TEST(DeviceCoe, DownloadsMoreInTheSameMail) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 20 31 12 1C 00 06 00 00 00 02 00 01 16 02 16"), "00 30 70 12 1C 00 00 00 00 00");
  EXPECT_EQ(robot.upload(0x1C12, 0, true), "02 00 01 16 02 16");
}

TEST(DeviceCoe, DownloadsInSegments) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 20 31 12 1C 00 0C 00 00 00 05 00 00 16"), "00 30 70 12 1C 00 00 00 00 00");
  EXPECT_EQ(robot.upload(0x1C12, 0), "09") << "nothing is written before all of it is there";
  EXPECT_EQ(robot.ask("00 20 0A 01 16 00 00 00 00 00"), "00 30 20 00 00 00 00 00 00 00");
  EXPECT_EQ(robot.ask("00 20 13 02 16 10 16 11 16 00"), "00 30 30 00 00 00 00 00 00 00");
  EXPECT_EQ(robot.upload(0x1C12, 0, true), "05 00 00 16 01 16 02 16 10 16 11 16");
}

TEST(DeviceCoe, AbortsADownloadOfAnotherLengthThanSaid) {
  CoeRig robot;
  robot.ask("00 20 31 12 1C 00 0C 00 00 00 05 00 00 16");
  EXPECT_EQ(robot.ask("00 20 0B 01 16 00 00 00 00 00"), "00 20 80 12 1C 00 10 00 07 06") << "ends early";
  robot.ask("00 20 31 12 1C 00 06 00 00 00 05 00 00 16");
  EXPECT_EQ(robot.ask("00 20 01 01 16 02 16 03 16 04"), "00 20 80 12 1C 00 12 00 07 06") << "goes on";
  EXPECT_EQ(robot.ask("00 20 31 12 1C 00 01 02 00 00 05 00"), "00 20 80 12 1C 00 12 00 07 06") << "513 bytes";
  EXPECT_EQ(robot.upload(0x1C12, 0), "09");
}

TEST(DeviceCoe, SaysInAnAbortWhatIsWrong) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 20 40 FF 5F 00 00 00 00 00"), "00 20 80 FF 5F 00 00 00 02 06");
  EXPECT_EQ(robot.ask("00 20 40 18 10 09 00 00 00 00"), "00 20 80 18 10 09 11 00 09 06");
  EXPECT_EQ(robot.ask("00 20 23 18 10 01 00 00 00 00"), "00 20 80 18 10 01 02 00 01 06");
  EXPECT_EQ(robot.ask("00 20 50 08 10 00 00 00 00 00"), "00 20 80 08 10 00 04 00 01 06");
  EXPECT_EQ(robot.ask("00 20 E0 08 10 00 00 00 00 00"), "00 20 80 08 10 00 01 00 04 05");
  EXPECT_EQ(robot.server.aborts(), 5u);
}

TEST(DeviceCoe, ForgetsATransferWhenANewOneBeginsOrTheMasterAborts) {
  CoeRig robot;
  robot.ask("00 20 50 11 1A 00 00 00 00 00");
  EXPECT_EQ(robot.ask("00 20 80 11 1A 00 00 00 04 05"), "");
  EXPECT_EQ(robot.ask("00 20 60 00 00 00 00 00 00 00"), "00 20 80 11 1A 00 01 00 04 05");
  robot.ask("00 20 50 11 1A 00 00 00 00 00");
  EXPECT_EQ(robot.ask("00 20 40 01 10 00 00 00 00 00"), "00 30 4F 01 10 00 00 00 00 00");
  EXPECT_EQ(robot.ask("00 20 60 00 00 00 00 00 00 00"), "00 20 80 01 10 00 01 00 04 05");
}

TEST(DeviceCoe, AnswersWithAMailboxErrorWhatIsNoRequest) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00"), "error 6");
  EXPECT_EQ(robot.ask("00 20"), "error 6");
  EXPECT_EQ(robot.ask("00 20 40 08 10"), "error 6");
  EXPECT_EQ(robot.ask("00 80 01 00"), "error 6");
  EXPECT_EQ(robot.ask("00 30 4F 08 10 00 00 00 00 00"), "error 4");
  EXPECT_EQ(robot.ask("00 50 00 00 00 00 00 00 00 00"), "error 4");
}

}  // namespace
}  // namespace meca::ethercat::device_test
