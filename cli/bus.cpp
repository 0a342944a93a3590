#include "cli/bus.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>

namespace meca::cli {

std::atomic<bool> interrupted{false};

namespace {

constexpr std::size_t kLongestClient = 63;  // string<63> in control.idl

std::string client_name(const Invocation& call) {
  if (!call.client.empty()) return call.client;
  std::array<char, 64> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host = {'?'};
  const std::string pid = ":" + std::to_string(getpid());
  std::string name = "meca-ctl@" + std::string(host.data());
  return name.substr(0, kLongestClient - pid.size()) + pid;
}

dds::ParticipantOptions options(const Invocation& call) {
  return {call.domain, "meca-ctl", call.interfaces, call.shared_memory};
}

}  // namespace

Bus::Bus(const Invocation& call)
    : domain_(call.domain), prefix_(call.prefix), client_(client_name(call)), participant_(options(call)) {}

std::string Bus::where() const { return "DDS domain " + std::to_string(domain_) + ", topics '" + prefix_ + "'"; }

const bridge::TopicConfig& Bus::qos_of(std::string_view topic) {
  return std::ranges::find(bridge::kTopics, topic, &bridge::TopicInfo::name)->defaults;
}

}  // namespace meca::cli
