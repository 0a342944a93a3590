// A client of the bridge on Cyclone DDS: a participant, readers and a command writer, and checks that speak in
// sentences.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "bridge.h"
#include "control.h"
#include "dds/dds.h"
#include "meca500.h"

// Every topic the bridge publishes: X(name). The first are sections with a header, the rest have none.
#define SECTION_TOPICS(X)  \
  X(RobotStatus)           \
  X(MotionStatus)          \
  X(TargetJointSet)        \
  X(TargetEndEffectorPose) \
  X(TargetConfiguration)   \
  X(TargetWrf)             \
  X(TargetTrf)             \
  X(RobotTimestamp)        \
  X(SafetyStatus)          \
  X(DynamicData)           \
  X(CyclicState)           \
  X(RobotControl) X(MotionControl) X(MotionCommand) X(HostTime) X(BrakesControl) X(DynamicDataConfiguration)
#define OTHER_TOPICS(X) X(BridgeStatus) X(ControlStatus) X(CommandReceipt)

#define ROBOT "arm1"

// A failed check is printed and counted; the program goes on, so that one run shows everything.
void check(bool ok, const char* sentence, ...) __attribute__((format(printf, 2, 3)));
int failures(void);

void pause_ms(int ms);
double seconds_now(void);

dds_entity_t open_participant(int domain);

// Readers. `durable`: RELIABLE, TRANSIENT_LOCAL, as a late joiner asks for; else Cyclone's default: best effort,
// volatile.
enum ReaderKind { DEFAULT_READER, DURABLE_READER, KEEP_EVERYTHING_READER };
dds_entity_t open_reader(dds_entity_t participant, const dds_topic_descriptor_t* type, const char* name,
                         enum ReaderKind kind);
#define OPEN_READER(participant, name, kind) open_reader(participant, &meca500_##name##_desc, "meca500/" #name, kind)

// Takes the oldest sample; false when there is none with data.
bool take(dds_entity_t reader, void* sample);

// Waits until the bridge says that the robot's link is up and `cycles` cycles are behind it.
bool wait_for_bridge(dds_entity_t participant, uint64_t cycles);

// Control of the robot, with the sign of life that it needs.
typedef struct {
  dds_entity_t commands, lease, receipts;
  const char* name;
  uint64_t last_id, lease_sequence;
} Client;
Client open_client(dds_entity_t participant, const char* name);
void renew_lease(Client* client);
// Sends and returns the command's id.
uint64_t send_command(Client* client, meca500_CommandKind kind, uint32_t motion_command_id, const double* arguments,
                      uint32_t argument_count, bool report_completion);
