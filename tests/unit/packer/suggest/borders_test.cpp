// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/borders.hpp"

#include <gtest/gtest.h>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

std::vector<std::vector<std::vector<Corner>>> simple_rings(const std::vector<std::string>& rows) {
  const Regions regions = drawn_regions(rows);
  std::vector<Border> borders;
  for (const Border& border : trace_borders(regions, drawn_space(rows))) {
    borders.push_back(simplified(border));
  }
  return rings_of(borders, regions.count);
}

TEST(Borders, AreTracedOnceForBothNeighbours) {
  const std::vector<std::string> rows{"######", "#aabb#", "#aabb#", "######"};
  const std::vector<Border> borders = trace_borders(drawn_regions(rows), drawn_space(rows));
  // Around a, around b, and between them, from (3, 1) to (3, 3).
  ASSERT_EQ(borders.size(), 3u);
  std::size_t between = 0;
  for (const Border& border : borders) {
    if (!border.between_regions()) continue;
    ++between;
    EXPECT_EQ(border.corners, (std::vector<Corner>{{3, 1}, {3, 2}, {3, 3}}));
    EXPECT_EQ(border.left, 0);
    EXPECT_EQ(border.right, 1);
  }
  EXPECT_EQ(between, 1u);
}

TEST(Borders, OfARectangleHaveFourCorners) {
  const auto rings = simple_rings({"######", "#aaaa#", "#aaaa#", "######"});
  ASSERT_EQ(rings.size(), 1u);
  ASSERT_EQ(rings[0].size(), 1u);
  EXPECT_EQ(rings[0][0].size(), 4u);
}

TEST(Borders, OfASlantedWallAreOneLine) {
  // Steps of one cell: every corner of the stairs lies on one of two parallel lines, and the line
  // through the outer ones keeps all centres on their sides.
  const auto rings = simple_rings({"#########",  //
                                   "#a#######",  //
                                   "#aa######",  //
                                   "#aaa#####",  //
                                   "#aaaa####",  //
                                   "#aaaaa###",  //
                                   "#########"});
  ASSERT_EQ(rings[0].size(), 1u);
  EXPECT_LE(rings[0][0].size(), 6u);
}

TEST(Borders, AroundAPillarAreAHole) {
  const auto rings = simple_rings({"#######",  //
                                   "#aaaaa#",  //
                                   "#aa#aa#",  //
                                   "#aaaaa#",  //
                                   "#######"});
  ASSERT_EQ(rings[0].size(), 2u);
  EXPECT_EQ(rings[0][0].size(), 4u);
  EXPECT_GE(rings[0][1].size(), 3u);
}

}  // namespace
}  // namespace zonepack::packer::suggest
