// What the person asked for on the command line, checked and complete; and the exit codes that answer.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "idl/types.hpp"

namespace meca::cli {

enum class ExitCode : int {
  kDone = 0,          // done, or completed
  kRefused = 1,       // rejected, aborted, discarded, or not healthy
  kArguments = 2,     // the command line was not understood
  kNoBridge = 4,      // no bridge answered, or DDS could not be opened
  kTimeOut = 5,       // no answer in time; the command may still be running
  kInterrupted = 130  // Ctrl-C before the end (128 + SIGINT, as shells have it)
};

enum class Verb : std::uint8_t {
  kStatus,
  kWatch,
  kCommand,
  kVelocity,
  kTake,
  kTopics,
  kDecode,
  kHealth,
  kReceipts,
  kErrors,
  kSim,
  kScan,
};

enum class ScanBus : std::uint8_t { kEthernetIp, kEthercat };

// One command for the bridge, without robot, client and id.
struct CommandPlan {
  std::string title;  // as the person knows it: "move-joints", "SetJointVel"
  meca500::CommandKind kind = meca500::CommandKind::TAKE_CONTROL;
  std::uint32_t motion_command_id = 0;
  std::vector<double> arguments;  // at most six, in the manual's order and units
  bool use_variables = false;
};

struct VelocityPlan {
  meca500::VelocityKind kind = meca500::VelocityKind::MOVE_JOINTS_VEL;
  std::array<float, 6> velocity{};  // deg/s, or mm/s and deg/s
};

struct Invocation {
  Verb verb = Verb::kStatus;

  // How to reach the bridge.
  int domain = 0;
  std::string prefix = "meca500/";
  std::vector<std::string> interfaces;
  bool shared_memory = true;
  std::string robot;   // empty: the only one on the bus
  std::string client;  // empty: meca-ctl@host:pid

  // How to answer.
  bool json = false;
  bool wait = false;
  std::optional<double> timeout_s;   // empty: the verb's own
  std::optional<double> duration_s;  // --for; empty: the verb's own
  std::optional<double> rate_hz;     // watch

  CommandPlan command;
  VelocityPlan velocity;

  // sim
  std::string sim_line;  // empty: which words there are
  std::string socket;    // empty: the robot's usual one

  // scan
  ScanBus scan_bus = ScanBus::kEthernetIp;
  std::string address;  // empty: everybody on the interfaces

  // decode
  std::string input;
  std::string firmware = "11";
  bool big_endian = false;

  // errors
  std::string trouble;  // code or name, known to find_trouble(); empty: all
  bool markdown = false;
};

}  // namespace meca::cli
