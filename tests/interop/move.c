// A client of another vendor takes control, activates, homes and moves the robot, and what it sees is what the model
// holds: forward kinematics of TargetJointSet equals TargetEndEffectorPose. A late joiner then gets the same state.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/interop/kinematics.h"
#include "tests/interop/peer.h"

static const double kTrf[6] = {10, -20, 30, 40, 50, -60};
static const double kWrf[6] = {100, 50, -25, 10, -15, 20};
static const double kTarget[6] = {30, 20, -10, 15, 40, -25};

typedef struct {
  Client client;
  dds_entity_t joints, poses, cyclic;
  size_t pairs, cyclic_samples;  // compared so far
  double worst_mm, worst_deg, least_joint, most_joint;
  Frame wrf, trf;
  uint64_t from_cycle;  // compared from here on: the frames are in force; 0 = not yet
} Observer;

static Frame frame_of(const double p[6]) { return frame_from_pose(p[0], p[1], p[2], p[3], p[4], p[5]); }

static void compare(Observer* o, const float joints[6], const meca500_TargetEndEffectorPose* p) {
  const Frame expected = frame_multiply(frame_inverse(o->wrf), frame_multiply(forward_kinematics(joints), o->trf));
  const Frame seen = frame_from_pose(p->x, p->y, p->z, p->alpha, p->beta, p->gamma);
  o->worst_mm = fmax(o->worst_mm, distance_mm(expected, seen));
  o->worst_deg = fmax(o->worst_deg, distance_deg(expected, seen));
  o->least_joint = fmin(o->least_joint, joints[0]);
  o->most_joint = fmax(o->most_joint, joints[0]);
}

static bool is_compared(const Observer* o, const meca500_Header* header) {
  return o->from_cycle > 0 && header->cycle > o->from_cycle;
}

// Pairs TargetJointSet and TargetEndEffectorPose of the same bus cycle; both topics are written at the same pace.
static void observe(Observer* o) {
  enum { kRemembered = 256 };
  static meca500_TargetJointSet recent[kRemembered];
  static size_t count;
  while (take(o->joints, &recent[count % kRemembered])) ++count;
  meca500_TargetEndEffectorPose pose;
  while (take(o->poses, &pose)) {
    for (size_t i = count > kRemembered ? count - kRemembered : 0; i < count && is_compared(o, &pose.header); ++i) {
      const meca500_TargetJointSet* joints = &recent[i % kRemembered];
      if (joints->header.cycle != pose.header.cycle) continue;
      compare(o, joints->joints, &pose);
      ++o->pairs;
    }
  }
  static meca500_CyclicState* state;
  if (state == NULL) state = meca500_CyclicState__alloc();
  while (take(o->cyclic, state)) {
    if (!is_compared(o, &state->header)) continue;
    compare(o, state->target_joint_set.joints, &state->target_end_effector_pose);
    ++o->cyclic_samples;
  }
}

// Waits for the terminal receipt of a command, renewing the lease; the states must come in their order, once each.
static meca500_CommandReceipt finish(Observer* o, uint64_t id, const char* what) {
  meca500_CommandReceipt receipt, last = {0};
  int highest = -1;
  bool in_order = true, terminal = false;
  for (const double end = seconds_now() + 40; !terminal && seconds_now() < end; pause_ms(5)) {
    renew_lease(&o->client);
    observe(o);
    while (take(o->client.receipts, &receipt)) {
      if (receipt.command_id != id || strcmp(receipt.client, o->client.name) != 0) continue;
      in_order = in_order && !terminal && (int)receipt.state > highest;
      highest = (int)receipt.state;
      terminal = receipt.state >= meca500_COMPLETED;
      last = receipt;
    }
  }
  check(in_order, "%s: receipts come in order, the terminal one last", what);
  check(terminal && last.state == meca500_COMPLETED, "%s ends as COMPLETED (state %d, reason %d: %s)", what,
        (int)last.state, (int)last.reason, last.text);
  return last;
}

static void do_action(Observer* o, meca500_CommandKind kind, const char* what) {
  finish(o, send_command(&o->client, kind, 0, NULL, 0, false), what);
}

// Returns the bus cycle in which it was completed.
static uint64_t do_motion(Observer* o, uint32_t id, const double arguments[6], const char* what) {
  return finish(o, send_command(&o->client, meca500_MOTION, id, arguments, 6, true), what).cycle;
}

static void check_motion(const Observer* o) {
  check(o->pairs >= 20, "TargetJointSet and TargetEndEffectorPose of the same cycle were compared (%zu pairs)",
        o->pairs);
  check(o->cyclic_samples >= 20, "CyclicState was compared (%zu samples)", o->cyclic_samples);
  check(o->least_joint < 5 && o->most_joint > 25, "the joints were seen moving (joint 1 from %.2f to %.2f)",
        o->least_joint, o->most_joint);
  check(o->worst_mm < 1e-3, "FK(TargetJointSet) = TargetEndEffectorPose in position (worst %.6f mm)", o->worst_mm);
  check(o->worst_deg < 1e-3, "FK(TargetJointSet) = TargetEndEffectorPose in orientation (worst %.6f deg)",
        o->worst_deg);
}

// Waits for the first sample of a durable reader that satisfies `wanted`; the last value stays in `sample`.
#define AWAIT(participant, name, sample, wanted)                                           \
  do {                                                                                     \
    const dds_entity_t reader = OPEN_READER(participant, name, DURABLE_READER);            \
    bool seen = false;                                                                     \
    for (const double end = seconds_now() + 20; !seen && seconds_now() < end; pause_ms(5)) \
      while (!seen && take(reader, &(sample))) seen = (wanted);                            \
    check(seen, "a late joiner sees " #name ": " #wanted);                                 \
    dds_delete(reader);                                                                    \
  } while (0)

static bool near(double a, double b) { return fabs(a - b) < 1e-3; }

static bool is_frame(const float* seen, const double expected[6]) {
  for (int i = 0; i < 6; ++i)
    if (!near(seen[i], expected[i])) return false;
  return true;
}

static bool stops_are_clear(const meca500_StopSignals* s) { return !s->e_stop && !s->p_stop1 && !s->p_stop2; }

// cs = front/back of axis 1, ce = elbow up/down, cw = sign of joint 5 (spec: from the geometry).
static bool is_posture(const meca500_TargetConfiguration* c) {
  const double rad = 3.14159265358979323846 / 180, q2 = kTarget[1] * rad, q23 = (kTarget[1] + kTarget[2]) * rad;
  const int cs = 135 * sin(q2) + 38 * sin(q23) + 120 * cos(q23) > 0 ? 1 : -1;
  return c->shoulder == cs && c->elbow == (kTarget[2] > -72.43 ? 1 : -1) && c->wrist == (kTarget[4] > 0 ? 1 : -1) &&
         c->turn == 0;
}

static bool are_joint_positions(const meca500_DynamicData* d) {
  if (d->type_id != meca500_DynamicDataType_JOINT_POS || d->values._length != 6) return false;
  for (uint32_t i = 0; i < 6; ++i) {
    // Actual positions carry the idle noise of the real robot, about 0.001 degrees.
    if (fabs(d->values._buffer[i].value - kTarget[i]) > 0.1 || strcmp(d->values._buffer[i].unit, "deg") != 0)
      return false;
  }
  return true;
}

// Everything is at rest: a participant that joins now learns the whole state from what was written before it came.
static void check_late_joiner(int domain) {
  const dds_entity_t p = open_participant(domain);
  meca500_RobotStatus robot;
  AWAIT(p, RobotStatus, robot, robot.activated && robot.homed && !robot.busy && robot.error_code == 0);
  meca500_MotionStatus motion;
  AWAIT(p, MotionStatus, motion,
        motion.eob && motion.eom && !motion.paused && motion.fifo_space == 13000 && motion.move_id != 0);
  meca500_TargetJointSet joints;
  AWAIT(p, TargetJointSet, joints, is_frame(joints.joints, kTarget));
  meca500_TargetConfiguration posture;
  AWAIT(p, TargetConfiguration, posture, is_posture(&posture));
  meca500_TargetWrf wrf;
  AWAIT(p, TargetWrf, wrf, is_frame(&wrf.x, kWrf));
  meca500_TargetTrf trf;
  AWAIT(p, TargetTrf, trf, is_frame(&trf.x, kTrf));
  meca500_RobotTimestamp time;
  AWAIT(p, RobotTimestamp, time,
        time.microseconds < 1000000 && time.header.robot_time_us == time.seconds * 1000000ull + time.microseconds);
  meca500_SafetyStatus safety;
  AWAIT(p, SafetyStatus, safety, safety.known && stops_are_clear(&safety.stop));
  meca500_DynamicData* dynamic = meca500_DynamicData__alloc();
  AWAIT(p, DynamicData, *dynamic, are_joint_positions(dynamic));
  meca500_DynamicData_free(dynamic, DDS_FREE_ALL);
  meca500_RobotControl control;
  AWAIT(p, RobotControl, control, !control.activate && !control.home_robot && !control.deactivate);
  meca500_MotionControl moving;
  AWAIT(p, MotionControl, moving, moving.move_id == motion.move_id && !moving.clear_motion);
  meca500_MotionCommand command;
  AWAIT(p, MotionCommand, command, command.motion_command_id != meca500_MotionCommandId_NO_MOVEMENT);
  meca500_HostTime host;
  AWAIT(p, HostTime, host, host.header.quality == meca500_GOOD);
  meca500_BrakesControl brakes;
  AWAIT(p, BrakesControl, brakes, !brakes.brakes_control_allowed);
  meca500_DynamicDataConfiguration slots;
  AWAIT(p, DynamicDataConfiguration, slots, slots.header.quality == meca500_GOOD);
  meca500_ControlStatus owner;
  AWAIT(p, ControlStatus, owner, owner.owned == false && strcmp(owner.last_owner, "cyclone-move") == 0);
  meca500_CommandReceipt receipt;
  AWAIT(p, CommandReceipt, receipt, receipt.state == meca500_COMPLETED && strcmp(receipt.client, "cyclone-move") == 0);
  meca500_BridgeStatus* bridge = meca500_BridgeStatus__alloc();
  AWAIT(p, BridgeStatus, *bridge, bridge->commands_received >= 6 && bridge->commands_rejected == 0);
  meca500_BridgeStatus_free(bridge, DDS_FREE_ALL);
  dds_delete(p);
}

int main(int argc, char** argv) {
  const int domain = argc > 1 ? atoi(argv[1]) : 0;
  const dds_entity_t participant = open_participant(domain);
  if (!wait_for_bridge(participant, 1)) return 1;

  Observer o = {.client = open_client(participant, "cyclone-move"), .wrf = frame_of(kWrf), .trf = frame_of(kTrf)};
  o.joints = OPEN_READER(participant, TargetJointSet, KEEP_EVERYTHING_READER);
  o.poses = OPEN_READER(participant, TargetEndEffectorPose, KEEP_EVERYTHING_READER);
  o.cyclic = OPEN_READER(participant, CyclicState, KEEP_EVERYTHING_READER);

  do_action(&o, meca500_TAKE_CONTROL, "TAKE_CONTROL");
  do_action(&o, meca500_ACTIVATE, "ACTIVATE");
  do_action(&o, meca500_HOME, "HOME");
  do_motion(&o, meca500_MotionCommandId_SET_TRF, kTrf, "SET_TRF");
  o.from_cycle = do_motion(&o, meca500_MotionCommandId_SET_WRF, kWrf, "SET_WRF");
  do_motion(&o, meca500_MotionCommandId_MOVE_JOINTS, kTarget, "MOVE_JOINTS");
  check_motion(&o);
  do_action(&o, meca500_RELEASE_CONTROL, "RELEASE_CONTROL");

  check_late_joiner(domain);
  dds_delete(participant);
  return failures() == 0 ? 0 : 1;
}
