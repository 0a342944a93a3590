#include "bridge/bridge.hpp"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>
#include <vector>

#include "bridge/buses.hpp"
#include "bridge/dds.hpp"
#include "bridge/intake.hpp"
#include "bridge/loop.hpp"
#include "bridge/publisher.hpp"
#include "bridge/realtime.hpp"

namespace meca::bridge {
namespace {

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

void log(const RealtimeAnswers& answers) {
  for (const auto& answer : answers) {
    spdlog::log(answer.granted ? spdlog::level::info : spdlog::level::warn, "{}", answer.text);
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
  std::vector<PublishedLoop> make_loops(const Config& config);

  static constexpr std::size_t kReaderEvents = 1024;

  RealtimeConfig realtime;
  Wakeup wakeup;
  SpscQueue<ReaderEvent> reader_events{kReaderEvents};
  std::vector<std::unique_ptr<RobotChannel>> channels;
  dds::Participant participant;
  Topics topics;
  std::vector<std::unique_ptr<Loop>> loops;
  std::unique_ptr<Publisher> publisher;
  std::unique_ptr<Intake> intake;
  bool running = false;
};

Bridge::Impl::Impl(const Config& config)
    : realtime(config.realtime),
      channels(make_channels(config.robots)),
      participant(participant_options(config.dds)),
      topics(participant, config.dds) {
  publisher = std::make_unique<Publisher>(topics, make_loops(config), reader_events, wakeup, print);
  intake = std::make_unique<Intake>(participant, config.dds, channel_pointers(), reader_events, wakeup);
}

std::vector<PublishedLoop> Bridge::Impl::make_loops(const Config& config) {
  std::vector<PublishedLoop> published;
  for (LoopPlan& plan : open_buses(config, channels)) {
    loops.push_back(std::make_unique<Loop>(std::move(plan.buses), plan.cycle, config.realtime, wakeup));
    std::vector<PublishedRobot> robots;
    for (const LoopPlan::Robot& robot : plan.robots) {
      robots.push_back({.channel = channels[robot.index].get(),
                        .transport = std::string(to_string(config.robots[robot.index].type)),
                        .counters = robot.counters});
    }
    published.push_back({.cycle = plan.cycle,
                         .pace = [loop = loops.back().get()] { return loop->pace(); },
                         .robots = std::move(robots)});
  }
  return published;
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
  log(make_process_realtime(impl_->realtime));
  for (auto& loop : impl_->loops) log(loop->start());
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
