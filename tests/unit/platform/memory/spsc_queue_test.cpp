// SPDX-License-Identifier: Apache-2.0
#include "platform/memory/spsc_queue.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <thread>

namespace zonepack {
namespace {

TEST(SpscQueue, GivesItemsInTheirOrderAndRefusesOneTooMany) {
  SpscQueue<int> queue(3);
  EXPECT_TRUE(queue.push(1) && queue.push(2) && queue.push(3));
  EXPECT_FALSE(queue.push(4));
  EXPECT_EQ(queue.size(), 3u);
  int item = 0;
  for (int expected = 1; expected <= 3; ++expected) {
    ASSERT_TRUE(queue.pop(item));
    EXPECT_EQ(item, expected);
  }
  EXPECT_FALSE(queue.pop(item));
  EXPECT_EQ(queue.peek(), nullptr);
}

TEST(SpscQueue, LosesAndRepeatsNothingBetweenTwoThreads) {
  constexpr std::uint64_t kItems = 200'000;
  SpscQueue<std::uint64_t> queue(7);
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kItems; ++i) {
      while (!queue.push(i)) std::this_thread::yield();
    }
  });
  for (std::uint64_t expected = 0; expected < kItems;) {
    std::uint64_t item = 0;
    if (!queue.pop(item)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(item, expected);
    ++expected;
  }
  producer.join();
}

}  // namespace
}  // namespace zonepack
