// Not activated, not homed, paused, held, full: what people and programs did.
#include "tests/unit/stops/situation.hpp"

namespace meca::test {
namespace {

using image::Layout;
using enum CommandKind;

CycleSettings with_supervisor() {
  CycleSettings s;
  s.clients.clients[0] = {ClientName("supervisor"), false, 10, std::nullopt};
  s.clients.count = 1;
  return s;
}

// Halfway through what the owner asked for.
std::function<void(Cell&)> under_way(CommandKind kind, bool ready_first) {
  return [kind, ready_first](Cell& c) {
    ready_first ? c.make_ready() : c.connect();
    if (kind == kHome) c.outcome(kActivate);
    c.send(kind);
    c.steps(30);
  };
}

void supervisor_takes_over(Cell& c) {
  c.make_ready();
  c.owner_moves();
  CommandRequest request = c.request(kTakeControl);
  request.client = ClientName("supervisor");
  request.participant = participant(7);
  c.send(request);
  for (std::uint64_t i = 1; i < 700; ++i) {
    c.pending.push_back(LeaseRenewal{request.client, request.participant, i});
    c.step();
  }
  c.steps(500);  // and then it is switched off
}

// A robot that is busy for `seconds`, and has not one free place behind that.
std::function<void(Cell&)> full_queue(double seconds) {
  return [seconds](Cell& c) {
    c.make_ready();
    c.send(c.motion(image::kDelay, {seconds}));
    ASSERT_TRUE(c.until(
        [&] {
          if (c.pending.empty() && c.result->record.inputs.motion_status.fifo_space > 0) {
            c.send(c.motion(image::kSetBlending, {50}));
          }
          return c.result->record.inputs.motion_status.fifo_space == 0;
        },
        400'000));
    c.policy = LossPolicy::kFinishMotion;
    c.outcome(kReleaseControl);
    c.steps(5);
  };
}

std::vector<Situation> on_the_way_to_ready() {
  return {
      {"the_robot_is_cold",
       [](Cell& c) {
         c.connect();
         c.steps(5);
       },
       "the robot is not activated: its motors are off",
       "'meca-ctl activate', then 'meca-ctl home'",
       {},
       robot()},
      {"the_robot_is_cold_on_firmware_9",
       [](Cell& c) {
         c.connect();
         c.steps(5);
       },
       "the robot is not activated: its motors are off",
       "'meca-ctl activate', then 'meca-ctl home' (safety stops are not reported by this firmware",
       {},
       robot(Layout::kFirmware9)},
      {"the_robot_is_being_activated",
       under_way(kActivate, false),
       "the robot is being activated",
       "wait until it is, then 'meca-ctl home'; 'cell-plc' has control",
       {},
       robot()},
      {"the_robot_is_being_homed",
       under_way(kHome, false),
       "the robot is being homed",
       "wait until it is done",
       {},
       robot()},
      {"the_robot_is_being_deactivated",
       under_way(kDeactivate, true),
       "the robot is being deactivated",
       "wait; then 'meca-ctl activate'",
       {},
       robot()},
      {"the_robot_is_activated_but_not_homed",
       [](Cell& c) {
         c.connect();
         c.meca_ctl("activate");
         c.steps(5);
       },
       "the robot is not homed",
       "keep clear of the arm, then 'meca-ctl home'",
       {},
       robot()},
      {"the_motors_were_switched_off_by_somebody",
       [](Cell& c) {
         c.make_ready();
         c.meca_ctl("deactivate");
         c.steps(5);
       },
       "the robot is not activated: its motors are off",
       "'meca-ctl activate'",
       {},
       robot()},
  };
}

std::vector<Situation> paused() {
  return {
      {"the_program_in_control_has_paused_it",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.outcome(kPauseMotion);
         c.steps(200);
       },
       "the bridge holds the robot (PauseMotion is set)",
       "'meca-ctl resume'; 'cell-plc' has control: command from there, or let it release control first",
       {},
       robot()},
      {"the_program_in_control_has_paused_it_and_is_asked_to_let_go",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.outcome(kPauseMotion);
         c.steps(200);
       },
       "the bridge holds the robot (PauseMotion is set)",
       "'meca-ctl resume'; 'cell-plc' has control: command from there, or let it release control first",
       {},
       robot(),
       {},
       true},
      {"a_person_has_paused_it_and_gone",
       [](Cell& c) {
         c.make_ready();
         c.meca_ctl("pause");
         c.steps(50);
       },
       "the bridge holds the robot (PauseMotion is set): 'meca-ctl@bench:3' paused it",
       "'meca-ctl resume'",
       {},
       robot()},
      {"a_person_has_paused_it_on_firmware_9",
       [](Cell& c) {
         c.make_ready();
         c.meca_ctl("pause");
         c.steps(50);
       },
       "the bridge holds the robot (PauseMotion is set)",
       "'meca-ctl resume'",
       {},
       robot(Layout::kFirmware9)},
      {"a_person_has_emptied_the_queue",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.policy = LossPolicy::kFinishMotion;
         c.outcome(kTakeControl);
         c.outcome(kReleaseControl);
         c.meca_ctl("clear");
         c.steps(50);
       },
       "motion is paused and the queue was cleared",
       "'meca-ctl resume'",
       {},
       robot()},
      {"the_queue_is_full",
       full_queue(60),
       "the robot's motion queue is full",
       "wait until it has worked off some of it, or 'meca-ctl clear'",
       {{"wait until it has worked off some of it", [](Cell& c) { c.steps(60'000); }}},
       robot()},
      {"the_queue_is_full_and_the_person_does_not_want_to_wait",
       full_queue(3600),
       "the robot's motion queue is full",
       "wait until it has worked off some of it, or 'meca-ctl clear'",
       {},
       robot()},
  };
}

std::vector<Situation> owner_gone() {
  return {
      {"the_owner_died_while_the_robot_moved",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.kill_owner();
         c.steps(1000);
       },
       "the bridge holds the robot (PauseMotion is set): 'cell-plc' did not renew its lease",
       "'meca-ctl resume'",
       {},
       robot()},
      {"the_owner_died_while_the_robot_moved_on_firmware_9",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.kill_owner();
         c.steps(1000);
       },
       "the bridge holds the robot (PauseMotion is set): 'cell-plc' did not renew its lease",
       "'meca-ctl resume'",
       {},
       robot(Layout::kFirmware9)},
      {"the_owner_died_while_the_robot_stood",
       [](Cell& c) {
         c.make_ready();
         c.outcome(kTakeControl);
         c.kill_owner();
         c.steps(1000);
       },
       "the bridge holds the robot (PauseMotion is set): 'cell-plc' did not renew its lease",
       "'meca-ctl resume'",
       {},
       robot()},
      {"the_bridge_is_just_clearing_the_queue_of_a_dead_owner",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.kill_owner();
         ASSERT_TRUE(c.until([&] { return c.out.motion_control.clear_motion; }));
       },
       "the bridge is clearing the robot's queue (ClearMotion is set)",
       "wait until it is done, then 'meca-ctl resume'",
       {},
       robot()},
      {"the_owner_let_go_with_motion_queued",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.outcome(kReleaseControl);
         c.steps(1000);
       },
       "the bridge holds the robot (PauseMotion is set): 'cell-plc' paused it or left it with motion queued, and "
       "released control",
       "'meca-ctl resume'",
       {},
       robot()},
      {"a_supervisor_took_over_and_was_switched_off",
       supervisor_takes_over,
       "the bridge holds the robot (PauseMotion is set): 'supervisor' did not renew its lease",
       "'meca-ctl resume'",
       {},
       robot(),
       with_supervisor()},
      {"the_owner_died_and_the_motors_were_switched_off",
       [](Cell& c) {
         c.make_ready();
         c.owner_moves();
         c.kill_owner();
         c.steps(1000);
         c.meca_ctl("deactivate");
         c.steps(5);
       },
       "the robot is not activated: its motors are off",
       "'meca-ctl activate'",
       {},
       robot()},
  };
}

}  // namespace

std::vector<Situation> motion_situations() {
  std::vector<Situation> all = on_the_way_to_ready();
  for (const auto& part : {paused(), owner_gone()}) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace meca::test
