// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/hold_keeper.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace zonepack {
namespace {

void expect_hold(const TraceHold& hold, ZoneId zone, double from_s, double ready_s, double to_s) {
  EXPECT_EQ(std::tuple(hold.zone, hold.from_s, hold.ready_s, hold.to_s),
            std::tuple(zone, from_s, ready_s, to_s));
}

TEST(HoldKeeper, PairsBeginningAndEndByZone) {
  HoldKeeper keeper;
  keeper.begin(3, 1);
  keeper.begin(5, 2);
  keeper.ready(3, 4);
  keeper.end(5, 6);  // given up before it was ready
  keeper.end(3, 7);
  keeper.begin(5, 8);
  keeper.ready(5, 9);
  const std::vector<TraceHold> holds = keeper.take(10);
  ASSERT_EQ(holds.size(), 3u);
  expect_hold(holds[0], 3, 1, 4, 7);
  expect_hold(holds[1], 5, 2, 6, 6);
  expect_hold(holds[2], 5, 8, 9, 10);  // goes on at the end of the run
  EXPECT_TRUE(keeper.take(11).empty());
}

TEST(HoldKeeper, PassesOverWhatNeverBegan) {
  HoldKeeper keeper;
  keeper.ready(1, 1);
  keeper.end(1, 2);
  EXPECT_TRUE(keeper.take(3).empty());
}

TEST(HoldKeeper, AnotherMapEndsAllHolds) {
  HoldKeeper keeper;
  keeper.begin(1, 0);
  keeper.end_all(5);
  keeper.begin(1, 6);
  const std::vector<TraceHold> holds = keeper.take(9);
  ASSERT_EQ(holds.size(), 2u);
  EXPECT_EQ(holds[0].to_s, 5);
  EXPECT_EQ(holds[1].from_s, 6);
}

// Ten may be kept; the eleventh drops the shorter half. Zone i is held for i seconds.
TEST(HoldKeeper, KeepsTheLongestOfTooMany) {
  HoldKeeper keeper(10);
  for (ZoneId zone = 1; zone <= 11; ++zone) {
    keeper.begin(zone, 100.0 * zone);
    keeper.end(zone, 101.0 * zone);
  }
  const std::vector<TraceHold> holds = keeper.take(2000);
  ASSERT_EQ(holds.size(), 5u);
  for (std::size_t i = 0; i < holds.size(); ++i) EXPECT_EQ(holds[i].zone, 7 + i);
}

}  // namespace
}  // namespace zonepack
