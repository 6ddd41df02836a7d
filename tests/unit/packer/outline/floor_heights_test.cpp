// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/floor_heights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace zonepack::packer {
namespace {

// Points every 0.1 m on a level from (x0, y0) to (x1, y1).
void add_level(FloorFinder& finder, double x0, double y0, double x1, double y1, double z,
               double slope = 0) {
  for (double x = x0 + 0.05; x < x1; x += 0.1) {
    for (double y = y0 + 0.05; y < y1; y += 0.1) finder.add(x, y, z + slope * x);
  }
}

// Points every 0.1 m on a wall along x at y, 0.2 m thick.
void add_wall(FloorFinder& finder, double x0, double x1, double y, double z0, double z1) {
  for (double x = x0 + 0.05; x < x1; x += 0.1) {
    for (double z = z0 + 0.05; z < z1; z += 0.1) {
      for (const double side : {y, y + 0.1, y + 0.2}) finder.add(x, side, z);
    }
  }
}

std::optional<double> height_at(const FloorHeights& floor, double x, double y) {
  return floor.at(floor_square_of(x, y));
}

TEST(FloorHeights, FindsTheFloorBelowATableAndACeiling) {
  FloorFinder finder;
  add_level(finder, 0, 0, 8, 6, 0.03);
  add_level(finder, 0, 0, 8, 6, 2.6);
  add_level(finder, 2, 2, 4, 4, 0.75);
  const FloorHeights floor = finder.find();
  for (const double x : {0.5, 3.0, 7.5}) {
    ASSERT_TRUE(height_at(floor, x, 3)) << x;
    EXPECT_NEAR(*height_at(floor, x, 3), 0.03, 1e-3) << x;
  }
  EXPECT_NEAR(floor.median_m(), 0.03, 1e-3);
}

TEST(FloorHeights, TakesTheFloorAroundWhereABedHidesIt) {
  FloorFinder finder;
  add_level(finder, 0, 0, 2, 6, 0);
  add_level(finder, 4, 0, 6, 6, 0);
  add_level(finder, 2, 0, 4, 6, 0.55);  // the square from 2 to 4 sees no floor
  EXPECT_NEAR(*height_at(finder.find(), 3, 3), 0, 1e-3);
}

TEST(FloorHeights, ClimbsWithAFloorThatSlopes) {
  for (const double degrees : {1.0, -3.0}) {
    const double slope = std::tan(degrees * std::acos(-1.0) / 180);
    FloorFinder finder;
    add_level(finder, 0, 0, 60, 6, 0, slope);
    const FloorHeights floor = finder.find();
    // The middle of a square is 1 m from its sides; a robot's height begins at 0.2 m.
    for (double x = 1; x < 60; x += 2) EXPECT_NEAR(*height_at(floor, x, 3), slope * x, 0.06) << x;
  }
}

TEST(FloorHeights, DoesNotTakeWallsOrAScanInOnePlaneForAFloor) {
  FloorFinder walls;
  for (const double y : {0.0, 3.0, 6.0}) add_wall(walls, 0, 12, y, 0, 2.5);
  EXPECT_THROW(walls.find(), NoFloorPlan);
  FloorFinder plane;
  for (const double y : {0.0, 3.0, 6.0}) add_wall(plane, 0, 12, y, 0.4, 0.5);
  EXPECT_THROW(plane.find(), NoFloorPlan);
}

TEST(FloorHeights, IsNotMovedByPointsBelowTheFloor) {
  FloorFinder finder;
  add_level(finder, 0, 0, 6, 6, 0);
  for (int i = 0; i < 200; ++i) {  // as a shining floor reflects what stands on it
    finder.add(std::fmod(i * 0.37, 6), std::fmod(i * 0.73, 6), -0.3 - std::fmod(i * 0.11, 2));
  }
  EXPECT_NEAR(*height_at(finder.find(), 3, 3), 0, 1e-3);
}

// A reflected cupboard: 4 m², so wide enough to be a floor at every height, were it not solid.
TEST(FloorHeights, IsNotLoweredByWhatFillsSpaceBelowIt) {
  FloorFinder finder;
  add_level(finder, 0, 0, 6, 6, 0);
  for (double z = -1.45; z < 0; z += 0.1) add_level(finder, 2, 2, 4, 4, z);
  EXPECT_NEAR(*height_at(finder.find(), 1, 1), 0, 1e-3);
}

TEST(FloorHeights, FindsNoneInOnePointOrInNone) {
  FloorFinder finder;
  EXPECT_THROW(finder.find(), NoFloorPlan);
  finder.add(1, 2, 3);
  EXPECT_THROW(finder.find(), NoFloorPlan);
}

TEST(FloorHeights, IsTheSameInAnyOrderOfThePoints) {
  FloorFinder forward, backward;
  add_level(forward, 0, 0, 4, 4, 0);
  add_level(forward, 0, 0, 4, 4, 0.087);
  add_level(backward, 0, 0, 4, 4, 0.087);
  add_level(backward, 0, 0, 4, 4, 0);
  EXPECT_EQ(forward.find().z_m, backward.find().z_m);
}

TEST(FloorHeights, RefusesPointsInMorePlacesThanItHolds) {
  FloorFinder finder;
  for (std::size_t i = 0; i <= FloorFinder::kMostLevels + 10; ++i) {
    finder.add(static_cast<double>(i % 5000) * 2, static_cast<double>(i / 5000) * 2, 0);
  }
  try {
    finder.find();
    FAIL() << "more than kMostLevels were taken";
  } catch (const NoFloorPlan& error) {
    EXPECT_NE(std::string(error.what()).find("cut the map"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace zonepack::packer
