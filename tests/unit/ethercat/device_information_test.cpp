// SDO information of the device: CoE header, opcode (bit 7: more follows), reserved, fragments left, what was asked
// for.
#include "tests/unit/ethercat/device_coe_rig.hpp"

namespace meca::ethercat::device_test {
namespace {

TEST(DeviceInformation, CountsItsObjects) {
  CoeRig robot;
  // All; mappable outputs; mappable inputs; kept without power; settings.
  EXPECT_EQ(robot.ask("00 80 01 00 00 00 00 00"), "00 80 02 00 00 00 00 00 3E 00 0A 00 0F 00 01 00 05 00");
}

TEST(DeviceInformation, ListsAllObjectsInFragments) {
  CoeRig robot;
  const std::string first = robot.ask("00 80 01 00 00 00 01 00");
  EXPECT_THAT(first, testing::StartsWith("00 80 82 00 01 00 01 00 00 10 01 10 08 10 09 10 0A 10 18 10 F1 10 F8 10"));
  EXPECT_EQ(first.size(), 3 * (6 + 112u) - 1);
  EXPECT_EQ(robot.next(), "00 80 02 00 00 00 21 74 22 74 23 74 00 80 00 A0 00 AF FF AF");
  EXPECT_EQ(robot.next(), "");
}

TEST(DeviceInformation, ListsWhatCanBeMapped) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 80 01 00 00 00 02 00"),
            "00 80 02 00 00 00 02 00 00 72 05 73 06 73 10 73 00 74 10 74 20 74 21 74 22 74 23 74");
  EXPECT_EQ(
      robot.ask("00 80 01 00 00 00 03 00"),
      "00 80 02 00 00 00 03 00 F8 10 10 60 15 60 30 60 31 60 46 60 50 60 51 60 60 60 65 60 70 60 71 60 72 60 73 60 "
      "FF AF");
}

TEST(DeviceInformation, ListsWhatIsKeptAndWhatIsSet) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 80 01 00 00 00 04 00"), "00 80 02 00 00 00 04 00 00 80");
  EXPECT_EQ(robot.ask("00 80 01 00 00 00 05 00"), "00 80 02 00 00 00 05 00 F1 10 12 1C 13 1C 32 1C 33 1C");
}

TEST(DeviceInformation, HasNoOtherLists) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 80 01 00 00 00 06 00"), "00 80 07 00 00 00 00 00 01 06");
}

TEST(DeviceInformation, StopsAListWhenSomethingElseIsAsked) {
  CoeRig robot;
  robot.ask("00 80 01 00 00 00 01 00");
  robot.ask("00 20 40 01 10 00 00 00 00 00");
  EXPECT_EQ(robot.next(), "");
}

TEST(DeviceInformation, DescribesObjects) {
  CoeRig robot;
  // Index, data type, highest subindex, code (7 variable, 8 array, 9 record), name.
  EXPECT_EQ(robot.ask("00 80 03 00 00 00 08 10"),
            "00 80 04 00 00 00 08 10 09 00 00 07 44 65 76 69 63 65 20 6E 61 6D 65");
  EXPECT_EQ(robot.ask("00 80 03 00 00 00 12 1C"), "00 80 04 00 00 00 12 1C 06 00 09 08 53 4D 32");
  EXPECT_EQ(robot.ask("00 80 03 00 00 00 18 10"), "00 80 04 00 00 00 18 10 23 00 04 09 49 64 65 6E 74 69 74 79");
  EXPECT_EQ(robot.ask("00 80 03 00 00 00 FF 5F"), "00 80 07 00 00 00 00 00 02 06");
}

TEST(DeviceInformation, DescribesEntries) {
  CoeRig robot;
  // Index, subindex, value information, data type, bits, access, name.
  EXPECT_EQ(robot.ask("00 80 05 00 00 00 18 10 01 00"),
            "00 80 06 00 00 00 18 10 01 00 07 00 20 00 07 00 56 65 6E 64 6F 72 20 49 44");
  EXPECT_EQ(robot.ask("00 80 05 00 00 00 10 60 02 FF"), "00 80 06 00 00 00 10 60 02 00 01 00 01 00 87 00 42 75 73 79");
  EXPECT_EQ(robot.ask("00 80 05 00 00 00 12 1C 00 00"),
            "00 80 06 00 00 00 12 1C 00 00 05 00 08 00 0F 02 53 75 62 49 6E 64 65 78 20 30 30 30");
  EXPECT_EQ(robot.ask("00 80 05 00 00 00 18 10 05 00"), "00 80 07 00 00 00 11 00 09 06");
}

TEST(DeviceInformation, RefusesUnknownServices) {
  CoeRig robot;
  EXPECT_EQ(robot.ask("00 80 09 00 00 00 00 00"), "00 80 07 00 00 00 01 00 04 05");
}

}  // namespace
}  // namespace meca::ethercat::device_test
