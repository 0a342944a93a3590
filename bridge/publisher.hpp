// The publisher thread: drains every robot's queues into DDS samples and log lines. The only thread that writes to DDS
// or prints, so that a slow reader, a full disk or a log storm never reaches a cycle.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "bridge/channel.hpp"
#include "bridge/config.hpp"
#include "bridge/loop_log.hpp"
#include "bridge/pacer.hpp"
#include "bridge/robot_log.hpp"
#include "bridge/robot_publisher.hpp"
#include "bridge/wakeup.hpp"

namespace meca::bridge {

struct PublishedRobot {
  RobotChannel* channel = nullptr;                      // outlives the publisher
  std::string transport;                                // "builtin", ...
  std::span<const transports::CounterInfo> counters{};  // of its bus
};

// A loop and the robots that it owns.
struct PublishedLoop {
  Time cycle{};
  std::function<PaceFacts()> pace;
  std::vector<PublishedRobot> robots;
};

class Publisher {
 public:
  using Log = std::function<void(const LogLine&)>;

  // `reader_events` and `wakeup` outlive the publisher. `log` is called on the publisher thread only.
  Publisher(Topics& topics, std::vector<PublishedLoop> loops, SpscQueue<ReaderEvent>& reader_events, Wakeup& wakeup,
            Log log);
  ~Publisher();  // stops
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  void start();
  void stop();  // after a last round, so that nothing queued before is lost

  // One round over all queues, on the caller's thread: what the thread does each time it is woken.
  void run_once(Time now);

 private:
  struct Robot {
    PublishedRobot facts;
    RobotPublisher publisher;
    RobotLog log;
    std::uint64_t refused_receipts = 0;
  };
  struct Loop {
    Time cycle{};
    std::function<PaceFacts()> pace;
    LoopLog log;
    std::vector<Robot> robots;
  };
  void run();
  void drain_records(const Loop& loop, Robot& robot, Time now, std::int64_t unix_ns);
  void drain_receipts(Robot& robot);
  void drain_reader_events();
  void look_at_counters(Time now);
  void print();

  Topics& topics_;
  std::vector<Loop> loops_;
  Time next_look_{};  // at the counters
  SpscQueue<ReaderEvent>& reader_events_;
  Wakeup& wakeup_;
  Log log_;
  meca500::CommandReceipt receipt_;
  std::vector<LogLine> lines_;
  std::atomic<bool> stop_requested_{false};
  std::thread thread_;
};

}  // namespace meca::bridge
