#include "cli/json.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/unit/cli/samples.hpp"

namespace meca::cli {
namespace {

TEST(JsonNumber, IsTheShortestThatGivesTheSameFloat) {
  EXPECT_EQ(one_line(number(0.1F)), "0.1");
  EXPECT_EQ(one_line(number(-720.25F)), "-720.25");
  EXPECT_EQ(one_line(number(std::numeric_limits<float>::quiet_NaN())), "null");
  EXPECT_EQ(one_line(number(-std::numeric_limits<float>::infinity())), "null");
}

TEST(Json, OfARobotIsOneLineWithTheNamesOfTheIdl) {
  const std::string line = one_line(to_json("arm1", standing_robot()));
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto json = Json::parse(line);
  EXPECT_EQ(json["robot"], "arm1");
  EXPECT_EQ(json["bridge_status"]["link"], "LINK_UP");
  EXPECT_EQ(json["bridge_status"]["serial_number"], 4711);
  EXPECT_EQ(json["robot_status"]["activated"], true);
  EXPECT_EQ(json["robot_status"]["header"]["quality"], "GOOD");
  EXPECT_EQ(json["robot_status"]["header"]["receive_time_ns"], 1'700'000'000'000'000'000);
  EXPECT_EQ(json["target_joint_set"]["joints"], Json::parse("[-10.0, 0.0, 0.5, 0.0, 0.0, 720.25]"));
  EXPECT_EQ(json["target_end_effector_pose"]["beta"], 90);
  EXPECT_EQ(json["safety_status"]["stop"]["p_stop2"], false);
  EXPECT_EQ(json["control_status"]["owned"], false);
}

TEST(Json, SectionsThatHaveNotComeAreNull) {
  const auto json = to_json("arm1", RobotView{});
  EXPECT_TRUE(json["robot_status"].is_null());
  EXPECT_TRUE(json["bridge_status"].is_null());
  EXPECT_TRUE(json["dynamic_data"].empty());
}

TEST(Json, OfDynamicDataHasNamesAndUnits) {
  auto view = standing_robot();
  auto sample = with_header<meca500::DynamicData>();
  sample.slot(2);
  sample.type_id(40);
  sample.type_name("joint position (actual)");
  meca500::NamedValue value;
  value.name("joint 1");
  value.unit("deg");
  value.value(std::numeric_limits<double>::quiet_NaN());
  sample.values({value});
  view.dynamic_data[40] = sample;
  const auto json = Json::parse(one_line(to_json("arm1", view)))["dynamic_data"][0];
  EXPECT_EQ(json["slot"], 2);
  EXPECT_EQ(json["type_name"], "joint position (actual)");
  EXPECT_EQ(json["values"][0]["name"], "joint 1");
  EXPECT_EQ(json["values"][0]["unit"], "deg");
  EXPECT_TRUE(json["values"][0]["value"].is_null());
}

TEST(Json, OfAReceiptHasStateAndReasonAsWords) {
  meca500::CommandReceipt receipt;
  receipt.robot("arm1");
  receipt.client("me");
  receipt.command_id(7);
  receipt.state(meca500::ReceiptState::ABORTED);
  receipt.reason(meca500::ReceiptReason::REASON_ROBOT_ERROR);
  receipt.robot_error_code(1011);
  const auto json = to_json(receipt);
  EXPECT_EQ(json["command_id"], 7);
  EXPECT_EQ(json["state"], "ABORTED");
  EXPECT_EQ(json["reason"], "ROBOT_ERROR");
  EXPECT_EQ(json["robot_error_code"], 1011);
}

TEST(Json, TextThatIsNotUtf8IsReplacedAndNotThrown) {
  EXPECT_EQ(one_line(Json{{"robot", "arm\xFF"}}), "{\"robot\":\"arm\xEF\xBF\xBD\"}");
}

}  // namespace
}  // namespace meca::cli
