#include "bridge/publisher.hpp"

#include <chrono>
#include <utility>

namespace meca::bridge {
namespace {

// Without a loop that notifies (all stopped, or cycles of seconds) the queues are still looked at so often.
constexpr std::chrono::milliseconds kPatience{50};
constexpr Time kCounterPeriod = std::chrono::seconds(1);

Time monotonic() { return std::chrono::steady_clock::now().time_since_epoch(); }
std::int64_t unix_now() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

Publisher::Publisher(Topics& topics, std::vector<PublishedLoop> loops, SpscQueue<ReaderEvent>& reader_events,
                     Wakeup& wakeup, Log log)
    : topics_(topics), reader_events_(reader_events), wakeup_(wakeup), log_(std::move(log)) {
  for (auto& loop : loops) {
    std::vector<Robot> robots;
    std::vector<std::string> names;
    for (auto& robot : loop.robots) {
      const std::string& name = robot.channel->name;
      names.push_back(name);
      robots.push_back({std::move(robot), RobotPublisher(name, loop.cycle, topics), RobotLog(name)});
    }
    loops_.push_back({loop.cycle, std::move(loop.pace), LoopLog(names), std::move(robots)});
  }
}

Publisher::~Publisher() { stop(); }

void Publisher::start() {
  thread_ = std::thread([this] { run(); });
}

void Publisher::stop() {
  if (!thread_.joinable()) return;
  stop_requested_.store(true);
  wakeup_.notify();
  thread_.join();
  run_once(monotonic());
}

void Publisher::run() {
  while (!stop_requested_.load()) {
    wakeup_.wait(kPatience);
    run_once(monotonic());
  }
}

void Publisher::run_once(Time now) {
  const std::int64_t unix_ns = unix_now();
  for (auto& loop : loops_) {
    for (auto& robot : loop.robots) {
      drain_records(loop, robot, now, unix_ns);
      drain_receipts(robot);
    }
  }
  look_at_counters(now);
  drain_reader_events();
  print();
}

void Publisher::drain_records(const Loop& loop, Robot& robot, Time now, std::int64_t unix_ns) {
  auto& channel = *robot.facts.channel;
  if (channel.records.front() == nullptr) return;
  const PaceFacts pace = loop.pace();
  const StatusFacts facts{.transport = robot.facts.transport,
                          .cycle = loop.cycle,
                          .missed_cycles = pace.missed_cycles,
                          .records_dropped = channel.records_dropped.load(std::memory_order_relaxed),
                          .wakeup_lateness_max_us = pace.lateness_max_us,
                          .wakeup_lateness_mean_us = pace.lateness_mean_us,
                          .unix_ns = unix_ns,
                          .counters = robot.facts.counters};
  // At most one queue full per round: a loop faster than DDS must not keep the other robots waiting.
  for (std::size_t i = 0; i < channel.records.capacity(); ++i) {
    const CycleRecord* record = channel.records.front();
    if (record == nullptr) break;
    robot.publisher.publish(*record, facts);
    robot.log.look(*record, now, lines_);
    channel.records.pop();
  }
}

void Publisher::drain_receipts(Robot& robot) {
  auto& channel = *robot.facts.channel;
  while (const ReceiptEvent* event = channel.receipts.front()) {
    fill(channel.name, event->receipt, {}, event->cycle, event->unix_ns, receipt_);
    robot.refused_receipts += !topics_.command_receipt.writer.write(receipt_);
    channel.receipts.pop();
  }
}

void Publisher::drain_reader_events() {
  while (const ReaderEvent* event = reader_events_.front()) {
    if (event->has_receipt) {
      fill(event->robot, event->receipt, event->text, 0, event->unix_ns, receipt_);
      topics_.command_receipt.writer.write(receipt_);
    }
    if (!event->log_line.empty()) {
      lines_.push_back({LogLine::Level::kWarning, std::string(event->log_line.view())});
    }
    reader_events_.pop();
  }
}

void Publisher::look_at_counters(Time now) {
  if (now < next_look_) return;
  next_look_ = now + kCounterPeriod;
  for (auto& loop : loops_) {
    loop.log.look(loop.pace(), now, lines_);
    for (auto& robot : loop.robots) {
      const auto& channel = *robot.facts.channel;
      robot.log.look(LogFacts{.records_dropped = channel.records_dropped.load(std::memory_order_relaxed),
                              .receipts_lost = channel.receipts_lost.load(std::memory_order_relaxed),
                              .refused_writes = robot.publisher.refused_writes() + robot.refused_receipts},
                     now, lines_);
    }
  }
}

void Publisher::print() {
  for (const auto& line : lines_) log_(line);
  lines_.clear();
}

}  // namespace meca::bridge
