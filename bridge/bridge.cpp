#include "bridge/bridge.hpp"

#include <spdlog/spdlog.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "bridge/dds.hpp"
#include "bridge/intake.hpp"
#include "bridge/loop.hpp"
#include "bridge/publisher.hpp"
#include "bridge/realtime.hpp"
#include "sim/robot.hpp"
#include "transports/builtin/builtin.hpp"
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

CycleSettings settings_of(const RobotConfig& robot, std::endian byte_order) {
  CycleSettings settings;
  settings.cycle = robot.cycle;
  settings.byte_order = byte_order;
  settings.lease = robot.control.lease;
  settings.velocity_lease = robot.control.velocity_lease;
  settings.stale_after = 3 * robot.cycle;
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
LoopBus open_bus(const RobotConfig& robot, const DdsConfig& dds, RobotChannel& channel) {
  if (robot.type != TransportType::kBuiltin) {
    throw std::runtime_error(robot.name + ": transport type '" + std::string(to_string(robot.type)) +
                             "' is not built yet; this version has 'builtin'");
  }
  LoopBus bus;
  std::vector<std::unique_ptr<transports::ControlPanel>> panels;
  panels.push_back(open_panel(robot, dds));
  bus.transport = transports::make_builtin({model_of(robot)}, std::move(panels));
  bus.transport->open(monotonic());
  bus.robots.push_back({settings_of(robot, bus.transport->byte_order()), &channel});
  return bus;
}

void print(const LogLine& line) {
  switch (line.level) {
    case LogLine::Level::kInfo:
      return spdlog::info("{}", line.text);
    case LogLine::Level::kWarning:
      return spdlog::warn("{}", line.text);
    case LogLine::Level::kError:
      return spdlog::error("{}", line.text);
  }
}

dds::ParticipantOptions participant_options(const DdsConfig& config) {
  return {.domain = config.domain,
          .name = config.participant_name,
          .interfaces = config.interfaces,
          .shared_memory = config.shared_memory};
}

std::vector<std::unique_ptr<RobotChannel>> make_channels(const std::vector<RobotConfig>& robots) {
  std::vector<std::unique_ptr<RobotChannel>> channels;
  for (const auto& robot : robots) channels.push_back(std::make_unique<RobotChannel>(robot.name));
  return channels;
}

}  // namespace

// Members in the order of dependence: what is used by threads is destroyed after the threads.
struct Bridge::Impl {
  explicit Impl(const Config& config);
  std::vector<RobotChannel*> channel_pointers() const;
  void make_loops(const Config& config);
  std::vector<PublishedRobot> published_robots(const Config& config) const;

  static constexpr std::size_t kReaderEvents = 1024;

  RealtimeConfig realtime;
  Wakeup wakeup;
  SpscQueue<ReaderEvent> reader_events{kReaderEvents};
  std::vector<std::unique_ptr<RobotChannel>> channels;
  dds::Participant participant;
  Topics topics;
  std::vector<std::unique_ptr<Loop>> loops;
  std::vector<Loop*> loop_of;  // by robot
  std::unique_ptr<Publisher> publisher;
  std::unique_ptr<Intake> intake;
  bool running = false;
};

Bridge::Impl::Impl(const Config& config)
    : realtime(config.realtime),
      channels(make_channels(config.robots)),
      participant(participant_options(config.dds)),
      topics(participant, config.dds) {
  make_loops(config);
  publisher = std::make_unique<Publisher>(topics, published_robots(config), reader_events, wakeup, print);
  intake = std::make_unique<Intake>(participant, config.dds, channel_pointers(), reader_events, wakeup);
}

// Robots with the same cycle share a thread.
void Bridge::Impl::make_loops(const Config& config) {
  std::map<Time, std::vector<LoopBus>> groups;
  for (std::size_t i = 0; i < config.robots.size(); ++i) {
    groups[config.robots[i].cycle].push_back(open_bus(config.robots[i], config.dds, *channels[i]));
  }
  std::map<Time, Loop*> by_cycle;
  for (auto& [cycle, buses] : groups) {
    loops.push_back(std::make_unique<Loop>(std::move(buses), cycle, config.realtime, wakeup));
    by_cycle[cycle] = loops.back().get();
  }
  for (const auto& robot : config.robots) loop_of.push_back(by_cycle[robot.cycle]);
}

std::vector<PublishedRobot> Bridge::Impl::published_robots(const Config& config) const {
  std::vector<PublishedRobot> robots;
  for (std::size_t i = 0; i < config.robots.size(); ++i) {
    robots.push_back({.channel = channels[i].get(),
                      .transport = std::string(to_string(config.robots[i].type)),
                      .cycle = config.robots[i].cycle,
                      .pace = [loop = loop_of[i]] { return loop->pace(); }});
  }
  return robots;
}

std::vector<RobotChannel*> Bridge::Impl::channel_pointers() const {
  std::vector<RobotChannel*> pointers;
  for (const auto& channel : channels) pointers.push_back(channel.get());
  return pointers;
}

Bridge::Bridge(const Config& config) : impl_(std::make_unique<Impl>(config)) {}

Bridge::~Bridge() { stop(); }

void Bridge::start() {
  if (impl_->running) return;
  for (const auto& line : make_process_realtime(impl_->realtime)) spdlog::info("{}", line);
  for (auto& loop : impl_->loops) {
    for (const auto& line : loop->start()) spdlog::info("{}", line);
  }
  impl_->publisher->start();
  impl_->intake->start();
  impl_->running = true;
}

void Bridge::stop() {
  if (!impl_->running) return;
  impl_->running = false;
  // No new wishes; stop image and good-bye on every bus at once; then what is left to say; DDS goes with the object.
  impl_->intake->stop();
  for (auto& loop : impl_->loops) loop->request_stop();
  for (auto& loop : impl_->loops) loop->join();
  impl_->publisher->stop();
}

}  // namespace meca::bridge
