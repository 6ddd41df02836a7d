// SPDX-License-Identifier: Apache-2.0
#include "platform/memory/seqlock.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace zonepack {
namespace {

TEST(Seqlock, NeverShowsHalfOfAValue) {
  using Value = std::array<std::uint64_t, 16>;
  Seqlock<Value> lock;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t turn = 1; turn <= 20'000; ++turn) {
      Value value;
      value.fill(turn);
      lock.store(value);
      if (turn % 64 == 0) std::this_thread::yield();
    }
    done = true;
  });
  while (!done) {
    const Value value = lock.load();
    for (const std::uint64_t part : value) ASSERT_EQ(part, value[0]);
  }
  writer.join();
  EXPECT_EQ(lock.load()[15], 20'000u);
}

}  // namespace
}  // namespace zonepack
