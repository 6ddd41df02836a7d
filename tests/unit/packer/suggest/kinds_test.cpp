// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/kinds.hpp"

#include <gmock/gmock.h>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

TEST(Kinds, CallALongStripWithTwoNeighboursACorridor) {
  // Cells of 0.5 m. a is 1 cell wide and 20 long: its clearance is 1 cell, so it counts as 2 cells
  // wide, 1 m, and its 5 m2 are 5 squares of that. b has 2.25 m2, c 2.5 m2.
  const std::vector<std::string> rows{"######################",  //
                                      "#bbbbbbbbb#cccccccccc#",  //
                                      "#aaaaaaaaaaaaaaaaaaaa#",  //
                                      "######################"};
  const Regions regions = drawn_regions(rows);
  const FreeSpace space = drawn_space(rows);
  const std::vector<Kind> kinds =
      kinds_of(regions, space, std::vector<std::int32_t>(space.size(), 1));
  EXPECT_STREQ(kinds[0].name, "corridor");
  EXPECT_STREQ(kinds[1].name, "closet");
  EXPECT_DOUBLE_EQ(kinds[2].area_m2, 2.5);
}

TEST(Kinds, AreNumberedByFallingArea) {
  EXPECT_THAT(names_of({{"room", 10}, {"corridor", 30}, {"room", 20}, {"room", 10}}),
              testing::ElementsAre("room-2", "corridor-1", "room-1", "room-3"));
}

}  // namespace
}  // namespace zonepack::packer::suggest
