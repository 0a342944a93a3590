#include "cli/decode.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "cli/json.hpp"
#include "cli/plan.hpp"

namespace meca::cli {
namespace {

using ::testing::HasSubstr;

constexpr image::Format kLittle11{};

// From an EtherCAT capture of a real robot with 9.x firmware (linuxcnc_meca500, public; values as decoded in its log):
// activated, homed, brakes bit set, queue empty, EOM; then the bytes the capture does not have are 0.
std::string captured_input() {
  std::string hex =
      "16 00 00 00"                           // 0x0016: Activated, Homed, BrakesEngaged; no error
      "00 00 00 00 00 00 C8 32"               // no checkpoint, MoveID 0, FIFOSpace 0x32C8 = 13000
      "04 00 00 00"                           // EOM; no program
      "5F 29 3B BF 7A 36 9B BF 79 E9 A6 3D"   // joints -0.7311, -1.2126, 0.0815 deg
      "D8 81 93 BF FE 43 9A BF C9 76 86 BF"   // -1.1524, -1.2052, -1.0505 deg
      "EE 4B 3A 43 5B 42 16 C0 8D 97 9C 43"   // pose 186.2966, -2.3478, 313.184 mm
      "A6 9B 86 41 35 1E AF 42 1D 5A 98 C1";  // 16.826, 87.559, -19.044 deg
  hex.append(static_cast<std::size_t>(252 - 64) * 2, '0');
  return hex;
}

std::string message(const std::function<void()>& action) {
  try {
    action();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "(no error)";
}

class TemporaryFile {
 public:
  // Named after the process: ctest runs tests of this program side by side.
  explicit TemporaryFile(const std::string& content)
      : path_(testing::TempDir() + "meca_ctl_decode_test." + std::to_string(getpid())) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

TEST(ParseHex, TakesDigitsInEverySpelling) {
  const std::vector<std::byte> expected{std::byte{0x00}, std::byte{0xAB}, std::byte{0x10}};
  EXPECT_EQ(parse_hex("00ab10"), expected);
  EXPECT_EQ(parse_hex("00 AB 10\n"), expected);
  EXPECT_EQ(parse_hex("0x00 0xab 0X10"), expected);
  EXPECT_EQ(parse_hex("0x00,0xAB,0x10"), expected);
  EXPECT_EQ(parse_hex("00:ab:10"), expected);
  EXPECT_EQ(parse_hex(" \r\n\t00\nab10"), expected);
  EXPECT_TRUE(parse_hex("").empty());
}

TEST(ParseHex, NamesThePlaceOfTheMistake) {
  EXPECT_EQ(message([] { parse_hex("00 1g"); }), "character 5, 'g', is not a hex digit");
  EXPECT_EQ(message([] { parse_hex("0 0"); }), "character 2, ' ', stands in the middle of a byte");
  EXPECT_EQ(message([] { parse_hex("00 a"); }), "the last byte, number 2, has only one digit");
  EXPECT_EQ(message([] { parse_hex("00\x01"); }), "character 3, the byte 1, is not a hex digit");
}

TEST(ParseFirmware, FindsTheGeneration) {
  EXPECT_EQ(parse_firmware("11.3"), image::Layout::kFirmware11);
  EXPECT_EQ(parse_firmware("11.3.3.12637"), image::Layout::kFirmware11);
  EXPECT_EQ(parse_firmware("10.2.1"), image::Layout::kFirmware10);
  EXPECT_EQ(parse_firmware("9"), image::Layout::kFirmware9);
}

TEST(ParseFirmware, RefusesWhatHasNoLayoutHere) {
  EXPECT_THAT(message([] { parse_firmware("8.3"); }), HasSubstr("'8.3' has another, smaller image"));
  EXPECT_THAT(message([] { parse_firmware("12.0"); }), HasSubstr("'12.0' is not known here"));
  EXPECT_THAT(message([] { parse_firmware("110"); }), HasSubstr("use 9.x, 10.x or 11.x"));
  EXPECT_THAT(message([] { parse_firmware("11x"); }), HasSubstr("'11x'"));
  EXPECT_THAT(message([] { parse_firmware(""); }), HasSubstr("--firmware"));
}

TEST(Decode, NamesTheFieldsOfACapturedInputImage) {
  const auto bytes = parse_hex(captured_input());
  const auto json = Json::parse(render_image(bytes, {image::Layout::kFirmware9, std::endian::little}, true));
  EXPECT_EQ(json["image"], "input");
  EXPECT_EQ(json["layout"], "9.x");
  const auto& status = json["sections"]["RobotStatus"];
  EXPECT_EQ(status["Activated"]["value"], true);
  EXPECT_EQ(status["Homed"]["value"], true);
  EXPECT_EQ(status["BrakesEngaged"]["value"], true);
  EXPECT_EQ(status["SimActivated"]["value"], false);
  const auto& motion = json["sections"]["MotionStatus"];
  EXPECT_EQ(motion["FIFOSpace"]["value"], 13000);
  EXPECT_EQ(motion["EOM"]["value"], true);
  EXPECT_EQ(motion["EOB"]["value"], false);
  const auto& joints = json["sections"]["TargetJointSet"];
  ASSERT_EQ(joints.size(), 6u);
  EXPECT_EQ(joints.begin()->at("value"), -0.7311);
  EXPECT_EQ(joints.begin()->at("unit"), "deg");
  const auto& pose = json["sections"]["TargetEndEffectorPose"];
  ASSERT_EQ(pose.size(), 6u);
  EXPECT_EQ(pose.begin()->at("value"), 186.2966);
  EXPECT_EQ(pose.begin()->at("unit"), "mm");
}

TEST(Decode, OfFirmware9NeverClaimsThatNoStopIsActive) {
  const auto bytes = parse_hex(captured_input());
  const auto json = Json::parse(render_image(bytes, {image::Layout::kFirmware9, std::endian::little}, true));
  const auto& safety = json["sections"]["SafetyStatus"];
  EXPECT_EQ(safety.size(), 1u);
  EXPECT_EQ(safety["known"]["value"], false);
}

TEST(Decode, ShowsSectionsNamesUnitsAndSizeAsText) {
  const auto text = render_image(parse_hex(captured_input()), {image::Layout::kFirmware9, std::endian::little}, false);
  EXPECT_THAT(text, HasSubstr("Input image (robot -> host), 252 bytes, firmware 9.x, little-endian"));
  EXPECT_THAT(text, HasSubstr("\nMotionStatus\n"));
  EXPECT_THAT(text, HasSubstr("\nTargetJointSet\n"));
  EXPECT_THAT(text, HasSubstr(" deg\n"));
}

// Output of the same capture: SetPoint, MoveJointsVel, dynamic data 40, 42, 43, automatic.
TEST(Decode, NamesTheFieldsOfACapturedOutputImage) {
  std::string hex = "00000000 0000 0100 15000000";
  hex += std::string(6 * 8, '0') + std::string(2 * 8, '0');  // six arguments, HostTime, brakes
  hex += "28000000 2A000000 2B000000 00000000";
  const auto json = Json::parse(render_image(parse_hex(hex), kLittle11, true));
  EXPECT_EQ(json["image"], "output");
  EXPECT_EQ(json["sections"]["MotionControl"]["SetPoint"]["value"], true);
  const auto& command = json["sections"]["MotionCommand"];
  EXPECT_EQ(command["MotionCommandID"]["value"], 21);
  EXPECT_EQ(command["MotionCommandID"]["hint"], "MoveJointsVel");
  EXPECT_EQ(command["w1"]["unit"], "deg/s");
}

TEST(Decode, ReadsBigEndianWhenTold) {
  std::string hex = "00000000 0000 0100 00000015" + std::string(48 * 2, '0');
  const auto json = Json::parse(render_image(parse_hex(hex), {image::Layout::kFirmware11, std::endian::big}, true));
  EXPECT_EQ(json["byte_order"], "big");
  EXPECT_EQ(json["sections"]["MotionCommand"]["MotionCommandID"]["value"], 21);
}

TEST(Decode, RefusesOtherSizesAndNamesBoth) {
  EXPECT_EQ(message([] { render_image(std::vector<std::byte>(61), kLittle11, false); }),
            "decode: 61 bytes came; an input image (robot -> host) has 252, an output image (host -> robot) 60");
}

TEST(Decode, ShowsANumberThatIsNoneAsNullInJson) {
  // Joint 1 at byte 16 is a quiet NaN.
  std::string hex = std::string(32, '0') + "0000C07F" + std::string((252 - 20) * 2, '0');
  const auto json = Json::parse(render_image(parse_hex(hex), kLittle11, true));
  const auto& joints = json["sections"]["TargetJointSet"];
  EXPECT_TRUE(joints.begin()->at("value").is_null());
}

TEST(ReadImage, TakesHexFromTheCommandLine) { EXPECT_EQ(read_image("00ff").size(), 2u); }

TEST(ReadImage, TakesAFileOfRawBytes) {
  const TemporaryFile file(std::string(252, '\x81'));
  const auto bytes = read_image(file.path());
  ASSERT_EQ(bytes.size(), 252u);
  EXPECT_EQ(bytes.front(), std::byte{0x81});
}

TEST(ReadImage, TakesAFileOfRawZeroes) {
  const TemporaryFile file(std::string(60, '\0'));
  EXPECT_EQ(read_image(file.path()), std::vector<std::byte>(60));
}

TEST(ReadImage, TakesAFileOfHexDigits) {
  const TemporaryFile file(captured_input() + "\n");
  EXPECT_EQ(read_image(file.path()).size(), 252u);
}

TEST(ReadImage, SaysWhatAFileShouldHaveBeen) {
  const TemporaryFile file("not an image");
  EXPECT_THAT(message([&] { read_image(file.path()); }),
              HasSubstr("has 12 bytes: neither 60 or 252 raw bytes, nor hex"));
  EXPECT_THAT(message([] { read_image("no_such_file.bin"); }),
              HasSubstr("no file of that name, and not hex: character 1"));
}

}  // namespace
}  // namespace meca::cli
