// What travels between DDS clients and the control machines: requests in, receipts and control state out.
// Fixed-size and trivially copyable, so that they pass through the queues without allocation. No DDS types here;
// the names mirror idl/control.idl.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

#include "transports/text.hpp"

namespace meca::control {

using ClientName = FixedText<63>;  // longer text is cut; whoever lets outside text in checks its length first
using ParticipantId = std::array<std::byte, 12>;  // DDS GUID prefix: which participant wrote the sample

enum class CommandKind : std::uint8_t {
  kTakeControl,
  kReleaseControl,
  kActivate,
  kDeactivate,
  kHome,
  kResetError,
  kPauseMotion,
  kResumeMotion,
  kClearMotion,
  kSimMode,
  kRecoveryMode,
  kBrakes,
  kDynamicData,
  kSetHostTime,
  kMotion,
};

enum class LossPolicy : std::uint8_t { kStopMotion, kFinishMotion };

struct CommandRequest {
  ClientName client;
  ParticipantId participant{};
  std::uint64_t command_id = 0;
  CommandKind kind = CommandKind::kTakeControl;
  std::uint32_t motion_command_id = 0;
  std::array<double, 6> arguments{};
  std::uint8_t argument_count = 0;
  bool use_variables = false;
  bool report_completion = false;
  LossPolicy on_loss = LossPolicy::kStopMotion;
};

enum class VelocityKind : std::uint8_t { kMoveJointsVel, kMoveLinVelWrf, kMoveLinVelTrf };

struct VelocityRequest {
  ClientName client;
  ParticipantId participant{};
  std::uint64_t sequence_number = 0;
  VelocityKind kind = VelocityKind::kMoveJointsVel;
  std::array<float, 6> velocity{};
};

struct LeaseRenewal {
  ClientName client;
  ParticipantId participant{};
  std::uint64_t sequence_number = 0;
};

// The bridge is asked to stop: stop image, pending commands end as REASON_SHUTDOWN.
struct ShutdownRequest {};

using Request = std::variant<CommandRequest, VelocityRequest, LeaseRenewal, ShutdownRequest>;

enum class ReceiptState : std::uint8_t {
  kAccepted,
  kSent,
  kAcknowledged,
  kCompleted,
  kDiscarded,
  kRejected,
  kAborted,
};
constexpr bool is_terminal(ReceiptState s) noexcept { return s >= ReceiptState::kCompleted; }

enum class Reason : std::uint8_t {
  kNone,
  kNotOwner,
  kMonitoringOnly,
  kNoLink,
  kFirmwareUnknown,
  kUnknownCommand,
  kArgumentCount,
  kArgumentRange,
  kNotActivated,
  kNotHomed,
  kWrongState,
  kRobotError,
  kSafetyStop,
  kPaused,
  kQueueFull,
  kTimeOut,
  kLinkLost,
  kOwnerLost,
  kCleared,
  kNotAllowed,
  kShutdown,
  kDuplicate,
};

// What a refusal for want of control (kNotOwner) adds to the owner's name.
enum class ControlHint : std::uint8_t {
  kNone,
  kTakeFirst,    // nobody has control, and what was sent does not take it (a velocity stream)
  kMayTakeOver,  // the client's priority is higher than the owner's: TAKE_CONTROL takes over
  kContended,    // a client of higher priority is taking over already
  kWaiting,      // the client itself is taking over; the owner's grace is not over yet
  kOutranked,    // it was taking over, and a client of still higher priority takes over in its place
};

struct Receipt {
  ClientName client;
  std::uint64_t command_id = 0;
  ReceiptState state = ReceiptState::kAccepted;
  Reason reason = Reason::kNone;
  std::uint16_t robot_error = 0;
  // What the sentence for people needs; the publisher writes the sentence (receipt_text.hpp).
  CommandKind kind = CommandKind::kTakeControl;
  std::uint32_t motion_command_id = 0;
  std::uint8_t argument = 0;  // kArgumentRange: index; kArgumentCount: how many came
  double value = 0, minimum = 0, maximum = 0;
  ClientName other;  // kNotOwner: who has control; then value, minimum, maximum are the priorities of the client, of
                     // the owner and of who is taking over
  ControlHint hint = ControlHint::kNone;
};

struct ControlState {
  bool owned = false;
  ClientName owner;
  ParticipantId owner_participant{};
  std::int64_t since_unix_ns = 0;
  std::uint32_t priority = 0;  // of the owner
  std::uint32_t lease_ms = 0;
  LossPolicy on_loss = LossPolicy::kStopMotion;  // what will happen, whatever the owner asked for
  ClientName contender;  // of higher priority, takes over when the owner's grace is over; empty: nobody
  std::uint32_t contender_priority = 0;
  std::int64_t contender_takes_over_unix_ns = 0;
  bool monitoring_only = false;
  Receipt last_refusal;  // client empty: none yet
  ClientName last_owner;
  enum class Loss : std::uint8_t {
    kNone,
    kReleased,
    kLeaseExpired,
    kLinkLost,
    kShutdown,
    kTakenOver
  } last_loss = Loss::kNone;
  std::int64_t last_renewal_unix_ns = 0;  // of the owner, or of the last one when there is none; no news by itself
};

}  // namespace meca::control
