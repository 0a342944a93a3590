// Robots in an EtherCAT segment, as a measuring instrument: a chain of devices on a raw socket, where the kernel stamps
// every frame (on a virtual cable that is when it was sent). What a bare loop sends (bare_ethernet.hpp) goes back as it
// came.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tests/bench/ethercat_cable.hpp"
#include "tests/bench/period_statistics.hpp"
#include "transports/ethercat/chain.hpp"
#include "transports/image/image.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/raw_ethernet.hpp"

namespace meca::bench {

// The beginnings of cycles on the wire.
struct Rhythm {
  PeriodStatistics periods;
  std::vector<double> off_us;  // of each period against the cycle, without sign
  void begin(std::chrono::nanoseconds at);

 private:
  std::optional<std::chrono::nanoseconds> last_;
};

// Runs on the thread that calls it, and only while it is called.
class EthercatCell {
 public:
  // `stamped`: every input image carries the Unix time at which its frame came by. Throws std::runtime_error.
  explicit EthercatCell(int robots, bool stamped = false);

  void run(std::chrono::nanoseconds duration);
  // Until every robot is in OP and gets outputs; throws std::runtime_error after 30 s.
  void run_until_operational();

  // Bridge, bare loop and robots have what they asked for (bare_ethernet.hpp): then other programs hardly disturb them.
  bool real_time() const { return real_time_; }

  void restart();  // forgets what was measured
  Rhythm& rhythm() { return cyclic_.rhythm; }
  Rhythm& bare_rhythm() { return bare_.rhythm; }
  // How long a cyclic frame was with the robots, mean: it is part of the round trip, and on a real robot would be 1 us.
  double robots_us() const {
    return 1e-3 * static_cast<double>(held_.count()) / static_cast<double>(std::max(frames_, 1L));
  }

  // Bytes of each frame of a cycle, as the bridge sends them.
  const std::vector<std::size_t>& frames_of_a_cycle() const { return sizes_; }
  // CLOCK_MONOTONIC: when the last cycle began.
  std::chrono::nanoseconds last_cycle() const { return last_cycle_; }

 private:
  struct Received {
    std::span<std::byte> frame;  // until the next call
    std::chrono::nanoseconds at{};
  };
  // One EtherType at the robots' end of the cable.
  struct Port {
    explicit Port(std::uint16_t ether_type);
    std::optional<Received> receive();

    net::RawEthernet socket;
    Rhythm rhythm;
    std::array<std::byte, net::RawEthernet::kLongestFrame> buffer{};
  };
  void serve_robots();
  void serve_bare();
  void note_cyclic(const Received& received, bool begins_cycle);

  std::vector<ethercat::Device> devices_;
  ethercat::Chain chain_;
  bool stamped_, real_time_ = false;
  Port cyclic_, bare_;
  net::Poller poller_;
  std::vector<std::size_t> sizes_, current_sizes_;
  std::chrono::nanoseconds last_cycle_{}, held_{};
  long frames_ = 0;
};

}  // namespace meca::bench
