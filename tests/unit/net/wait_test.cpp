#include "transports/net/wait.hpp"

#include <gtest/gtest.h>

#include <array>

#include "transports/net/udp.hpp"

namespace meca::net {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kLoopback = 0x7F000001;

TEST(WaitReadable, EndsWhenOneOfSeveralHasSomethingToRead) {
  UdpSocket quiet({kLoopback, 0}, {}), asked({kLoopback, 0}, {}), asker({kLoopback, 0}, {});
  const std::array<std::byte, 3> datagram{};
  ASSERT_TRUE(asker.send(asked.local(), datagram));
  const std::array descriptors{quiet.descriptor(), asked.descriptor()};
  wait_readable(descriptors, 600s);  // ctest would end it
  std::array<std::byte, 16> buffer;
  ASSERT_TRUE(asked.receive(buffer));
  EXPECT_FALSE(quiet.receive(buffer));
}

TEST(WaitReadable, EndsAfterItsTimeWhenNothingComes) {
  const UdpSocket quiet({kLoopback, 0}, {});
  const std::array descriptors{quiet.descriptor()};
  const auto begin = std::chrono::steady_clock::now();
  wait_readable(descriptors, 20ms);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);
  wait_readable(descriptors, -1s);  // over already: not for ever
}

}  // namespace
}  // namespace meca::net
