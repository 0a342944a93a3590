// The vendor's headers, and the few places where Fast DDS 2.9 (Debian 12) and 3 (Debian 13) differ. For dds.cpp only.
#pragma once

#if __has_include(<fastdds/config.hpp>)
#define MECA_FAST_DDS_3 1
#else
#define MECA_FAST_DDS_3 0
#endif

#include <cstdint>
#include <fastdds/dds/core/condition/StatusCondition.hpp>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/core/status/StatusMask.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#if MECA_FAST_DDS_3
#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.hpp>

#include "idl/bridgePubSubTypes.hpp"
#include "idl/controlPubSubTypes.hpp"
#include "idl/meca500PubSubTypes.hpp"
#else
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>

#include "idl/bridgePubSubTypes.h"
#include "idl/controlPubSubTypes.h"
#include "idl/meca500PubSubTypes.h"
#endif

namespace meca::dds::vendor {

namespace fdds = eprosima::fastdds::dds;

// Resource limits: -1 is the documented value, but 2.9 counts it as a limit of minus one instance.
inline constexpr std::int32_t kUnlimited = 0;
using DomainId = std::uint32_t;
using UdpTransport = eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using SharedMemTransport = eprosima::fastdds::rtps::SharedMemTransportDescriptor;

#if MECA_FAST_DDS_3
using Duration = eprosima::fastdds::dds::Duration_t;
inline constexpr auto kPreallocatedWithRealloc = eprosima::fastdds::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
inline bool ok(eprosima::fastdds::dds::ReturnCode_t code) { return code == eprosima::fastdds::dds::RETCODE_OK; }
inline void set_heartbeat_period(fdds::DataWriterQos& qos, Duration period) {
  qos.reliable_writer_qos().times.heartbeat_period = period;
}
// 3 describes its types during discovery, 2.9 does not. Cyclone 0.10.5 finds 3.1's description of our types (seen with
// BridgeStatus) not assignable to its own and silently does not match; without one it goes by the type's name.
inline void keep_types_private(fdds::DomainParticipantQos& qos) {
  qos.properties().properties().emplace_back(fdds::parameter_policy_type_propagation, "disabled");
}
#else
using Duration = eprosima::fastrtps::Duration_t;
inline constexpr auto kPreallocatedWithRealloc = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
inline bool ok(const eprosima::fastrtps::types::ReturnCode_t& code) {
  return code == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;
}
inline void set_heartbeat_period(fdds::DataWriterQos& qos, Duration period) {
  qos.reliable_writer_qos().times.heartbeatPeriod = period;
}
inline void keep_types_private(fdds::DomainParticipantQos&) {}
#endif

}  // namespace meca::dds::vendor
