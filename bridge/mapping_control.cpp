// The control half of mapping.hpp: receipts out, requests in. What comes in is checked here for form (lengths, enum
// values); whether it makes sense for this robot now is for the control machines to say.
#include <algorithm>

#include "bridge/control/receipt_text.hpp"
#include "bridge/mapping.hpp"

namespace meca::bridge {
namespace {

using control::Reason;
using control::ReceiptState;

// The IDL enums and those of control/messages.hpp are the same lists; the ends prove it.
static_assert(static_cast<int>(meca500::CommandKind::MOTION) == static_cast<int>(control::CommandKind::kMotion));
static_assert(static_cast<int>(meca500::ReceiptState::ABORTED) == static_cast<int>(ReceiptState::kAborted));
static_assert(static_cast<int>(meca500::ReceiptReason::REASON_DUPLICATE) == static_cast<int>(Reason::kDuplicate));
static_assert(static_cast<int>(meca500::VelocityKind::MOVE_LIN_VEL_TRF) ==
              static_cast<int>(control::VelocityKind::kMoveLinVelTrf));
static_assert(static_cast<int>(meca500::LossPolicy::FINISH_MOTION) ==
              static_cast<int>(control::LossPolicy::kFinishMotion));

// DDS delivers whatever number the other side sent as an enum.
template <typename Ours, typename Theirs>
bool convert(Theirs value, Ours last, Ours& result) {
  const auto number = static_cast<std::int64_t>(value);
  if (number < 0 || number > static_cast<std::int64_t>(last)) return false;
  result = static_cast<Ours>(number);
  return true;
}

template <typename Theirs>
std::string number_of(Theirs value) {
  return std::to_string(static_cast<std::int64_t>(value));
}

Refusal refuse(const control::CommandRequest& request, Reason reason, std::string text) {
  Refusal refusal;
  refusal.receipt.client = request.client;
  refusal.receipt.command_id = request.command_id;
  refusal.receipt.state = ReceiptState::kRejected;
  refusal.receipt.reason = reason;
  refusal.receipt.kind = request.kind;
  refusal.receipt.motion_command_id = request.motion_command_id;
  refusal.text = std::move(text);
  return refusal;
}

constexpr const char* kBadClient = "the client name is empty or has control characters; give a name people can read";

}  // namespace

void fill(std::string_view robot, const control::Receipt& receipt, std::string_view text, std::uint64_t cycle,
          std::int64_t unix_ns, meca500::CommandReceipt& sample) {
  set_text(sample.robot(), robot);
  set_text(sample.client(), receipt.client);
  sample.command_id(receipt.command_id);
  sample.state(static_cast<meca500::ReceiptState>(receipt.state));
  sample.reason(static_cast<meca500::ReceiptReason>(receipt.reason));
  set_text(sample.text(), text.empty() ? control::describe(receipt) : std::string(text));
  sample.robot_error_code(receipt.robot_error);
  sample.cycle(cycle);
  sample.time_ns(unix_ns);
}

std::variant<control::CommandRequest, Refusal> to_request(const meca500::Command& sample,
                                                          const control::ParticipantId& participant) {
  control::CommandRequest request;
  request.client = std::string_view(sample.client().c_str());
  request.participant = participant;
  request.command_id = sample.command_id();
  request.motion_command_id = sample.motion_command_id();
  request.use_variables = sample.use_variables();
  request.report_completion = sample.report_completion();
  if (!convert(sample.kind(), control::CommandKind::kMotion, request.kind)) {
    return refuse(request, Reason::kUnknownCommand,
                  "kind " + number_of(sample.kind()) + " is not a CommandKind; use 0 (TAKE_CONTROL) to 14 (MOTION)");
  }
  if (!is_presentable(request.client)) return refuse(request, Reason::kNotAllowed, kBadClient);
  if (!convert(sample.on_loss(), control::LossPolicy::kFinishMotion, request.on_loss)) {
    return refuse(
        request, Reason::kArgumentRange,
        "on_loss " + number_of(sample.on_loss()) + " is not a LossPolicy; use 0 (STOP_MOTION) or 1 (FINISH_MOTION)");
  }
  const auto& arguments = sample.arguments();
  if (arguments.size() > request.arguments.size()) {
    auto refusal = refuse(request, Reason::kArgumentCount,
                          std::to_string(arguments.size()) + " arguments were given; no command takes more than 6");
    refusal.receipt.argument = static_cast<std::uint8_t>(std::min<std::size_t>(arguments.size(), 255));
    return refusal;
  }
  std::copy(arguments.begin(), arguments.end(), request.arguments.begin());
  request.argument_count = static_cast<std::uint8_t>(arguments.size());
  return request;
}

std::variant<control::VelocityRequest, std::string> to_request(const meca500::VelocityCommand& sample,
                                                               const control::ParticipantId& participant) {
  control::VelocityRequest request;
  request.client = std::string_view(sample.client().c_str());
  request.participant = participant;
  request.sequence_number = sample.sequence_number();
  request.velocity = sample.velocity();
  if (!is_presentable(request.client)) return std::string("VelocityCommand ignored: ") + kBadClient;
  if (!convert(sample.kind(), control::VelocityKind::kMoveLinVelTrf, request.kind)) {
    return "VelocityCommand of " + std::string(request.client.view()) + " ignored: kind " + number_of(sample.kind()) +
           " is not a VelocityKind; use 0 (MOVE_JOINTS_VEL) to 2 (MOVE_LIN_VEL_TRF)";
  }
  return request;
}

std::variant<control::LeaseRenewal, std::string> to_request(const meca500::ControlLease& sample,
                                                            const control::ParticipantId& participant) {
  control::LeaseRenewal renewal;
  renewal.client = std::string_view(sample.client().c_str());
  renewal.participant = participant;
  renewal.sequence_number = sample.sequence_number();
  if (!is_presentable(renewal.client)) return std::string("ControlLease ignored: ") + kBadClient;
  return renewal;
}

}  // namespace meca::bridge
