// The robot's error codes that the model raises (spec 3.1; texts are in transports/image/error_codes.hpp).
#pragma once

#include <cstdint>

namespace meca::sim::error {

inline constexpr std::uint16_t kNone = 0, kBufferFull = 1000, kUnknownCommand = 1001, kArguments = 1003,
                               kNotActivated = 1005, kNotHomed = 1006, kJointOverLimit = 1007, kAlreadyInError = 1011,
                               kSingularity = 1012, kOutOfReach = 1016, kMustBeDeactivated = 1026,
                               kStartConfMismatch = 1033, kNoGripper = 1038, kCommandFailed = 1040,
                               kNoPneumaticModule = 1041, kNotAllowedNow = 1046, kGetVariable = 1551,
                               kSetVariable = 1554, kProgramNotFound = 3017, kProgramInvalid = 3020,
                               kProgramRecursion = 3023, kTorqueLimit = 3029, kCollision = 3041, kWorkZone = 3049,
                               kDurationTooShort = 3051;

}  // namespace meca::sim::error
