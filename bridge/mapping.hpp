// Image sections, requests and receipts <-> IDL samples: plain functions, one pair of structs each.
// They fill samples that are used again and again, so that publishing a section allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "bridge/control/messages.hpp"
#include "bridge/cycle.hpp"
#include "bridge/diagnosis.hpp"
#include "idl/types.hpp"
#include "transports/image/image.hpp"

namespace meca::bridge {

// Bounded IDL strings are arrays: setting one never allocates, and cuts what is too long. Not their assign(), which
// leaves the end of a longer text before in place.
template <typename String>
void set_text(String& to, std::string_view text) {
  constexpr std::size_t kLongest = 255;  // of all IDL strings
  std::array<char, kLongest + 1> terminated;
  const std::size_t size = std::min(text.size(), kLongest);
  std::copy_n(text.data(), size, terminated.data());
  terminated[size] = '\0';
  to = terminated.data();
}

// ---------------------------------------------------------------- bridge -> DDS: the key `robot` is the caller's

meca500::Quality to_idl(Quality quality) noexcept;
meca500::LinkState to_idl(transports::LinkState link) noexcept;
void fill_header(const CycleRecord& record, meca500::Header& header);

// Every field of the section; header and key stay as they are.
void fill(const image::RobotStatus& section, meca500::RobotStatus& sample);
void fill(const image::MotionStatus& section, meca500::MotionStatus& sample);
void fill(const image::TargetJointSet& section, meca500::TargetJointSet& sample);
void fill(const image::Pose& section, meca500::TargetEndEffectorPose& sample);
void fill(const image::TargetConfiguration& section, meca500::TargetConfiguration& sample);
void fill(const image::Pose& section, meca500::TargetWrf& sample);
void fill(const image::Pose& section, meca500::TargetTrf& sample);
void fill(const image::RobotTimestamp& section, meca500::RobotTimestamp& sample);
void fill(const image::SafetyStatus& section, meca500::SafetyStatus& sample);
void fill(const image::RobotControl& section, meca500::RobotControl& sample);
void fill(const image::MotionControl& section, meca500::MotionControl& sample);
void fill(const image::MotionCommand& section, meca500::MotionCommand& sample);
void fill(const image::HostTime& section, meca500::HostTime& sample);
void fill(const image::BrakesControl& section, meca500::BrakesControl& sample);
void fill(const image::DynamicDataConfiguration& section, meca500::DynamicDataConfiguration& sample);

// A dynamic data slot with the names and units of its type in this firmware layout; undocumented types stay raw.
void fill(const image::DynamicData& data, std::uint8_t slot, image::Layout layout, meca500::DynamicData& sample);

// The whole input image, header and keys included.
void fill(std::string_view robot, const CycleRecord& record, meca500::CyclicState& sample);

void fill(const control::ControlState& state, meca500::ControlStatus& sample);

// What BridgeStatus says besides the record: constants of the robot and counters of its threads.
struct StatusFacts {
  std::string_view transport;  // "builtin", "ethernet_ip", ...
  Time cycle{};
  std::uint64_t missed_cycles = 0, records_dropped = 0;
  std::uint32_t wakeup_lateness_max_us = 0, wakeup_lateness_mean_us = 0;
  std::int64_t unix_ns = 0;
  std::span<const transports::CounterInfo> counters{};  // what CycleRecord::transport_counters hold
};
void fill(const CycleRecord& record, const Diagnosis& diagnosis, const StatusFacts& facts,
          meca500::BridgeStatus& sample);

// `text` empty: the sentence of control::describe().
void fill(std::string_view robot, const control::Receipt& receipt, std::string_view text, std::uint64_t cycle,
          std::int64_t unix_ns, meca500::CommandReceipt& sample);

std::string to_string(const control::ParticipantId& id);            // "01.0f.a2..." as DDS tools print a GUID prefix
std::string to_string(const transports::FirmwareVersion& version);  // "11.3.3.12637"

// Text that came from outside may stand in logs and terminals: not empty, no control characters.
bool is_presentable(std::string_view name) noexcept;

// ---------------------------------------------------------------- DDS -> bridge

// A sample that says something no machine needs to see: the receipt, with a sentence of its own.
struct Refusal {
  control::Receipt receipt;
  std::string text;
};

std::variant<control::CommandRequest, Refusal> to_request(const meca500::Command& sample,
                                                          const control::ParticipantId& participant);
// A stream has no receipts: a bad sample gives a sentence for the log.
std::variant<control::VelocityRequest, std::string> to_request(const meca500::VelocityCommand& sample,
                                                               const control::ParticipantId& participant);
std::variant<control::LeaseRenewal, std::string> to_request(const meca500::ControlLease& sample,
                                                            const control::ParticipantId& participant);

}  // namespace meca::bridge
