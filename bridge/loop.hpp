// The thread that owns buses: wakes by absolute deadlines, exchanges every bus, steps every robot's Cycle and hands
// records and receipts to the publisher. After start-up: no allocation, lock, log or exception.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bridge/channel.hpp"
#include "bridge/config.hpp"
#include "bridge/cycle.hpp"
#include "bridge/pacer.hpp"
#include "bridge/realtime.hpp"
#include "bridge/wakeup.hpp"
#include "transports/transport.hpp"

namespace meca::bridge {

// One robot in the order of its bus.
struct LoopRobot {
  CycleSettings settings;
  RobotChannel* channel = nullptr;  // outlives the loop
};

struct LoopBus {
  std::unique_ptr<transports::Transport> transport;  // opened
  std::vector<LoopRobot> robots;
};

// One round over several buses, without thread or clock: what the loop does each time it wakes up.
class BusGroup {
 public:
  explicit BusGroup(std::vector<LoopBus> buses);

  enum class Ending : std::uint8_t { kNone, kStop, kGiveUp };
  // Exchanges every bus, steps every robot. kStop: every Cycle is told to stop its robot; kGiveUp: to wait for nothing.
  // False when every robot has had its step already: there is nothing new to publish.
  bool run(Stamp stamp, Ending ending) noexcept;
  // Between two rounds: a bus of its own may wait by itself (see Transport::wait).
  transports::Transport::Woke wait(Time deadline) noexcept;
  // Something arrived before the next round: steps the robots that it concerns, in place of that round's step.
  void run_arrived(Stamp stamp) noexcept;
  // By how much the next deadline should move (see Transport::deadline_shift).
  Time deadline_shift() const noexcept;
  // After kStop: every robot has stopped and every command has its end.
  bool finished() const noexcept;

  // The orderly good-bye; afterwards every robot's last record says that nobody is connected any more.
  void close(Stamp stamp) noexcept;

 private:
  struct Robot {
    Robot(const LoopRobot& robot) : cycle(robot.settings), channel(robot.channel) {}
    Cycle cycle;
    RobotChannel* channel;
    std::unique_ptr<StepResult> result = std::make_unique<StepResult>();
    Ending told = Ending::kNone;
    bool stepped = false;  // by run_arrived() since the last round
  };
  struct Bus {
    std::unique_ptr<transports::Transport> transport;
    std::vector<Robot> robots;
    std::vector<transports::Exchange> exchanges;
  };
  void step(Robot& robot, transports::Exchange& exchange, Stamp stamp, Ending ending) noexcept;
  std::size_t take_requests(Robot& robot, Ending ending) noexcept;

  std::vector<Bus> buses_;
  std::array<control::Request, Cycle::kMaxRequests> requests_;  // of the robot being stepped
};

class Loop {
 public:
  // `wakeup` is notified when there is something to publish; it outlives the loop.
  Loop(std::vector<LoopBus> buses, Time cycle, const RealtimeConfig& realtime, Wakeup& wakeup);
  ~Loop();  // stops
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  // Starts the thread; returns when it has asked for its real-time properties, with what it got.
  RealtimeAnswers start();

  // Asks for the stop image, then time to clear the queues and to end the commands, at most 1.5 s, then the transports'
  // good-bye. Does not wait: several loops stop at once.
  void request_stop() noexcept { stop_requested_.store(true); }
  void join();

  PaceFacts pace() const noexcept;  // from any thread

 private:
  void run(std::promise<RealtimeAnswers> ready);
  void wait_for(Time deadline) noexcept;
  void share_pace(const PaceFacts& facts) noexcept;

  BusGroup group_;
  Time cycle_;
  RealtimeConfig realtime_;
  Wakeup& wakeup_;
  std::atomic<bool> stop_requested_{false};
  std::atomic<std::uint64_t> missed_cycles_{0};
  std::atomic<std::uint32_t> lateness_max_us_{0}, lateness_mean_us_{0};
  std::thread thread_;
};

}  // namespace meca::bridge
