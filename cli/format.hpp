// Samples -> text for people. Pure functions: what is shown depends on the arguments alone.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "cli/view.hpp"

namespace meca::cli {

// What the robot is doing, in a few words: "moving", "paused", "in error 1011 ...", "not connected: ...".
std::string activity(const RobotView& view);

// "yes", or why a motion command would not move the robot and what to do about it. `reader`, a client's name: that it
// has control itself is no news to it.
std::string readiness(const RobotView& view, std::string_view reader = {});

// Stop signals that are raised, and which of them may be reset; never "no stop" when the robot does not say.
std::string safety(const RobotView& view);

// "1040 CMD_FAILED: the command failed; 'meca-ctl errors 1040' explains it" or "none". What to do about it depends on
// the rest of the robot's state: readiness() says it.
std::string error_text(std::uint16_t code);

// "free", or who has control since when. `now_ns` is Unix time.
std::string control_text(const meca500::ControlStatus& status, std::int64_t now_ns);

std::string joints_text(const meca500::TargetJointSet& sample);
std::string pose_text(const meca500::TargetEndEffectorPose& sample);

// Flags that are set, by name: "activated, homed, simulation".
std::string flags_text(const RobotView& view);

// One robot on one screen.
std::string status_text(const std::string& robot, const RobotView& view, std::int64_t now_ns);

// "arm1: move-joints: rejected (ARGUMENT_RANGE): q1 = 400 ..."
std::string receipt_text(const meca500::CommandReceipt& receipt, std::string_view title);

// Columns as wide as their longest cell, two blanks between. The first row is the heading.
std::string table(const std::vector<std::vector<std::string>>& rows);

// Fixed decimals, as wide as told: fixed(-1.5, 8, 3) is "  -1.500".
std::string fixed(double value, int width, int decimals);

std::string seconds_text(std::chrono::nanoseconds time);  // "2.5 s"

}  // namespace meca::cli
