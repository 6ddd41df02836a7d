// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "packer/zones/shared_border.hpp"

namespace zonepack::packer {
namespace {

double common_area(const Polygon& a, const Polygon& b) {
  MeasuringSteps steps(1'000'000);
  return common_area_m2(a, b, steps).value();
}

const Polygon kUnitSquare{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}};

// An L of 4 x 4 with a 2 x 2 corner taken out at the upper right, and a 1 x 1 hole.
const Polygon kEll{{{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}},
                   {{{0.5, 0.5}, {0.5, 1.5}, {1.5, 1.5}, {1.5, 0.5}}}};

TEST(Plane, SegmentsMeetWhereTheyCross) {
  const auto at = meeting_point({{0, 0}, {2, 2}}, {{0, 2}, {2, 0}});
  ASSERT_TRUE(at.has_value());
  EXPECT_EQ(*at, (Point2{1, 1}));
}

TEST(Plane, SegmentsMeetWhereAnEndTouches) {
  EXPECT_EQ(meeting_point({{0, 0}, {2, 0}}, {{1, 0}, {1, 5}}), (Point2{1, 0}));
  EXPECT_EQ(meeting_point({{0, 0}, {2, 0}}, {{1, 0.001}, {1, 5}}), std::nullopt);
}

TEST(Plane, SegmentsInOneLineMeetOnlyWhereTheyOverlap) {
  EXPECT_EQ(meeting_point({{0, 0}, {2, 0}}, {{1, 0}, {3, 0}}), (Point2{2, 0}));
  EXPECT_EQ(meeting_point({{0, 0}, {2, 0}}, {{2.1, 0}, {3, 0}}), std::nullopt);
}

TEST(Plane, ASimpleRingHasNoSelfCrossing) {
  EXPECT_TRUE(self_crossings(kUnitSquare.outer).empty());
  EXPECT_TRUE(self_crossings(kEll.outer).empty());
  EXPECT_TRUE(self_crossings({{0, 0}, {1, 0}, {0, 1}}).empty());
}

TEST(Plane, ABowTieCrossesInItsMiddle) {
  const auto crossings = self_crossings({{0, 0}, {2, 2}, {2, 0}, {0, 2}});
  ASSERT_EQ(crossings.size(), 1u);
  EXPECT_EQ(crossings[0].edge_a, 0u);
  EXPECT_EQ(crossings[0].edge_b, 2u);
  EXPECT_EQ(crossings[0].at, (Point2{1, 1}));
}

TEST(Plane, ASpikeThatFoldsBackIsASelfCrossing) {
  // Out along y = 0 to (3, 0) and back to (1, 0): edges 0 and 1 lie on each other.
  const auto crossings = self_crossings({{0, 0}, {3, 0}, {1, 0}, {1, 2}, {0, 2}});
  ASSERT_FALSE(crossings.empty());
  EXPECT_EQ(crossings[0].edge_a, 0u);
  EXPECT_EQ(crossings[0].edge_b, 1u);
}

TEST(Plane, ARingThatTouchesItselfAtAVertexIsASelfCrossing) {
  EXPECT_FALSE(self_crossings({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}).empty());
}

TEST(Plane, CommonAreaOfShiftedSquares) {
  const Polygon shifted{{{0.5, 0.25}, {1.5, 0.25}, {1.5, 1.25}, {0.5, 1.25}}, {}};
  EXPECT_DOUBLE_EQ(common_area(kUnitSquare, shifted), 0.5 * 0.75);
  EXPECT_DOUBLE_EQ(common_area(shifted, kUnitSquare), 0.5 * 0.75);
}

TEST(Plane, CommonAreaIsZeroForNeighbours) {
  EXPECT_EQ(common_area(kUnitSquare, {{{1, 0}, {2, 0}, {2, 1}, {1, 1}}, {}}), 0);
  EXPECT_EQ(common_area(kUnitSquare, {{{5, 0}, {6, 0}, {6, 1}, {5, 1}}, {}}), 0);
  // The corner taken out of the L belongs to the other.
  EXPECT_EQ(common_area(kEll, {{{2, 2}, {4, 2}, {4, 4}, {2, 4}}, {}}), 0);
}

TEST(Plane, CommonAreaTakesHolesOff) {
  // The 2 x 2 square at the origin holds all of the 1 x 1 hole: 4 - 1.
  EXPECT_DOUBLE_EQ(common_area(kEll, {{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {}}), 3);
  EXPECT_DOUBLE_EQ(common_area(kEll, kEll), 12 - 1);
}

TEST(Plane, CommonAreaOfATriangleAndADiamondByHand) {
  // Triangle (0,0) (2,0) (0,2) and the square |x-1| + |y-1| <= 1: the line x + y = 2 halves the
  // square (area 2), and the half below it lies inside the triangle.
  const Polygon triangle{{{0, 0}, {2, 0}, {0, 2}}, {}};
  const Polygon diamond{{{1, 0}, {2, 1}, {1, 2}, {0, 1}}, {}};
  EXPECT_NEAR(common_area(triangle, diamond), 1, 1e-12);
}

TEST(Plane, CommonAreaOfRandomStarsAgreesWithCounting) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(1, 3), unit(0, 1);
  for (int round = 0; round < 5; ++round) {
    Polygon a, b;
    for (int i = 0; i < 12; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + 0.8 * unit(random)) / 12;
      double r = radius(random);
      a.outer.push_back({r * std::cos(angle), r * std::sin(angle)});
      r = radius(random);
      b.outer.push_back({1 + r * std::cos(angle), r * std::sin(angle)});
    }
    int inside = 0;
    constexpr int kGrid = 400;  // cells of 2 cm over 8 m x 8 m
    for (int i = 0; i < kGrid; ++i) {
      for (int j = 0; j < kGrid; ++j) {
        const Point2 p{-4 + (i + 0.5) * 0.02, -4 + (j + 0.5) * 0.02};
        inside += side_of(a, p) == Side::kInside && side_of(b, p) == Side::kInside;
      }
    }
    // Error of counting: about half a cell along an outline of some 30 m, mostly cancelling.
    EXPECT_NEAR(common_area(a, b), inside * 0.02 * 0.02, 0.03);
  }
}

TEST(Plane, TurnsRingsSoThatTheInteriorIsOnTheLeft) {
  const Polygon turned =
      with_interior_on_the_left({{{0, 0}, {0, 3}, {3, 3}, {3, 0}}, {{{1, 1}, {2, 1}, {2, 2}}}});
  EXPECT_GT(twice_signed_area(turned.outer), 0);
  EXPECT_LT(twice_signed_area(turned.holes[0]), 0);
}

TEST(SharedBorder, IsTheCommonPartOfTwoCoincidingEdges) {
  const Polygon right{{{1, 0.25}, {2, 0.25}, {2, 3}, {1, 3}}, {}};
  const auto pieces = shared_borders(kUnitSquare, right, 0.1, 0.3).value();
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].p, (Point2{1, 0.25}));
  EXPECT_EQ(pieces[0].q, (Point2{1, 1}));
}

TEST(SharedBorder, RunsMidwayBetweenOutlinesThatLieApart) {
  const Polygon right{{{1.08, 0}, {2, 0}, {2, 1}, {1.08, 1}}, {}};
  const auto pieces = shared_borders(kUnitSquare, right, 0.1, 0.3).value();
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_DOUBLE_EQ(pieces[0].p.x_m, 1.04);
  EXPECT_DOUBLE_EQ(pieces[0].q.x_m, 1.04);
  EXPECT_TRUE(shared_borders(kUnitSquare, right, 0.05, 0.3)->empty());
}

TEST(SharedBorder, JoinsPiecesInOneLineAndKeepsCornersApart) {
  // The neighbour has an extra vertex at (1, 0.5), and also runs along the top.
  const Polygon around{{{1, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 1}, {1, 1}, {1, 0.5}}, {}};
  const auto pieces = shared_borders(kUnitSquare, around, 0.1, 0.3).value();
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].p, (Point2{1, 0}));
  EXPECT_EQ(pieces[0].q, (Point2{1, 1}));
  EXPECT_EQ(pieces[1].p, (Point2{1, 1}));
  EXPECT_EQ(pieces[1].q, (Point2{0, 1}));
}

TEST(SharedBorder, LeavesOutPiecesThatAreTooShortAndEdgesThatRunTheSameWay) {
  const Polygon low{{{1, 0}, {2, 0}, {2, 0.2}, {1, 0.2}}, {}};
  EXPECT_TRUE(shared_borders(kUnitSquare, low, 0.1, 0.3)->empty());
  EXPECT_EQ(shared_borders(kUnitSquare, low, 0.1, 0.1)->size(), 1u);
  EXPECT_TRUE(shared_borders(kUnitSquare, kUnitSquare, 0.1, 0.1)->empty());
}

TEST(CommonRegion, CoversTheCommonArea) {
  // A square of 4 m and a triangle with the corners (2, 1), (8, 1), (2, 7): its slope passes x = 4
  // at y = 5, above the square. Common: x 2 to 4, y 1 to 4, 6 m2.
  const Polygon square{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {}};
  const Polygon triangle{{{2, 1}, {8, 1}, {2, 7}}, {}};
  MeasuringSteps steps(1000);
  double area = 0;
  for (const Ring& piece : common_region(square, triangle, steps)) area += area_m2({piece, {}});
  EXPECT_NEAR(area, 6, 1e-4);
}

TEST(CommonRegion, FollowsSlopes) {
  // The triangle (0, 0), (4, 0), (0, 4) in a square of 4 m: all of it, 8 m2.
  const Polygon square{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {}};
  const Polygon triangle{{{0, 0}, {4, 0}, {0, 4}}, {}};
  MeasuringSteps steps(1000);
  double area = 0;
  for (const Ring& piece : common_region(square, triangle, steps)) area += area_m2({piece, {}});
  EXPECT_NEAR(area, 8, 1e-4);
  EXPECT_TRUE(common_region(square, {{{9, 9}, {10, 9}, {9, 10}}, {}}, steps).empty());
}

}  // namespace
}  // namespace zonepack::packer
