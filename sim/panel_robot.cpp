// What people may do to a simulated robot itself: its buttons, errors, its surroundings, and questions.
#include <algorithm>

#include "sim/motion_queue.hpp"
#include "sim/panel_table.hpp"
#include "transports/image/error_codes.hpp"

namespace meca::sim {
namespace {

using Kind = PanelAnswer::Kind;

void release_e_stop(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  robot.release_e_stop();
  const bool waits = robot.stops().e_stop == StopSignal::kResettable;
  done(answer, waits ? "E-Stop released; the power supply waits for 'press reset'" : "E-Stop released");
}

void press_reset(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  const StopSignals stops = robot.stops();
  if (stops.e_stop == StopSignal::kPresent) {
    return refused(answer, "Reset does nothing while the E-Stop is pressed; 'release e-stop' first");
  }
  if (stops.e_stop == StopSignal::kReset && stops.reboot == StopSignal::kReset) {
    return refused(answer,
                   "there is nothing to reset: neither a released E-Stop nor a reboot waits for the Reset button");
  }
  robot.press_reset_button();
  done(answer, "Reset pressed, no E-Stop and no reboot stops the robot any more");
}

void place_part(Robot& robot, const PanelRequest& request, PanelAnswer& answer) noexcept {
  if (!robot.place_part(request.numbers[0])) {
    return refused(
        answer,
        "no part fits: there is no gripper (transport.tool, meca-sim --tool), or it is not open wider than the part");
  }
  done(answer, request.numbers[0] > 0 ? "the part is between the fingers" : "there is no part between the fingers");
}

void release_p_stop2(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  robot.release_p_stop2();
  const bool waits = robot.stops().p_stop2 == StopSignal::kResettable;
  done(answer, waits ? "P-Stop 2 released; the host has to resume motion" : "P-Stop 2 is not pressed");
}

void restore_connection(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  robot.restore_connection();
  const bool waits = robot.stops().connection_dropped == StopSignal::kResettable;
  done(answer, waits ? "connection restored; the host has to resume motion" : "the connection is not dropped");
}

void raise_error(Robot& robot, const PanelRequest& request, PanelAnswer& answer) noexcept {
  if (robot.inputs().robot_status.error_code != 0) {
    return refused(answer, "the robot is in error already and shows the first cause only; reset that error first");
  }
  robot.raise_error(static_cast<std::uint16_t>(request.numbers[0]));
  done(answer, "the robot is in error");
}

std::string known_code(const PanelRequest& request) {
  const auto code = static_cast<std::uint16_t>(request.numbers[0]);
  if (image::find_error_code(code) != nullptr) return {};
  return std::to_string(code) + " is no error code of the Meca500 that any document names; try 1007, joint over limit";
}

void status(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  const image::Inputs& in = robot.inputs();
  const Journal& journal = robot.journal();
  answer.kind = Kind::kStatus;
  answer.status = {.stops = robot.stops(),
                   .present = robot.present(),
                   .monitoring = robot.monitoring(),
                   .activated = in.robot_status.activated,
                   .homed = in.robot_status.homed,
                   .error = in.robot_status.error_code,
                   .queued = static_cast<std::uint16_t>(MotionQueue::kCapacity - in.motion_status.fifo_space),
                   .executed = journal.count(Outcome::kExecuted),
                   .discarded = journal.count(Outcome::kDiscarded),
                   .refused = journal.count(Outcome::kRefused),
                   .violations = robot.violations().size()};
}

template <class Entry>
void list(const Log<Entry>& log, std::uint64_t wanted, std::array<Entry, PanelAnswer::kMostListed>& out,
          PanelAnswer& answer) noexcept {
  answer.total = log.size();
  answer.listed = static_cast<std::size_t>(std::min(wanted, log.size() - log.first()));
  for (std::size_t i = 0; i < answer.listed; ++i) out[i] = log[log.size() - answer.listed + i];
}

void journal(Robot& robot, const PanelRequest& request, PanelAnswer& answer) noexcept {
  answer.kind = Kind::kJournal;
  list(robot.journal(), static_cast<std::uint64_t>(request.numbers[0]), answer.commands, answer);
}

void violations(Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
  answer.kind = Kind::kViolations;
  list(robot.violations(), PanelAnswer::kMostListed, answer.violations, answer);
}

constexpr Number kCode[] = {{"CODE", 0, 65535, Number::Form::kWhole}};
constexpr Number kWidth[] = {{"MM", 0, 1000}};
constexpr Number kPush[] = {{"JOINT", 1, 6, Number::Form::kWhole}, {"PERCENT", -1000, 1000}};
constexpr Number kSphere[] = {{"X", -1000, 1000}, {"Y", -1000, 1000}, {"Z", -1000, 1000}, {"RADIUS", 1, 1000}};
constexpr Number kHowMany[] = {{"N", 1, PanelAnswer::kMostListed, Number::Form::kWhole, 10}};

// One row a word. Words of one beginning stand together, and one that has all words of another comes before it.
constexpr Row kRows[] = {
    {"press e-stop",
     {},
     "the emergency stop: the motors lose their power",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.press_e_stop();
       done(answer, "E-Stop pressed");
     }},
    {"press reset", {}, "the Reset button on the power supply of an R4, after the E-Stop was released", press_reset},
    {"press p-stop2",
     {},
     "the protective stop P-Stop 2",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.press_p_stop2();
       done(answer, "P-Stop 2 pressed");
     }},
    {"release e-stop", {}, "an R4 then waits for the Reset button", release_e_stop},
    {"release p-stop2", {}, "the host then has to resume motion", release_p_stop2},
    {"drop connection",
     {},
     "the safety stop 'connection dropped'; the bus itself goes on",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.drop_connection();
       done(answer, "connection dropped");
     }},
    {"restore connection", {}, "the host then has to resume motion", restore_connection},
    {"raise error", kCode, "any error code of the robot, e.g. 1007", raise_error, known_code},
    {"power cycle",
     {},
     "power fails and comes back: the robot is away until it has started up",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.power_cycle();
       done(answer, "the robot starts up");
     }},
    {"place part", kWidth, "a part of this width between the fingers of the gripper, 0 takes it away", place_part},
    {"place obstacle", kSphere,
     "a sphere (mm, base frame) that the robot sees coming; it minds it with SetCollisionCfg",
     [](Robot& robot, const PanelRequest& r, PanelAnswer& answer) noexcept {
       robot.place_obstacle(r.numbers[0], r.numbers[1], r.numbers[2], r.numbers[3]);
       done(answer, "the obstacle is there");
     }},
    {"remove obstacle",
     {},
     "takes it away",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.place_obstacle(0, 0, 0, 0);
       done(answer, "there is no obstacle");
     }},
    {"push joint", kPush,
     "an outside force, as torque in percent of what the motor can give; stays until changed, 0 ends it",
     [](Robot& robot, const PanelRequest& r, PanelAnswer& answer) noexcept {
       robot.push(static_cast<int>(r.numbers[0]), r.numbers[1]);
       done(answer, r.numbers[1] != 0 ? "somebody pushes the joint" : "nobody pushes the joint");
     }},
    {"monitoring on",
     {},
     "the robot ignores what this host sends",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.set_monitoring(true);
       done(answer, "the robot only lets this host watch");
     }},
    {"monitoring off",
     {},
     "the robot obeys this host again",
     [](Robot& robot, const PanelRequest&, PanelAnswer& answer) noexcept {
       robot.set_monitoring(false);
       done(answer, "the robot listens to this host");
     }},
    {"status", {}, "what is pressed, error, queue, counts", status},
    {"violations", {}, "the rules of the protocol that the host broke", violations},
    {"journal", kHowMany, "the last N commands (10) and what became of them", journal},
    {"help",
     {},
     "these words",
     [](Robot&, const PanelRequest&, PanelAnswer& answer) noexcept { answer.kind = Kind::kHelp; }},
};

}  // namespace

std::span<const Row> robot_rows() noexcept { return kRows; }

}  // namespace meca::sim
