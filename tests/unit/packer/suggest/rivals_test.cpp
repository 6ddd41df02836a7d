// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/rivals.hpp"

#include <gmock/gmock.h>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

TEST(Squares, AreThereWhereverSomethingIsFree) {
  // Squares of 2 x 2 cells, from the first cell behind the margin; the one at the right is all
  // wall.
  const FreeSpace space = drawn_space({"########",  //
                                       "#..#.###",  //
                                       "#.######",  //
                                       "########"});
  EXPECT_EQ(drawn(squares_of(space, 1.0), space),
            (std::vector<std::string>{"########", "#aabb###", "#aabb###", "########"}));
}

TEST(Stretches, GoToTheNearestOnFoot) {
  const FreeSpace space = drawn_space({"#########", "#.......#", "#.#####.#", "#########"});
  // The path begins at the lower left and ends at the lower right.
  const std::vector<PathPlace> path{{space.at(1, 1), 0}, {space.at(7, 1), 1}};
  // The upper row: 7 cells, each 1 to 7 steps away; the middle one is as near to both, and goes to
  // the first.
  EXPECT_EQ(drawn(stretches_of(space, path), space),
            (std::vector<std::string>{"#########", "#aaaabbb#", "#a#####b#", "#########"}));
}

TEST(CutLong, CutsIntoEqualLengths) {
  const std::vector<std::string> rows{"##########", "#aaaaaaaa#", "##########"};
  Regions regions = drawn_regions(rows);
  const FreeSpace space = drawn_space(rows);
  // 8 cells are 7 steps of 0.5 m: 3.5 m, in parts of 2 m at most: two.
  cut_long(regions, space, 2.0);
  EXPECT_EQ(drawn(regions, space),
            (std::vector<std::string>{"##########", "#aaaabbbb#", "##########"}));
  cut_long(regions, space, 2.0);
  EXPECT_EQ(regions.count, 2);
}

}  // namespace
}  // namespace zonepack::packer::suggest
