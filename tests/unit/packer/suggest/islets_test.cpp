// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/islets.hpp"

#include <gtest/gtest.h>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

// A desk of one cell, 0.5 m, cuts the right corner off.
const FreeSpace kRoom = drawn_space({"#######", "#...#.#", "#...#.#", "#######"});
const std::vector<std::string> kRegions{"#######", "#aaa###", "#aaa###", "#######"};

TEST(FoldIslets, BridgesADeskToTheCornerBehindIt) {
  Regions regions = drawn_regions(kRegions);
  fold_islets(regions, kRoom, 0.5);
  // The bridge is the cell beside the islet's lowest cell.
  EXPECT_EQ(drawn(regions, kRoom),
            (std::vector<std::string>{"#######", "#aaa#a#", "#aaaaa#", "#######"}));
}

TEST(FoldIslets, LeavesWhatIsFartherAwayAlone) {
  Regions regions = drawn_regions(kRegions);
  fold_islets(regions, kRoom, 0.2);
  EXPECT_EQ(drawn(regions, kRoom), kRegions);
}

}  // namespace
}  // namespace zonepack::packer::suggest
