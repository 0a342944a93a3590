// The EtherNet/IP transport against robots on real sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/session/adapter_host.hpp"
#include "transports/ethernet_ip/transport.hpp"
#include "transports/net/clock.hpp"

namespace meca::test {
namespace {

using namespace ethernet_ip;
using namespace std::chrono_literals;
using testing::HasSubstr;
using transports::Exchange;
using transports::LinkState;

constexpr auto kPatience = 60s;  // the end of hope, not an expectation
constexpr Time kCycle = 10ms;

const std::string kBridge = "127.0.7.1", kArm1 = "127.0.7.2", kArm2 = "127.0.7.3";

BusOptions usual_bus() {
  BusOptions out;
  out.bind = net::parse_ipv4(kBridge).value();
  out.name = "test";
  return out;
}

RobotOptions robot(const std::string& address) {
  RobotOptions out;
  out.address = address;
  out.timeout_multiplier = 64;  // 640 ms: the machine may be busy
  return out;
}

// Turns a bus as the bridge's loop does.
class Turner {
 public:
  explicit Turner(std::vector<RobotOptions> robots, const BusOptions& options = usual_bus(), Time cycle = kCycle)
      : exchanges(robots.size()), cycle_(cycle), bus_(make_transport(std::move(robots), options)) {
    bus_->open(net::monotonic());
    deadline_ = net::monotonic();
  }

  void turn() {
    using Woke = transports::Transport::Woke;
    deadline_ = std::max(deadline_ + cycle_, net::monotonic());
    while (bus_->wait(deadline_) == Woke::kArrival) exchange();
    exchange();
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
    return until(
        [&] { return std::ranges::all_of(exchanges, [](const auto& e) { return e.link == LinkState::kUp; }); });
  }

  std::int64_t counter(std::string_view name, std::size_t robot = 0) const {
    const auto all = bus_->counters();
    const auto found = std::ranges::find(all, name, &transports::CounterInfo::name);
    if (found == all.end()) throw std::invalid_argument("no counter " + std::string(name));
    return exchanges[robot].counters[static_cast<std::size_t>(found - all.begin())];
  }
  std::string detail(std::size_t robot = 0) const { return std::string(exchanges[robot].link_detail.view()); }
  void close() { bus_->close(); }

  std::vector<Exchange> exchanges;
  std::vector<std::uint64_t> images = std::vector<std::uint64_t>(exchanges.size());

 private:
  void exchange() {
    bus_->exchange(net::monotonic(), exchanges);
    for (std::size_t i = 0; i < exchanges.size(); ++i) images[i] += exchanges[i].fresh;
  }

  Time cycle_, deadline_{};
  std::unique_ptr<transports::Transport> bus_;
};

image::InputBytes input_of(int value) {
  image::InputBytes out;
  out.fill(static_cast<std::byte>(value));
  return out;
}

TEST(EthernetIpTransport, CarriesTheImageInBothDirections) {
  AdapterHost arm1(kArm1);
  arm1.with([](auto& a) { a.set_input(input_of(0x5A)); });
  Turner bus({robot(kArm1)});
  ASSERT_TRUE(bus.until_up()) << bus.detail();
  EXPECT_TRUE(bus.until([&] { return bus.exchanges[0].input == input_of(0x5A); }));
  bus.exchanges[0].output.fill(std::byte{0xA5});
  bus.exchanges[0].output_valid = true;
  EXPECT_TRUE(
      bus.until([&] { return arm1.with([&](auto& a) { return a.run() && a.output() == bus.exchanges[0].output; }); }));
  EXPECT_EQ(bus.detail(), "");
  EXPECT_EQ(bus.counter("api_o_to_t"), 10'000);
  EXPECT_EQ(bus.counter("api_t_to_o"), 10'000);
}

}  // namespace
}  // namespace meca::test
