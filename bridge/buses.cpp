#include "bridge/buses.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "sim/robot.hpp"
#include "transports/builtin/builtin.hpp"
#include "transports/ethercat/transport.hpp"
#include "transports/ethernet_ip/transport.hpp"
#include "transports/net/ipv4.hpp"
#include "transports/panel/control_panel.hpp"

namespace meca::bridge {
namespace {

sim::ToolType tool_of(const std::string& name) {
  if (name == "MEGP25E") return sim::ToolType::kMegp25e;
  if (name == "MEGP25LS") return sim::ToolType::kMegp25ls;
  if (name == "MPM500") return sim::ToolType::kMpm500;
  return sim::ToolType::kNone;
}

sim::RobotOptions model_of(const RobotConfig& robot) {
  const auto& config = robot.builtin;
  const auto version = parse_firmware(config.firmware).value_or(transports::FirmwareVersion{});
  sim::RobotOptions options;
  options.product = config.product == "R3" ? sim::Product::kMeca500R3 : sim::Product::kMeca500R4;
  options.layout = image::layout_of(version.major).value_or(image::Layout::kFirmware11);
  options.firmware_minor = version.minor;
  options.firmware_patch = version.patch;
  if (version.build != 0) options.firmware_build = version.build;
  options.serial_number = config.serial_number;
  options.noise = config.noise;
  options.tool = tool_of(config.tool);
  options.variables = sim::example_variables();
  options.seed = config.serial_number;
  // One millisecond, not none: what takes no time at all shows no Busy, and clients wait for its end.
  if (config.instant_homing) {
    options.activation_time = options.homing_time = options.deactivation_time = std::chrono::milliseconds(1);
    options.boot_time = std::chrono::milliseconds(100);  // long enough for the link to be seen down
  }
  return options;
}

// How often the robot sends an image.
Time image_period(const RobotConfig& robot) {
  return robot.type == TransportType::kEthernetIp ? std::max(robot.cycle, robot.ethernet_ip.rpi) : robot.cycle;
}

CycleSettings settings_of(const RobotConfig& robot, std::endian byte_order) {
  CycleSettings settings;
  settings.cycle = robot.cycle;
  settings.byte_order = byte_order;
  settings.lease = robot.control.lease;
  settings.velocity_lease = robot.control.velocity_lease;
  settings.stale_after = 3 * image_period(robot);
  settings.monitoring_only = !robot.control.enabled;
  settings.allow_brakes = robot.control.allow_brakes;
  settings.clients = robot.control.clients;
  settings.firmware = robot.firmware;
  settings.dynamic_data = robot.dynamic_data;
  return settings;
}

Time monotonic() { return std::chrono::steady_clock::now().time_since_epoch(); }

// Without it the robot works all the same; only its buttons cannot be pressed.
std::unique_ptr<transports::ControlPanel> open_panel(const RobotConfig& robot, const DdsConfig& dds) {
  const std::string& socket = robot.builtin.control_socket;
  if (socket == "off") return nullptr;
  try {
    std::filesystem::path path = socket;
    if (socket == "auto") path = transports::default_control_socket(dds.domain, dds.topic_prefix, robot.name);
    auto panel = std::make_unique<transports::ControlPanel>(std::move(path));
    spdlog::info("{}: the simulated robot's buttons are at {}", robot.name, panel->socket().string());
    return panel;
  } catch (const std::runtime_error& error) {
    spdlog::warn("{}: no control socket, its buttons cannot be pressed: {}", robot.name, error.what());
    return nullptr;
  }
}

// Every robot has a bus of its own here: no network joins built-in robots.
LoopBus open_builtin(const RobotConfig& robot, const DdsConfig& dds, RobotChannel& channel) {
  LoopBus bus;
  std::vector<std::unique_ptr<transports::ControlPanel>> panels;
  panels.push_back(open_panel(robot, dds));
  bus.transport = transports::make_builtin({model_of(robot)}, std::move(panels));
  bus.transport->open(monotonic());
  bus.robots.push_back({settings_of(robot, bus.transport->byte_order()), &channel});
  return bus;
}

ethernet_ip::RobotOptions options_of(const RobotConfig& robot) {
  const EthernetIpConfig& config = robot.ethernet_ip;
  return {.address = config.address,
          .tcp_port = config.tcp_port,
          .rpi_us = static_cast<std::uint32_t>(image_period(robot) / std::chrono::microseconds(1)),
          .timeout_multiplier = config.timeout_multiplier,
          .multicast = config.multicast,
          .large_forward_open = config.large_forward_open,
          .key = config.key,
          .key_major = config.key_major,
          .key_minor = config.key_minor};
}

// Two bridges on one machine differ in what they publish, and so in who they are to the robots.
ethernet_ip::BusOptions options_of(const Config& config) {
  const EthernetIpBusConfig& bus = config.ethernet_ip;
  return {
      .bind = net::parse_ipv4(bus.bind).value_or(0),
      .io_port = bus.io_port,
      .vendor_id = bus.vendor_id,
      .serial_number = bus.serial_number,
      .name = config.dds.participant_name + "/" + std::to_string(config.dds.domain) + "/" + config.dds.topic_prefix};
}

using Channels = std::vector<std::unique_ptr<RobotChannel>>;

void plan_builtin(const Config& config, const Channels& channels, std::vector<LoopPlan>& plans) {
  std::map<Time, LoopPlan> by_cycle;
  for (std::size_t i = 0; i < config.robots.size(); ++i) {
    const RobotConfig& robot = config.robots[i];
    if (robot.type != TransportType::kBuiltin) continue;
    LoopPlan& plan = by_cycle[robot.cycle];
    plan.cycle = robot.cycle;
    plan.buses.push_back(open_builtin(robot, config.dds, *channels[i]));
    plan.robots.push_back({i, plan.buses.back().transport->counters()});
  }
  for (auto& [cycle, plan] : by_cycle) plans.push_back(std::move(plan));
}

// A bus with a loop of its own. `name`: of the protocol, for the sentence when it cannot be opened.
void open_fieldbus(const std::string& name, LoopBus bus, LoopPlan& plan) {
  try {
    bus.transport->open(monotonic());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(name + ": " + error.what());
  }
  for (LoopPlan::Robot& robot : plan.robots) robot.counters = bus.transport->counters();
  plan.buses.push_back(std::move(bus));
}

void plan_ethernet_ip(const Config& config, const Channels& channels, std::vector<LoopPlan>& plans) {
  LoopPlan plan;
  LoopBus bus;
  std::vector<ethernet_ip::RobotOptions> options;
  for (std::size_t i = 0; i < config.robots.size(); ++i) {
    const RobotConfig& robot = config.robots[i];
    if (robot.type != TransportType::kEthernetIp) continue;
    plan.cycle = options.empty() ? robot.cycle : std::min(plan.cycle, robot.cycle);
    options.push_back(options_of(robot));
    bus.robots.push_back({settings_of(robot, std::endian::little), channels[i].get()});
    plan.robots.push_back({i, {}});
  }
  if (options.empty()) return;
  bus.transport = ethernet_ip::make_transport(std::move(options), options_of(config));
  open_fieldbus("EtherNet/IP", std::move(bus), plan);
  plans.push_back(std::move(plan));
}

ethercat::BusOptions options_of(const EthercatSegmentConfig& segment, Time cycle) {
  return {.interface = segment.interface,
          .redundant_interface = segment.redundant_interface,
          .cycle = cycle,
          .dc = segment.dc,
          .dc_shift = segment.dc_shift,
          .watchdog = segment.watchdog,
          .separate = segment.separate};
}

void plan_ethercat(const Config& config, const EthercatSegmentConfig& segment, const Channels& channels,
                   std::vector<LoopPlan>& plans) {
  LoopPlan plan;
  LoopBus bus;
  std::vector<ethercat::RobotPlace> places;
  for (std::size_t i = 0; i < config.robots.size(); ++i) {
    const RobotConfig& robot = config.robots[i];
    if (robot.type != TransportType::kEthercat || robot.ethercat.interface != segment.interface) continue;
    plan.cycle = robot.cycle;
    places.push_back({.position = robot.ethercat.position, .alias = robot.ethercat.alias});
    bus.robots.push_back({settings_of(robot, std::endian::little), channels[i].get()});
    plan.robots.push_back({i, {}});
  }
  bus.transport = ethercat::make_transport(std::move(places), options_of(segment, plan.cycle));
  open_fieldbus("EtherCAT", std::move(bus), plan);
  plans.push_back(std::move(plan));
}

}  // namespace

std::vector<LoopPlan> open_buses(const Config& config, const Channels& channels) {
  for (const RobotConfig& robot : config.robots) {
    if (is_available(robot.type)) continue;
    throw std::runtime_error(robot.name + ": transport type '" + std::string(to_string(robot.type)) +
                             "' is not built yet; this version has 'builtin', 'ethernet_ip' and 'ethercat'");
  }
  std::vector<LoopPlan> plans;
  plan_builtin(config, channels, plans);
  plan_ethernet_ip(config, channels, plans);
  for (const EthercatSegmentConfig& segment : config.ethercat) plan_ethercat(config, segment, channels, plans);
  return plans;
}

}  // namespace meca::bridge
