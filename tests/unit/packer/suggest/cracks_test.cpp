// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/cracks.hpp"

#include <gtest/gtest.h>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

using Rows = std::vector<std::string>;

constexpr double kLeast_m = 0.3;  // three cells of 0.1 m

Rows parted(const Rows& rows, bool changes = true) {
  const FreeSpace space = drawn_space(rows, 0.1);
  Regions regions = drawn_regions(rows);
  EXPECT_EQ(part_at_cracks(regions, space, kLeast_m), changes);
  return drawn(regions, space);
}

TEST(Cracks, PartRoomsThatACorridorJoins) {
  EXPECT_EQ(parted({"#########",  //
                    "#bbb#ccc#",  //
                    "#bbb#ccc#",  //
                    "#bbbcccc#",  //
                    "#aaaaaaa#",  //
                    "#########"}),
            (Rows{"#########",  //
                  "#bbb#ccc#",  //
                  "#bbb#ccc#",  //
                  "#bbb#ccc#",  //
                  "#aaaaaaa#",  //
                  "#########"}));
}

TEST(Cracks, StayWhereNothingElseJoinsTheTwo) {
  const Rows rows{"#########",  //
                  "#aaa#bbb#",  //
                  "#aaabbbb#",  //
                  "#########"};
  EXPECT_EQ(parted(rows, false), rows);
}

TEST(Cracks, StayWhereTheyAreTheWidestWayIntoARoom) {
  // b is joined to a by two cells and to c by one: the former stays.
  EXPECT_EQ(parted({"#########",  //
                    "#bbbcccc#",  //
                    "#bb##ccc#",  //
                    "##bb#ccc#",  //
                    "#aaaaaaa#",  //
                    "#########"}),
            (Rows{"#########",  //
                  "#bbb#ccc#",  //
                  "#bb##ccc#",  //
                  "##bb#ccc#",  //
                  "#aaaaaaa#",  //
                  "#########"}));
}

TEST(Cracks, AreNoDoorsOfThreeCells) {
  const Rows rows{"#########",  //
                  "#bbb#ccc#",  //
                  "#bbbcccc#",  //
                  "#bbbcccc#",  //
                  "#bbbcccc#",  //
                  "#bbb#ccc#",  //
                  "#aaaaaaa#",  //
                  "#########"};
  EXPECT_EQ(parted(rows, false), rows);
}

}  // namespace
}  // namespace zonepack::packer::suggest
