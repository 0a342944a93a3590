#include "transports/image/error_codes.hpp"

#include <algorithm>

namespace meca::image {
namespace {

constexpr bool kResettable = true;
constexpr bool kPermanent = false;  // ResetError does not help: power cycle, service or support

// Numbers, names and the last column are facts of the vendor's Python library (3.0.3, firmware 11.3 generation).
// inferred: causes and remedies, from the command descriptions of the manual. Ascending by code. The two last texts:
// before the reset, after it.
constexpr ErrorInfo kErrors[] = {
    // Refused commands.
    {1000, "BUFFER_FULL", "the motion queue is full", "commands arrive faster than the robot works them off", "",
     "watch fifo_space and send the next command when there is room", kResettable},
    {1001, "UNKNOWN_CMD", "the robot does not know this command",
     "a command id or name that this firmware or robot model does not have", "",
     "check the command against the robot's firmware and model before sending it again", kResettable},
    {1002, "SYNTAX_ERR", "a text command could not be parsed", "a bracket or comma is missing in a text command", "",
     "correct the text command or the stored program", kResettable},
    {1003, "ARG_ERR", "an argument is wrong", "too few arguments, or a value outside its range", "",
     "compare the arguments with the ranges in the manual and send the command again", kResettable},
    {1005, "NOT_ACTIVATED", "the command needs an activated robot", "the motors are off", "",
     "activate the robot before the command is sent again", kResettable},
    {1006, "NOT_HOMED", "the command needs a homed robot", "the robot was activated but not homed", "",
     "home the robot before the command is sent again", kResettable},
    {1007, "JOINT_OVER_LIMIT", "the target lies outside a joint limit",
     "the requested joint set or pose needs a joint beyond its model or user limit", "",
     "choose another target or posture, or widen the user joint limits", kResettable},
    {1010, "BLOCKED_BY_180_DEG_PROT", "a joint would turn by more than 180 degrees in one move",
     "a Cartesian target far away in joint space", "", "insert an intermediate point or fix the configuration and turn",
     kResettable},
    {1011, "ALREADY_ERR", "the robot is in error and takes no commands", "an earlier error was not reset",
     "find the first error in the robot's log and remove its cause", "", kResettable},
    {1012, "SINGULARITY_ERR", "the path runs into a singularity",
     "a linear move through or close to a singular posture", "",
     "use a joint move, shift the path, or let the robot choose the configuration", kResettable},
    {1013, "ACTIVATION_ERR", "the robot could not be activated",
     "a drive did not start or a safety stop came in between", "clear all safety stops", "activate again", kResettable},
    {1014, "HOMING_ERR", "homing did not succeed", "a joint or the gripper was blocked during homing",
     "free the arm and the gripper", "home again", kResettable},
    {1015, "MASTER_ERR", "mastering did not succeed", "the mastering procedure was not completed",
     "read the robot's log for the reason", "repeat the mastering or ask the vendor's support", kResettable},
    {1016, "OUT_OF_REACH", "the target is beyond the arm's reach", "a pose or joint set outside the work space", "",
     "check target, WRF and TRF, and move the target closer", kResettable},
    {1022, "NOT_SAVING_ERR", "no program is being saved", "saving was stopped without having been started", "",
     "start saving before ending it", kResettable},
    {1023, "PROGRAM_IGNORED_CMD", "a stored program holds a command that programs may not contain",
     "the program was saved with a command of another kind", "", "remove the command from the program", kResettable},
    {1024, "MASTERING_NEEDED", "the robot has lost its mastering", "calibration data of a joint is gone",
     "do not move the robot; contact the vendor's support", "", kPermanent},
    {1025, "IMPOSSIBLE_RESET_ERR", "the present error cannot be reset", "ResetError was tried on a permanent error",
     "power the robot off and on again", "", kPermanent},
    {1026, "MUST_BE_DEACTIVATED", "the command is only taken while deactivated",
     "a configuration command was sent to an activated robot", "", "deactivate the robot, configure, activate again",
     kResettable},
    {1027, "SIM_MUST_DEACTIVATED", "simulation mode can only be switched while deactivated",
     "sim_mode was changed on an activated robot", "", "deactivate the robot, switch the mode, activate again",
     kResettable},
    {1029, "PROGRAM_FULL", "the program memory is full", "the program being saved exceeds 13000 commands", "",
     "split the program", kResettable},
    {1030, "ALREADY_SAVING", "a program is being saved already", "saving was started twice", "",
     "finish the present saving before starting another", kResettable},
    {1031, "ILLEGAL_WHILE_SAVING", "the command is not allowed while a program is saved",
     "a request was sent between start and end of saving", "", "finish saving before the command is sent again",
     kResettable},
    {1032, "HOMING_JOINTS_OUT_OF_RANGE", "a joint was out of range for homing",
     "firmware 8 only: a joint outside its limits at power-on", "", "move the joint into its range and home again",
     kResettable},
    {1033, "START_CONF_MISMATCH", "the arm is not in the configuration that the move asks for",
     "a linear move with a fixed configuration begins in another one", "",
     "reach the configuration with a joint move first, or use automatic configuration", kResettable},
    {1038, "NO_GRIPPER", "no gripper is connected", "a gripper command without a gripper, or with a loose cable",
     "connect the gripper", "home again", kResettable},
    {1040, "CMD_FAILED", "the command failed", "the robot gives no further reason",
     "read the robot's log for the reason", "", kResettable},
    {1041, "NO_VBOX", "no pneumatic module is connected", "a valve command without an MPM500, or with a loose cable",
     "connect the pneumatic module", "", kResettable},
    {1042, "EXT_TOOL_SIM_MUST_DEACTIVATED", "the simulated tool can only be changed while deactivated",
     "the external tool type was switched on an activated robot", "",
     "deactivate the robot, switch the tool, activate again", kResettable},
    {1043, "INVALID_BANK_ID", "this robot has no such I/O bank", "an I/O command meant for another robot or module", "",
     "use a bank that the robot has", kResettable},
    {1044, "NO_VACUUM_MODULE_ID", "this robot has no vacuum module", "a vacuum command meant for another robot", "",
     "do not send vacuum commands to this robot", kResettable},
    {1045, "API_LOCKED", "the robot's command interface is locked", "somebody locked the interface",
     "unlock it with the tool that locked it", "", kResettable},
    {1046, "NOT_ALLOWED_NOW", "the command is not allowed in the present state",
     "the robot's mode or a safety condition forbids it", "",
     "bring the robot into the state that the command needs and send it again", kResettable},
    // Files, programs, variables.
    {1500, "LIST_FILES_ERR", "the robot could not list its files", "its file service failed", "",
     "try again, and restart the robot when it persists", kResettable},
    {1501, "LOAD_FILE_ERR", "the robot could not load a file", "the file is missing or damaged", "",
     "check name and contents of the file", kResettable},
    {1502, "SAVE_FILE_ERR", "the robot could not save a file", "no space, a bad name or bad contents", "",
     "check the name and the free space", kResettable},
    {1503, "DELETE_FILE_ERR", "the robot could not delete a file", "the file does not exist or is in use", "",
     "check the name and stop the program that uses it", kResettable},
    {1504, "SAVE_ROBOT_CONFIG_ERR", "the robot could not store its configuration", "its storage refused the write", "",
     "try again, and contact the vendor's support when it persists", kResettable},
    {1505, "UPDATE_LOADED_PROGRAMS_ERR", "the list of loaded programs could not be renewed",
     "a stored program is damaged", "", "check the stored programs", kResettable},
    {1506, "SIDECAR_TIMEOUT_ERR", "the robot's program service did not answer", "an internal service hangs or restarts",
     "", "try again, and restart the robot when it persists", kResettable},
    {1550, "LIST_VARIABLES_ERR", "the variables could not be listed", "the variable service failed", "",
     "try again, and restart the robot when it persists", kResettable},
    {1551, "GET_VARIABLE_ERR", "a variable could not be read", "there is no variable of that name or id", "",
     "create the variable before it is read", kResettable},
    {1552, "CREATE_VARIABLE_ERR", "a variable could not be created",
     "the name or cyclic id is taken or illegal, or the value is no number", "",
     "choose another name, or a free id in 10000..19999", kResettable},
    {1553, "DELETE_VARIABLE_ERR", "a variable could not be deleted", "there is no variable of that name", "",
     "check the name", kResettable},
    {1554, "SET_VARIABLE_ERR", "a variable could not be set", "it does not exist, or the value has another type", "",
     "create the variable first and keep its type", kResettable},
    {2072, "MASTERING_ALREADY_DONE", "mastering has been done already", "mastering was asked for again", "",
     "leave it, or ask the vendor's support how to override it", kResettable},
    {2601, "REGISTER_CMD_FAILURE", "an internal command could not be registered or removed",
     "the robot's program service refused it", "", "try again, and restart the robot when it persists", kResettable},
    // The robot itself.
    {3001, "USER_ALREADY", "another client is connected to the robot", "the text interface serves one client at a time",
     "close the other connection", "", kPermanent},
    {3003, "CMD_TOO_LONG", "a text command is too long", "a missing end of line or NUL", "", "shorten the command",
     kResettable},
    {3005, "ERROR_MOTION", "the motion failed", "a collision, a blocked joint or an overload",
     "free the arm, check payload and path", "", kResettable},
    {3006, "ERROR_DRIVE_COMM", "the robot lost contact with its drives", "an internal fault, or supply trouble",
     "power the robot off and on again; contact the vendor's support when it persists", "", kPermanent},
    {3009, "INIT_FAILED", "the robot did not start up properly", "an internal fault at boot",
     "power the robot off and on again; contact the vendor's support when it persists", "", kPermanent},
    {3014, "CANT_SAVE_PROGRAM", "a program could not be saved", "no space, or a storage fault", "",
     "delete programs that are not needed and save again", kResettable},
    {3017, "PROGRAM_NOT_FOUND", "there is no such program", "StartProgram with an unknown number or name", "",
     "check the program's cyclic id in the robot", kResettable},
    {3020, "PROGRAM_INVALID", "the program cannot be run", "it holds mistakes", "",
     "correct the program and save it again", kResettable},
    {3023, "PROGRAM_RECURSION", "the program would call itself", "a chain of program calls comes back to its start", "",
     "break the chain of calls", kResettable},
    {3024, "SELF_DIAG_FAILED", "the self-test found a hardware fault", "defective hardware",
     "take the robot out of service and contact the vendor's support", "", kPermanent},
    {3025, "ERROR_GRIPPER", "the gripper reports a fault", "it is blocked, overheated or badly connected",
     "free and check the gripper", "home again", kResettable},
    {3026, "MAINTENANCE_CHECK", "the robot found a hardware problem and asks for maintenance",
     "a part wears out or measures out of its tolerance", "contact the vendor's support", "", kResettable},
    {3027, "INTERNAL_ERROR", "an unexpected internal error", "a fault inside the robot's firmware",
     "save the robot's log for the vendor's support", "", kResettable},
    {3029, "TORQUE_LIMIT_ERROR", "a joint exceeded its torque limit",
     "contact with something, too much payload, or a limit set too low",
     "free the arm, check payload and torque limits", "", kResettable},
    {3031, "TEXT_API_ERROR", "an earlier text command was wrong", "a client on the text interface sent a bad command",
     "", "find it in the robot's log and correct that client", kResettable},
    {3033, "NO_VALID_CFG", "the robot has no valid configuration", "its configuration data is damaged",
     "contact the vendor's support", "", kPermanent},
    {3037, "ERROR_VBOX", "the pneumatic module reports a fault", "the module or its cable is defective",
     "check the module and its cable", "", kResettable},
    {3039, "EXT_TOOL_NEED_UPDATE", "the external tool needs newer firmware", "tool and robot firmware do not match",
     "update the tool's firmware with the robot's web interface", "", kPermanent},
    {3041, "COLLISION_ERROR", "the move was stopped before a collision",
     "arm, tool and surroundings as configured would touch", "",
     "choose another path, or correct the tool sphere and the collision settings", kResettable},
    {3042, "FW_NEED_REINSTALL", "the firmware must be installed again", "an update was interrupted or is damaged",
     "install the firmware again", "", kPermanent},
    {3043, "EXT_TOOL_COMM_ERR", "the contact with the external tool is bad", "a loose or damaged tool cable",
     "check the cable and the plug", "", kResettable},
    {3044, "EXT_PORT_COMM_ERR", "the contact on the external port is bad",
     "a loose or damaged cable at the external port", "check the cable and the plug", "", kResettable},
    {3046, "PSU_ERROR", "the power supply reports a permanent fault",
     "a defect or a wiring mistake in the safety circuit", "check the wiring and power the supply off and on again", "",
     kPermanent},
    {3047, "FAILED_TO_MOUNT_EMMC_SD", "the robot cannot read its internal storage", "a defective storage",
     "contact the vendor's support", "", kPermanent},
    {3049, "WORK_ZONE_ERROR", "the robot reached the edge of its work zone", "a path leaves the configured zone", "",
     "choose another path or widen the work zone", kResettable},
    {3050, "PSU_POWER_LOSS", "the power supply lost its input power", "mains interrupted",
     "restore the power and start the robot again", "", kPermanent},
    {3051, "DURATION_TOO_SHORT_ERROR", "the move cannot be done in the requested time",
     "the move duration is too short", "", "allow more time, or lower the severity of SetMoveDurationCfg", kResettable},
    {3052, "WRONG_MOVE_MODE_ERROR", "the move does not fit the present move mode",
     "a move that time-based mode does not offer", "", "switch with SetMoveMode before the move", kResettable},
};

static_assert(std::size(kErrors) == 75);
static_assert(std::ranges::adjacent_find(kErrors, std::ranges::greater_equal{}, &ErrorInfo::code) ==
              std::ranges::end(kErrors));

}  // namespace

std::span<const ErrorInfo> error_codes() noexcept { return kErrors; }

const ErrorInfo* find_error_code(std::uint16_t code) noexcept {
  const auto found = std::ranges::lower_bound(kErrors, code, {}, &ErrorInfo::code);
  return found != std::ranges::end(kErrors) && found->code == code ? found : nullptr;
}

std::string remedy_text(const ErrorInfo& error, std::string_view reset) {
  std::string text(error.remedy);
  if (!error.resettable) return text;
  for (const std::string_view part : {reset, error.afterwards}) {
    if (!part.empty()) text += (text.empty() ? "" : ", then ") + std::string(part);
  }
  return text;
}

}  // namespace meca::image
