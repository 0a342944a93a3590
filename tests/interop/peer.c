#include "tests/interop/peer.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failure_count;

void check(bool ok, const char* sentence, ...) {
  va_list arguments;
  va_start(arguments, sentence);
  printf(ok ? "ok:     " : "FAILED: ");
  vprintf(sentence, arguments);
  printf("\n");
  fflush(stdout);
  va_end(arguments);
  failure_count += !ok;
}

int failures(void) { return failure_count; }

void pause_ms(int ms) { dds_sleepfor(DDS_MSECS(ms)); }
double seconds_now(void) { return (double)dds_time() / 1e9; }

static dds_entity_t must(dds_entity_t entity, const char* what) {
  if (entity < 0) {
    fprintf(stderr, "Cyclone DDS could not make %s: %s\n", what, dds_strretcode(entity));
    exit(2);
  }
  return entity;
}

dds_entity_t open_participant(int domain) {
  return must(dds_create_participant((dds_domainid_t)domain, NULL, NULL), "a participant");
}

dds_entity_t open_reader(dds_entity_t participant, const dds_topic_descriptor_t* type, const char* name,
                         enum ReaderKind kind) {
  const dds_entity_t topic = must(dds_create_topic(participant, type, name, NULL, NULL), name);
  if (kind == DEFAULT_READER) return must(dds_create_reader(participant, topic, NULL, NULL), name);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  if (kind == KEEP_EVERYTHING_READER) dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  const dds_entity_t reader = must(dds_create_reader(participant, topic, qos, NULL), name);
  dds_delete_qos(qos);
  return reader;
}

bool take(dds_entity_t reader, void* sample) {
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) > 0) {
    if (info.valid_data) return true;
  }
  return false;
}

bool wait_for_bridge(dds_entity_t participant, uint64_t cycles) {
  const dds_entity_t reader = OPEN_READER(participant, BridgeStatus, DEFAULT_READER);
  meca500_BridgeStatus* status = meca500_BridgeStatus__alloc();
  bool up = false;
  for (const double end = seconds_now() + 30; !up && seconds_now() < end; pause_ms(10)) {
    while (take(reader, status))
      up = up || (status->link == meca500_LINK_UP && status->firmware_known && status->cycles >= cycles);
  }
  check(up, "the bridge says that the link to %s is up and its firmware known", ROBOT);
  meca500_BridgeStatus_free(status, DDS_FREE_ALL);
  dds_delete(reader);
  return up;
}

static dds_entity_t open_writer(dds_entity_t participant, const dds_topic_descriptor_t* type, const char* name) {
  const dds_entity_t topic = must(dds_create_topic(participant, type, name, NULL, NULL), name);
  return must(dds_create_writer(participant, topic, NULL, NULL), name);
}

static bool is_matched(dds_entity_t writer) {
  dds_publication_matched_status_t status;
  return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK && status.current_count > 0;
}

Client open_client(dds_entity_t participant, const char* name) {
  Client client = {.name = name};
  client.commands = open_writer(participant, &meca500_Command_desc, "meca500/Command");
  client.lease = open_writer(participant, &meca500_ControlLease_desc, "meca500/ControlLease");
  client.receipts = OPEN_READER(participant, CommandReceipt, KEEP_EVERYTHING_READER);
  bool matched = false;
  for (const double end = seconds_now() + 30; !matched && seconds_now() < end; pause_ms(10))
    matched = is_matched(client.commands) && is_matched(client.lease);
  check(matched, "the bridge's readers of Command and ControlLease match Cyclone's default writers");
  return client;
}

void renew_lease(Client* client) {
  meca500_ControlLease lease = {.robot = ROBOT, .sequence_number = ++client->lease_sequence};
  snprintf(lease.client, sizeof lease.client, "%s", client->name);
  dds_write(client->lease, &lease);
}

uint64_t send_command(Client* client, meca500_CommandKind kind, uint32_t motion_command_id, const double* arguments,
                      uint32_t argument_count, bool report_completion) {
  double copy[6] = {0};
  if (argument_count > 0) memcpy(copy, arguments, argument_count * sizeof copy[0]);
  meca500_Command command = {.robot = ROBOT,
                             .command_id = ++client->last_id,
                             .kind = kind,
                             .motion_command_id = motion_command_id,
                             .arguments = {._maximum = 6, ._length = argument_count, ._buffer = copy},
                             .report_completion = report_completion};
  snprintf(command.client, sizeof command.client, "%s", client->name);
  const dds_return_t result = dds_write(client->commands, &command);
  if (result != DDS_RETCODE_OK) check(false, "Cyclone writes a Command: %s", dds_strretcode(result));
  return command.command_id;
}
