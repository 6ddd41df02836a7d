// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/occupancy_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace zonepack::packer {
namespace {

Transform pose(double x, double y, double yaw) {
  const auto c = static_cast<float>(std::cos(yaw)), s = static_cast<float>(std::sin(yaw));
  return {c, -s, 0, static_cast<float>(x), s, c, 0, static_cast<float>(y), 0, 0, 1, 0};
}

Matrix cells(const std::vector<std::array<float, 2>>& points) {
  Matrix matrix{1, static_cast<std::int32_t>(points.size()), 5 | (1 << 3), {}};
  matrix.data.resize(points.size() * sizeof(points[0]));
  std::memcpy(matrix.data.data(), points.data(), matrix.data.size());
  return matrix;
}

// The square of 2 m around the robot, free, in cells of 0.1 m.
Grid square() {
  std::vector<std::array<float, 2>> points;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) points.push_back({float(i) * 0.1f, float(j) * 0.1f});
  }
  Grid grid;
  grid.cell_size = 0.1f;
  grid.empty = cells(points);
  return grid;
}

Cell cell_at(const MapImage& image, double x, double y) {
  return image.at(static_cast<std::size_t>((x - image.x_min_m) / image.resolution_m),
                  static_cast<std::size_t>((y - image.y_min_m) / image.resolution_m));
}

TEST(OccupancyMap, IsEmptyWithoutGrids) { EXPECT_TRUE(OccupancyMap(0.05).image().cells.empty()); }

TEST(OccupancyMap, PutsCellsWhereTheRobotSawThem) {
  OccupancyMap map(0.1);
  Grid grid = square();
  grid.obstacle = cells({{1.55f, 0}});
  // At (10, -5), looking north: 1.55 m ahead is (10, -3.45).
  map.add(grid, pose(10, -5, std::acos(-1.0) / 2));
  const MapImage image = map.image();
  EXPECT_EQ(image.count(Cell::kOccupied), 1u);
  EXPECT_EQ(cell_at(image, 10.02, -3.45), Cell::kOccupied);
  EXPECT_EQ(cell_at(image, 10.02, -4.2), Cell::kFree);
  EXPECT_EQ(cell_at(image, 10.02, -3.8), Cell::kUnknown);
}

TEST(OccupancyMap, LeavesNoPinholesWhenAGridIsTurned) {
  for (const double yaw : {0.1, 0.5, 0.785, 2.0}) {
    OccupancyMap map(0.1);
    map.add(square(), pose(0.03, 0.07, yaw));
    const MapImage image = map.image();
    for (double x = -0.6; x <= 0.6; x += 0.05) {
      for (double y = -0.6; y <= 0.6; y += 0.05) {
        ASSERT_EQ(cell_at(image, x, y), Cell::kFree) << yaw << " " << x << " " << y;
      }
    }
    // 2.1 m x 2.1 m of cells of 0.01 m2.
    EXPECT_NEAR(static_cast<double>(image.count(Cell::kFree)), 441, 12);
  }
}

TEST(OccupancyMap, LetsTheSumOfSightingsDecide) {
  // One hit is 0.847, one miss -0.405: free again after three misses, occupied after two.
  for (const int misses : {2, 3}) {
    OccupancyMap map(0.1);
    Grid hit;
    hit.cell_size = 0.1f;
    hit.obstacle = cells({{0.5f, 0.5f}});
    map.add(hit, pose(0.02, 0.02, 0));
    for (int i = 0; i < misses; ++i) map.add(square(), pose(0.02, 0.02, 0));
    EXPECT_EQ(cell_at(map.image(), 0.52, 0.52), misses == 2 ? Cell::kOccupied : Cell::kFree);
  }
}

TEST(OccupancyMap, LetsAnObstacleBeatFreeCellsOfTheSameSignature) {
  OccupancyMap map(0.1);
  Grid grid = square();
  grid.obstacle = cells({{0.5f, 0.5f}, {0.5f, 0.5f}});
  map.add(grid, pose(0.02, 0.02, 0));
  EXPECT_EQ(map.image().count(Cell::kOccupied), 1u);
}

TEST(OccupancyMap, TakesGroundAsFreeAndIgnoresHeight) {
  OccupancyMap map(0.1);
  Grid grid;
  grid.cell_size = 0.1f;
  grid.ground = Matrix{1, 1, 5 | (2 << 3), {}};
  const std::array<float, 3> point{0.3f, 0, -0.02f};
  grid.ground->data.resize(sizeof point);
  std::memcpy(grid.ground->data.data(), point.data(), sizeof point);
  map.add(grid, pose(0.02, 0.02, 0));
  EXPECT_EQ(map.image().count(Cell::kFree), 1u);
}

TEST(OccupancyMap, LeavesOutCellsThatAreNoNumbersOrFarAway) {
  OccupancyMap map(0.1);
  Grid grid;
  grid.cell_size = 0.1f;
  grid.empty = cells({{std::numeric_limits<float>::quiet_NaN(), 0}, {1e30f, 0}, {0, -101}});
  grid.obstacle = cells({{std::numeric_limits<float>::infinity(), 0}});
  map.add(grid, pose(0, 0, 0));
  EXPECT_TRUE(map.image().cells.empty());
  grid.cell_size = 0;
  map.add(grid, pose(0, 0, 0));
  EXPECT_TRUE(map.image().cells.empty());
}

TEST(OccupancyMap, RefusesAMapThatReachesToTheHorizon) {
  OccupancyMap map(0.05);
  map.add(square(), pose(0, 0, 0));
  map.add(square(), pose(1e6, 1e6, 0));
  EXPECT_THROW(map.image(), std::runtime_error);
}

TEST(MapImage, ComesFromTheDatabasesOwnMap) {
  OptimisedMap own;
  own.cells = {2, 3, 1, {}};
  for (const int value : {-1, 0, 100, 0, 0, 100}) own.cells.data.push_back(std::byte(value));
  own.x_min = -1.5f;
  own.y_min = 0.1f;
  own.resolution = 0.05f;
  const MapImage image = image_of(own);
  EXPECT_EQ(image.width, 3u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_EQ(image.at(0, 0), Cell::kUnknown);
  EXPECT_EQ(image.at(2, 0), Cell::kOccupied);
  EXPECT_EQ(image.at(0, 1), Cell::kFree);
  // Row 0 of the picture is the greatest y.
  EXPECT_EQ(to_pgm(image), std::string("P5\n3 2\n255\n\xFE\xFE\x00\xCD\xFE\x00", 17));
  EXPECT_EQ(map_yaml(image, "map.pgm"),
            "image: map.pgm\nresolution: 0.05\norigin: [-1.5, 0.1, 0.0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  // Pixel size, and the centre of the upper left pixel: (-1.5 + 0.025, 0.1 + 2 * 0.05 - 0.025).
  EXPECT_EQ(world_file(image), "0.05\n0\n0\n-0.05\n-1.475\n0.175\n");
}

}  // namespace
}  // namespace zonepack::packer
