// SPDX-License-Identifier: Apache-2.0
#include "platform/process/stamp_converter.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kOffset = 1'700'000'000'000 * kMs;
constexpr std::int64_t kHour = 3'600'000 * kMs;

// A queue that was empty at 100 ms and is read at 110 ms.
StampConverter read_at_110(std::int64_t offset_ns) {
  StampConverter stamps(kOffset);
  stamps.restart(0);
  stamps.read_between(100 * kMs, 100 * kMs, kOffset);
  stamps.emptied();
  stamps.read_between(110 * kMs, 110 * kMs, offset_ns);
  return stamps;
}

TEST(StampConverter, TakesTheOffsetOfTheClocksAway) {
  EXPECT_EQ(read_at_110(kOffset).monotonic_of(kOffset + 104 * kMs), 104 * kMs);
}

TEST(StampConverter, IsUnharmedByAWallClockSetBetweenArrivalAndReading) {
  for (const std::int64_t step : {kHour, -kHour, 1000 * kMs, -1000 * kMs, 30 * kMs, -30 * kMs}) {
    const StampConverter stamps = read_at_110(kOffset + step);
    EXPECT_EQ(stamps.monotonic_of(kOffset + 104 * kMs), 104 * kMs) << "before " << step;
    EXPECT_EQ(stamps.monotonic_of(kOffset + step + 107 * kMs), 107 * kMs) << "after " << step;
  }
}

TEST(StampConverter, IsUnharmedByAWallClockSetBeforeTheFirstReading) {
  for (const std::int64_t step : {kHour, -kHour}) {
    StampConverter stamps(kOffset);
    stamps.restart(0);
    stamps.read_between(110 * kMs, 110 * kMs, kOffset + step);
    EXPECT_EQ(stamps.monotonic_of(kOffset + 104 * kMs), 104 * kMs) << "before " << step;
    EXPECT_EQ(stamps.monotonic_of(kOffset + step + 107 * kMs), 107 * kMs) << "after " << step;
  }
}

TEST(StampConverter, IsOffByLessThanTheTimeBetweenReadingsWhereBothOffsetsWouldDo) {
  // 4 ms forward: a stamp made before it, at 104 ms, could as well have been made after it.
  const std::int64_t stamp = read_at_110(kOffset + 4 * kMs).monotonic_of(kOffset + 104 * kMs);
  EXPECT_EQ(stamp, 100 * kMs);
}

TEST(StampConverter, NeverLeavesTheTimeInWhichTheFrameArrived) {
  const StampConverter stamps = read_at_110(kOffset);
  EXPECT_EQ(stamps.monotonic_of(kOffset + 20 * kHour), 110 * kMs);
  EXPECT_EQ(stamps.monotonic_of(kOffset - 20 * kHour), 100 * kMs);
  EXPECT_EQ(stamps.monotonic_of(kOffset + 110 * kMs + 300'000), 110 * kMs);  // read late by 0.3 ms
}

TEST(StampConverter, KeepsTheOldOffsetWhileAnythingFromBeforeTheStepMayWait) {
  StampConverter stamps = read_at_110(kOffset + kHour);  // did not empty the queue
  stamps.read_between(120 * kMs, 120 * kMs, kOffset + kHour);
  EXPECT_EQ(stamps.monotonic_of(kOffset + 105 * kMs), 105 * kMs);
}

TEST(HardwareStamps, KeepTheDistancesThatTheControllerSaw) {
  HardwareStamps hardware;
  // Arrivals 10 ms apart on a clock that started at 5 s; the interrupt comes 0.1 to 3 ms late.
  EXPECT_EQ(hardware.monotonic_of(5000 * kMs, 100 * kMs + kMs / 10), 100 * kMs + kMs / 10);
  EXPECT_EQ(hardware.monotonic_of(5010 * kMs, 113 * kMs), 110 * kMs + kMs / 10);
  EXPECT_EQ(hardware.monotonic_of(5020 * kMs, 121 * kMs), 120 * kMs + kMs / 10);
}

TEST(HardwareStamps, FollowAClockThatDrifts) {
  HardwareStamps hardware;
  // 100 ppm slow: after a minute it is 6 ms behind, of which at most 0.2 ms may show.
  std::int64_t worst = 0;
  for (std::int64_t t = 0; t < 60'000 * kMs; t += 10 * kMs) {
    const std::int64_t got = hardware.monotonic_of(t - t / 10'000, t + kMs / 100);
    worst = std::max(worst, std::abs(got - t));
  }
  EXPECT_LE(worst, kMs / 5 + kMs / 100);
}

TEST(HardwareStamps, StartOverWhenTheControllersClockWasSet) {
  HardwareStamps hardware;
  hardware.monotonic_of(5000 * kMs, 100 * kMs);
  EXPECT_EQ(hardware.monotonic_of(0, 110 * kMs), 110 * kMs);
  EXPECT_EQ(hardware.monotonic_of(7000 * kMs, 120 * kMs), 120 * kMs);
}

TEST(HardwareStamps, AreNeverLaterThanTheSoftwareStamp) {
  HardwareStamps hardware;
  hardware.monotonic_of(5000 * kMs, 105 * kMs);
  EXPECT_EQ(hardware.monotonic_of(5010 * kMs, 111 * kMs), 111 * kMs);
}

}  // namespace
}  // namespace zonepack
