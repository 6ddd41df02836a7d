// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/geometry.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

const Polygon kSquareWithHole{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};

TEST(Geometry, DistinguishesInsideBorderAndOutsideWithHoles) {
  EXPECT_EQ(side_of(kSquareWithHole, {3, 3}), Side::kInside);
  EXPECT_EQ(side_of(kSquareWithHole, {1.5, 1.5}), Side::kOutside);
  EXPECT_EQ(side_of(kSquareWithHole, {5, 1.5}), Side::kOutside);
  EXPECT_EQ(side_of(kSquareWithHole, {4, 2}), Side::kBorder);
  EXPECT_EQ(side_of(kSquareWithHole, {0, 0}), Side::kBorder);
  EXPECT_EQ(side_of(kSquareWithHole, {2, 1.5}), Side::kBorder);
}

TEST(Geometry, AreaTakesHolesOff) { EXPECT_DOUBLE_EQ(area_m2(kSquareWithHole), 15.0); }

TEST(Geometry, DistanceToASegmentEndsAtItsEnds) {
  const Segment2 s{{0, 0}, {2, 0}};
  EXPECT_DOUBLE_EQ(distance_m(s, {1, 3}), 3);
  EXPECT_DOUBLE_EQ(distance_m(s, {5, 4}), 5);  // 3-4-5 from (2, 0)
  EXPECT_DOUBLE_EQ(distance_to_border_m(kSquareWithHole, {1.5, 1.5}), 0.5);
}

}  // namespace
}  // namespace zonepack
