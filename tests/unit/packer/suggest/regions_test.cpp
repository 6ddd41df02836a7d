// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/regions.hpp"

#include <gtest/gtest.h>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

using Rows = std::vector<std::string>;

FreeSpace space_of(const Rows& rows) { return drawn_space(rows); }

TEST(Regions, AreCutWhereTheyFellApartAndNumberedFromTheLowestCell) {
  const Rows rows{"#####", "#bab#", "#aaa#", "#####"};
  Regions regions = drawn_regions(rows);
  renumber(regions, space_of(rows));
  EXPECT_EQ(drawn(regions, space_of(rows)), (Rows{"#####", "#bac#", "#aaa#", "#####"}));
  EXPECT_EQ(regions.count, 3);
}

TEST(FoldSmall, GivesACrumbToTheNeighbourWithTheWidestPass) {
  // b touches a through one cell at the wall and c through two, one of them off the walls.
  const Rows rows{"########", "#aabbcc#", "#aa#bcc#", "#aa##cc#", "########"};
  Regions regions = drawn_regions(rows);
  const FreeSpace space = space_of(rows);
  fold_small(regions, space, squared_clearance(space), 1.0, {});  // b has 3 cells of 0.25 m2
  EXPECT_EQ(drawn(regions, space),
            (Rows{"########", "#aabbbb#", "#aa#bbb#", "#aa##bb#", "########"}));
}

TEST(FoldSmall, DropsAnIsletWithoutNeighbours) {
  Regions regions = drawn_regions({"#######", "#a#bbb#", "###bbb#", "#######"});
  const FreeSpace space = space_of({"#######", "#.#...#", "###...#", "#######"});
  fold_small(regions, space, squared_clearance(space), 1.0, {});
  EXPECT_EQ(drawn(regions, space), (Rows{"#######", "###aaa#", "###aaa#", "#######"}));
}

TEST(FoldSmall, DropsTheHollowOfAWallHoweverLong) {
  // 1 cell of 0.5 m wide: the clearance is 1 cell, less than half of 1.2 m.
  const Rows rows{"##########", "#aaaaaaaa#", "##########"};
  Regions regions = drawn_regions(rows);
  const FreeSpace space = space_of(rows);
  fold_small(regions, space, squared_clearance(space), 1.0, {.least_m2 = 0, .least_width_m = 1.2});
  EXPECT_EQ(regions.count, 0);
}

TEST(FillGaps, FillsAPillarAndNotTheWallBetweenRooms) {
  const Rows rows{"########", "#aaabbb#", "#a#a#bb#", "#aaabbb#", "########"};
  Regions regions = drawn_regions(rows);
  fill_gaps(regions, space_of(rows), 1.0);
  EXPECT_EQ(drawn(regions, space_of(rows)),
            (Rows{"########", "#aaabbb#", "#aaa#bb#", "#aaabbb#", "########"}));
}

TEST(OpenCorners, LeaveNoRegionThatTouchesItselfAtACorner) {
  const Rows rows{"######", "#aaaa#", "#a##a#", "#aa#a#", "#a#aa#", "#aaaa#", "######"};
  Regions regions = drawn_regions(rows);
  const FreeSpace space = space_of(rows);
  open_corners(regions, space);
  for (std::int32_t y = 0; y + 1 < space.rows; ++y) {
    for (std::int32_t x = 0; x + 1 < space.columns; ++x) {
      const Region a = regions.at(space.at(x, y)), b = regions.at(space.at(x + 1, y + 1));
      const Region c = regions.at(space.at(x + 1, y)), d = regions.at(space.at(x, y + 1));
      EXPECT_FALSE(a == b && a != kNoRegion && c != a && d != a);
      EXPECT_FALSE(c == d && c != kNoRegion && a != c && b != c);
    }
  }
}

}  // namespace
}  // namespace zonepack::packer::suggest
