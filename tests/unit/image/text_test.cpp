// An image as named rows.
#include "transports/image/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/unit/image/golden_images.hpp"
#include "tests/unit/image/support.hpp"
#include "transports/image/motion_commands.hpp"

namespace meca::image {
namespace {

using test::encoded;
using test::from_hex;
using test::kFormats;
using test::name_of;

constexpr Format kV9{Layout::kFirmware9}, kV11{Layout::kFirmware11};

FieldText row(const std::vector<FieldText>& rows, std::string_view section, std::string_view name) {
  const auto found =
      std::ranges::find_if(rows, [&](const FieldText& text) { return text.section == section && text.name == name; });
  return found == rows.end() ? FieldText{section, name, "", "no such row", ""} : *found;
}

bool has_section(const std::vector<FieldText>& rows, std::string_view section) {
  return std::ranges::find(rows, section, &FieldText::section) != rows.end();
}

TEST(ImageText, ShowsValuesWithUnits) {
  const auto rows = fields_of_inputs(from_hex<kInputSize>(golden::kInputs11Little), kV11);
  EXPECT_EQ(row(rows, "RobotStatus", "Activated").value, "true");
  EXPECT_EQ(row(rows, "RobotStatus", "Busy").value, "false");
  EXPECT_EQ(row(rows, "MotionStatus", "FIFOSpace").value, "13000");
  EXPECT_EQ(row(rows, "TargetConfiguration", "Turn").value, "-100");
  EXPECT_EQ(row(rows, "TargetJointSet", "J2"), (FieldText{"TargetJointSet", "J2", "deg", "-2.25", ""}));
  EXPECT_EQ(row(rows, "TargetEndEffectorPose", "z"), (FieldText{"TargetEndEffectorPose", "z", "mm", "308", ""}));
  EXPECT_EQ(row(rows, "SafetyStatus", "PStop2Resettable").value, "true");
  EXPECT_EQ(row(rows, "SafetyStatus", "OperationMode").value, "1");
}

TEST(ImageText, NamesDynamicValuesByTheirType) {
  const auto rows = fields_of_inputs(from_hex<kInputSize>(golden::kInputs11Little), kV11);
  EXPECT_EQ(row(rows, "DynamicData 0", "DynamicDataTypeID").hint, "joint position (actual)");
  EXPECT_EQ(row(rows, "DynamicData 0", "joint 6"), (FieldText{"DynamicData 0", "joint 6", "deg", "6", ""}));
  EXPECT_EQ(row(rows, "DynamicData 1", "build").value, "12637");
  EXPECT_EQ(row(rows, "DynamicData 1", "Value 5").value, "0") << "what the type does not name keeps its number";
  EXPECT_EQ(row(rows, "DynamicData 2", "wrist").value, "NaN") << "automatic";
  EXPECT_EQ(row(rows, "DynamicData 3", "value 1").value, "0.5");
}

TEST(ImageText, ShowsTheSerialNumberExactly) {
  Inputs inputs;
  inputs.dynamic_data[0] = {3, {4294967295.0F, std::bit_cast<float>(4294967295U)}};  // more bits than a REAL has
  const auto rows = fields_of_inputs(encoded(inputs, kV11), kV11);
  EXPECT_EQ(row(rows, "DynamicData 0", "serial number").value, "4294967295");
}

TEST(ImageText, ExplainsErrorCodes) {
  Inputs inputs;
  inputs.robot_status.error_code = 3006;
  const auto text = row(fields_of_inputs(encoded(inputs, kV11), kV11), "RobotStatus", "ErrorCode");
  EXPECT_EQ(text.value, "3006");
  EXPECT_TRUE(text.hint.starts_with("ERROR_DRIVE_COMM: ")) << text.hint;
  EXPECT_NE(text.hint.find("ResetError does not clear it"), std::string::npos) << text.hint;
  const auto hint_of = [&](std::uint16_t code) {
    inputs.robot_status.error_code = code;
    return row(fields_of_inputs(encoded(inputs, kV11), kV11), "RobotStatus", "ErrorCode").hint;
  };
  EXPECT_EQ(hint_of(0), "no error");
  EXPECT_EQ(hint_of(1007).find("ResetError does not"), std::string::npos);
  EXPECT_EQ(hint_of(4711), "a code that no document names");
}

TEST(ImageText, NamesArgumentsByTheirCommand) {
  Outputs outputs;
  outputs.motion_command = {kMoveLinVelWrf, {1, 2, 3, 4, 5, 6}};
  const auto rows = fields_of_outputs(encoded(outputs, kV11), kV11);
  EXPECT_EQ(row(rows, "MotionCommand", "MotionCommandID").hint, "MoveLinVelWrf");
  EXPECT_EQ(row(rows, "MotionCommand", "vx"), (FieldText{"MotionCommand", "vx", "mm/s", "1", ""}));
  EXPECT_EQ(row(rows, "MotionCommand", "wz"), (FieldText{"MotionCommand", "wz", "deg/s", "6", ""}));

  outputs.motion_command.command_id = kDelay;
  const auto delay = fields_of_outputs(encoded(outputs, kV11), kV11);
  EXPECT_EQ(row(delay, "MotionCommand", "t").unit, "s");
  EXPECT_EQ(row(delay, "MotionCommand", "Argument 2").value, "2") << "ignored by the robot, but it is in the image";
}

TEST(ImageText, ArgumentsThatAreVariablesHaveNoUnit) {
  Outputs outputs;
  outputs.motion_command = {kDelay, {10001}};
  outputs.motion_control.use_variables = true;
  const auto text = row(fields_of_outputs(encoded(outputs, kV11), kV11), "MotionCommand", "t");
  EXPECT_EQ(text, (FieldText{"MotionCommand", "t", "", "10001", "cyclic id of a variable"}));
}

TEST(ImageText, LeavesOutWhatTheLayoutDoesNotHave) {
  const auto v9 = fields_of_outputs(OutputBytes{}, kV9), v11 = fields_of_outputs(OutputBytes{}, kV11);
  EXPECT_EQ(row(v9, "MotionControl", "ResetPStop2").value, "false");
  EXPECT_EQ(row(v9, "MotionControl", "ResumeMotion").value, "no such row");
  EXPECT_EQ(row(v9, "RobotControl", "DisableEtherCAT").value, "no such row");
  EXPECT_EQ(row(v11, "MotionControl", "ResumeMotion").value, "false");
  EXPECT_EQ(row(v11, "MotionControl", "ResetPStop2").value, "no such row");
}

TEST(ImageText, Firmware9SaysThatSafetyIsUnknownAndNothingElseAboutIt) {
  const auto v9 = fields_of_inputs(InputBytes{}, kV9);
  EXPECT_EQ(std::ranges::count(v9, "SafetyStatus", &FieldText::section), 1);
  const auto text = row(v9, "SafetyStatus", "known");
  EXPECT_EQ(text.value, "false");
  EXPECT_NE(text.hint.find("unknown"), std::string::npos);
  EXPECT_EQ(row(fields_of_inputs(InputBytes{}, kV11), "SafetyStatus", "known").value, "no such row");
}

TEST(ImageText, HasEverySectionOfTheManualInEveryFormat) {
  constexpr std::string_view kInputSections[] = {
      "RobotStatus",   "MotionStatus",  "TargetJointSet", "TargetEndEffectorPose", "TargetConfiguration",
      "TargetWrf",     "TargetTrf",     "RobotTimestamp", "SafetyStatus",          "DynamicData 0",
      "DynamicData 1", "DynamicData 2", "DynamicData 3"};
  constexpr std::string_view kOutputSections[] = {"RobotControl", "MotionControl", "MotionCommand",
                                                  "HostTime",     "BrakesControl", "DynamicDataConfiguration"};
  for (const auto format : kFormats) {
    const auto inputs = fields_of_inputs(InputBytes{}, format);
    const auto outputs = fields_of_outputs(OutputBytes{}, format);
    for (const auto section : kInputSections) EXPECT_TRUE(has_section(inputs, section)) << name_of(format) << section;
    for (const auto section : kOutputSections) EXPECT_TRUE(has_section(outputs, section)) << name_of(format) << section;
    std::set<std::pair<std::string_view, std::string_view>> names;
    for (const auto& text : inputs) {
      EXPECT_TRUE(names.emplace(text.section, text.name).second) << text.section << " " << text.name << " twice";
    }
  }
}

TEST(ImageText, WritesFloatsSoThatTheyReadBackTheSame) {
  Inputs inputs;
  inputs.target_joint_set.joints = {
      0.1F, -0.0F, 1e-30F, 3.4028235e38F, std::bit_cast<float>(0x7F800000U), std::bit_cast<float>(0xFF800000U)};
  const auto rows = fields_of_inputs(encoded(inputs, kV11), kV11);
  const auto text = [&](std::string_view name) { return row(rows, "TargetJointSet", name).value; };
  EXPECT_EQ(text("J1"), "0.1");
  EXPECT_EQ(text("J2"), "-0");
  EXPECT_EQ(text("J3"), "1e-30");
  EXPECT_EQ(std::stof(text("J4")), 3.4028235e38F);
  EXPECT_EQ(text("J5"), "Infinity");
  EXPECT_EQ(text("J6"), "-Infinity");
}

}  // namespace
}  // namespace meca::image
