// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/route.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/building.hpp"
#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::box;
using testing_support::three_rooms;

TEST(Route, LeadsThroughTheMiddlesOfDoors) {
  const auto route = plan_route(three_rooms(), 0, 2);
  ASSERT_TRUE(route.ok());
  EXPECT_EQ(route->zones, (std::vector<ZoneId>{0, 1, 2}));
  EXPECT_EQ(route->doors, (std::vector<Point2>{{4, 2}, {8, 2}}));
  EXPECT_EQ(route->length_m, 4);  // from (4, 2) to (8, 2)
}

TEST(Route, FromAPointCountsTheWayToTheFirstDoor) {
  const auto route = plan_route(three_rooms(), 0, 2, Point2{1, 6});
  ASSERT_TRUE(route.ok());
  EXPECT_EQ(route->length_m, 9);  // 3, 4, 5 to (4, 2), then 4
}

TEST(Route, WithinOneZoneHasNoDoors) {
  const auto route = plan_route(three_rooms(), 1, 1, Point2{5, 1});
  ASSERT_TRUE(route.ok());
  EXPECT_EQ(route->zones, std::vector<ZoneId>{1});
  EXPECT_TRUE(route->doors.empty());
  EXPECT_EQ(route->length_m, 0);
}

TEST(Route, ToAZoneThatNothingLeadsToIsNotFound) {
  const GraphPortal portals[] = {{0, 1, {{4, 1}, {4, 2}}}};
  const ZoneGraph graph(
      {{"a", box(0, 0, 4, 4)}, {"b", box(4, 0, 8, 4)}, {"island", box(20, 0, 24, 4)}}, portals);
  EXPECT_EQ(plan_route(graph, 0, 2).error().code, ErrorCode::kNotFound);
}

// A ring of four rooms around (4, 4): from a to d both routes are equally long, through b or c.
TEST(Route, OfTwoEqualWaysTakesTheOneThroughTheLowerZone) {
  const GraphPortal portals[] = {{0, 2, {{1, 4}, {3, 4}}},
                                 {2, 3, {{4, 5}, {4, 7}}},
                                 {0, 1, {{4, 1}, {4, 3}}},
                                 {1, 3, {{5, 4}, {7, 4}}}};
  const ZoneGraph graph({{"a", box(0, 0, 4, 4)},
                         {"b", box(4, 0, 8, 4)},
                         {"c", box(0, 4, 4, 8)},
                         {"d", box(4, 4, 8, 8)}},
                        portals);
  const auto route = plan_route(graph, 0, 3, Point2{2, 2});
  ASSERT_TRUE(route.ok());
  EXPECT_EQ(route->length_m, 2 + std::sqrt(8.0));
  EXPECT_EQ(route->zones, (std::vector<ZoneId>{0, 1, 3}));
}

// A square of rooms with doors between all neighbours, and one more room that nothing leads to.
ZoneGraph grid_and_island(std::uint32_t side) {
  std::vector<GraphZone> zones;
  std::vector<GraphPortal> portals;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const double x = 4.0 * (i % side), y = 4.0 * (i / side);
    zones.push_back({"z", box(x, y, x + 4, y + 4)});
    if ((i + 1) % side != 0) portals.push_back({i, i + 1, {{x + 4, y + 1}, {x + 4, y + 3}}});
    if (i + side < side * side) portals.push_back({i, i + side, {{x + 1, y + 4}, {x + 3, y + 4}}});
  }
  zones.push_back({"z", box(-100, 0, -96, 4)});
  return ZoneGraph(std::move(zones), portals);
}

// 64 rooms a side: 4 * 64 * 63 = 16,128 ways through a portal; 65: 16,640, over the bound.
TEST(Route, GivesUpAtItsBoundAndNotBefore) {
  EXPECT_EQ(plan_route(grid_and_island(64), 0, 64 * 64).error().code, ErrorCode::kNotFound);
  const ZoneGraph graph = grid_and_island(65);
  EXPECT_EQ(plan_route(graph, 0, 65 * 65).error().code, ErrorCode::kTooLarge);
  const auto near = plan_route(graph, 0, 30);
  ASSERT_TRUE(near.ok());
  EXPECT_EQ(near->length_m, 29 * 4.0);
}

// All pairs of the sample building, against a shortest route found by relaxing every edge often
// enough.
TEST(Route, IsAsShortAsBellmanAndFordFindIt) {
  const auto building =
      testing_support::read_building(std::string(ZONEPACK_TEST_DATA) + "/zones.geojson");
  const ZoneGraph graph(building.zones, building.portals);
  const auto middle = [](const Segment2& s) {
    return Point2{(s.p.x_m + s.q.x_m) / 2, (s.p.y_m + s.q.y_m) / 2};
  };
  const auto share = [](const GraphPortal& a, const GraphPortal& b) {
    return a.zone_a == b.zone_a || a.zone_a == b.zone_b || a.zone_b == b.zone_a ||
           a.zone_b == b.zone_b;
  };
  const auto& portals = building.portals;
  for (ZoneId from = 0; from < graph.zone_count(); ++from) {
    std::vector<double> to_portal(portals.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < portals.size(); ++i) {
      if (portals[i].zone_a == from || portals[i].zone_b == from) to_portal[i] = 0;
    }
    for (std::size_t round = 0; round < portals.size(); ++round) {
      for (std::size_t a = 0; a < portals.size(); ++a) {
        for (std::size_t b = 0; b < portals.size(); ++b) {
          if (!share(portals[a], portals[b])) continue;
          to_portal[b] = std::min(
              to_portal[b],
              to_portal[a] + distance_m(middle(portals[a].segment), middle(portals[b].segment)));
        }
      }
    }
    for (ZoneId to = 0; to < graph.zone_count(); ++to) {
      if (to == from) continue;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < portals.size(); ++i) {
        if (portals[i].zone_a == to || portals[i].zone_b == to) {
          least = std::min(least, to_portal[i]);
        }
      }
      const auto route = plan_route(graph, from, to);
      ASSERT_TRUE(route.ok()) << from << " to " << to;
      EXPECT_NEAR(route->length_m, least, 1e-9) << from << " to " << to;
      EXPECT_EQ(route->doors.size() + 1, route->zones.size());
    }
  }
}

}  // namespace
}  // namespace zonepack
