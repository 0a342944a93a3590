// meca-ctl scan against the device side of EtherNet/IP on the loopback, at an address of its own: no bridge, no robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/cli/process.hpp"
#include "transports/ethernet_ip/adapter.hpp"
#include "transports/net/clock.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/udp.hpp"

namespace meca::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

// Parallel runs of the tests on one machine do not meet: 127.64.0.0 to 127.127.255.255 by our process id.
std::uint32_t own_loopback() { return 0x7F400000u | (static_cast<std::uint32_t>(::getpid()) & 0x3FFFFF); }

// Answers ListIdentity over UDP until it goes.
class Device {
 public:
  Device() : socket_({own_loopback(), ethernet_ip::kTcpPort}, {}), thread_([this] { serve(); }) {}
  ~Device() {
    stop_ = true;
    thread_.join();
  }

 private:
  static ethernet_ip::AdapterSettings settings() {
    ethernet_ip::AdapterSettings s;
    s.identity.vendor_id = 1565;
    s.identity.device_type = 43;
    s.identity.product_code = 500;
    s.identity.major = 11;
    s.identity.minor = 3;
    s.identity.serial_number = 4711;
    s.identity.state = 3;
    s.identity.set_name("Meca500");
    s.address = own_loopback();
    return s;
  }
  void serve() {
    ethernet_ip::Adapter adapter(settings());
    std::array<std::byte, 1500> buffer;
    net::Poller poller(1);
    poller.watch(0, socket_.descriptor());
    while (!stop_) {
      poller.wait(net::monotonic() + 10ms);
      while (const auto received = socket_.receive(buffer)) {
        const auto answer = adapter.udp_received(std::span(buffer).first(received->size), false);
        if (!answer.bytes.empty()) socket_.send(received->from, answer.bytes);
      }
    }
  }

  net::UdpSocket socket_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

Result scan(std::vector<std::string> words) {
  words.insert(words.begin(), {MECA_CTL, "scan", "ethernet_ip"});
  return run(words);
}

TEST(Scan, FindsTheRobotAndMarksIt) {
  const Device device;
  const auto result = scan({"--address", net::to_string(own_loopback()), "--timeout", "30"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr(net::to_string(own_loopback()) + "  Meca500"));
  EXPECT_THAT(result.output, HasSubstr("1 device, 1 Meca500"));
}

TEST(Scan, TellsProgramsInJson) {
  const Device device;
  const auto result = scan({"--address", net::to_string(own_loopback()), "--timeout", "30", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const auto found = nlohmann::json::parse(result.output);
  EXPECT_EQ(found["addresses"][0], net::to_string(own_loopback()));
  EXPECT_EQ(found["serial_number"], 4711);
  EXPECT_EQ(found["revision"], "11.3");
  EXPECT_EQ(found["meca500"], true);
}

TEST(Scan, SaysWhatToCheckWhenNobodyAnswers) {
  const auto result = scan({"--address", net::to_string(own_loopback()), "--timeout", "0.2"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("no EtherNet/IP device answered within 0.2 s"));
}

TEST(Scan, ListsTheInterfacesWhenTheOneThatWasNamedIsNotThere) {
  const auto result = scan({"--interface", "nowhere0"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("there is no interface 'nowhere0'"));
  EXPECT_THAT(result.output, HasSubstr("lo (127.0.0.1/8)"));
}

}  // namespace
}  // namespace meca::test
