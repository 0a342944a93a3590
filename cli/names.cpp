#include "cli/names.hpp"

namespace meca::cli {

std::string_view name(meca500::Quality value) {
  switch (value) {
    case meca500::Quality::UNKNOWN:
      return "UNKNOWN";
    case meca500::Quality::GOOD:
      return "GOOD";
    case meca500::Quality::STALE:
      return "STALE";
    case meca500::Quality::DISCONNECTED:
      return "DISCONNECTED";
  }
  return "?";
}

std::string_view name(meca500::LinkState value) {
  switch (value) {
    case meca500::LinkState::LINK_DOWN:
      return "LINK_DOWN";
    case meca500::LinkState::LINK_CONNECTING:
      return "LINK_CONNECTING";
    case meca500::LinkState::LINK_UP:
      return "LINK_UP";
  }
  return "?";
}

std::string_view name(meca500::ReceiptState value) {
  switch (value) {
    case meca500::ReceiptState::ACCEPTED:
      return "ACCEPTED";
    case meca500::ReceiptState::SENT:
      return "SENT";
    case meca500::ReceiptState::ACKNOWLEDGED:
      return "ACKNOWLEDGED";
    case meca500::ReceiptState::COMPLETED:
      return "COMPLETED";
    case meca500::ReceiptState::DISCARDED:
      return "DISCARDED";
    case meca500::ReceiptState::REJECTED:
      return "REJECTED";
    case meca500::ReceiptState::ABORTED:
      return "ABORTED";
  }
  return "?";
}

std::string_view name(meca500::ReceiptReason value) {
  using R = meca500::ReceiptReason;
  switch (value) {
    case R::REASON_NONE:
      return "NONE";
    case R::REASON_NOT_OWNER:
      return "NOT_OWNER";
    case R::REASON_MONITORING_ONLY:
      return "MONITORING_ONLY";
    case R::REASON_NO_LINK:
      return "NO_LINK";
    case R::REASON_FIRMWARE_UNKNOWN:
      return "FIRMWARE_UNKNOWN";
    case R::REASON_UNKNOWN_COMMAND:
      return "UNKNOWN_COMMAND";
    case R::REASON_ARGUMENT_COUNT:
      return "ARGUMENT_COUNT";
    case R::REASON_ARGUMENT_RANGE:
      return "ARGUMENT_RANGE";
    case R::REASON_NOT_ACTIVATED:
      return "NOT_ACTIVATED";
    case R::REASON_NOT_HOMED:
      return "NOT_HOMED";
    case R::REASON_WRONG_STATE:
      return "WRONG_STATE";
    case R::REASON_ROBOT_ERROR:
      return "ROBOT_ERROR";
    case R::REASON_SAFETY_STOP:
      return "SAFETY_STOP";
    case R::REASON_PAUSED:
      return "PAUSED";
    case R::REASON_QUEUE_FULL:
      return "QUEUE_FULL";
    case R::REASON_TIME_OUT:
      return "TIME_OUT";
    case R::REASON_LINK_LOST:
      return "LINK_LOST";
    case R::REASON_OWNER_LOST:
      return "OWNER_LOST";
    case R::REASON_CLEARED:
      return "CLEARED";
    case R::REASON_NOT_ALLOWED:
      return "NOT_ALLOWED";
    case R::REASON_SHUTDOWN:
      return "SHUTDOWN";
    case R::REASON_DUPLICATE:
      return "DUPLICATE";
  }
  return "?";
}

std::string_view name(meca500::LossPolicy value) {
  switch (value) {
    case meca500::LossPolicy::STOP_MOTION:
      return "STOP_MOTION";
    case meca500::LossPolicy::FINISH_MOTION:
      return "FINISH_MOTION";
  }
  return "?";
}

bool is_terminal(meca500::ReceiptState state) {
  switch (state) {
    case meca500::ReceiptState::ACCEPTED:
    case meca500::ReceiptState::SENT:
    case meca500::ReceiptState::ACKNOWLEDGED:
      return false;
    case meca500::ReceiptState::COMPLETED:
    case meca500::ReceiptState::DISCARDED:
    case meca500::ReceiptState::REJECTED:
    case meca500::ReceiptState::ABORTED:
      return true;
  }
  return false;
}

}  // namespace meca::cli
