// The objects of a Meca500, by firmware. What they have to be: the vendor's ESI 9.3.3 and 10.2.1, and a real robot that
// was read after it had been switched on.
#include "tests/unit/ethercat/device_coe_rig.hpp"
#include "transports/ethercat/pdo_objects.hpp"

namespace meca::ethercat::device_test {
namespace {

TEST(DeviceDictionary, SaysWhoTheRobotIs) {
  CoeRig robot;
  EXPECT_EQ(robot.upload(0x1000), "89 13 00 00");
  EXPECT_EQ(robot.upload(0x1001), "00");
  EXPECT_EQ(robot.upload(0x1008), "4D 65 63 61 35 30 30");  // Meca500
  EXPECT_EQ(robot.upload(0x1009), "33");
  EXPECT_EQ(robot.upload(0x100A), "31 30 2E 32 2E 31 2E 38 31 32 30");  // 10.2.1.8120
  EXPECT_EQ(robot.upload(0x1018, 0), "04");
  EXPECT_EQ(robot.upload(0x1018, 1), "E1 AD EC 00");
  EXPECT_EQ(robot.upload(0x1018, 2), "00 D5 04 00");
  EXPECT_EQ(robot.upload(0x1018, 3), "01 00 00 00");
}

TEST(DeviceDictionary, HasTheSynchronizationOfTheEsi) {
  CoeRig robot;
  EXPECT_EQ(robot.upload(0x10F1, 1), "01 00 00 00");
  EXPECT_EQ(robot.upload(0x10F1, 2), "04 00");
  EXPECT_EQ(robot.upload(0x1C32, 0), "20");
  EXPECT_EQ(robot.upload(0x1C32, 1), "01 00");
  EXPECT_EQ(robot.upload(0x1C32, 3), "abort 06090011");
  EXPECT_EQ(robot.upload(0x1C32, 4), "07 80");
  EXPECT_EQ(robot.upload(0x1C32, 5), "40 42 0F 00");
  EXPECT_EQ(robot.upload(0x1C32, 32), "00");
  EXPECT_EQ(robot.upload(0x1C33, 1), "22 00");
}

TEST(DeviceDictionary, HasSyncManagerTypesAndTheOldOrderOnRequest) {
  EXPECT_EQ(CoeRig().upload(0x1C00, 0, true), "04 00 01 02 03 04");
  DeviceSettings old = meca500();
  old.old_sync_manager_types = true;
  EXPECT_EQ(CoeRig(old).upload(0x1C00, 0, true), "04 00 02 01 03 04");
}

TEST(DeviceDictionary, HasCountsWithoutEntriesAfterPowerOn) {
  CoeRig robot(meca500(Layout::kFirmware9));
  EXPECT_EQ(robot.upload(0x1C12, 0), "09");
  EXPECT_EQ(robot.upload(0x1C12, 1), "00 00");
  EXPECT_EQ(robot.upload(0x1C13, 0), "0B");
  EXPECT_EQ(robot.upload(0x0000, 0), "abort 06020000");
  EXPECT_FALSE(robot.objects.assigned(kRxPdoAssignment, rx_assignment()));
}

TEST(DeviceDictionary, HasTheAssignmentOfTheEsiWhereItIsAskedFor) {
  for (const auto& [layout, rx, tx] :
       {std::tuple{Layout::kFirmware9, "09 00 00 16 01 16 02 16 10 16 11 16 20 16 21 16 22 16 23 16",
                   "0C 00 00 1A 01 1A 02 1A 03 1A 08 1A 09 1A 0A 1A 10 1A 20 1A 21 1A 22 1A 23 1A"},
        std::tuple{Layout::kFirmware10, "09 00 00 16 01 16 02 16 10 16 11 16 20 16 21 16 22 16 23 16",
                   "0D 00 00 1A 01 1A 02 1A 03 1A 08 1A 09 1A 0A 1A 10 1A 11 1A 20 1A 21 1A 22 1A 23 1A"}}) {
    DeviceSettings settings = meca500(layout);
    settings.assigned = true;
    CoeRig robot(settings);
    EXPECT_EQ(robot.upload(0x1C12, 0, true), rx);
    EXPECT_EQ(robot.upload(0x1C13, 0, true), tx);
  }
}

TEST(DeviceDictionary, MapsWhatTheEsiMaps) {
  CoeRig nine(meca500(Layout::kFirmware9)), ten;
  EXPECT_EQ(nine.upload(0x1600, 0), "07");
  EXPECT_EQ(nine.upload(0x1600, 7), "1A 00 00 00");
  EXPECT_EQ(ten.upload(0x1600, 0), "08");
  EXPECT_EQ(ten.upload(0x1600, 7), "01 07 00 72");
  EXPECT_EQ(ten.upload(0x1600, 8), "19 00 00 00");
  EXPECT_EQ(ten.upload(0x1602, 1), "20 00 05 73");
  EXPECT_EQ(nine.upload(0x1A10, 0), "06");
  EXPECT_EQ(ten.upload(0x1A10, 0), "03");
  EXPECT_EQ(nine.upload(0x1A11, 0), "abort 06020000");
  EXPECT_EQ(ten.upload(0x1A11, 0), "1E");
  EXPECT_EQ(ten.upload(0x1A11, 0, true).size(), 3 * 122u - 1);
}

TEST(DeviceDictionary, ShowsLiveInputs) {
  CoeRig robot;
  robot.objects.input[0] = std::byte{0x06};  // Activated, Homed
  robot.objects.input[2] = std::byte{0xEA};  // ErrorCode
  robot.objects.input[3] = std::byte{0x03};
  robot.objects.input[65] = std::byte{0xFF};  // Elbow
  EXPECT_EQ(robot.upload(0x6010, 0), "0A");
  EXPECT_EQ(robot.upload(0x6010, 1), "EA 03");
  EXPECT_EQ(robot.upload(0x6010, 2), "00");
  EXPECT_EQ(robot.upload(0x6010, 3), "01");
  EXPECT_EQ(robot.upload(0x6010, 4), "01");
  EXPECT_EQ(robot.upload(0x6046, 2), "FF");
  // Complete Access packs bits: the count in 16 bits, the error, then nine BOOLs.
  EXPECT_EQ(robot.upload(0x6010, 0, true), "0A 00 EA 03 06 00");
  EXPECT_EQ(robot.upload(0x6010, 1, true), "EA 03 06 00");
}

TEST(DeviceDictionary, HasTheCheckpointsOfEachFirmware) {
  EXPECT_EQ(CoeRig(meca500(Layout::kFirmware9)).upload(0x6015, 0), "0B");
  EXPECT_EQ(CoeRig(meca500(Layout::kFirmware10)).upload(0x6015, 0), "0A");
  EXPECT_EQ(CoeRig(meca500(Layout::kFirmware10)).upload(0x6015, 1), "00 00 00 00");
  EXPECT_EQ(CoeRig(meca500(Layout::kFirmware11)).upload(0x6015, 0), "0B");
  EXPECT_EQ(CoeRig(meca500(Layout::kFirmware11)).upload(0x6015, 1), "00 00");
}

TEST(DeviceDictionary, LeavesOutWhatOnlyOtherRobotsHave) {
  CoeRig robot;
  EXPECT_EQ(robot.upload(0x6065, 2), "00");              // EStop
  EXPECT_EQ(robot.upload(0x6065, 3), "abort 06090011");  // PStop1
  EXPECT_EQ(robot.upload(0x6065, 0, true), "19 00 00 00");
}

TEST(DeviceDictionary, TakesOutputsBySdo) {
  CoeRig robot;
  EXPECT_EQ(robot.download(0x7420, 1, "28 00 00 00"), "ok");
  EXPECT_EQ(robot.upload(0x7420, 1), "28 00 00 00");
  EXPECT_EQ(robot.objects.output[44], std::byte{0x28});
  EXPECT_EQ(robot.download(0x7200, 2, "01"), "ok");
  EXPECT_EQ(robot.objects.output[0], std::byte{0x02});
  EXPECT_EQ(robot.download(0x7200, 2, "02"), "abort 06090030");
}

TEST(DeviceDictionary, RefusesWhatCannotBeWritten) {
  CoeRig robot;
  EXPECT_EQ(robot.download(0x1018, 1, "00 00 00 00"), "abort 06010002");
  EXPECT_EQ(robot.download(0x6010, 2, "01"), "abort 06010002");
  EXPECT_EQ(robot.download(0x1600, 1, "01 01 00 72"), "abort 06010002");
  EXPECT_EQ(robot.download(0x5FFF, 0, "00"), "abort 06020000");
  EXPECT_EQ(robot.download(0x8000, 3, "01"), "abort 06090011");
  EXPECT_EQ(robot.download(0x8000, 1, "03"), "abort 06090030");
  EXPECT_EQ(robot.download(0x10F1, 2, "04"), "abort 06070013");
  EXPECT_EQ(robot.download(0x10F1, 2, "04 00 00 00"), "abort 06070012");
  EXPECT_EQ(robot.download(0x10F1, 2, "05 00"), "ok");
  EXPECT_EQ(robot.upload(0x10F1, 2), "05 00");
}

TEST(DeviceDictionary, WritesARecordAtOnceOrNotAtAll) {
  CoeRig robot;
  EXPECT_EQ(robot.download(0x8000, 0, "02 00 02 02", true), "ok");
  EXPECT_EQ(robot.upload(0x8000, 0, true), "02 00 02 02");
  EXPECT_EQ(robot.download(0x8000, 1, "01 01", true), "ok");
  EXPECT_EQ(robot.download(0x8000, 0, "02 00 02 03", true), "abort 06090030");
  EXPECT_EQ(robot.download(0x8000, 0, "02 00 02", true), "abort 06070010");
  EXPECT_EQ(robot.download(0x1018, 0, "04 00", true), "abort 06010002");
  EXPECT_EQ(robot.upload(0x8000, 0, true), "02 00 01 01");
}

TEST(DeviceDictionary, HasNoCompleteAccessForVariablesAndMiddles) {
  CoeRig robot;
  EXPECT_EQ(robot.upload(0x1008, 0, true), "abort 06010004");
  EXPECT_EQ(robot.upload(0x1018, 2, true), "abort 06010004");
  EXPECT_EQ(robot.download(0x7400, 0, "00 00 00 00", true), "abort 06010004");
}

TEST(DeviceAssignment, IsWrittenWhileItsCountIsZero) {
  CoeRig robot;
  EXPECT_EQ(robot.download(0x1C12, 1, "00 16"), "abort 06010003");
  EXPECT_EQ(robot.download(0x1C12, 0, "00"), "ok");
  std::uint8_t sub = 0;
  for (const char* pdo : {"00 16", "01 16", "02 16", "10 16", "11 16", "20 16", "21 16", "22 16", "23 16"}) {
    EXPECT_EQ(robot.download(0x1C12, ++sub, pdo), "ok");
  }
  EXPECT_FALSE(robot.objects.assigned(kRxPdoAssignment, rx_assignment()));
  EXPECT_EQ(robot.download(0x1C12, 0, "09"), "ok");
  EXPECT_TRUE(robot.objects.assigned(kRxPdoAssignment, rx_assignment()));
  EXPECT_EQ(robot.download(0x1C12, 0, "08"), "abort 06010003");
}

TEST(DeviceAssignment, IsWrittenByCompleteAccess) {
  CoeRig robot;
  const char* all = "09 00 00 16 01 16 02 16 10 16 11 16 20 16 21 16 22 16 23 16";
  EXPECT_EQ(robot.download(0x1C12, 0, all, true), "ok");
  EXPECT_TRUE(robot.objects.assigned(kRxPdoAssignment, rx_assignment()));
  EXPECT_EQ(robot.upload(0x1C12, 0, true), all);
  EXPECT_EQ(robot.download(0x1C12, 0, "01 00 01 16", true), "ok");
  EXPECT_EQ(robot.upload(0x1C12, 0, true), "01 00 01 16");
  EXPECT_FALSE(robot.objects.assigned(kRxPdoAssignment, rx_assignment()));
}

TEST(DeviceAssignment, TakesOnlyPdosOfItsDirectionAndNotTooMany) {
  CoeRig robot;
  ASSERT_EQ(robot.download(0x1C12, 0, "00"), "ok");
  EXPECT_EQ(robot.download(0x1C12, 1, "00 1A"), "abort 06040041");
  EXPECT_EQ(robot.download(0x1C12, 1, "03 16"), "abort 06040041");
  EXPECT_EQ(robot.download(0x1C12, 0, "01"), "abort 06040041");  // entry 1 is still 0
  EXPECT_EQ(robot.download(0x1C12, 0, "0A"), "abort 06040042");
  EXPECT_EQ(robot.download(0x1C12, 10, "00 16"), "abort 06090011");
  EXPECT_EQ(robot.download(0x1C12, 0, "02 00 00 16", true), "abort 06070013");
  EXPECT_EQ(robot.download(0x1C12, 0, "01 00 00 1A", true), "abort 06040041");
}

TEST(DeviceAssignment, IsWrittenInPreopOnly) {
  CoeRig robot;
  robot.state = AlState::kSafeop;
  EXPECT_EQ(robot.download(0x1C12, 0, "00"), "abort 08000022");
  EXPECT_EQ(robot.download(0x1C12, 0, "00 00", true), "abort 08000022");
  EXPECT_EQ(robot.upload(0x1C12, 0), "09");
  EXPECT_EQ(robot.download(0x1C32, 1, "02 00"), "abort 08000022");
}

TEST(DeviceAssignment, IsForgottenWithoutPower) {
  CoeRig robot;
  ASSERT_EQ(robot.download(0x1C12, 0, "01 00 01 16", true), "ok");
  robot.objects.reset();
  EXPECT_EQ(robot.upload(0x1C12, 0), "09");
  EXPECT_EQ(robot.upload(0x1C12, 1), "00 00");
}

}  // namespace
}  // namespace meca::ethercat::device_test
