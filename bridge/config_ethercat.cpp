#include "bridge/config_ethercat.hpp"

#include <algorithm>
#include <string>

#include "bridge/config_values.hpp"
#include "transports/ethercat/master.hpp"

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;
using ethercat::Master;
using std::chrono::nanoseconds;

constexpr std::string_view kInterface = "the name of a network interface as 'ip link' shows it, e.g. eth1";
// Register 0420 counts 100 us in 16 bits.
constexpr nanoseconds kShortestWatchdog = 1ms, kLongestWatchdog = 6553500us;
constexpr int kCyclesPerWatchdog = 3;  // fewer, and one late frame would stop the robot
// A general purpose system is late by some 10 ms now and then; a robot that is left alone should notice it soon.
constexpr nanoseconds kTightWatchdog = 40ms, kLazyWatchdog = 5s;

// They have one cycle, or the configuration is wrong anyway.
std::vector<const RobotConfig*> robots_on(const std::string& interface, const std::vector<RobotConfig>& robots) {
  std::vector<const RobotConfig*> out;
  for (const RobotConfig& robot : robots) {
    if (robot.type == TransportType::kEthercat && robot.ethercat.interface == interface) out.push_back(&robot);
  }
  return out;
}

void check_watchdog(const Section& segment, nanoseconds cycle, nanoseconds watchdog) {
  const std::string given = to_string(watchdog) + (segment.find("watchdog") == nullptr ? " (the default)" : "");
  if (watchdog < kCyclesPerWatchdog * cycle) {
    segment.report().error(segment.mark("watchdog"), segment.path("watchdog"),
                           given + " is less than " + std::to_string(kCyclesPerWatchdog) + " cycles of " +
                               to_string(cycle) + "; write " + to_string(kCyclesPerWatchdog * cycle) + " or more");
  } else if (watchdog < kTightWatchdog || watchdog > kLazyWatchdog) {
    segment.report().warning(
        segment.mark("watchdog"), segment.path("watchdog"),
        given + (watchdog > kLazyWatchdog
                     ? ": the robot notices only then that the bridge is gone; 5s or less is better"
                     : ": one hiccup of this machine stops the robots; from 40ms on it suits a system that is not "
                       "real-time"));
  }
}

void check_use(const Section& segment, const EthercatSegmentConfig& config, const std::vector<RobotConfig>& robots) {
  Report& report = segment.report();
  const auto users = robots_on(config.interface, robots);
  if (users.empty()) {
    report.warning(segment.mark("interface"), segment.path("interface"),
                   "no robot names '" + config.interface + "'; the segment is not opened");
    return;
  }
  check_watchdog(segment, users.front()->cycle, config.watchdog);
  if (config.dc && config.dc_shift >= users.front()->cycle) {
    report.error(segment.mark("dc_shift"), segment.path("dc_shift"),
                 to_string(config.dc_shift) + " is not shorter than the cycle of " + to_string(users.front()->cycle));
  }
}

void check_ring(const Section& segment, const EthercatSegmentConfig& config, const std::vector<RobotConfig>& robots) {
  const std::string& back = config.redundant_interface;
  if (back.empty()) return;
  if (config.dc) {
    segment.report().error(segment.mark("dc"), segment.path("dc"),
                           "distributed clocks and a ring do not go together in this version; leave one of them out");
  }
  if (back == config.interface) {
    segment.report().error(segment.mark("redundant_interface"), segment.path("redundant_interface"),
                           "'" + back + "' is the segment's interface already; a ring needs a second one");
  } else if (const auto users = robots_on(back, robots); !users.empty()) {
    segment.report().error(segment.mark("redundant_interface"), segment.path("redundant_interface"),
                           "'" + back + "' is where this ring comes back, but '" + users.front()->name +
                               "' names it as its interface; write '" + config.interface + "' there");
  }
}

EthercatSegmentConfig read_segment(const Section& segment) {
  EthercatSegmentConfig out;
  segment.require("interface", "interface: eth1");
  segment.text("interface", kInterface, config_values::is_interface_name, out.interface);
  segment.text("redundant_interface", kInterface, config_values::is_interface_name, out.redundant_interface);
  segment.flag("dc", out.dc);
  if (segment.duration("dc_shift", 0ns, kLongestEthercatCycle, out.dc_shift) && out.dc_shift > 0ns && !out.dc) {
    segment.report().warning(segment.mark("dc_shift"), segment.path("dc_shift"),
                             "is not used without distributed clocks; write 'dc: true' as well");
  }
  segment.duration("watchdog", kShortestWatchdog, kLongestWatchdog, out.watchdog);
  segment.flag("separate", out.separate);
  return out;
}

// An interface belongs to one segment, at either end of it.
void check_same(const Section& segment, const EthercatSegmentConfig& config,
                const std::vector<EthercatSegmentConfig>& others) {
  const auto taken = [&others](const std::string& name) {
    return !name.empty() && std::ranges::any_of(others, [&](const EthercatSegmentConfig& other) {
      return other.interface == name || other.redundant_interface == name;
    });
  };
  for (const auto& [key, name] :
       {std::pair("interface", config.interface), std::pair("redundant_interface", config.redundant_interface)}) {
    if (!taken(name)) continue;
    segment.report().error(segment.mark(key), segment.path(key),
                           "'" + name + "' is in a segment above already; an interface belongs to one");
  }
}

std::vector<EthercatSegmentConfig> read_given(const Section& section, const std::vector<RobotConfig>& robots) {
  constexpr std::string_view kExpected = "a list of up to 64 segments, e.g. [{interface: eth1, watchdog: 100ms}]";
  std::vector<EthercatSegmentConfig> out;
  const auto elements = section.list("segments", 64, kExpected);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string path = section.path("segments") + "[" + std::to_string(i) + "]";
    if (elements[i].kind != yaml::Kind::kMap) {
      section.report().unexpected(elements[i], path, "a segment, e.g. {interface: eth1, watchdog: 100ms}");
      continue;
    }
    const Section segment(&elements[i], elements[i].mark, path, "ethercat.segments[]", section.report());
    EthercatSegmentConfig config = read_segment(segment);
    if (config.interface.empty()) continue;
    check_same(segment, config, out);
    check_use(segment, config, robots);
    check_ring(segment, config, robots);
    out.push_back(std::move(config));
  }
  return out;
}

}  // namespace

std::vector<EthercatSegmentConfig> read_ethercat_segments(const Section& root, const std::vector<RobotConfig>& robots) {
  const Section section = root.child("ethercat", "ethercat");
  const std::vector<EthercatSegmentConfig> given = read_given(section, robots);
  std::vector<EthercatSegmentConfig> out;
  for (const RobotConfig& robot : robots) {
    const std::string& interface = robot.ethercat.interface;
    if (robot.type != TransportType::kEthercat || interface.empty()) continue;
    if (std::ranges::find(out, interface, &EthercatSegmentConfig::interface) != out.end()) continue;
    const auto settings = std::ranges::find(given, interface, &EthercatSegmentConfig::interface);
    EthercatSegmentConfig segment;
    segment.interface = interface;
    out.push_back(settings != given.end() ? *settings : segment);
    const std::size_t count = robots_on(interface, robots).size();
    if (count <= Master::kMostRobots) continue;
    section.report().error(root.mark("robots"), "robots",
                           std::to_string(count) + " robots are on '" + interface + "', a segment has at most " +
                               std::to_string(Master::kMostRobots) + "; put some on another interface");
  }
  return out;
}

void read_ethercat(const Section& transport, EthercatConfig& out) {
  transport.require("interface", "interface: eth1");
  transport.text("interface", kInterface, config_values::is_interface_name, out.interface);
  transport.integer("position", 0, Master::kMostDevices - 1, out.position);
  std::uint16_t alias = 0;
  if (transport.integer("alias", 1, 65535, alias)) out.alias = alias;
  if (out.alias && transport.find("position") != nullptr) {
    transport.report().error(transport.mark("alias"), transport.path("alias"),
                             "stands in place of a position; leave one of them out");
  }
}

}  // namespace meca::bridge
