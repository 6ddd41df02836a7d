// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/basins.hpp"

#include <gtest/gtest.h>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

// Two rooms of 5 x 5 cells, whose peaks are 3, and a door of one cell: its clearance is 1.
const std::vector<std::string> kTwoRooms{"#############",  //
                                         "#.....#.....#",  //
                                         "#.....#.....#",  //
                                         "#...........#",  //
                                         "#.....#.....#",  //
                                         "#.....#.....#",  //
                                         "#############"};

TEST(Basins, PartTwoRoomsAtADoor) {
  const FreeSpace space = drawn_space(kTwoRooms);
  const Regions regions = basins_of(space, squared_clearance(space), 0.8);
  EXPECT_EQ(regions.count, 2);
  EXPECT_NE(regions.at(space.at(1, 1)), regions.at(space.at(11, 5)));
}

TEST(Basins, JoinWhereThePassIsWideEnough) {
  const FreeSpace space = drawn_space(kTwoRooms);
  // The pass is 1 / 3 of the peaks: 0.333 and 0.334 are just below and above.
  EXPECT_EQ(basins_of(space, squared_clearance(space), 0.333).count, 1);
  EXPECT_EQ(basins_of(space, squared_clearance(space), 0.334).count, 2);
}

TEST(Basins, GiveEveryFreeCellToARoomThatHangsTogether) {
  const FreeSpace space = drawn_space(kTwoRooms);
  Regions regions = basins_of(space, squared_clearance(space), 0.8);
  const std::vector<std::string> before = drawn(regions, space);
  for (std::size_t i = 0; i < space.size(); ++i) {
    EXPECT_EQ(regions.of_cell[i] != kNoRegion, space.free[i] != 0);
  }
  renumber(regions, space);
  EXPECT_EQ(drawn(regions, space), before);
}

}  // namespace
}  // namespace zonepack::packer::suggest
