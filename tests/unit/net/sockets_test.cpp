// TCP, UDP and waiting for them, on loopback addresses and ports that the system chooses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "transports/net/clock.hpp"
#include "transports/net/ipv4.hpp"
#include "transports/net/machine.hpp"
#include "transports/net/poller.hpp"
#include "transports/net/tcp.hpp"
#include "transports/net/udp.hpp"

namespace meca::net {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::uint32_t kHere = 0x7F000001, kThere = 0x7F000907, kNobody = 0xC0000201;  // 127.0.9.7, 192.0.2.1
constexpr auto kPatience = 30s;

std::vector<std::byte> bytes(std::string_view text) {
  std::vector<std::byte> out;
  for (const char c : text) out.push_back(static_cast<std::byte>(c));
  return out;
}

std::string sentence(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

// True as soon as the condition holds.
bool eventually(const std::function<bool()>& condition) {
  const auto end = monotonic() + kPatience;
  while (!condition()) {
    if (monotonic() > end) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

TEST(Ipv4, IsReadAndWrittenAsPeopleDo) {
  EXPECT_EQ(parse_ipv4("192.168.0.100"), 0xC0A80064u);
  EXPECT_EQ(to_string(std::uint32_t{0xC0A80064}), "192.168.0.100");
  EXPECT_EQ(to_string(Endpoint{0xC0A80064, 2222}), "192.168.0.100:2222");
  for (const char* wrong : {"", "192.168.0", "192.168.0.256", "192.168.0.100.1", "robot", "192.168.0.100 "}) {
    EXPECT_EQ(parse_ipv4(wrong), std::nullopt) << wrong;
  }
}

TEST(Ipv4, NamesAreResolvedOrTheSentenceSaysWhichWasNot) {
  EXPECT_EQ(resolve_ipv4("127.0.9.7"), kThere);
  EXPECT_EQ(resolve_ipv4("localhost"), kHere);
  EXPECT_THAT(sentence([] { resolve_ipv4("no-such-robot.invalid"); }),
              StartsWith("the host name 'no-such-robot.invalid' has no IPv4 address here"));
}

TEST(Ipv4, KnowsTheLoopbackInterfaceAndWhereItLeads) {
  const auto all = ipv4_interfaces();
  const auto loopback = std::ranges::find(all, kHere, &Interface::address);
  ASSERT_NE(loopback, all.end());
  EXPECT_EQ(loopback->broadcast(), 0x7FFFFFFFu);
  EXPECT_EQ(source_for(kHere), kHere);
}

TEST(Udp, CarriesDatagramsAndSaysWhoSentThem) {
  UdpSocket a({kHere, 0}, {.dscp = 47, .receive_buffer = 65536}), b({kThere, 0}, {});
  ASSERT_TRUE(a.send(b.local(), bytes("hello")));
  std::array<std::byte, 3> buffer{};
  std::optional<UdpSocket::Received> got;
  ASSERT_TRUE(eventually([&] { return (got = b.receive(buffer)).has_value(); }));
  EXPECT_EQ(got->from, a.local());
  EXPECT_EQ(got->size, 5U);  // as it was sent, though only three bytes had room
  EXPECT_EQ(b.receive(buffer), std::nullopt);
}

TEST(Udp, GoesOnAfterNobodyListened) {
  Endpoint closed;
  {
    const UdpSocket gone({kHere, 0}, {});
    closed = gone.local();
  }
  UdpSocket a({kHere, 0}, {}), b({kHere, 0}, {});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(a.send(closed, bytes("?")));
  ASSERT_TRUE(a.send(b.local(), bytes("!")));
  std::array<std::byte, 8> buffer{};
  EXPECT_TRUE(eventually([&] { return b.receive(buffer).has_value(); }));
  EXPECT_EQ(a.receive(buffer), std::nullopt);
}

TEST(Udp, DeliversGroupsToMembersOnly) {
  constexpr std::uint32_t kGroup = 0xEFC00909;  // 239.192.9.9
  UdpSocket member({0, 0}, {}), sender({kHere, 0}, {.multicast_interface = kHere});
  const Endpoint group{kGroup, member.local().port};
  ASSERT_TRUE(member.join(kGroup, kHere));
  std::array<std::byte, 8> buffer{};
  ASSERT_TRUE(sender.send(group, bytes("1")));
  ASSERT_TRUE(eventually([&] { return member.receive(buffer).has_value(); }));
  member.leave(kGroup, kHere);
  ASSERT_TRUE(sender.send(group, bytes("2")));
  ASSERT_TRUE(sender.send({kHere, group.port}, bytes("3")));
  ASSERT_TRUE(eventually([&] { return member.receive(buffer).has_value(); }));
  EXPECT_EQ(buffer[0], std::byte{'3'});  // what went to the group did not come
  EXPECT_FALSE(member.join(kGroup, kNobody));
}

TEST(Udp, SaysWhyAPortCannotBeHad) {
  const UdpSocket first({kHere, 0}, {});
  const Endpoint taken = first.local();
  EXPECT_EQ(sentence([&] { UdpSocket second(taken, {}); }),
            "UDP port " + std::to_string(taken.port) +
                " of 127.0.0.1 is taken by another program on this machine; stop it, or choose another port");
  EXPECT_EQ(sentence([&] {
              UdpSocket everywhere({0, taken.port}, {});
            }),
            "UDP port " + std::to_string(taken.port) +
                " is taken by another program on this machine; stop it, bind to one address, or choose another port");
  EXPECT_EQ(sentence([] { UdpSocket elsewhere({kNobody, 0}, {}); }), "192.0.2.1 is not an address of this machine");
}

TEST(Tcp, ConnectsFromTheAddressItIsToldAndCarriesBytesBothWays) {
  TcpListener listener({kHere, 0});
  auto client = TcpStream::connect(listener.local(), 27, kThere);
  ASSERT_TRUE(client);
  std::optional<TcpStream> server;
  ASSERT_TRUE(eventually([&] { return (server = listener.accept()).has_value(); }));
  ASSERT_TRUE(eventually([&] { return client.progress() == TcpStream::Progress::kConnected; }));
  EXPECT_EQ(client.local().ipv4, kThere);
  EXPECT_EQ(server->peer(), client.local());
  EXPECT_EQ(client.peer(), listener.local());

  std::array<std::byte, 8> buffer{};
  EXPECT_EQ(server->receive(buffer).bytes, 0U);  // nothing yet, and not closed
  EXPECT_EQ(client.send(bytes("ping")).bytes, 4U);
  ASSERT_TRUE(eventually([&] { return server->receive(buffer).bytes == 4; }));
  EXPECT_EQ(server->send(bytes("pong")).bytes, 4U);
  ASSERT_TRUE(eventually([&] { return client.receive(buffer).bytes == 4; }));
  server->close();
  ASSERT_TRUE(eventually([&] { return client.receive(buffer).closed; }));
  EXPECT_EQ(client.trouble(), "");  // in order
}

TEST(Tcp, SaysThatNobodyListens) {
  Endpoint closed;
  {
    const TcpListener gone({kHere, 0});
    closed = gone.local();
  }
  auto stream = TcpStream::connect(closed);
  EXPECT_TRUE(eventually([&] { return stream.progress() == TcpStream::Progress::kFailed; }));
  EXPECT_EQ(stream.trouble(), "connection refused: nothing listens there");
  EXPECT_FALSE(stream);
}

TEST(Tcp, SaysThatTheOwnAddressIsNone) {
  const TcpListener listener({kHere, 0});
  const auto stream = TcpStream::connect(listener.local(), 0, kNobody);
  EXPECT_FALSE(stream);
  EXPECT_EQ(stream.trouble(), "the own address to connect from is not an address of this machine");
}

TEST(Tcp, SendsAsMuchAsGoesAndNoMore) {
  TcpListener listener({kHere, 0});
  auto client = TcpStream::connect(listener.local());
  ASSERT_TRUE(eventually([&] { return client.progress() == TcpStream::Progress::kConnected; }));
  const std::vector<std::byte> much(1 << 20);
  TcpStream::Count sent;
  ASSERT_TRUE(eventually([&] {
    sent = client.send(much);
    return sent.bytes < much.size();
  }));
  EXPECT_FALSE(sent.closed);
}

TEST(Tcp, SaysWhyAPortCannotBeHad) {
  const TcpListener first({kHere, 0});
  const Endpoint taken = first.local();
  EXPECT_THAT(sentence([&] { TcpListener second(taken); }),
              HasSubstr("TCP port " + std::to_string(taken.port) + " of 127.0.0.1 is taken by another program"));
  EXPECT_EQ(sentence([] { TcpListener elsewhere({kNobody, 0}); }), "192.0.2.1 is not an address of this machine");
}

TEST(Poller, WakesForWhatArrivesAndSaysWhere) {
  UdpSocket a({kHere, 0}, {}), b({kHere, 0}, {}), c({kHere, 0}, {});
  Poller poller(3);
  poller.watch(0, a.descriptor());
  poller.watch(2, b.descriptor());
  EXPECT_FALSE(poller.wait(monotonic() + 1ms));
  ASSERT_TRUE(c.send(b.local(), bytes("x")));
  EXPECT_TRUE(poller.wait(monotonic() + kPatience));
  EXPECT_FALSE(poller.ready(0));
  EXPECT_FALSE(poller.ready(1));
  EXPECT_TRUE(poller.ready(2));
  EXPECT_TRUE(poller.wait({}));  // a time that is over: only a look
  poller.watch(2, -1);
  EXPECT_FALSE(poller.wait({}));
  EXPECT_FALSE(poller.ready(2));
}

TEST(Poller, WaitsUntilTheTimeAndNotLess) {
  Poller poller(1);
  const auto until = monotonic() + 3ms;
  EXPECT_FALSE(poller.wait(until));
  EXPECT_GE(monotonic(), until);
}

TEST(Machine, HasTheSameIdentityEveryTime) {
  EXPECT_FALSE(machine_identity().empty());
  EXPECT_EQ(machine_identity(), machine_identity());
}

}  // namespace
}  // namespace meca::net
