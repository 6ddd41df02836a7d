// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/zone_graph.hpp"

#include <gtest/gtest.h>

#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::box;
using testing_support::three_rooms;

TEST(ZoneGraph, FindsTheZoneThatHoldsAPoint) {
  const ZoneGraph graph = three_rooms();
  EXPECT_EQ(graph.zone_at({2, 2}), 0u);
  EXPECT_EQ(graph.zone_at({6, 1}), 1u);
  EXPECT_EQ(graph.zone_at({9, 3}), 2u);
  EXPECT_EQ(graph.zone_at({-1, 2}), kNoZone);
}

TEST(ZoneGraph, GivesABorderToTheZoneFirstByName) {
  EXPECT_EQ(three_rooms().zone_at({4, 2}), 0u);  // of a and b
  EXPECT_EQ(three_rooms().zone_at({8, 2}), 1u);  // of b and c
}

TEST(ZoneGraph, PutsInsideBeforeBorder) {
  // Zone a ends where b holds the point inside: two zones may overlap a little.
  const ZoneGraph graph({{"a", box(0, 0, 4, 4)}, {"b", box(3.9, 0, 8, 4)}}, {});
  EXPECT_EQ(graph.zone_at({4, 2}), 1u);
}

TEST(ZoneGraph, FindsTheNearestZoneOutsideOfAllWithinTheRadius) {
  const ZoneGraph graph = three_rooms();
  EXPECT_EQ(graph.zone_near({12.5, 2}, 1.0), 2u);
  EXPECT_EQ(graph.zone_near({13.5, 2}, 1.0), kNoZone);
  EXPECT_EQ(graph.zone_near({4, -0.5}, 1.0), 0u);  // as far from a as from b
}

TEST(ZoneGraph, MeasuresDepthInsideAsPositive) {
  const ZoneGraph graph = three_rooms();
  EXPECT_DOUBLE_EQ(graph.depth_m(0, {1, 2}), 1);
  EXPECT_DOUBLE_EQ(graph.depth_m(0, {7, 8}), -5);  // 3 beyond x = 4, 4 beyond y = 4
  EXPECT_DOUBLE_EQ(graph.depth_m(0, {4, 2}), 0);
}

TEST(ZoneGraph, ListsTheExitsOfEachZoneAndTheirDirection) {
  const ZoneGraph graph = three_rooms();
  ASSERT_EQ(graph.exits(1).size(), 2u);
  EXPECT_EQ(graph.exits(1)[0].to, 0u);
  EXPECT_EQ(graph.exits(1)[0].outward, (Point2{-1, 0}));
  EXPECT_EQ(graph.exits(1)[1].to, 2u);
  EXPECT_EQ(graph.exits(1)[1].outward, (Point2{1, 0}));
  ASSERT_EQ(graph.exits(0).size(), 1u);
  EXPECT_EQ(graph.exits(0)[0].outward, (Point2{1, 0}));
}

TEST(ZoneGraph, KnowsTheDirectionOfAPortalThatStandsOffTheBorder) {
  const GraphPortal portal{0, 1, {{3.95, 1}, {3.95, 3}}};
  const ZoneGraph graph({{"a", box(0, 0, 4, 4)}, {"b", box(4, 0, 8, 4)}}, {{portal}});
  EXPECT_EQ(graph.exits(0)[0].outward, (Point2{1, 0}));
  EXPECT_EQ(graph.exits(1)[0].outward, (Point2{-1, 0}));
}

TEST(ZoneGraph, FindsAZoneAmongAHundredThousand) {
  std::vector<GraphZone> zones;
  std::vector<GraphPortal> portals;
  for (int i = 0; i < 100'000; ++i) {
    const double x = 5.0 * (i % 400), y = 5.0 * (i / 400);
    zones.push_back({"z", box(x, y, x + 5, y + 5)});
    if (i % 400 != 0) {
      portals.push_back(
          {static_cast<ZoneId>(i - 1), static_cast<ZoneId>(i), {{x, y + 2}, {x, y + 3}}});
    }
  }
  const ZoneGraph graph(std::move(zones), portals);
  EXPECT_EQ(graph.zone_at({5.0 * 123 + 1, 5.0 * 77 + 1}), 77u * 400 + 123);
  EXPECT_EQ(graph.exits(200).size(), 2u);
  // Counts what it holds: at least the vertices, the exits and the tree.
  EXPECT_GT(graph.memory_bytes(), 100'000u * (4 * sizeof(Point2) + 2 * sizeof(Exit)));
}

}  // namespace
}  // namespace zonepack
