// Waiting for several descriptors at once, until a time.
#include "transports/net/poller.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "transports/net/clock.hpp"
#include "transports/net/file.hpp"

namespace meca::net {
namespace {

using namespace std::chrono_literals;

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) == 0) {
      read_end = File(ends[0]);
      write_end = File(ends[1]);
    }
  }
  File read_end, write_end;
};

TEST(Poller, WaitsUntilTheTimeItIsTold) {
  const Pipe pipe;
  Poller poller(1);
  poller.watch(0, pipe.read_end.get());
  const auto until = monotonic() + 20ms;
  EXPECT_FALSE(poller.wait(until));
  EXPECT_GE(monotonic(), until);
  EXPECT_FALSE(poller.ready(0));
}

TEST(Poller, SaysWhichIsReady) {
  const Pipe silent, speaking;
  ASSERT_EQ(::write(speaking.write_end.get(), "x", 1), 1);
  Poller poller(4);
  poller.watch(0, silent.read_end.get());
  poller.watch(1, speaking.read_end.get());
  poller.watch(2, silent.write_end.get());
  poller.watch(3, silent.write_end.get(), true);
  EXPECT_TRUE(poller.wait(monotonic() + 1h));
  EXPECT_FALSE(poller.ready(0));
  EXPECT_TRUE(poller.ready(1));
  EXPECT_FALSE(poller.ready(2)) << "there is room to send, but nobody asked";
  EXPECT_TRUE(poller.ready(3));
}

TEST(Poller, DoesNotLookWhereItIsNoLongerTold) {
  const Pipe pipe;
  ASSERT_EQ(::write(pipe.write_end.get(), "x", 1), 1);
  Poller poller(1);
  poller.watch(0, pipe.read_end.get());
  poller.watch(0, -1);
  EXPECT_FALSE(poller.wait(monotonic()));
  EXPECT_FALSE(poller.ready(0));
}

TEST(Poller, LooksAlsoWhenTheTimeIsOver) {
  const Pipe pipe;
  ASSERT_EQ(::write(pipe.write_end.get(), "x", 1), 1);
  Poller poller(1);
  poller.watch(0, pipe.read_end.get());
  EXPECT_TRUE(poller.wait(monotonic() - 1h));
  EXPECT_TRUE(poller.ready(0));
}

}  // namespace
}  // namespace meca::net
