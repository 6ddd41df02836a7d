// SPDX-License-Identifier: Apache-2.0
#include "platform/devices/edge_filter.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

TEST(EdgeFilter, WithoutADebounceTimeEveryChangeIsAnEdgeAtOnce) {
  EdgeFilter filter(0);
  for (std::int64_t t = 1; t <= 6; ++t) {
    const auto edge = filter.change({.stamp_ns = t, .active = t % 2 == 1});
    ASSERT_TRUE(edge);
    EXPECT_EQ(edge->stamp_ns, t);
    EXPECT_EQ(edge->active, t % 2 == 1);
    EXPECT_FALSE(filter.settle(t));
  }
}

TEST(EdgeFilter, ALevelCountsOnceItHasLastedFromItsOwnEdge) {
  EdgeFilter filter(100);
  EXPECT_FALSE(filter.change({.stamp_ns = 1000, .active = true}));
  EXPECT_FALSE(filter.change({.stamp_ns = 1050, .active = false}));  // lasted 50
  EXPECT_FALSE(filter.change({.stamp_ns = 1060, .active = true}));
  EXPECT_FALSE(filter.settle(1159));
  const auto edge = filter.settle(1160);
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->stamp_ns, 1060);
  EXPECT_TRUE(edge->active);
  EXPECT_FALSE(filter.settle(9999));
}

TEST(EdgeFilter, ALevelThatLastedIsReportedWithTheNextChangeHoweverLate) {
  EdgeFilter filter(100);
  EXPECT_FALSE(filter.change({.stamp_ns = 1000, .active = true}));
  const auto on = filter.change({.stamp_ns = 1100, .active = false});
  ASSERT_TRUE(on);
  EXPECT_EQ(on->stamp_ns, 1000);
  const auto off = filter.change({.stamp_ns = 1200, .active = true});
  ASSERT_TRUE(off);
  EXPECT_FALSE(off->active);
  EXPECT_EQ(off->stamp_ns, 1100);
}

TEST(EdgeFilter, ReturningToTheOldLevelIsNoEdgeAndStartsOver) {
  EdgeFilter filter(100);
  EXPECT_FALSE(filter.change({.stamp_ns = 1000, .active = true}));
  EXPECT_FALSE(filter.change({.stamp_ns = 1099, .active = false}));
  EXPECT_FALSE(filter.settle(5000));
  EXPECT_FALSE(filter.change({.stamp_ns = 5000, .active = true}));
  EXPECT_FALSE(filter.settle(5099));
  EXPECT_TRUE(filter.settle(5100));
}

TEST(EdgeFilter, AnEarlierStampCountsAsTheOneBefore) {
  EdgeFilter filter(100);
  EXPECT_FALSE(filter.change({.stamp_ns = 1000, .active = true}));
  EXPECT_FALSE(filter.change({.stamp_ns = 10, .active = false}));
  EXPECT_FALSE(filter.change({.stamp_ns = 10, .active = true}));
  const auto edge = filter.settle(1100);
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->stamp_ns, 1000);
}

TEST(EdgeFilter, TheSameLevelTwiceChangesNothing) {
  EdgeFilter filter(100);
  EXPECT_FALSE(filter.change({.stamp_ns = 1000, .active = true}));
  EXPECT_FALSE(filter.change({.stamp_ns = 1090, .active = true}));
  EXPECT_TRUE(filter.settle(1100));
  EXPECT_TRUE(filter.level());
}

}  // namespace
}  // namespace zonepack
