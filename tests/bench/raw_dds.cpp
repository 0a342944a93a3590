#include "tests/bench/raw_dds.hpp"

#include <time.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "bridge/dds_vendor.hpp"
#include "idl/types.hpp"
#include "tests/bench/clock.hpp"

namespace meca::bench {
namespace {

namespace fdds = eprosima::fastdds::dds;

template <typename T, typename Support>
long write_at_rate(const RawWriterOptions& options, const char* topic_name) {
  auto* participant = fdds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(options.domain), fdds::PARTICIPANT_QOS_DEFAULT);
  if (participant == nullptr) throw std::runtime_error("raw Fast DDS: no participant");
  fdds::TypeSupport type(new Support());
  type.register_type(participant);
  auto* topic = participant->create_topic(topic_name, type.get_type_name(), fdds::TOPIC_QOS_DEFAULT);
  auto* publisher = participant->create_publisher(fdds::PUBLISHER_QOS_DEFAULT);
  // The QoS of the bridge's own writers, so that the same reader work is asked for.
  fdds::DataWriterQos qos;
  qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = fdds::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 1;
  qos.endpoint().history_memory_policy = dds::vendor::kPreallocatedWithRealloc;
  qos.data_sharing().off();
  qos.resource_limits().max_instances = dds::vendor::kUnlimited;
  qos.resource_limits().max_samples = dds::vendor::kUnlimited;
  qos.resource_limits().max_samples_per_instance = 1;
  qos.resource_limits().allocated_samples = 1;
  auto* writer = publisher->create_datawriter(topic, qos);
  if (writer == nullptr) throw std::runtime_error("raw Fast DDS: no writer");

  std::vector<T> samples(static_cast<std::size_t>(options.instances));
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].robot(("raw" + std::to_string(i)).c_str());

  const long ticks = std::chrono::duration_cast<std::chrono::milliseconds>(options.duration).count();
  const double per_tick = options.writes_per_second / 1000.0;
  long written = 0;
  auto deadline = monotonic_now();
  for (long tick = 1; tick <= ticks; ++tick) {
    deadline += std::chrono::milliseconds(1);
    sleep_until(deadline);
    for (const long due = static_cast<long>(static_cast<double>(tick) * per_tick); written < due; ++written) {
      T& sample = samples[static_cast<std::size_t>(written) % samples.size()];
      sample.header().cycle(static_cast<std::uint64_t>(tick));
      sample.header().receive_time_ns(unix_now_ns());
      writer->write(&sample, fdds::InstanceHandle_t());
    }
  }
  participant->delete_contained_entities();
  fdds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  return written;
}

}  // namespace

long run_raw_writer(const RawWriterOptions& options) {
  return options.whole_image
             ? write_at_rate<meca500::CyclicState, meca500::CyclicStatePubSubType>(options, "meca500/CyclicState")
             : write_at_rate<meca500::TargetEndEffectorPose, meca500::TargetEndEffectorPosePubSubType>(
                   options, "meca500/TargetEndEffectorPose");
}

}  // namespace meca::bench
