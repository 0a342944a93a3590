// The queue between two threads, and the bell that wakes its consumer; the tests with threads are there for TSan.
#include "bridge/queues.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

#include "bridge/wakeup.hpp"

namespace meca::bridge {
namespace {

using namespace std::chrono_literals;

TEST(SpscQueue, AnEmptyQueueHasNoFront) {
  const SpscQueue<int> queue(4);
  EXPECT_EQ(queue.front(), nullptr);
  EXPECT_EQ(queue.size(), 0U);
}

TEST(SpscQueue, TheCapacityIsThePowerOfTwoAboveTheWish) {
  EXPECT_EQ(SpscQueue<int>(1).capacity(), 1U);
  EXPECT_EQ(SpscQueue<int>(5).capacity(), 8U);
  EXPECT_EQ(SpscQueue<int>(8).capacity(), 8U);
}

TEST(SpscQueue, AFullQueueRefusesAndKeepsWhatItHas) {
  SpscQueue<int> queue(2);
  EXPECT_TRUE(queue.push(1));
  EXPECT_TRUE(queue.push(2));
  EXPECT_FALSE(queue.push(3));
  EXPECT_EQ(*queue.front(), 1);
  queue.pop();
  EXPECT_TRUE(queue.push(4));
  EXPECT_EQ(*queue.front(), 2);
  queue.pop();
  EXPECT_EQ(*queue.front(), 4);
}

TEST(SpscQueue, TwoThreadsSeeEveryElementOnceInOrderAndWhole) {
  struct Wide {  // wider than a word: a torn element would show
    std::array<std::uint64_t, 8> copies;
  };
  constexpr std::uint64_t kCount = 100'000;
  SpscQueue<Wide> queue(16);
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kCount; ++i) {
      Wide wide;
      wide.copies.fill(i);
      while (!queue.push(wide)) std::this_thread::yield();
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 0; expected < kCount;) {
    const Wide* wide = queue.front();
    if (wide == nullptr) {
      std::this_thread::yield();
      continue;
    }
    for (const auto copy : wide->copies) wrong += copy != expected;
    queue.pop();
    ++expected;
  }
  producer.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(queue.front(), nullptr);
}

TEST(Wakeup, ANotificationBeforeTheWaitIsNotLost) {
  Wakeup wakeup;
  wakeup.notify();
  wakeup.notify();
  wakeup.wait(1h);  // a lost one would hang here until the test runner ends it
}

TEST(Wakeup, NoElementIsLeftWaitingForTheTimeout) {
  Wakeup wakeup;
  SpscQueue<int> queue(1024);
  constexpr int kCount = 20'000;
  std::thread producer([&] {
    for (int i = 0; i < kCount; ++i) {
      while (!queue.push(i)) std::this_thread::yield();
      wakeup.notify();
    }
  });
  for (int seen = 0; seen < kCount;) {
    wakeup.wait(1h);
    while (queue.front() != nullptr) {
      queue.pop();
      ++seen;
    }
  }
  producer.join();
}

}  // namespace
}  // namespace meca::bridge
