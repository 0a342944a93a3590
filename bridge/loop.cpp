#include "bridge/loop.hpp"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace meca::bridge {
namespace {

// The stop image is sent at least so often, and at least so long, before the good-bye; and so long at most, because the
// bridge promises to be gone within 2 s.
constexpr int kStopCyclesAtLeast = 3;
constexpr Time kStopTime = std::chrono::milliseconds(50);
constexpr Time kStopPatience = std::chrono::milliseconds(1500);

Time to_time(const timespec& t) { return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec); }

Time monotonic() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return to_time(t);
}

Stamp stamp() noexcept {
  timespec wall{};
  clock_gettime(CLOCK_REALTIME, &wall);
  return {.now = monotonic(), .unix_ns = to_time(wall).count()};
}

void sleep_until(Time deadline) noexcept {
  const timespec t{.tv_sec = static_cast<time_t>(deadline.count() / 1'000'000'000),
                   .tv_nsec = static_cast<long>(deadline.count() % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

}  // namespace

BusGroup::BusGroup(std::vector<LoopBus> buses) {
  for (auto& bus : buses) {
    auto& ours = buses_.emplace_back();
    ours.transport = std::move(bus.transport);
    for (const auto& robot : bus.robots) ours.robots.emplace_back(robot);
    ours.exchanges.resize(ours.robots.size());
  }
}

bool BusGroup::run(Stamp stamp, Ending ending) noexcept {
  bool news = false;
  for (auto& bus : buses_) {
    bus.transport->exchange(stamp.now, bus.exchanges);
    for (std::size_t i = 0; i < bus.robots.size(); ++i) {
      Robot& robot = bus.robots[i];
      const bool had_its_step = std::exchange(robot.stepped, false) && !bus.exchanges[i].fresh && ending == robot.told;
      if (had_its_step) continue;
      step(robot, bus.exchanges[i], stamp, ending);
      news = true;
    }
  }
  return news;
}

transports::Transport::Woke BusGroup::wait(Time deadline) noexcept {
  return buses_.size() == 1 ? buses_.front().transport->wait(deadline) : transports::Transport::Woke::kCannotWait;
}

void BusGroup::run_arrived(Stamp stamp) noexcept {
  for (auto& bus : buses_) {
    bus.transport->exchange(stamp.now, bus.exchanges);
    for (std::size_t i = 0; i < bus.robots.size(); ++i) {
      Robot& robot = bus.robots[i];
      if (!bus.exchanges[i].fresh) continue;
      step(robot, bus.exchanges[i], stamp, robot.told);
      robot.stepped = true;
    }
  }
}

Time BusGroup::deadline_shift() const noexcept {
  return buses_.size() == 1 ? buses_.front().transport->deadline_shift() : Time{};
}

bool BusGroup::finished() const noexcept {
  return std::ranges::all_of(buses_, [](const Bus& bus) {
    return std::ranges::all_of(bus.robots, [](const Robot& robot) { return robot.cycle.finished(); });
  });
}

std::size_t BusGroup::take_requests(Robot& robot, Ending ending) noexcept {
  std::size_t count = 0;
  if (ending != robot.told) {
    requests_[count++] = control::ShutdownRequest{};
    robot.told = ending;
  }
  auto& channel = *robot.channel;
  const std::size_t room = channel.receipts.capacity() - channel.receipts.size();
  if (room < RobotChannel::kReceiptReserve) return count;
  while (count < requests_.size()) {
    const control::Request* request = channel.inbox.front();
    if (request == nullptr) break;
    requests_[count++] = *request;
    channel.inbox.pop();
  }
  return count;
}

void BusGroup::step(Robot& robot, transports::Exchange& exchange, Stamp stamp, Ending ending) noexcept {
  const std::size_t requests = take_requests(robot, ending);
  StepResult& result = *robot.result;
  result.receipt_count = 0;
  robot.cycle.step({requests_.data(), requests}, exchange, stamp, result);
  auto& channel = *robot.channel;
  if (!channel.records.push(result.record)) channel.records_dropped.fetch_add(1, std::memory_order_relaxed);
  for (std::size_t i = 0; i < result.receipt_count; ++i) {
    if (channel.receipts.push({result.receipts[i], result.record.cycle, stamp.unix_ns})) continue;
    channel.receipts_lost.fetch_add(1, std::memory_order_relaxed);
  }
}

void BusGroup::close(Stamp stamp) noexcept {
  for (auto& bus : buses_) {
    bus.transport->close();
    for (auto& robot : bus.robots) {
      CycleRecord& record = robot.result->record;
      ++record.cycle;
      record.quality = Quality::kDisconnected;
      record.link = transports::LinkState::kDown;
      record.link_detail = "the bridge has stopped";
      record.closing = true;
      if (record.control.owned) {
        record.control.owned = false;
        record.control.last_owner = record.control.owner;
        record.control.owner = {};
        record.control.contender = {};
        record.control.last_loss = control::ControlState::Loss::kShutdown;
        record.control.since_unix_ns = stamp.unix_ns;
      }
      if (!robot.channel->records.push(record)) robot.channel->records_dropped.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

Loop::Loop(std::vector<LoopBus> buses, Time cycle, const RealtimeConfig& realtime, Wakeup& wakeup)
    : group_(std::move(buses)), cycle_(cycle), realtime_(realtime), wakeup_(wakeup) {}

Loop::~Loop() {
  request_stop();
  join();
}

RealtimeAnswers Loop::start() {
  std::promise<RealtimeAnswers> ready;
  auto got = ready.get_future();
  thread_ = std::thread([this, promise = std::move(ready)]() mutable { run(std::move(promise)); });
  return got.get();
}

void Loop::join() {
  if (thread_.joinable()) thread_.join();
}

PaceFacts Loop::pace() const noexcept {
  return {missed_cycles_.load(std::memory_order_relaxed), lateness_max_us_.load(std::memory_order_relaxed),
          lateness_mean_us_.load(std::memory_order_relaxed)};
}

void Loop::share_pace(const PaceFacts& facts) noexcept {
  missed_cycles_.store(facts.missed_cycles, std::memory_order_relaxed);
  lateness_max_us_.store(facts.lateness_max_us, std::memory_order_relaxed);
  lateness_mean_us_.store(facts.lateness_mean_us, std::memory_order_relaxed);
}

void Loop::wait_for(Time deadline) noexcept {
  using Woke = transports::Transport::Woke;
  for (;;) {
    switch (group_.wait(deadline)) {
      case Woke::kCannotWait:
        return sleep_until(deadline);
      case Woke::kDeadline:
        return;
      case Woke::kArrival:
        group_.run_arrived(stamp());
        wakeup_.notify();
    }
  }
}

void Loop::run(std::promise<RealtimeAnswers> ready) {
  ready.set_value(make_thread_realtime(realtime_));
  Pacer pacer(cycle_, monotonic() + cycle_);
  using Ending = BusGroup::Ending;
  const auto stop_cycles = std::max<std::int64_t>(kStopCyclesAtLeast, kStopTime / cycle_);
  const auto patience = std::max<std::int64_t>(kStopCyclesAtLeast, kStopPatience / cycle_);
  Ending ending = Ending::kNone;
  for (std::int64_t stopping = 0; ending != Ending::kGiveUp && !(stopping >= stop_cycles && group_.finished());) {
    wait_for(pacer.deadline());
    pacer.woke(monotonic());
    if (stop_requested_.load()) ending = ++stopping < patience ? Ending::kStop : Ending::kGiveUp;
    // Not without need: a frame may be on its way back, and its step notifies again.
    if (group_.run(stamp(), ending)) wakeup_.notify();
    pacer.done(monotonic());
    pacer.shift(group_.deadline_shift());
    share_pace(pacer.facts());
  }
  group_.close(stamp());
  wakeup_.notify();
}

}  // namespace meca::bridge
