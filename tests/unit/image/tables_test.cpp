// The tables of commands, dynamic data types and error codes: against the manual's words, and against the numbers of
// the vendor's Python library where that reference is at hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <vector>

#include "tests/unit/image/support.hpp"
#include "transports/image/dynamic_data_types.hpp"
#include "transports/image/error_codes.hpp"
#include "transports/image/field_table.hpp"
#include "transports/image/motion_commands.hpp"
#include "transports/image/stop_signals.hpp"

namespace meca::image {
namespace {

using test::contents;

const Argument& argument(std::uint32_t id, std::size_t index) { return find_motion_command(id)->arguments[index]; }

TEST(MotionCommands, AreFoundByIdAndByNameInAnyCase) {
  EXPECT_EQ(find_motion_command(kMoveJoints)->name, "MoveJoints");
  EXPECT_EQ(find_motion_command("movelinveltrf")->id, 23U);
  EXPECT_EQ(find_motion_command("MoveJoint"), nullptr);
  EXPECT_EQ(find_motion_command(""), nullptr);
  for (const auto& command : motion_commands()) {
    EXPECT_EQ(find_motion_command(command.id), &command);
    EXPECT_EQ(find_motion_command(command.name), &command) << "names are unique";
  }
}

TEST(MotionCommands, IdsThatNoTableNamesAreUnknown) {
  for (const std::uint32_t id : {52U, 59U, 61U, 99U, 101U, 149U, 157U, 201U, 1001U, 9999U, 20000U, 0xFFFFFFFFU}) {
    EXPECT_EQ(find_motion_command(id), nullptr) << id;
  }
}

TEST(MotionCommands, EveryIdOfAVariableSetsIt) {
  for (const std::uint32_t id : {10000U, 12345U, 19999U}) {
    EXPECT_EQ(find_motion_command(id)->name, "SetVariable");
    EXPECT_EQ(find_motion_command(id)->minimum_arguments, 1U);
  }
}

TEST(MotionCommands, AppearWithTheFirmwareThatTheVendorsFilesShowThemIn) {
  const auto ids_until = [](Layout layout) {
    std::set<std::uint32_t> ids;
    for (const auto& command : motion_commands()) {
      if (command.since <= layout) ids.insert(command.id);
    }
    return ids;
  };
  std::set<std::uint32_t> expected;  // Omron project of 9.3.3: 0-33, 100
  for (std::uint32_t id = 0; id <= 33; ++id) expected.insert(id);
  expected.insert(100);
  EXPECT_EQ(ids_until(Layout::kFirmware9), expected);
  for (std::uint32_t id = 34; id <= 48; ++id) expected.insert(id);  // sample projects of 10.2: 0-48, 100
  EXPECT_EQ(ids_until(Layout::kFirmware10), expected);
  expected.insert({49, 50, 51, 60, 150, 151, 152, 153, 154, 155, 156, 200, 1002, 10000});  // manual 11.3, Table 8
  EXPECT_EQ(ids_until(Layout::kFirmware11), expected);
}

TEST(MotionCommands, OnlyThreeAreVelocityCommandsAndOnlyFourteenBelongToOtherRobots) {
  std::set<std::uint32_t> velocity, others, configuration;
  for (const auto& command : motion_commands()) {
    if (command.command_class == CommandClass::kVelocity) velocity.insert(command.id);
    if (command.command_class == CommandClass::kOtherRobots) others.insert(command.id);
    if (command.command_class == CommandClass::kConfiguration) configuration.insert(command.id);
  }
  EXPECT_EQ(velocity, (std::set<std::uint32_t>{21, 22, 23}));
  EXPECT_EQ(others, (std::set<std::uint32_t>{34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47}));
  EXPECT_EQ(configuration, (std::set<std::uint32_t>{150, 151, 152, 153, 154, 155, 156}));
}

TEST(MotionCommands, HaveAtMostSixNamedArgumentsWithASaneRange) {
  for (const auto& command : motion_commands()) {
    EXPECT_LE(command.arguments.size(), 6U) << command.name;
    EXPECT_LE(command.minimum_arguments, command.arguments.size()) << command.name;
    std::set<std::string_view> names;
    for (const auto& one : command.arguments) {
      EXPECT_LE(one.minimum, one.maximum) << command.name << " " << one.name;
      EXPECT_TRUE(names.insert(one.name).second) << command.name << " " << one.name;
      EXPECT_TRUE(std::ranges::is_sorted(one.choices)) << command.name << " " << one.name;
    }
  }
}

TEST(MotionCommands, RangesIncludeTheirLimitsAndNothingBeyond) {
  const auto& blending = argument(kSetBlending, 0);
  EXPECT_TRUE(allows(blending, 0) && allows(blending, 100));
  EXPECT_FALSE(allows(blending, -0.01F) || allows(blending, 100.01F));
  const auto& timeout = argument(kSetVelTimeout, 0);
  EXPECT_TRUE(allows(timeout, 0.001F)) << "the limit as a float is the limit";
  EXPECT_FALSE(allows(timeout, std::nextafter(0.001F, 0.0F)) || allows(timeout, 1.001F));
  const auto& q3 = argument(kMoveJoints, 2);
  EXPECT_TRUE(allows(q3, -135) && allows(q3, 70));
  EXPECT_FALSE(allows(q3, -135.1F) || allows(q3, 70.1F));
  EXPECT_TRUE(allows(argument(kSetJointVel, 0), 150)) << "R4";
  EXPECT_TRUE(allows(argument(kMoveLin, 0), -1e9F)) << "reach is for the robot to judge";
}

TEST(MotionCommands, NoArgumentMayBeNanOrInfinite) {
  for (const auto& command : motion_commands()) {
    for (const auto& one : command.arguments) {
      for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity()}) {
        EXPECT_FALSE(allows(one, bad)) << command.name << " " << one.name << " " << bad;
      }
    }
  }
}

TEST(MotionCommands, WholeNumbersAndChoicesAreKept) {
  EXPECT_FALSE(allows(argument(kSetCheckpoint, 0), 1.5F));
  EXPECT_FALSE(allows(argument(kSetCheckpoint, 0), 0) || allows(argument(kSetCheckpoint, 0), 8001));
  EXPECT_TRUE(allows(argument(kSetConf, 0), -1) && allows(argument(kSetConf, 0), 1));
  EXPECT_FALSE(allows(argument(kSetConf, 0), 0)) << "a posture is -1 or 1; 0 is only ever reported";
  EXPECT_FALSE(allows(argument(kSetMoveDurationCfg, 0), 2)) << "severities there are 0, 1 and 4";
  EXPECT_TRUE(allows(argument(kSetTorqueLimitsCfg, 0), 2)) << "and here 0, 1, 2 and 4";
  EXPECT_TRUE(allows(argument(kSetValveState, 1), -1)) << "unchanged";
}

TEST(DynamicDataTypes, NameTheirValuesAndUnits) {
  const auto* joints = find_dynamic_data_type(40);
  ASSERT_NE(joints, nullptr);
  EXPECT_EQ(joints->name, "joint position (actual)");
  ASSERT_EQ(joints->values.size(), 6U);
  EXPECT_EQ(joints->values[5].name, "joint 6");
  EXPECT_EQ(joints->values[5].unit, "deg");
  EXPECT_EQ(find_dynamic_data_type(19999)->name, "variable");
  for (const std::uint32_t id : {35U, 39U, 47U, 51U, 57U, 63U, 64U, 71U, 80U, 9999U, 20000U}) {
    EXPECT_EQ(find_dynamic_data_type(id), nullptr) << id;
  }
}

TEST(DynamicDataTypes, FitTheDdsTopicThatCarriesTheirNames) {  // idl/meca500.idl: string<31> name, string<15> unit
  for (const auto& type : dynamic_data_types()) {
    EXPECT_EQ(find_dynamic_data_type(type.id), &type) << "ids are unique";
    for (const auto layout : {Layout::kFirmware9, Layout::kFirmware10, Layout::kFirmware11}) {
      const auto values = find_dynamic_data_type(type.id, layout)->values;
      EXPECT_LE(values.size(), 6U) << type.name;
      std::set<std::string_view> names;
      for (const auto& value : values) {
        EXPECT_TRUE(!value.name.empty() && value.name.size() <= 31 && value.unit.size() <= 15) << value.name;
        EXPECT_TRUE(names.insert(value.name).second) << type.name << ": " << value.name << " twice";
      }
    }
  }
}

TEST(DynamicDataTypes, Firmware9GivesJointLimitsInPairsAndLaterOnesInTriples) {
  const auto* old = find_dynamic_data_type(14, Layout::kFirmware9);
  EXPECT_EQ(old->values[1].name, "joint 1 max");
  EXPECT_EQ(old->values[2].name, "joint 2 min");
  for (const auto layout : {Layout::kFirmware10, Layout::kFirmware11}) {
    EXPECT_EQ(find_dynamic_data_type(14, layout)->values[1].name, "joint 2 min");
    EXPECT_EQ(find_dynamic_data_type(15, layout)->values[3].name, "joint 4 max");
  }
  EXPECT_EQ(find_dynamic_data_type(22, Layout::kFirmware9)->values.size(), 5U);
  EXPECT_EQ(find_dynamic_data_type(22, Layout::kFirmware11)->values.size(), 6U);
}

TEST(DynamicDataTypes, TheSerialNumberIsTheBitsOfAReal) {
  const auto* serial = find_dynamic_data_type(kDynSerialNumber);
  EXPECT_EQ(dynamic_value(serial->values[0], 1234.5F), 1234.5);
  EXPECT_EQ(dynamic_value(serial->values[1], std::bit_cast<float>(0x3B9ACA07U)), 1000000007.0);
  EXPECT_EQ(dynamic_value(serial->values[1], std::bit_cast<float>(0xFFFFFFFFU)), 4294967295.0) << "a NaN as a REAL";
}

TEST(ErrorCodes, AreSeventyFiveWithTextCauseAndRemedy) {
  EXPECT_EQ(error_codes().size(), 75U);
  for (const auto& error : error_codes()) {
    EXPECT_EQ(find_error_code(error.code), &error) << "codes are unique";
    for (const auto text : {error.text, error.cause}) EXPECT_FALSE(text.empty() || text.ends_with('.')) << error.name;
    EXPECT_FALSE(error.remedy.ends_with('.') || error.afterwards.ends_with('.')) << error.name;
    if (error.resettable) {
      EXPECT_FALSE(error.remedy.empty() && error.afterwards.empty()) << error.name << " would only come again";
    } else {
      EXPECT_FALSE(error.remedy.empty()) << error.name;
      EXPECT_TRUE(error.afterwards.empty()) << error.name << ": nothing comes after a reset that does not help";
    }
  }
  EXPECT_EQ(find_error_code(0), nullptr);
  EXPECT_EQ(find_error_code(3004), nullptr) << "end of motion is a status, no error";
  EXPECT_EQ(find_error_code(3041)->name, "COLLISION_ERROR");
}

TEST(ErrorCodes, HaveARemedyInTheOrderInWhichAPersonDoesIt) {
  EXPECT_EQ(remedy_text(*find_error_code(1014), "ResetError"),
            "free the arm and the gripper, then ResetError, then home again");
  EXPECT_EQ(remedy_text(*find_error_code(3005), "ResetError"), "free the arm, check payload and path, then ResetError");
  EXPECT_EQ(remedy_text(*find_error_code(1022), "ResetError"), "ResetError, then start saving before ending it");
  EXPECT_EQ(remedy_text(*find_error_code(3033), "ResetError"), "contact the vendor's support");
  for (const auto& error : error_codes()) {
    EXPECT_EQ(std::string(error.remedy).find("reset"), std::string::npos) << error.name << " would say it twice";
    EXPECT_EQ(std::string(error.afterwards).find("reset"), std::string::npos) << error.name;
  }
}

TEST(StopSignals, AreTheBitsOfTheSafetySectionWithTextCauseAndRemedy) {
  std::size_t bits = 0;
  for (const auto& field : kInputFields) {
    bits += field.section == rows::kSafety && (field.byte == 128 || field.byte == 129);
  }
  ASSERT_EQ(stop_signals().size(), bits);
  std::size_t last = 0;
  for (const auto& stop : stop_signals()) {
    EXPECT_EQ(&stop_info(stop.bit), &stop) << stop.name;
    EXPECT_EQ(find_stop_by_code(stop.status_code), &stop) << stop.name;
    EXPECT_EQ(find_error_code(stop.status_code), nullptr) << stop.name << " is a stop, no error";
    for (const auto text : {stop.name, stop.text, stop.cause, stop.remedy}) {
      EXPECT_FALSE(text.empty() || text.ends_with('.')) << stop.field;
    }
    const auto& field = field_of(stop);
    EXPECT_EQ(field.name, stop.field);
    EXPECT_GT(field.first_bit(), last) << stop.field << ": in the order of the bits";
    last = field.first_bit();
    EXPECT_EQ(resettable_field_of(stop).first_bit(), field.first_bit() + 32) << stop.field;
    Inputs inputs;
    std::get<Place<Inputs, bool>>(field.place).write(inputs) = true;
    EXPECT_TRUE(inputs.safety_status.stop.*stop.bit) << stop.field << " is another bit in the field table";
  }
}

TEST(StopSignals, AMeca500HasFour) {
  std::vector<std::string_view> names;
  for (const auto& stop : stop_signals()) {
    if (field_of(stop).robots == Robots::kMeca500) names.push_back(stop.field);
  }
  EXPECT_EQ(names, (std::vector<std::string_view>{"EStop", "PStop2", "Reboot", "ConnectionDropped"}));
}

// ---- against the vendor's Python library 3.0.3, reference only

TEST(TablesAndVendor, ErrorCodesHaveTheVendorsNamesAndResetFlags) {
  MECA_SHARED_OR_SKIP(file, "status_codes_mecademicpy_3.0.3.json");
  const auto json = contents(file);
  const std::regex entry(
      R"re("code":\s*(\d+),\s*"name":\s*"MX_ST_(\w+)",\s*"is_error":\s*true,\s*"is_resettable":\s*(true|false))re");
  std::size_t errors = 0;
  for (std::sregex_iterator match(json.begin(), json.end(), entry), end; match != end; ++match) {
    const auto code = std::stoul((*match)[1]);
    if (code > 0xFFFF) continue;  // a marker that widens the enumeration to 32 bits
    const auto* error = find_error_code(static_cast<std::uint16_t>(code));
    ASSERT_NE(error, nullptr) << code;
    EXPECT_EQ(error->name, (*match)[2].str());
    EXPECT_EQ(error->resettable, (*match)[3] == "true") << error->name;
    ++errors;
  }
  EXPECT_EQ(errors, error_codes().size());
}

std::map<std::uint32_t, std::string> vendor_enum(const std::string& json, const std::string& name) {
  const auto begin = json.find("\"" + name + "\"");
  const auto list = json.substr(begin, json.find(']', begin) - begin);
  const std::regex entry(R"re("name":\s*"(\w+)",\s*"value":\s*(\d+))re");
  std::map<std::uint32_t, std::string> values;
  for (std::sregex_iterator match(list.begin(), list.end(), entry), end; match != end; ++match) {
    values[static_cast<std::uint32_t>(std::stoull((*match)[2]))] = (*match)[1];
  }
  return values;
}

std::string letters(std::string_view text) {
  std::string kept;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) kept += static_cast<char>(std::toupper(c));
  }
  return kept;
}

TEST(TablesAndVendor, MotionCommandsHaveTheVendorsNumbers) {
  MECA_SHARED_OR_SKIP(file, "enums_mecademicpy_3.0.3.json");
  const auto vendor = vendor_enum(contents(file), "MxMotionCmdType");
  ASSERT_FALSE(vendor.empty());
  const std::set<std::uint32_t> spelled_otherwise = {18, 19, 20, 31, 32, 37, 38, 39, 40};
  for (const auto& command : motion_commands()) {
    if (command.id == kFirstVariable) continue;  // a range there, no member of the enumeration
    const auto found = vendor.find(command.id);
    ASSERT_NE(found, vendor.end()) << command.name;
    if (spelled_otherwise.contains(command.id)) continue;
    EXPECT_EQ(letters(found->second), "MXMOTIONCMDTYPE" + letters(command.name));
  }
  for (const auto& [id, name] : vendor) {  // not in the manual: internal, newer robots, or no commands at all
    if (id == 101 || id == 201 || id == 1000 || id == 1001 || id > kLastVariable) continue;
    EXPECT_NE(find_motion_command(id), nullptr) << name;
  }
}

TEST(TablesAndVendor, DynamicDataTypesHaveTheVendorsNumbers) {
  MECA_SHARED_OR_SKIP(file, "enums_mecademicpy_3.0.3.json");
  const auto vendor = vendor_enum(contents(file), "MxEip_DynamicType");
  constexpr std::uint32_t kEndOfMeca500 = 63;  // a marker, as is the one that widens the enumeration
  ASSERT_TRUE(vendor.contains(kEndOfMeca500));
  for (const auto& [id, name] : vendor) {
    if (id == kEndOfMeca500 || id == 0xFFFFFFFFU) continue;
    const auto* type = find_dynamic_data_type(id);
    ASSERT_NE(type, nullptr) << name;
    EXPECT_TRUE(id < kEndOfMeca500 || !type->on_meca500) << name;
  }
  for (const auto& type : dynamic_data_types()) {
    if (type.id == 4 || type.id == kFirstVariable) continue;  // manual 9.2 names 4; variables are a range
    EXPECT_TRUE(vendor.contains(type.id)) << type.name;
  }
}

}  // namespace
}  // namespace meca::image
