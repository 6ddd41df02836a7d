// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/slice.hpp"

#include <gtest/gtest.h>

#include "packer/outline/map_server.hpp"

namespace zonepack::packer {
namespace {

// The floor at z 1 from (0, 0) to (4, 2).
FloorHeights two_squares() { return {{{{0, 0}, 1.0}, {{1, 0}, 1.0}}}; }

Cell cell_of(const MapImage& image, double x, double y) {
  return image.at(static_cast<std::size_t>((x - image.x_min_m) / image.resolution_m),
                  static_cast<std::size_t>((y - image.y_min_m) / image.resolution_m));
}

TEST(Slice, TellsTheFloorFromWhatStandsOnItAndWhatHangsAbove) {
  Slice slice(two_squares(), {0.2, 1.5}, 0.05);
  slice.add(0.02, 0.02, 1.01, Seen::kSurface);  // floor
  slice.add(1.02, 0.02, 1.21, Seen::kSurface);  // just high enough
  slice.add(2.02, 0.02, 2.49, Seen::kSurface);  // just low enough
  slice.add(3.02, 0.02, 1.17, Seen::kSurface);  // a threshold
  slice.add(0.02, 1.02, 2.51, Seen::kSurface);  // above the robot
  slice.add(1.02, 1.02, 1.60, Seen::kFree);
  slice.add(2.02, 1.02, 1.01, Seen::kFree);     // only just above the floor
  slice.add(3.02, 1.02, 0.80, Seen::kSurface);  // below the floor
  slice.add(9.00, 1.02, 1.00, Seen::kSurface);  // where no floor was found
  const MapImage image = slice.image();
  EXPECT_EQ(cell_of(image, 0.02, 0.02), Cell::kFree);
  EXPECT_EQ(cell_of(image, 1.02, 0.02), Cell::kOccupied);
  EXPECT_EQ(cell_of(image, 2.02, 0.02), Cell::kOccupied);
  EXPECT_EQ(cell_of(image, 1.02, 1.02), Cell::kFree);
  EXPECT_EQ(image.count(Cell::kFree), 2u);
  EXPECT_EQ(image.count(Cell::kOccupied), 2u);
  // From 0 to 2.05 and to 1.05, and 0.5 m on every side.
  EXPECT_DOUBLE_EQ(image.x_min_m, -0.5);
  EXPECT_EQ(image.width, 61u);
  EXPECT_EQ(image.height, 41u);
}

TEST(Slice, TakesOnePointAmongManyOfTheFloorForAStray) {
  Slice slice(two_squares(), {}, 0.05);
  for (int i = 0; i < 11; ++i) slice.add(0.02, 0.02, 1, Seen::kSurface);
  slice.add(0.02, 0.02, 1.5, Seen::kSurface);
  for (int i = 0; i < 10; ++i) slice.add(1.02, 0.02, 1, Seen::kSurface);
  slice.add(1.02, 0.02, 1.5, Seen::kSurface);
  for (int i = 0; i < 1000; ++i) slice.add(2.02, 0.02, 1.3, Seen::kFree);
  slice.add(2.02, 0.02, 1.5, Seen::kSurface);
  const MapImage image = slice.image();
  EXPECT_EQ(cell_of(image, 0.02, 0.02), Cell::kFree);
  EXPECT_EQ(cell_of(image, 1.02, 0.02), Cell::kOccupied);
  EXPECT_EQ(cell_of(image, 2.02, 0.02), Cell::kOccupied);  // empty space outvotes nothing
}

TEST(Slice, ClosesGapsThatAreNarrowerThanARobot) {
  Slice slice(two_squares(), {}, 0.05);
  slice.add(0.02, 0.02, 1, Seen::kSurface);
  slice.add(0.32, 0.02, 1, Seen::kSurface);  // five cells of nothing between
  slice.add(0.67, 0.02, 1, Seen::kSurface);  // six
  slice.add(0.02, 1.02, 1.5, Seen::kSurface);
  slice.add(0.17, 1.02, 1, Seen::kSurface);
  slice.add(0.32, 1.02, 1.5, Seen::kSurface);  // with floor between
  const MapImage image = slice.image();
  EXPECT_EQ(cell_of(image, 0.17, 0.02), Cell::kFree);
  EXPECT_EQ(cell_of(image, 0.52, 0.02), Cell::kUnknown);
  EXPECT_EQ(cell_of(image, 0.17, 1.02), Cell::kOccupied);
  EXPECT_EQ(image.count(Cell::kFree), 8u);
  EXPECT_EQ(image.count(Cell::kOccupied), 7u);
}

TEST(Slice, LeavesAWallBetweenTwoFloorsClosed) {
  Slice slice(two_squares(), {}, 0.05);
  slice.add(0.02, 0.02, 1, Seen::kSurface);
  slice.add(0.12, 0.02, 1.5, Seen::kSurface);
  slice.add(0.22, 0.02, 1, Seen::kSurface);
  const MapImage image = slice.image();
  EXPECT_EQ(cell_of(image, 0.12, 0.02), Cell::kOccupied);
  EXPECT_EQ(cell_of(image, 0.07, 0.02), Cell::kUnknown);
}

TEST(Slice, TakesLargerCellsForAFloorThatIsFarAndRefusesOneBeyondThat) {
  FloorHeights far = two_squares();
  far.z_m[{500, 500}] = 1;  // 1 km by 1 km: 4e8 cells of 5 cm, 2.5e7 of 20 cm
  const Slice slice(far, {}, 0.05);
  EXPECT_DOUBLE_EQ(slice.cell_m(), 0.2);
  far.z_m[{500'000, 500'000}] = 1;
  EXPECT_THROW(Slice(far, {}, 0.05), NoFloorPlan);
}

TEST(Slice, IsNeverLargerThanAGridThatIsSearchedForRooms) {
  FloorHeights wide = two_squares();
  wide.z_m[{204, 203}] = 1;  // 8201 x 8161 cells of 5 cm: under 2^26, but not with their margin
  Slice slice(wide, {}, 0.05);
  slice.add(0.01, 0.01, 1, Seen::kSurface);
  slice.add(409.9, 407.9, 1, Seen::kSurface);
  const MapImage image = slice.image();
  EXPECT_DOUBLE_EQ(image.resolution_m, 0.1);
  EXPECT_LE(image.cells.size(), kMostServedCells);
  EXPECT_TRUE(Slice(two_squares(), {}, 0.05).image().cells.empty());  // nothing was seen
}

}  // namespace
}  // namespace zonepack::packer
