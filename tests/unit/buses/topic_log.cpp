#include "tests/unit/buses/topic_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "bridge/control/receipt_text.hpp"
#include "bridge/diagnosis.hpp"
#include "bridge/mapping.hpp"
#include "cli/json.hpp"
#include "idl/types.hpp"

namespace meca::test {
namespace {

using cli::Json;

// The first images after a loss may still say that nobody is connected to the robot.
constexpr int kOlderThanTheConnection = 2;

// "activated, homed, error_code 3005": what is set, by its name in the IDL.
void list(const Json& value, const std::string& name, std::string& out) {
  std::string item;
  if (value.is_boolean() && value.get<bool>()) item = name;
  if (value.is_number() && value != 0) item = name + " " + value.dump();
  if (value.is_string() && !value.get_ref<const std::string&>().empty()) item = name + " " + value.dump();
  if (!item.empty()) out += (out.empty() ? "" : ", ") + item;
  if (!value.is_structured()) return;
  for (const auto& [key, inner] : value.items()) list(inner, name.empty() ? key : name + "." + key, out);
}
std::string text(const Json& sample) {
  std::string out;
  list(sample, "", out);
  return out.empty() ? "-" : out;
}

// Without the key, the header and what `without` names.
template <class Sample>
std::string text(const Sample& sample, std::initializer_list<const char*> without) {
  Json json = cli::to_json(sample);
  for (const char* key : {"robot", "header"}) json.erase(key);
  for (const char* key : without) json.erase(key);
  return text(json);
}

template <class Sample, class Section>
Sample sample_of(const Section& section) {
  Sample out;
  bridge::fill(section, out);
  return out;
}

std::string text(const meca500::RobotControl& s) {
  return text(Json{{"deactivate", s.deactivate()},
                   {"activate", s.activate()},
                   {"home_robot", s.home_robot()},
                   {"reset_error", s.reset_error()},
                   {"sim_mode", s.sim_mode()},
                   {"recovery_mode", s.recovery_mode()}});
}
std::string text(const meca500::MotionControl& s) {
  return text(Json{{"move_id", s.move_id()},
                   {"set_point", s.set_point()},
                   {"pause_motion", s.pause_motion()},
                   {"clear_motion", s.clear_motion()},
                   {"resume_motion", s.resume_motion()}});
}
std::string text(const meca500::MotionCommand& s) {
  Json arguments = Json::array();
  for (const float argument : s.arguments()) arguments.push_back(cli::number(argument));
  return s.motion_command_id() == 0 ? "-" : std::to_string(s.motion_command_id()) + " " + cli::one_line(arguments);
}

// What each bus says in its own words and numbers is not here: link_detail, counters.
std::string text(bridge::CycleRecord record) {
  record.link_detail = {};
  const bridge::Diagnosis diagnosis = bridge::diagnose(record);
  meca500::BridgeStatus sample;
  bridge::fill(record, diagnosis, {}, sample);
  const Json all = cli::to_json(sample);
  Json json;
  for (const char* key : {"link", "firmware_known", "firmware", "layout", "ready", "cause", "remedy"}) {
    json[key] = all[key];
  }
  return text(json);
}

}  // namespace

void TopicLog::take(const bridge::CycleRecord& record) {
  meca500::ControlStatus control;
  bridge::fill(record.control, control);
  offer("ControlStatus",
        text(control, {"owner_participant", "since_ns", "lease_ms", "contender_takes_over_ns", "last_renewal_ns"}));
  last_ = record;
  const bool good = record.quality == bridge::Quality::kGood;
  const bool down = record.quality == bridge::Quality::kDisconnected && record.link == transports::LinkState::kDown;
  if (good || down) offer("Header", good ? "quality \"GOOD\"" : "quality \"DISCONNECTED\"");
  good_images_ = good ? good_images_ + 1 : 0;
  if (!good) return;
  const image::Inputs& in = record.inputs;
  const image::Outputs& out = record.outputs;
  offer("RobotStatus", text(sample_of<meca500::RobotStatus>(in.robot_status), {}));
  offer("MotionStatus", text(sample_of<meca500::MotionStatus>(in.motion_status), {"fifo_space"}));
  if (good_images_ > kOlderThanTheConnection)
    offer("SafetyStatus", text(sample_of<meca500::SafetyStatus>(in.safety_status), {}));
  offer("RobotControl", text(sample_of<meca500::RobotControl>(out.robot_control)));
  offer("MotionControl", text(sample_of<meca500::MotionControl>(out.motion_control)));
  offer("MotionCommand", text(sample_of<meca500::MotionCommand>(out.motion_command)));
}

void TopicLog::take(const control::Receipt& receipt, const std::string& title) {
  meca500::CommandReceipt sample;
  bridge::fill("arm", receipt, control::describe(receipt), 0, 0, sample);
  const Json json = cli::to_json(sample);
  std::string line = "CommandReceipt   " + title + ": " + json["state"].get<std::string>();
  if (json["reason"] != "NONE") {
    line += " " + json["reason"].get<std::string>() + ": " + json["text"].get<std::string>();
  }
  receipts_.push_back(line);
}

void TopicLog::offer(const std::string& topic, const std::string& value) {
  auto at = std::ranges::find(topics_, topic, &Topic::name);
  if (at == topics_.end()) at = topics_.insert(topics_.end(), Topic{topic, "", {}});
  if (at->last == value) return;
  at->last = value;
  at->changes.push_back(value);
}

std::string TopicLog::changes() {
  offer("BridgeStatus", text(last_));
  std::string out;
  for (const std::string& receipt : std::exchange(receipts_, {})) out += "  " + receipt + "\n";
  for (Topic& topic : topics_) {
    for (const std::string& value : std::exchange(topic.changes, {})) {
      out += "  " + topic.name + std::string(17 - topic.name.size(), ' ') + value + "\n";
    }
  }
  return out;
}

std::string TopicLog::joints(const bridge::CycleRecord& record) {
  const auto sample = sample_of<meca500::TargetJointSet>(record.inputs.target_joint_set);
  std::string out = "  TargetJointSet  ";
  for (const float joint : sample.joints()) {
    char number[32];
    std::snprintf(number, sizeof number, " %.3f", std::round(joint * 1000.0F) == 0 ? 0.0 : static_cast<double>(joint));
    out += number;
  }
  return out + "\n";
}

}  // namespace meca::test
