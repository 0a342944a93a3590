// A participant of another vendor, with that vendor's default QoS, started late: it gets every topic of the bridge.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/interop/peer.h"

typedef struct {
  const char* name;
  const char* topic;
  const dds_topic_descriptor_t* type;
  size_t header;  // offset of the header in the sample; 0 = none
  dds_entity_t reader;
  void* sample;  // the first one that arrived
  bool arrived;
} Topic;

static Topic topics[] = {
#define SECTION(name) \
  {#name, "meca500/" #name, &meca500_##name##_desc, offsetof(meca500_##name, header), 0, NULL, false},
#define OTHER(name) {#name, "meca500/" #name, &meca500_##name##_desc, 0, 0, NULL, false},
    SECTION_TOPICS(SECTION) OTHER_TOPICS(OTHER)};
static const size_t topic_count = sizeof topics / sizeof topics[0];

static size_t arrived_count(void) {
  size_t count = 0;
  for (size_t i = 0; i < topic_count; ++i) {
    Topic* t = &topics[i];
    if (!t->arrived) t->arrived = take(t->reader, t->sample);
    count += t->arrived;
  }
  return count;
}

static void check_topic(const Topic* t) {
  check(t->arrived, "%s reaches a Cyclone reader with default QoS that came late", t->name);
  if (!t->arrived) return;
  check(strcmp(t->sample, ROBOT) == 0, "%s names its robot", t->name);  // the key comes first in every type
  if (t->header == 0) return;
  const meca500_Header* header = (const meca500_Header*)((const char*)t->sample + t->header);
  check(header->quality == meca500_GOOD, "%s is marked GOOD", t->name);
  check(header->cycle > 0, "%s carries its bus cycle", t->name);
  check(header->robot_time_us > 0, "%s carries the robot's time", t->name);
  const double age = seconds_now() - (double)header->receive_time_ns / 1e9;
  check(age > -1 && age < 120, "%s carries a receive time in Unix nanoseconds", t->name);
}

int main(int argc, char** argv) {
  const int domain = argc > 1 ? atoi(argv[1]) : 0;
  const dds_entity_t first = open_participant(domain);
  if (!wait_for_bridge(first, 200)) return 1;

  const dds_entity_t participant = open_participant(domain);
  for (size_t i = 0; i < topic_count; ++i) {
    Topic* t = &topics[i];
    t->reader = open_reader(participant, t->type, t->topic, DEFAULT_READER);
    t->sample = dds_alloc(t->type->m_size);
  }

  // Receipts are events: there is one to see once somebody has asked for something. Asked again until the readers
  // match.
  Client client = open_client(participant, "cyclone-every-topic");
  double next_command = 0;
  for (const double end = seconds_now() + 30; arrived_count() < topic_count && seconds_now() < end; pause_ms(5)) {
    if (seconds_now() < next_command) continue;
    send_command(&client, meca500_TAKE_CONTROL, 0, NULL, 0, false);
    send_command(&client, meca500_RELEASE_CONTROL, 0, NULL, 0, false);
    next_command = seconds_now() + 0.5;
  }

  for (size_t i = 0; i < topic_count; ++i) {
    check_topic(&topics[i]);
    dds_sample_free(topics[i].sample, topics[i].type, DDS_FREE_ALL);
  }
  dds_delete(participant);
  dds_delete(first);
  return failures() == 0 ? 0 : 1;
}
