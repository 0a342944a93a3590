// Samples -> JSON, with the names of the IDL. NaN and infinity become null, as JSON has neither.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "cli/view.hpp"

namespace meca::cli {

using Json = nlohmann::ordered_json;

Json to_json(const meca500::Header& header);
Json to_json(const meca500::RobotStatus& sample);
Json to_json(const meca500::MotionStatus& sample);
Json to_json(const meca500::TargetJointSet& sample);
Json to_json(const meca500::TargetEndEffectorPose& sample);
Json to_json(const meca500::TargetConfiguration& sample);
Json to_json(const meca500::SafetyStatus& sample);
Json to_json(const meca500::DynamicData& sample);
Json to_json(const meca500::BridgeStatus& sample);
Json to_json(const meca500::ControlStatus& sample);
Json to_json(const meca500::CommandReceipt& sample);

// Everything known of one robot; sections not received are null.
Json to_json(const std::string& robot, const RobotView& view);

// One line, without line feed. Text that is not UTF-8 is replaced, never an exception.
std::string one_line(const Json& json);

// The shortest decimal number that gives the same float back: 0.1, not 0.10000000149.
Json number(float value);

}  // namespace meca::cli
