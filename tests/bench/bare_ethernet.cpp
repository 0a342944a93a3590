#include "tests/bench/bare_ethernet.hpp"

#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "tests/bench/clock.hpp"
#include "tests/bench/ethercat_cable.hpp"
#include "transports/net/raw_ethernet.hpp"

namespace meca::bench {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr nanoseconds kCycle = 1ms, kBreath = 50us;
constexpr std::uint32_t kRemembered = 4;  // cycles: what comes back later counts as lost, as with the bridge

class BareLoop {
 public:
  explicit BareLoop(const BareLoopOptions& options)
      : socket_(kMasterInterface, kBareEtherType), frames_(options.frames) {
    buffer_.fill(std::byte{0});
    std::fill_n(buffer_.begin(), 6, std::byte{0xFF});  // to everybody, from us
    std::ranges::copy(socket_.address(), buffer_.begin() + 6);
    buffer_[12] = static_cast<std::byte>(kBareEtherType >> 8);
    buffer_[13] = static_cast<std::byte>(kBareEtherType & 0xFF);
  }

  // Returns how many cycles were over before they could begin.
  long run(nanoseconds begin, nanoseconds duration) {
    long missed = 0;
    for (auto deadline = begin; deadline < begin + duration;) {
      sleep_until(deadline);
      send_all();
      // Only so long that a reply which does not come costs no cycle.
      for (std::size_t i = 0; i < frames_.size();) {
        const auto cycle = receive(deadline + kCycle - kBreath);
        if (!cycle) break;
        i += *cycle == cycle_ ? 1 : 0;
      }
      sent_ += static_cast<long>(frames_.size());
      deadline += kCycle;
      const long skipped = std::max<long>(0, (monotonic_now() - deadline + kCycle - 1ns) / kCycle);
      missed += skipped;
      deadline += skipped * kCycle;
      note_second();
    }
    return missed;
  }

  void restart() {
    seconds_ = {};
    sent_ = received_ = 0;
  }
  const RoundTrips& seconds() const { return seconds_; }
  long lost() const { return sent_ - received_; }

 private:
  void send_all() {
    ++cycle_;
    sent_at_[cycle_ % kRemembered] = monotonic_now();
    std::memcpy(&buffer_[kBareCycle], &cycle_, sizeof cycle_);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      buffer_[kBareNumber] = static_cast<std::byte>(i);
      ::send(socket_.descriptor(), buffer_.data(), frames_[i], 0);
    }
  }
  // The cycle of the frame that came, which may be one before.
  std::optional<std::uint32_t> receive(nanoseconds until) {
    pollfd waiting{socket_.descriptor(), POLLIN, 0};
    const timespec timeout{0, std::max(until - monotonic_now(), 0ns).count()};
    if (::ppoll(&waiting, 1, &timeout, nullptr) <= 0) return std::nullopt;
    if (::recv(socket_.descriptor(), received_frame_.data(), received_frame_.size(), 0) < 0) return std::nullopt;
    std::uint32_t cycle = 0;
    std::memcpy(&cycle, &received_frame_[kBareCycle], sizeof cycle);
    if (cycle_ - cycle < kRemembered) {
      const auto back = monotonic_now();
      trips_.add(back - sent_at_[cycle % kRemembered], back);
      ++received_;
    }
    return cycle;
  }
  void note_second() {
    const auto now = monotonic_now();
    if (now < next_second_) return;
    if (trips_.facts().max > 0) seconds_.second(trips_.facts());
    next_second_ = now + 1s;
  }

  net::RawEthernet socket_;
  std::vector<std::size_t> frames_;
  std::array<std::byte, net::RawEthernet::kLongestFrame> buffer_{}, received_frame_{};
  std::uint32_t cycle_ = 0;
  std::array<nanoseconds, kRemembered> sent_at_{};
  ethercat::Histogram trips_;
  RoundTrips seconds_;
  nanoseconds next_second_{};
  long sent_ = 0, received_ = 0;
};

}  // namespace

void RoundTrips::second(const ethercat::Histogram::Facts& facts) {
  ++seconds_;
  p50_ += facts.p50;
  p99_ += facts.p99;
  max_ = std::max(max_, facts.max);
}

bool make_real_time() {
  const sched_param wanted{.sched_priority = kPriority};
  return sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) == 0;
}

nlohmann::ordered_json run_bare_ethernet(const BareLoopOptions& options) {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // as the bridge
  make_real_time();
  BareLoop loop(options);
  loop.run(options.begin, options.start_up);
  loop.restart();
  const long missed = loop.run(options.begin + options.start_up, options.duration);
  return {{"trip_p50_us", loop.seconds().p50_us()},
          {"trip_p99_us", loop.seconds().p99_us()},
          {"trip_max_us", loop.seconds().max_us()},
          {"lost", loop.lost()},
          {"missed_cycles", missed}};
}

}  // namespace meca::bench
