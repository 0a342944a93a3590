// Raw Ethernet: the sentences need no rights, the frames run through a cable in a network namespace of their own.
#include "transports/net/raw_ethernet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <thread>
#include <vector>

#include "tests/network_namespace.hpp"
#include "transports/net/clock.hpp"
#include "transports/net/poller.hpp"

namespace meca::net {
namespace {

using namespace std::chrono_literals;
using test::kNoNamespace;
using test::NetworkNamespace;
using testing::AllOf;
using testing::HasSubstr;
using Link = RawEthernet::Link;

constexpr std::uint16_t kEtherType = 0x88A4;
constexpr auto kPatience = 30s;

std::string sentence(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

// The shortest frame: to everybody, from `source`, all its bytes of the value `content`.
std::vector<std::byte> frame(const std::array<std::byte, 6>& source, std::uint16_t ether_type, int content) {
  std::vector<std::byte> out(60, static_cast<std::byte>(content));
  std::fill_n(out.begin(), 6, std::byte{0xFF});
  std::copy(source.begin(), source.end(), out.begin() + 6);
  out[12] = static_cast<std::byte>(ether_type >> 8);
  out[13] = static_cast<std::byte>(ether_type & 0xFF);
  return out;
}

std::vector<std::byte> next(RawEthernet& socket) {
  Poller poller(1);
  poller.watch(0, socket.descriptor());
  const auto end = monotonic() + kPatience;
  std::vector<std::byte> buffer(2000);
  while (poller.wait(end)) {
    if (const auto size = socket.receive(buffer)) return {buffer.begin(), buffer.begin() + static_cast<long>(*size)};
  }
  return {};
}

// A cable that was just plugged in takes a moment to carry.
bool eventually(const std::function<bool()>& condition) {
  const auto end = monotonic() + kPatience;
  while (!condition()) {
    if (monotonic() > end) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}
bool becomes(RawEthernet& socket, Link link) {
  return eventually([&] { return socket.link() == link; });
}
bool carries(RawEthernet& from, RawEthernet& to, const std::vector<std::byte>& sent) {
  std::vector<std::byte> buffer(sent.size());
  return eventually([&] { return from.send(sent) && to.receive(buffer) == sent.size() && buffer == sent; });
}

TEST(RawEthernet, NamesTheInterfacesThatThereAreWhenOneIsNot) {
  EXPECT_THAT(sentence([] { RawEthernet("eth99", kEtherType); }),
              HasSubstr("there is no network interface 'eth99' on this machine; it has "));
  EXPECT_THAT(sentence([] { RawEthernet("an-interface-with-a-long-name", kEtherType); }),
              HasSubstr("there is no network interface 'an-interface-with-a-long-name'"));
}

TEST(RawEthernet, RefusesTheLoopback) {
  EXPECT_EQ(sentence([] { RawEthernet("lo", kEtherType); }),
            "'lo' is no Ethernet interface but a loopback; name the one that the robot's cable is in");
}

TEST(RawEthernet, SaysWhichRightIsMissingAndHowToGiveIt) {
  const NetworkNamespace network;
  if (!network.usable()) GTEST_SKIP() << kNoNamespace;
  network.cable("eth1", "robot1");
  if (::seteuid(65534) != 0) GTEST_SKIP() << "runs without another user to become";  // takes the rights away
  const std::string said = sentence([] { RawEthernet("eth1", kEtherType); });
  ASSERT_EQ(::seteuid(0), 0);
  EXPECT_THAT(said, AllOf(HasSubstr("raw frames on 'eth1' need the right CAP_NET_RAW; run as root"),
                          HasSubstr("sudo setcap cap_net_raw,cap_sys_nice,cap_ipc_lock+ep /"), HasSubstr("test_net"),
                          HasSubstr("docker run --user root --cap-add NET_RAW")));
}

TEST(RawEthernet, RefusesAnInterfaceOfShortFrames) {
  const NetworkNamespace network;
  if (!network.usable()) GTEST_SKIP() << kNoNamespace;
  network.cable("eth1", "robot1");
  ASSERT_TRUE(network.ip("link set eth1 mtu 1400"));
  EXPECT_EQ(sentence([] { RawEthernet("eth1", kEtherType); }),
            "'eth1' takes frames of 1400 bytes (MTU), 1500 are needed; ip link set eth1 mtu 1500");
}

TEST(RawEthernet, CarriesFramesOfItsTypeAndNotItsOwn) {
  const NetworkNamespace network;
  if (!network.usable()) GTEST_SKIP() << kNoNamespace;
  network.cable("eth1", "robot1");
  RawEthernet ours("eth1", kEtherType), theirs("robot1", kEtherType), others("robot1", 0x8892);
  const auto sent = frame(ours.address(), kEtherType, 0x11);
  EXPECT_TRUE(others.send(frame(others.address(), 0x8892, 0x22)));
  EXPECT_TRUE(ours.send(sent));
  EXPECT_EQ(next(theirs), sent);
  EXPECT_TRUE(theirs.send(sent));
  EXPECT_EQ(next(ours), sent);
  std::array<std::byte, 60> buffer;
  EXPECT_EQ(ours.receive(buffer), std::nullopt);  // neither what it sent itself nor what is of another type
  EXPECT_EQ(theirs.receive(buffer), std::nullopt);
}

TEST(RawEthernet, TellsTheWholeSizeOfAFrameThatWasCut) {
  const NetworkNamespace network;
  if (!network.usable()) GTEST_SKIP() << kNoNamespace;
  network.cable("eth1", "robot1");
  RawEthernet ours("eth1", kEtherType), theirs("robot1", kEtherType);
  auto longest = frame(ours.address(), kEtherType, 0x33);
  longest.resize(RawEthernet::kLongestFrame);
  ASSERT_TRUE(ours.send(longest));
  Poller poller(1);
  poller.watch(0, theirs.descriptor());
  ASSERT_TRUE(poller.wait(monotonic() + kPatience));
  std::array<std::byte, 60> buffer;
  EXPECT_EQ(theirs.receive(buffer), RawEthernet::kLongestFrame);
}

TEST(RawEthernet, SeesTheCableAndTheSwitchAndGoesOnAfterwards) {
  const NetworkNamespace network;
  if (!network.usable()) GTEST_SKIP() << kNoNamespace;
  network.cable("eth1", "robot1");
  RawEthernet ours("eth1", kEtherType), theirs("robot1", kEtherType);
  const auto sent = frame(ours.address(), kEtherType, 0x44);
  EXPECT_TRUE(becomes(ours, Link::kUp));
  ASSERT_TRUE(network.ip("link set robot1 down"));
  EXPECT_TRUE(becomes(ours, Link::kNoCarrier));
  ASSERT_TRUE(network.ip("link set eth1 down"));
  EXPECT_TRUE(becomes(ours, Link::kDown));
  EXPECT_FALSE(ours.send(sent));
  ASSERT_TRUE(network.ip("link set eth1 up") && network.ip("link set robot1 up"));
  EXPECT_TRUE(becomes(ours, Link::kUp));
  EXPECT_TRUE(carries(ours, theirs, sent));
}

TEST(RawEthernet, OpensAnInterfaceThatIsDown) {
  const NetworkNamespace network;
  if (!network.usable()) GTEST_SKIP() << kNoNamespace;
  network.cable("eth1", "robot1");
  ASSERT_TRUE(network.ip("link set eth1 down"));
  RawEthernet ours("eth1", kEtherType);
  EXPECT_TRUE(becomes(ours, Link::kDown));
  ASSERT_TRUE(network.ip("link set eth1 up"));
  RawEthernet theirs("robot1", kEtherType);
  const auto sent = frame(ours.address(), kEtherType, 0x55);
  EXPECT_TRUE(carries(ours, theirs, sent));
}

TEST(RawEthernet, FindsAnInterfaceThatWasTakenAwayAndCameBack) {
  const NetworkNamespace network;
  if (!network.usable()) GTEST_SKIP() << kNoNamespace;
  network.cable("eth1", "robot1");
  RawEthernet ours("eth1", kEtherType);
  ASSERT_TRUE(network.ip("link del eth1"));
  EXPECT_TRUE(becomes(ours, Link::kGone));
  network.cable("eth1", "robot1");
  EXPECT_TRUE(becomes(ours, Link::kUp));
  RawEthernet theirs("robot1", kEtherType);
  const auto sent = frame(ours.address(), kEtherType, 0x66);
  EXPECT_TRUE(carries(theirs, ours, sent));
}

}  // namespace
}  // namespace meca::net
