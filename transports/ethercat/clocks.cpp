#include "transports/ethercat/clocks.hpp"

#include <algorithm>
#include <utility>

#include "transports/ethercat/registers.hpp"

namespace meca::ethercat {
namespace {

constexpr unsigned kDriftsToBeginWith = 3000, kDriftsPerFrame = 20;
constexpr unsigned kMostFailures = 100;
constexpr std::uint16_t kSpeedStart = 0x1000, kFilterDepths = 0x0C00;  // the loop starts from its defaults

template <std::size_t N>
std::array<std::byte, N> little_endian(std::uint64_t value) noexcept {
  std::array<std::byte, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = static_cast<std::byte>(value >> 8 * i & 0xFF);
  return out;
}

// Frames pass the ports of a device in this order (ESC data sheet, section I).
constexpr std::array<unsigned, 4> kPortOrder{0, 3, 1, 2};

struct Ports {
  std::array<unsigned, 4> used{};
  std::size_t count = 0;
};
// Those with a device, or the master, behind them: "communication" of DL status.
Ports ports_in_use(std::uint16_t dl_status) noexcept {
  Ports out;
  for (const unsigned port : kPortOrder)
    if ((dl_status >> (9 + 2 * port) & 1) != 0) out.used[out.count++] = port;
  return out;
}

}  // namespace

std::int64_t clock_difference(std::uint32_t value) noexcept {
  const auto magnitude = static_cast<std::int64_t>(value & 0x7FFF'FFFF);
  return (value & 0x8000'0000) != 0 ? magnitude : -magnitude;
}

// Proportional and integral parts as one public master (SOEM) has proven them: 1/100 and 1/20 ns per cycle.
void PhaseControl::seen(std::uint64_t reference) noexcept {
  const std::int64_t cycle = cycle_.count();
  if (cycle <= 0) return;
  const auto phase = static_cast<std::int64_t>(reference % static_cast<std::uint64_t>(cycle));
  std::int64_t late = (phase - target_.count()) % cycle;
  if (late > cycle / 2) late -= cycle;
  if (late < -cycle / 2) late += cycle;
  integral_ = std::clamp(integral_ + Time(late > 0 ? 1 : late < 0 ? -1 : 0), Time(-20 * 1000), Time(20 * 1000));
  correct(Time(late));
  seen_ = true;
}

void PhaseControl::next_cycle() noexcept {
  if (!std::exchange(seen_, false)) correct({});
}

void PhaseControl::correct(Time late) noexcept {
  const Time most = cycle_ / 100;
  correction_ = std::clamp(-late / 100 - integral_ / 20, -most, most);
}

Clocks::Clocks(std::uint64_t epoch) : epoch_(epoch) {
  clocks_.reserve(ChainScan::kMostDevices);
  before_.reserve(ChainScan::kMostDevices);
}

void Clocks::start(std::span<const ChainScan::Device> devices) noexcept {
  std::swap(clocks_, before_);
  clocks_.clear();
  for (const ChainScan::Device& device : devices) {
    if ((device.features & kFeatureDc) == 0) continue;
    Clock clock;
    const auto before = std::ranges::find(before_, device.life, &Clock::life);
    if (before != before_.end()) clock = *before;
    clock.life = device.life;
    clock.address = device.address;
    clock.dl_status = device.dl_status;
    clocks_.push_back(clock);
  }
  restart();
}

void Clocks::restart() noexcept {
  failures_ = drifts_ = 0;
  begin(clocks_.empty() ? Step::kIdle : Step::kLatch);
}

void Clocks::begin(Step step) noexcept {
  step_ = step;
  ++generation_;
  for (Clock& clock : clocks_) clock.answered = clock.asked = false;
}

std::optional<std::uint16_t> Clocks::reference() const noexcept {
  if (clocks_.empty() || !clocks_.front().running) return std::nullopt;
  return clocks_.front().address;
}

bool Clocks::add_to(InFlight& frame, Time now) noexcept {
  if (!running()) return false;
  if (step_ == Step::kDrift) return add_drift(frame);
  if (step_ == Step::kLatch) {
    Clock& first = clocks_.front();
    if (first.asked) return false;
    latched_ = now;
    first.asked = frame.add(
        {Command::kBwr, address_of(0, reg::kDcReceiveTimes), 4, {}, {Purpose::Kind::kClocks, generation_, 0}});
    return first.asked;
  }
  bool added = false;
  for (std::size_t i = 0; i < clocks_.size(); ++i)
    if (!clocks_[i].answered && !clocks_[i].asked && add_one(frame, i)) added = true;
  return added;
}

bool Clocks::add_one(InFlight& frame, std::size_t item) noexcept {
  Clock& clock = clocks_[item];
  const Purpose purpose{Purpose::Kind::kClocks, generation_, static_cast<std::uint16_t>(item)};
  const auto read = [&](std::uint16_t ado, std::uint16_t size) {
    return frame.add({Command::kFprd, address_of(clock.address, ado), size, {}, purpose});
  };
  const auto write = [&](std::uint16_t ado, const auto& bytes) {
    return frame.add(
        {Command::kFpwr, address_of(clock.address, ado), static_cast<std::uint16_t>(bytes.size()), bytes, purpose});
  };
  switch (step_) {
    case Step::kReadPorts:
      clock.asked = read(reg::kDcReceiveTimes, 16);
      break;
    case Step::kReadLocal:
      clock.asked = read(reg::kDcReceiveTimePu, 8);
      break;
    case Step::kDelay:
      clock.asked = write(reg::kDcDelay, little_endian<4>(clock.delay));
      break;
    case Step::kOffset:
      clock.asked = write(reg::kDcOffset, little_endian<8>(clock.offset));
      break;
    case Step::kSpeed:
      clock.asked = write(reg::kDcSpeedStart, little_endian<2>(kSpeedStart));
      break;
    case Step::kFilter:
      clock.asked = write(reg::kDcFilterDepths, little_endian<2>(kFilterDepths));
      break;
    case Step::kIdle:
    case Step::kLatch:
    case Step::kDrift:
    case Step::kReady:
      break;
  }
  return clock.asked;
}

bool Clocks::add_drift(InFlight& frame) noexcept {
  const Purpose purpose{Purpose::Kind::kClocks, generation_, 0};
  if (clocks_.front().asked) return false;
  for (unsigned i = 0; i < std::min(kDriftsPerFrame, kDriftsToBeginWith - drifts_); ++i) {
    if (!frame.add({Command::kFrmw, address_of(clocks_.front().address, reg::kDcSystemTime), 8, {}, purpose})) break;
    clocks_.front().asked = true;
  }
  return clocks_.front().asked;
}

void Clocks::answered(const Purpose& purpose, std::uint16_t working_counter, Bytes data) noexcept {
  if (purpose.step != generation_ || purpose.of >= clocks_.size() || !running()) return;
  Clock& clock = clocks_[purpose.of];
  clock.asked = false;
  if (step_ == Step::kDrift) {
    if (++drifts_ == kDriftsToBeginWith) begin(Step::kReady);
    return;
  }
  if (working_counter == 0) {
    // The device has left; the scan will notice. Not for ever at the same step.
    if (++failures_ > kMostFailures) restart();
    return;
  }
  wire::Reader in(data);
  if (step_ == Step::kReadPorts)
    for (std::uint32_t& port : clock.ports) port = in.u32();
  if (step_ == Step::kReadLocal) clock.local = in.u64();
  clock.answered = true;
  next_step();
}

void Clocks::lost(const Purpose& purpose) noexcept {
  if (purpose.step != generation_ || purpose.of >= clocks_.size()) return;
  clocks_[purpose.of].asked = false;
}

void Clocks::next_step() noexcept {
  const bool one_for_all = step_ == Step::kLatch;
  if (!one_for_all && !std::ranges::all_of(clocks_, &Clock::answered)) return;
  // Offset, speed and filter are for those that do not run yet.
  const auto begin_for_new = [this](Step step) {
    begin(step);
    for (Clock& clock : clocks_) clock.answered = clock.running;
    if (std::ranges::all_of(clocks_, &Clock::answered)) next_step();
  };
  switch (step_) {
    case Step::kLatch:
      return begin(Step::kReadPorts);
    case Step::kReadPorts:
      return begin(Step::kReadLocal);
    case Step::kReadLocal:
      compute_delays();
      compute_offsets();
      return begin(Step::kDelay);
    case Step::kDelay:
      return begin_for_new(Step::kOffset);
    case Step::kOffset:
      return begin_for_new(Step::kSpeed);
    case Step::kSpeed:
      return begin_for_new(Step::kFilter);
    case Step::kFilter: {
      const bool all_ran = std::ranges::all_of(clocks_, &Clock::running);
      for (Clock& clock : clocks_) clock.running = true;
      return begin(all_ran ? Step::kReady : Step::kDrift);
    }
    case Step::kIdle:
    case Step::kDrift:
    case Step::kReady:
      return;
  }
}

// A frame comes back to a port later by twice the way through what is behind it, less the time it spends behind the
// next device's own ports. Devices without clock count as cable: right in a line, which is what the robots form.
void Clocks::compute_delays() noexcept {
  struct Branch {
    std::size_t clock = 0, next = 1;  // the next of its ports that a device may be behind
  };
  std::array<Branch, ChainScan::kMostDevices> above{};
  std::size_t depth = 0;
  for (std::size_t i = 0; i < clocks_.size(); ++i) {
    Clock& child = clocks_[i];
    const Ports own = ports_in_use(child.dl_status);
    while (depth > 0 && above[depth - 1].next >= ports_in_use(clocks_[above[depth - 1].clock].dl_status).count) --depth;
    child.delay = 0;
    if (depth > 0) {
      Branch& branch = above[depth - 1];
      const Clock& parent = clocks_[branch.clock];
      const Ports ports = ports_in_use(parent.dl_status);
      const std::uint32_t left = parent.ports[ports.used[branch.next - 1]];
      const std::uint32_t round = parent.ports[ports.used[branch.next]] - left;
      const std::uint32_t inside = own.count > 1 ? child.ports[own.used[own.count - 1]] - child.ports[own.used[0]] : 0;
      ++branch.next;
      child.delay = parent.delay + (left - parent.ports[ports.used[0]]) + (round > inside ? (round - inside) / 2 : 0);
    }
    above[depth++] = {i, 1};
  }
}

// All latched the same frame, so at its time T each clock says T + delay. T is taken from one that runs, else from us.
void Clocks::compute_offsets() noexcept {
  std::uint64_t latched = epoch_ + static_cast<std::uint64_t>(latched_.count());
  const auto runs = std::ranges::find(clocks_, true, &Clock::running);
  if (runs != clocks_.end()) latched = runs->local + runs->offset - runs->delay;
  for (Clock& clock : clocks_)
    if (!clock.running) clock.offset = latched + clock.delay - clock.local;
}

}  // namespace meca::ethercat
