// A transport turned as the bridge's loop turns it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "transports/net/clock.hpp"
#include "transports/transport.hpp"

namespace meca::test {

using namespace std::chrono_literals;

inline constexpr auto kPatience = 60s;  // the end of hope, not an expectation

// For what happens without the bus.
inline bool eventually(const std::function<bool()>& condition) {
  const auto end = net::monotonic() + kPatience;
  while (!condition()) {
    if (net::monotonic() > end) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

class BusTurner {
 public:
  using Time = transports::Time;

  BusTurner(std::unique_ptr<transports::Transport> bus, std::size_t robots, Time cycle)
      : exchanges(robots), cycle_(cycle), bus_(std::move(bus)) {
    bus_->open(net::monotonic());
    deadline_ = net::monotonic();
  }

  ~BusTurner() {
    if (bus_) bus_->close();
  }

  void turn() {
    using Woke = transports::Transport::Woke;
    deadline_ = std::max(deadline_ + cycle_, net::monotonic());
    while (bus_->wait(deadline_) == Woke::kArrival) exchange();
    exchange();
    deadline_ += bus_->deadline_shift();
  }
  bool until(const std::function<bool()>& condition) {
    const Time end = net::monotonic() + kPatience;
    while (!condition()) {
      if (net::monotonic() > end) return false;
      turn();
    }
    return true;
  }
  bool until_up() {
    return until([&] {
      return std::ranges::all_of(exchanges, [](const auto& e) { return e.link == transports::LinkState::kUp; });
    });
  }

  std::int64_t counter(std::string_view name, std::size_t robot = 0) const {
    const auto all = bus_->counters();
    const auto found = std::ranges::find(all, name, &transports::CounterInfo::name);
    if (found == all.end()) throw std::invalid_argument("no counter " + std::string(name));
    return exchanges[robot].counters[static_cast<std::size_t>(found - all.begin())];
  }
  std::string detail(std::size_t robot = 0) const { return std::string(exchanges[robot].link_detail.view()); }
  void close() { bus_->close(); }
  void crash() { bus_ = nullptr; }  // without a good-bye

  std::vector<transports::Exchange> exchanges;
  std::uint64_t exchanged = 0;
  std::vector<std::uint64_t> images = std::vector<std::uint64_t>(exchanges.size());

 private:
  void exchange() {
    bus_->exchange(net::monotonic(), exchanges);
    ++exchanged;
    for (std::size_t i = 0; i < exchanges.size(); ++i) images[i] += exchanges[i].fresh;
  }

  Time cycle_, deadline_{};
  std::unique_ptr<transports::Transport> bus_;
};

inline image::InputBytes input_of(int value) {
  image::InputBytes out;
  out.fill(static_cast<std::byte>(value));
  return out;
}

}  // namespace meca::test
