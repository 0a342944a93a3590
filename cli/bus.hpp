// Where meca-ctl stands on the DDS bus: one participant, the topic prefix, and the name it appears under.
#pragma once

#include <atomic>
#include <string>

#include "bridge/dds.hpp"
#include "bridge/topics.hpp"
#include "cli/invocation.hpp"

namespace meca::cli {

// Set by SIGINT and SIGTERM; every loop that waits looks at it.
extern std::atomic<bool> interrupted;

class Bus {
 public:
  explicit Bus(const Invocation& call);  // throws dds::Error

  // State comes as late joiner too: the last value of every robot. `depth` samples per robot are kept until taken.
  template <typename Sample>
  dds::Reader<Sample> latest(std::string_view topic, int depth = 1) {
    return participant_.create_reader<Sample>(name(topic),
                                              {dds::Reliability::kReliable, dds::Durability::kTransientLocal, depth});
  }
  template <typename Sample>
  dds::Reader<Sample> from_now_on(std::string_view topic, int depth) {
    return participant_.create_reader<Sample>(name(topic),
                                              {dds::Reliability::kBestEffort, dds::Durability::kVolatile, depth});
  }
  // With the QoS the bridge reads the topic with: command topics are reliable, streams best effort.
  template <typename Sample>
  dds::Writer<Sample> writer(std::string_view topic) {
    const bool reliable = qos_of(topic).reliable;
    return participant_.create_writer<Sample>(name(topic),
                                              {reliable ? dds::Reliability::kReliable : dds::Reliability::kBestEffort,
                                               dds::Durability::kVolatile, reliable ? 16 : 1});
  }

  bool wait(std::chrono::nanoseconds timeout) { return participant_.wait_for_data(timeout); }
  const std::string& client() const { return client_; }
  std::string where() const;  // "DDS domain 0, topics 'meca500/'", for sentences

 private:
  std::string name(std::string_view topic) const { return prefix_ + std::string(topic); }
  static const bridge::TopicConfig& qos_of(std::string_view topic);

  int domain_;
  std::string prefix_;
  std::string client_;
  dds::Participant participant_;
};

}  // namespace meca::cli
