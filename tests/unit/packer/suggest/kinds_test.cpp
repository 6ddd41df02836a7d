// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/kinds.hpp"

#include <gmock/gmock.h>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

TEST(Kinds, CallALongStripWithTwoNeighboursACorridor) {
  // Cells of 0.5 m. a is 1 cell wide and 12 long: its clearance is 1 cell, so it counts as 2 cells
  // wide, 1 m, and 6 m2 are 6 squares of that.
  const std::vector<std::string> rows{"##############", "#bbbbb#cccccc#", "#aaaaaaaaaaaa#",
                                      "##############"};
  const Regions regions = drawn_regions(rows);
  FreeSpace space =
      drawn_space({"##############", "##.######.####", "#............#", "##############"});
  std::vector<std::int32_t> clearance2(space.size(), 1);
  const std::vector<Kind> kinds = kinds_of(regions, space, clearance2);
  EXPECT_STREQ(kinds[0].name, "corridor");
  EXPECT_STREQ(kinds[1].name, "closet");  // 1.25 m2
  EXPECT_DOUBLE_EQ(kinds[2].area_m2, 1.5);
}

TEST(Kinds, AreNumberedByFallingArea) {
  EXPECT_THAT(names_of({{"room", 10}, {"corridor", 30}, {"room", 20}, {"room", 10}}),
              testing::ElementsAre("room-2", "corridor-1", "room-1", "room-3"));
}

}  // namespace
}  // namespace zonepack::packer::suggest
