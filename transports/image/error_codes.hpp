// The 75 error codes the robot may show in ErrorCode, with text, likely cause and remedy in our own words.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace meca::image {

struct ErrorInfo {
  std::uint16_t code;
  std::string_view name;        // "JOINT_OVER_LIMIT"
  std::string_view text;        // what happened, a sentence without full stop
  std::string_view cause;       // likely cause
  std::string_view remedy;      // what to do before the reset; empty: reset at once
  std::string_view afterwards;  // what to do after the reset, so that it does not come back; may be empty
  bool resettable;              // ResetError clears it
};

std::span<const ErrorInfo> error_codes() noexcept;
const ErrorInfo* find_error_code(std::uint16_t code) noexcept;  // nullptr when no document names it

// All of the remedy in its order: "free the arm, then RESET, then home again". `reset`: how the reader resets an error;
// left out where that does not help.
std::string remedy_text(const ErrorInfo& error, std::string_view reset);

}  // namespace meca::image
