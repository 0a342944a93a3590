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

Publisher::Publisher(Topics& topics, std::vector<PublishedRobot> robots, SpscQueue<ReaderEvent>& reader_events,
                     Wakeup& wakeup, Log log)
    : topics_(topics), reader_events_(reader_events), wakeup_(wakeup), log_(std::move(log)) {
  for (auto& robot : robots) {
    RobotPublisher publisher(robot.channel->name, robot.cycle, topics);
    RobotLog robot_log(robot.channel->name);
    robots_.push_back(
        std::make_unique<Robot>(Robot{std::move(robot), std::move(publisher), std::move(robot_log), {}, 0}));
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
  for (auto& robot : robots_) {
    drain_records(*robot, now, unix_ns);
    drain_receipts(*robot);
    look_at_counters(*robot, now);
  }
  drain_reader_events();
  print();
}

void Publisher::drain_records(Robot& robot, Time now, std::int64_t unix_ns) {
  auto& channel = *robot.facts.channel;
  if (channel.records.front() == nullptr) return;
  const PaceFacts pace = robot.facts.pace();
  const StatusFacts facts{.transport = robot.facts.transport,
                          .cycle = robot.facts.cycle,
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

void Publisher::look_at_counters(Robot& robot, Time now) {
  if (now < robot.next_look) return;
  robot.next_look = now + kCounterPeriod;
  const auto& channel = *robot.facts.channel;
  robot.log.look(LogFacts{.missed_cycles = robot.facts.pace().missed_cycles,
                          .records_dropped = channel.records_dropped.load(std::memory_order_relaxed),
                          .receipts_lost = channel.receipts_lost.load(std::memory_order_relaxed),
                          .refused_writes = robot.publisher.refused_writes() + robot.refused_receipts},
                 now, lines_);
}

void Publisher::print() {
  for (const auto& line : lines_) log_(line);
  lines_.clear();
}

}  // namespace meca::bridge
