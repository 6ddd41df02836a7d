// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/rate_limit.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(RateLimit, ZeroIsNoLimit) {
  RateLimit limit(0);
  EXPECT_EQ(limit.spend(ByteCount{1} << 40, 0), 0);
}

TEST(RateLimit, AFullBucketLetsABurstThroughAndThenHoldsTheRate) {
  // 1 MB/s is 1 kB in 1 ms; the bucket holds 64 kB, which take 64 ms to come in.
  RateLimit limit(1'000'000, 64'000);
  const std::int64_t start = 5'000 * kMs;
  EXPECT_EQ(limit.spend(64'000, start), 0);
  EXPECT_EQ(limit.spend(10'000, start), 10 * kMs);
  EXPECT_EQ(limit.spend(5'000, start + 10 * kMs), 5 * kMs);
  // 20 ms later the debt of 5 kB is paid and 15 kB are in: 25 kB are 10 kB too many.
  EXPECT_EQ(limit.spend(25'000, start + 30 * kMs), 10 * kMs);
}

TEST(RateLimit, AtTheStartTheBucketIsFullWhateverTheClockSays) {
  RateLimit limit(1'000'000, 64'000);
  EXPECT_EQ(limit.spend(64'000, 64 * kMs), 0);
}

TEST(RateLimit, APauseOfAnyLengthFillsTheBucketOnlyOnce) {
  RateLimit limit(1'000'000, 64'000);
  EXPECT_EQ(limit.spend(1, 0), 0);
  EXPECT_EQ(limit.spend(65'000, 1'000'000 * kMs), 1 * kMs);
}

TEST(RateLimit, NeverLetsMoreThroughThanTimeAllows) {
  // A reader of 57 kB windows that obeys the limit, for 10 s at slightly less than 3 B/us.
  constexpr std::uint64_t kRate = 2'999'999, kWindow = 57'001;
  RateLimit limit(kRate);
  std::int64_t now = 100'000 * kMs;
  const std::int64_t start = now;
  std::uint64_t bytes = 0;
  while (now < start + 10'000 * kMs) {
    bytes += kWindow;
    now += limit.spend(kWindow, now);
    const double allowed = static_cast<double>(now - start) * kRate / 1e9;
    ASSERT_LE(static_cast<double>(bytes), allowed + kReadBufferBytes + kWindow);
  }
  // And no less: it used all the time allowed.
  EXPECT_GE(bytes, 10 * kRate);
}

TEST(RateLimit, OneByteASecondAndAWholeDiskDoNotOverflow) {
  RateLimit limit(1, 0);
  EXPECT_EQ(limit.spend(ByteCount{1} << 60, 0), 9'000'000'000 * 1'000'000'000);
  RateLimit large(1'000'000'000'000, 0);
  EXPECT_EQ(large.spend(1, 0), 1) << "rounded up";
}

}  // namespace
}  // namespace zonepack
