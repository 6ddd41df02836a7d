// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/suggest.hpp"

#include <gmock/gmock.h>

#include <random>
#include <set>

#include "packer/zones/plane.hpp"
#include "packer/zones/zone_file.hpp"
#include "packer/zones/zone_text.hpp"

namespace zonepack::packer::suggest {
namespace {

// Cells of 0.1 m; free from (x0, y0) to (x1, y1) in metres.
FreeSpace empty_space(double wide_m, double high_m) {
  FreeSpace space;
  space.cell_m = 0.1;
  space.columns = static_cast<std::int32_t>(wide_m * 10) + 2;
  space.rows = static_cast<std::int32_t>(high_m * 10) + 2;
  space.free.resize(static_cast<std::size_t>(space.columns * space.rows));
  return space;
}

void free_up(FreeSpace& space, double x0, double y0, double x1, double y1, bool free = true) {
  const auto cell = [](double metres) { return static_cast<std::int32_t>(metres * 10 + 0.5) + 1; };
  for (std::int32_t y = cell(y0); y < cell(y1); ++y) {
    for (std::int32_t x = cell(x0); x < cell(x1); ++x) {
      space.free[static_cast<std::size_t>(space.at(x, y))] = free ? 1 : 0;
    }
  }
}

// A corridor of 10 m x 2 m, and above it two rooms of 4.9 m x 4 m behind walls of 0.2 m, each with
// a door of 1 m.
FreeSpace two_offices() {
  FreeSpace space = empty_space(10, 6.2);
  free_up(space, 0, 0, 10, 2);
  free_up(space, 0, 2.2, 4.9, 6.2);
  free_up(space, 5.1, 2.2, 10, 6.2);
  free_up(space, 2, 2, 3, 2.2);
  free_up(space, 7, 2, 8, 2.2);
  return space;
}

// Every free cell's centre is in its zone and in no other.
void expect_exact(const FreeSpace& space, const Suggestion& found) {
  for (CellIndex cell = 0; static_cast<std::size_t>(cell) < space.size(); ++cell) {
    if (!space.is_free(cell) || found.regions.at(cell) == kNoRegion) continue;
    const Point2 centre{(cell % space.columns + 0.5) * space.cell_m,
                        (cell / space.columns + 0.5) * space.cell_m};
    for (std::size_t z = 0; z < found.plan.zones.size(); ++z) {
      const Side side = side_of(found.plan.zones[z].polygon, centre);
      if (static_cast<Region>(z) == found.regions.at(cell)) {
        ASSERT_NE(side, Side::kOutside) << cell;
      } else {
        ASSERT_NE(side, Side::kInside) << cell;
      }
    }
  }
}

TEST(Suggest, DrawsRoomsAndACorridorWithPortalsInTheDoors) {
  const FreeSpace space = two_offices();
  const Suggestion found = suggest(space, {}, {});
  ASSERT_EQ(found.plan.zones.size(), 3u);
  EXPECT_EQ(found.plan.zones[0].name, "corridor-1");
  EXPECT_EQ(found.plan.zones[1].name, "room-1");
  EXPECT_EQ(found.plan.zones[2].name, "room-2");
  ASSERT_EQ(found.plan.portals.size(), 2u);
  EXPECT_EQ(found.plan.portals[0].name, "corridor-1-room-1");
  const Segment2 door = found.plan.portals[0].segment;
  EXPECT_NEAR(distance_m(door.p, door.q), 1, 0.11);  // a cell more or less
  // In the wall, from y = 2 to 2.2 m, behind the margin of one cell.
  for (const Point2 end : {door.p, door.q}) {
    EXPECT_GE(end.y_m, 2.1 - 1e-9);
    EXPECT_LE(end.y_m, 2.3 + 1e-9);
  }
  expect_exact(space, found);
}

TEST(Suggest, DrawsZonesInWhichCheckZonesFindsNothing) {
  const ZoneFile checked = parse_zone_file(zones_geojson(suggest(two_offices(), {}, {}).plan));
  EXPECT_TRUE(checked.findings.faults.empty());
  EXPECT_TRUE(checked.findings.warnings.empty());
  EXPECT_EQ(checked.plan.zones.size(), 3u);
  EXPECT_FALSE(checked.plan.portals_found);
}

TEST(Suggest, KeepsEveryCellOnItsSideHoweverRaggedTheWalls) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 30; ++trial) {
    FreeSpace space = two_offices();
    for (std::int32_t y = 2; y + 2 < space.rows; ++y) {
      for (std::int32_t x = 2; x + 2 < space.columns; ++x) {
        const auto cell = static_cast<std::size_t>(space.at(x, y));
        // Most noise stands next to walls, some anywhere.
        const bool at_wall =
            space.free[cell] != space.free[cell + 1] ||
            space.free[cell] != space.free[cell + static_cast<std::size_t>(space.columns)];
        if (random() % (at_wall ? 4 : 60) == 0) space.free[cell] ^= 1;
      }
    }
    Options options;
    if (trial % 3 == 1) options.max_length_m = 3;
    if (trial % 3 == 2) options.method = Method::kGrid;
    const Suggestion found = suggest(space, {}, options);
    expect_exact(space, found);
    const ZoneFile checked = parse_zone_file(zones_geojson(found.plan));
    ASSERT_TRUE(checked.findings.faults.empty())
        << describe_faults(checked.findings, "trial " + std::to_string(trial));
    MeasuringSteps steps(1'000'000'000);
    for (std::size_t a = 0; a < checked.plan.zones.size(); ++a) {
      for (std::size_t b = a + 1; b < checked.plan.zones.size(); ++b) {
        ASSERT_NEAR(
            common_area_m2(checked.plan.zones[a].polygon, checked.plan.zones[b].polygon, steps)
                .value(),
            0, 1e-9);
      }
    }
  }
}

TEST(Suggest, JoinsByAPortalAllZonesThatTouchOnFreeGround) {
  const FreeSpace space = two_offices();
  Options options;
  options.max_length_m = 3;
  const Suggestion found = suggest(space, {}, options);
  std::set<std::pair<std::uint32_t, std::uint32_t>> joined;
  for (const PlannedPortal& portal : found.plan.portals) {
    joined.insert(std::minmax(portal.zone_a, portal.zone_b));
  }
  for (std::int32_t y = 0; y + 1 < space.rows; ++y) {
    for (std::int32_t x = 0; x + 1 < space.columns; ++x) {
      for (const CellIndex near : {space.at(x + 1, y), space.at(x, y + 1)}) {
        const Region a = found.regions.at(space.at(x, y)), b = found.regions.at(near);
        if (a == b || !space.is_free(space.at(x, y)) || !space.is_free(near)) continue;
        EXPECT_TRUE(joined.contains(
            std::minmax(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b))));
      }
    }
  }
  EXPECT_GE(joined.size(), 5u);
}

TEST(Suggest, CutsACorridorAcrossIntoEqualLengths) {
  Options options;
  options.max_length_m = 4;
  // The corridor is 10 m long, a little more along its diagonal: 3 parts.
  const Suggestion found = suggest(two_offices(), {}, options);
  std::vector<std::string> names;
  for (const PlannedZone& zone : found.plan.zones) names.push_back(zone.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"corridor-1.1", "corridor-1.2", "corridor-1.3"}));
}

TEST(Suggest, TurnsZonesWithTheGrid) {
  const GridPlace upright{{1, 2}, 0, 1};  // a quarter turn: x goes up, y to the left
  const Suggestion turned = suggest(two_offices(), upright, {});
  const Suggestion level = suggest(two_offices(), {}, {});
  ASSERT_EQ(turned.plan.zones.size(), level.plan.zones.size());
  const Point2 from = level.plan.zones[0].polygon.outer[0];
  const Point2 to = turned.plan.zones[0].polygon.outer[0];
  EXPECT_NEAR(to.x_m, 1 - from.y_m, 1e-9);
  EXPECT_NEAR(to.y_m, 2 + from.x_m, 1e-9);
}

TEST(Suggest, CutsACorridorOffTheHallThatItOpensInto) {
  FreeSpace space = empty_space(20, 8);
  free_up(space, 0, 0, 8, 8);
  free_up(space, 8, 3, 20, 5);  // 12 m long, 2 m wide, no door
  const Suggestion found = suggest(space, {}, {});
  ASSERT_EQ(found.plan.zones.size(), 2u);
  ASSERT_EQ(found.plan.portals.size(), 1u);
  EXPECT_NEAR(found.plan.portals[0].segment.p.x_m, 8.1, 0.51);
}

TEST(Suggest, TakesABedForFurnitureAndNotForAWall) {
  FreeSpace space = empty_space(6, 3.2);
  free_up(space, 0, 0, 6, 3.2);
  free_up(space, 2.5, 1.7, 3.5, 3.2, false);  // its head at the upper wall; 1.7 m are left
  EXPECT_EQ(suggest(space, {}, {}).plan.zones.size(), 1u);
  // A wall of 0.2 m with a door as wide as what is left parts two rooms: the pass is 0.85 m, the
  // peaks are 1.25 m, so 0.68 is below 0.8 and above the 0.65 of a pass without a wall.
  free_up(space, 2.5, 1.7, 3.5, 3.2);
  free_up(space, 2.9, 1.7, 3.1, 3.2, false);
  EXPECT_EQ(suggest(space, {}, {}).plan.zones.size(), 2u);
}

TEST(Suggest, SaysWhenNothingIsFree) {
  try {
    suggest(empty_space(3, 3), {}, {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no room was found"));
  }
}

}  // namespace
}  // namespace zonepack::packer::suggest
