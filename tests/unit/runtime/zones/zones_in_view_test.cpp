// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/zones_in_view.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "runtime/odometry/det_math.hpp"
#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using Zones = std::vector<ZoneId>;

// Rooms a, b, c in a row (rooms.hpp), doors half a metre to each side of y 2 at x 4 and x 8.
Zones seen(const Pose2& pose, ZoneId zone, double view_m) {
  static const ZoneGraph graph = testing_support::three_rooms();
  const ZonesInView view(graph, pose, zone, view_m);
  return {view.zones().begin(), view.zones().end()};
}

// From (3, 2) straight on: b begins after 1 m, c after 5 m.
TEST(ZonesInView, AreThoseBehindDoorsAheadTheNearestFirst) {
  EXPECT_EQ(seen({3, 2, 0}, 0, 10), (Zones{1, 2}));
  EXPECT_EQ(seen({3, 2, 0}, 0, 3), Zones{1});
  EXPECT_EQ(seen({3, 2, 0}, 0, 0.9), Zones{});
}

TEST(ZonesInView, AreNotBehindTheRobotOrBeyondItsSides) {
  EXPECT_EQ(seen({3, 2, kPi}, 0, 10), Zones{});
  EXPECT_EQ(seen({3, 2, kPi / 2}, 0, 10), Zones{});
  EXPECT_EQ(seen({6, 2, 0}, 1, 10), Zones{2});
  EXPECT_EQ(seen({6, 2, kPi}, 1, 10), Zones{0});
}

// Turned by 40 degrees, the last ray of the fan goes straight through both doors.
TEST(ZonesInView, ReachToTheEdgeOfTheView) {
  EXPECT_EQ(seen({3, 2, 39 * kPi / 180}, 0, 10), (Zones{1, 2}));
  EXPECT_EQ(seen({3, 2, 70 * kPi / 180}, 0, 10), Zones{});
}

TEST(ZonesInView, AreNoneFromNowhere) { EXPECT_EQ(seen({3, 2, 0}, kNoZone, 10), Zones{}); }

}  // namespace
}  // namespace zonepack
