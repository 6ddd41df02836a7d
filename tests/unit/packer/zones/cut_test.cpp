// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/cut.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "packer/zones/plane.hpp"

namespace zonepack::packer {
namespace {

constexpr Axis kX{1, 0};

double total_area(const std::vector<Polygon>& polygons) {
  double sum = 0;
  for (const Polygon& polygon : polygons) sum += area_m2(polygon);
  return sum;
}

TEST(Length, IsTheLongerSideOfTheRectangle) {
  const Axis flat = length_of({{{0, 0}, {6, 0}, {6, 2}, {0, 2}}, {}});
  EXPECT_DOUBLE_EQ(flat.ux, 1);
  EXPECT_DOUBLE_EQ(flat.uy, 0);
  const Axis tall = length_of({{{0, 0}, {2, 0}, {2, 6}, {0, 6}}, {}});
  EXPECT_DOUBLE_EQ(tall.ux, 0);
  EXPECT_DOUBLE_EQ(tall.uy, 1);
}

TEST(Length, FollowsACorridorThatStandsAtAnAngle) {
  // 10 x 1 along (0.6, 0.8) / across (-0.8, 0.6).
  const Polygon slanted{{{0, 0}, {6, 8}, {5.2, 8.6}, {-0.8, 0.6}}, {}};
  EXPECT_NEAR(length_of(slanted).ux, 0.6, 1e-12);
  EXPECT_NEAR(length_of(slanted).uy, 0.8, 1e-12);
}

TEST(Length, PrefersXForASquareAndPointsToGreaterX) {
  const Axis square = length_of({{{2, 2}, {0, 2}, {0, 0}, {2, 0}}, {}});
  EXPECT_DOUBLE_EQ(square.ux, 1);
  EXPECT_DOUBLE_EQ(square.uy, 0);
}

TEST(Length, IgnoresDentsInTheOutline) {
  const Polygon dented{{{0, 0}, {6, 0}, {6, 2}, {4, 2}, {3, 0.5}, {2, 2}, {0, 2}}, {}};
  EXPECT_DOUBLE_EQ(length_of(dented).ux, 1);
}

TEST(Cut, HalvesARectangle) {
  const Pieces pieces = cut({{{0, 0}, {6, 0}, {6, 2}, {0, 2}}, {}}, kX, 2);
  ASSERT_EQ(pieces.below.size(), 1u);
  ASSERT_EQ(pieces.above.size(), 1u);
  EXPECT_DOUBLE_EQ(area_m2(pieces.below[0]), 4);
  EXPECT_DOUBLE_EQ(area_m2(pieces.above[0]), 8);
  EXPECT_GT(twice_signed_area(pieces.below[0].outer), 0);
  EXPECT_GT(twice_signed_area(pieces.above[0].outer), 0);
}

TEST(Cut, LeavesAPolygonThatTheLineMisses) {
  const Pieces pieces = cut({{{0, 0}, {6, 0}, {6, 2}, {0, 2}}, {}}, kX, 7);
  EXPECT_EQ(pieces.below.size(), 1u);
  EXPECT_TRUE(pieces.above.empty());
}

TEST(Cut, GivesTheTwoLegsOfAUAsTwoPieces) {
  // Legs y 0...1 and 2...3 to the right of x = 2; the bottom of the U at the left.
  const Polygon u{{{0, 0}, {6, 0}, {6, 1}, {2, 1}, {2, 2}, {6, 2}, {6, 3}, {0, 3}}, {}};
  const Pieces pieces = cut(u, kX, 4);
  ASSERT_EQ(pieces.below.size(), 1u);
  ASSERT_EQ(pieces.above.size(), 2u);
  EXPECT_DOUBLE_EQ(area_m2(pieces.above[0]), 2);
  EXPECT_DOUBLE_EQ(area_m2(pieces.above[1]), 2);
  EXPECT_LT(pieces.above[0].outer[0].y_m, pieces.above[1].outer[0].y_m);
  EXPECT_DOUBLE_EQ(area_m2(pieces.below[0]), 10);
}

TEST(Cut, KeepsAHoleWithTheLegThatItIsIn) {
  const Polygon u{{{0, 0}, {6, 0}, {6, 1}, {2, 1}, {2, 2}, {6, 2}, {6, 3}, {0, 3}},
                  {{{5, 2.4}, {5, 2.6}, {5.2, 2.6}, {5.2, 2.4}}}};
  const Pieces pieces = cut(u, kX, 4);
  ASSERT_EQ(pieces.above.size(), 2u);
  EXPECT_TRUE(pieces.above[0].holes.empty());
  EXPECT_EQ(pieces.above[1].holes.size(), 1u);
}

TEST(Cut, OpensAHoleThatItPasses) {
  const Polygon ring = {{{0, 0}, {6, 0}, {6, 6}, {0, 6}}, {{{2, 2}, {2, 4}, {4, 4}, {4, 2}}}};
  const Pieces pieces = cut(ring, kX, 3);
  ASSERT_EQ(pieces.below.size(), 1u);
  ASSERT_EQ(pieces.above.size(), 1u);
  EXPECT_TRUE(pieces.below[0].holes.empty());
  EXPECT_DOUBLE_EQ(area_m2(pieces.below[0]), 16);
  EXPECT_EQ(side_of(pieces.below[0], {2.5, 3}), Side::kOutside);
  EXPECT_TRUE(self_crossings(pieces.below[0].outer).empty());
}

TEST(Cut, KeepsAHoleThatItMissesWithItsPiece) {
  const Polygon ring = {{{0, 0}, {6, 0}, {6, 6}, {0, 6}},
                        {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}, {{4, 4}, {4, 5}, {5, 5}, {5, 4}}}};
  const Pieces pieces = cut(ring, kX, 3);
  ASSERT_EQ(pieces.below.at(0).holes.size(), 1u);
  ASSERT_EQ(pieces.above.at(0).holes.size(), 1u);
  EXPECT_EQ(pieces.below[0].holes[0], ring.holes[0]);
  EXPECT_EQ(pieces.above[0].holes[0], ring.holes[1]);
}

TEST(Cut, SeparatesRoomsThatOnlyAHoleAndTheOutlineLeave) {
  // The hole spans nearly all of the width at x 2...4: cut at 3, two narrow bridges join the
  // halves.
  const Polygon ring = {{{0, 0}, {6, 0}, {6, 6}, {0, 6}}, {{{2, 1}, {2, 5}, {4, 5}, {4, 1}}}};
  const Pieces first = cut(ring, kX, 2.5);
  const Pieces second = cut(first.above.at(0), kX, 3.5);
  EXPECT_EQ(second.below.size(), 2u);  // the bridges, 1 m wide and 1 m long
  EXPECT_DOUBLE_EQ(total_area(second.below), 2);
  EXPECT_EQ(second.above.size(), 1u);
}

TEST(Cut, FindsAPlaceWithoutVertices) {
  const Polygon plain{{{0, 0}, {6, 0}, {6, 2}, {0, 2}}, {}};
  EXPECT_DOUBLE_EQ(place_between(plain, kX, 2, 4), 3);
  // A vertex at 3, in the very middle: the widest free stretch is 2...3 (the first of two).
  const Polygon dented{{{0, 0}, {6, 0}, {6, 2}, {3, 1}, {0, 2}}, {}};
  EXPECT_DOUBLE_EQ(place_between(dented, kX, 2, 4), 2.5);
}

}  // namespace
}  // namespace zonepack::packer
