#include "bridge/dds.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "bridge/dds_vendor.hpp"

namespace meca::dds {
namespace {

using vendor::fdds::DataReader;
using vendor::fdds::DataReaderQos;
using vendor::fdds::DataWriter;
using vendor::fdds::DataWriterQos;
using vendor::fdds::DomainParticipant;
using vendor::fdds::DomainParticipantFactory;
using vendor::fdds::DomainParticipantQos;
using vendor::fdds::Publisher;
using vendor::fdds::Subscriber;
using vendor::fdds::Topic;
using vendor::fdds::TypeSupport;

// Lost samples of a reliable state topic are noticed at the next heartbeat; the vendor's 3 s is an age for a robot.
constexpr std::chrono::milliseconds kHeartbeatPeriod{100};

// The last complaint of the middleware, so that an error can say more than "refused". Its own printing is off:
// what concerns the user becomes an exception or a counter, the rest is noise.
class LastComplaint final : public vendor::fdds::LogConsumer {
 public:
  void Consume(const vendor::fdds::Log::Entry& entry) override {
    if (entry.kind != vendor::fdds::Log::Error) return;
    const std::lock_guard lock(mutex());
    text() = entry.message;
  }
  static void forget() {
    vendor::fdds::Log::Flush();
    const std::lock_guard lock(mutex());
    text().clear();
  }
  static std::string sentence() {
    vendor::fdds::Log::Flush();
    const std::lock_guard lock(mutex());
    return text().empty() ? "" : " (Fast DDS says: " + text() + ")";
  }
  static void install() {
    static std::once_flag once;
    std::call_once(once, [] {
      mutex(), text();  // constructed before, so destroyed after, the vendor's log thread uses them
      vendor::fdds::Log::ClearConsumers();
      vendor::fdds::Log::SetVerbosity(vendor::fdds::Log::Error);
      vendor::fdds::Log::RegisterConsumer(std::make_unique<LastComplaint>());
    });
  }

 private:
  static std::mutex& mutex() {
    static auto& m = *new std::mutex;  // never destroyed: the log thread may outlive static destruction
    return m;
  }
  static std::string& text() {
    static auto& t = *new std::string;
    return t;
  }
};

std::vector<std::string> own_addresses() {
  std::vector<std::string> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = {};
    const auto* address = reinterpret_cast<const sockaddr_in*>(i->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof text) != nullptr) found.emplace_back(text);
  }
  freeifaddrs(list);
  return found;
}

// The vendor opens a participant that reaches nobody when an address is wrong; better to say so.
void check_interfaces(const std::vector<std::string>& wanted) {
  const auto own = own_addresses();
  for (const auto& address : wanted) {
    if (std::find(own.begin(), own.end(), address) != own.end()) continue;
    std::string list;
    for (const auto& a : own) list += (list.empty() ? "" : ", ") + a;
    throw Error("DDS interface " + address + " is not an IPv4 address of this machine; it has " + list);
  }
}

DomainParticipantQos participant_qos(const ParticipantOptions& options) {
  DomainParticipantQos qos;
  qos.name(options.name.c_str());
  vendor::keep_types_private(qos);
  if (!options.interfaces.empty() || !options.shared_memory) {
    auto udp = std::make_shared<vendor::UdpTransport>();
    for (const auto& address : options.interfaces) udp->interfaceWhiteList.emplace_back(address);
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    if (options.shared_memory)
      qos.transport().user_transports.push_back(std::make_shared<vendor::SharedMemTransport>());
  }
  return qos;
}

vendor::Duration duration(std::chrono::nanoseconds time) {
  time = std::max(time, std::chrono::nanoseconds(0));
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time);
  return {static_cast<std::int32_t>(seconds.count()), static_cast<std::uint32_t>((time - seconds).count())};
}

// The vendor's default of at most 10 instances would lose the eleventh robot.
void limit(const Qos& wanted, vendor::fdds::ResourceLimitsQosPolicy& limits) {
  limits.max_instances = wanted.max_instances > 0 ? wanted.max_instances : vendor::kUnlimited;
  limits.max_samples = vendor::kUnlimited;
  limits.max_samples_per_instance = wanted.depth > 0 ? wanted.depth : std::max(wanted.max_samples, 0);
  limits.allocated_samples = 1;  // more come when they are needed, and stay
}

// Writers and readers take the same policies.
template <typename EntityQos>
void apply(const Qos& wanted, EntityQos& qos) {
  using namespace vendor::fdds;
  qos.reliability().kind =
      wanted.reliability == Reliability::kReliable ? RELIABLE_RELIABILITY_QOS : BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      wanted.durability == Durability::kTransientLocal ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
  qos.history().kind = wanted.depth > 0 ? KEEP_LAST_HISTORY_QOS : KEEP_ALL_HISTORY_QOS;
  if (wanted.depth > 0) qos.history().depth = wanted.depth;
  limit(wanted, qos.resource_limits());
  if (wanted.lifespan.count() > 0) qos.lifespan().duration = duration(wanted.lifespan);
  qos.endpoint().history_memory_policy = vendor::kPreallocatedWithRealloc;
  qos.data_sharing().off();  // it would bypass the choice of transports, and a stopped reader could be overrun
}

// What readers and writers keep alive: entities go before their participant, whatever the order of destruction.
struct Core {
  explicit Core(const ParticipantOptions& options) {
    LastComplaint::install();
    if (options.domain < 0 || options.domain > 232) {
      throw Error("DDS domain " + std::to_string(options.domain) + " does not exist; use 0 to 232");
    }
    check_interfaces(options.interfaces);
    LastComplaint::forget();
    const auto qos = participant_qos(options);
    participant = DomainParticipantFactory::get_instance()->create_participant(vendor::DomainId(options.domain), qos);
    if (participant != nullptr) {
      publisher = participant->create_publisher(vendor::fdds::PUBLISHER_QOS_DEFAULT);
      subscriber = participant->create_subscriber(vendor::fdds::SUBSCRIBER_QOS_DEFAULT);
    }
    if (publisher == nullptr || subscriber == nullptr) {
      close();
      throw Error("DDS participant '" + options.name + "' could not be opened on domain " +
                  std::to_string(options.domain) + LastComplaint::sentence());
    }
  }
  ~Core() { close(); }
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  void close() noexcept {
    if (participant == nullptr) return;
    participant->delete_contained_entities();
    DomainParticipantFactory::get_instance()->delete_participant(participant);
    participant = nullptr;
  }

  Topic* topic(const std::string& name, TypeSupport type) {
    const std::lock_guard lock(mutex);
    auto& entry = topics[name];
    if (entry == nullptr) {
      LastComplaint::forget();
      if (!vendor::ok(type.register_type(participant)) ||
          (entry = participant->create_topic(name, type.get_type_name(), vendor::fdds::TOPIC_QOS_DEFAULT)) == nullptr) {
        throw Error("DDS topic '" + name + "' of type " + type.get_type_name() + " could not be created" +
                    LastComplaint::sentence());
      }
    } else if (entry->get_type_name() != type.get_type_name()) {
      throw Error("DDS topic '" + name + "' already has the type " + entry->get_type_name() + ", not " +
                  type.get_type_name());
    }
    return entry;
  }

  DomainParticipant* participant = nullptr;
  Publisher* publisher = nullptr;
  Subscriber* subscriber = nullptr;
  std::mutex mutex;  // guards topics and readers
  std::map<std::string, Topic*> topics;
  std::vector<DataReader*> readers;
  vendor::fdds::WaitSet waitset;
};

}  // namespace

namespace detail {

struct WriterImpl {
  std::shared_ptr<Core> core;
  DataWriter* writer;
  WriterImpl(std::shared_ptr<Core> c, DataWriter* w) : core(std::move(c)), writer(w) {}
  ~WriterImpl() { core->publisher->delete_datawriter(writer); }
  WriterImpl(const WriterImpl&) = delete;
  WriterImpl& operator=(const WriterImpl&) = delete;
};

struct ReaderImpl {
  std::shared_ptr<Core> core;
  DataReader* reader;
  ReaderImpl(std::shared_ptr<Core> c, DataReader* r) : core(std::move(c)), reader(r) {
    reader->get_statuscondition().set_enabled_statuses(vendor::fdds::StatusMask::data_available());
    core->waitset.attach_condition(reader->get_statuscondition());
    const std::lock_guard lock(core->mutex);
    core->readers.push_back(reader);
  }
  ~ReaderImpl() {
    core->waitset.detach_condition(reader->get_statuscondition());
    {
      const std::lock_guard lock(core->mutex);
      std::erase(core->readers, reader);
    }
    core->subscriber->delete_datareader(reader);
  }
  ReaderImpl(const ReaderImpl&) = delete;
  ReaderImpl& operator=(const ReaderImpl&) = delete;
};

bool write(WriterImpl& writer, const void* sample) noexcept {
  // 2.9 takes void* and does not write to it.
  return vendor::ok(writer.writer->write(const_cast<void*>(sample), vendor::fdds::InstanceHandle_t()));
}

int matched(const WriterImpl& writer) noexcept {
  vendor::fdds::PublicationMatchedStatus status;
  writer.writer->get_publication_matched_status(status);
  return status.current_count;
}

int matched(const ReaderImpl& reader) noexcept {
  vendor::fdds::SubscriptionMatchedStatus status;
  reader.reader->get_subscription_matched_status(status);
  return status.current_count;
}

bool take(ReaderImpl& reader, void* sample, SampleInfo& info) noexcept {
  vendor::fdds::SampleInfo vendor_info;
  if (!vendor::ok(reader.reader->take_next_sample(sample, &vendor_info))) return false;
  info.valid_data = vendor_info.valid_data;
  info.source_time_ns = vendor_info.source_timestamp.to_ns();
  // The handle of a publication is the GUID of its writer, and begins with the participant's prefix.
  for (std::size_t i = 0; i < info.participant.size(); ++i) {
    info.participant[i] = std::byte{vendor_info.publication_handle.value[i]};
  }
  return true;
}

}  // namespace detail

struct Participant::Impl {
  std::shared_ptr<Core> core;

  std::shared_ptr<detail::WriterImpl> make_writer(const std::string& name, const TypeSupport& type, const Qos& wanted) {
    Topic* topic = core->topic(name, type);
    DataWriterQos qos;
    apply(wanted, qos);
    vendor::set_heartbeat_period(qos, duration(kHeartbeatPeriod));
    LastComplaint::forget();
    DataWriter* writer = core->publisher->create_datawriter(topic, qos);
    if (writer == nullptr) {
      throw Error("DDS writer for '" + name + "' could not be created" + LastComplaint::sentence());
    }
    return std::make_shared<detail::WriterImpl>(core, writer);
  }

  std::shared_ptr<detail::ReaderImpl> make_reader(const std::string& name, const TypeSupport& type, const Qos& wanted) {
    Topic* topic = core->topic(name, type);
    DataReaderQos qos;
    apply(wanted, qos);
    LastComplaint::forget();
    DataReader* reader = core->subscriber->create_datareader(topic, qos);
    if (reader == nullptr) {
      throw Error("DDS reader for '" + name + "' could not be created" + LastComplaint::sentence());
    }
    return std::make_shared<detail::ReaderImpl>(core, reader);
  }
};

Participant::Participant(const ParticipantOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->core = std::make_shared<Core>(options);
}
Participant::~Participant() = default;

bool Participant::wait_for_data(std::chrono::nanoseconds timeout) {
  Core& core = *impl_->core;
  {
    // A status condition is cleared by the first take, not by the last: what is left over has no condition.
    const std::lock_guard lock(core.mutex);
    for (const DataReader* reader : core.readers) {
      if (reader->get_unread_count() > 0) return true;
    }
  }
  vendor::fdds::ConditionSeq active;
  return vendor::ok(core.waitset.wait(active, duration(timeout)));
}

ParticipantId Participant::id() const noexcept {
  ParticipantId prefix{};
  const auto& value = impl_->core->participant->guid().guidPrefix.value;
  for (std::size_t i = 0; i < prefix.size(); ++i) prefix[i] = std::byte{value[i]};
  return prefix;
}

// One line per topic type of idl/; its type support is the generated class of the same name.
#define MECA_TOPIC_TYPE(Type)                                                                                   \
  template <>                                                                                                   \
  Writer<meca500::Type> Participant::create_writer(const std::string& topic, const Qos& qos) {                  \
    return Writer<meca500::Type>(impl_->make_writer(topic, TypeSupport(new meca500::Type##PubSubType()), qos)); \
  }                                                                                                             \
  template <>                                                                                                   \
  Reader<meca500::Type> Participant::create_reader(const std::string& topic, const Qos& qos) {                  \
    return Reader<meca500::Type>(impl_->make_reader(topic, TypeSupport(new meca500::Type##PubSubType()), qos)); \
  }

MECA_TOPIC_TYPE(RobotStatus)
MECA_TOPIC_TYPE(MotionStatus)
MECA_TOPIC_TYPE(TargetJointSet)
MECA_TOPIC_TYPE(TargetEndEffectorPose)
MECA_TOPIC_TYPE(TargetConfiguration)
MECA_TOPIC_TYPE(TargetWrf)
MECA_TOPIC_TYPE(TargetTrf)
MECA_TOPIC_TYPE(RobotTimestamp)
MECA_TOPIC_TYPE(SafetyStatus)
MECA_TOPIC_TYPE(DynamicData)
MECA_TOPIC_TYPE(CyclicState)
MECA_TOPIC_TYPE(RobotControl)
MECA_TOPIC_TYPE(MotionControl)
MECA_TOPIC_TYPE(MotionCommand)
MECA_TOPIC_TYPE(HostTime)
MECA_TOPIC_TYPE(BrakesControl)
MECA_TOPIC_TYPE(DynamicDataConfiguration)
MECA_TOPIC_TYPE(Command)
MECA_TOPIC_TYPE(CommandReceipt)
MECA_TOPIC_TYPE(VelocityCommand)
MECA_TOPIC_TYPE(ControlLease)
MECA_TOPIC_TYPE(ControlStatus)
MECA_TOPIC_TYPE(BridgeStatus)
#undef MECA_TOPIC_TYPE

}  // namespace meca::dds
