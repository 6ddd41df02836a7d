// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// Plane geometry that only the packer needs. Metres in the map frame.
namespace zonepack::packer {

// Where two segments cross or touch (within kBorderTolerance_m); one of the common points where
// they overlap.
std::optional<Point2> meeting_point(const Segment2& a, const Segment2& b) noexcept;

// Two edges of one ring that meet without being neighbours, or neighbours that fold back onto each
// other. Edge i runs from vertex i to the next.
struct SelfCrossing {
  std::size_t edge_a = 0, edge_b = 0;
  Point2 at;
};

// In the order of the edges; empty for a simple ring. O(n^2).
std::vector<SelfCrossing> self_crossings(const Ring& ring);

// The common area of two polygons, which may be non-convex and have holes. The plane is cut into
// horizontal strips at every vertex and at every crossing of the two outlines: between them no
// edges cross, so the common width is linear in y and the width at half height times the height is
// exact up to rounding. Each polygon must not cross itself.
double common_area_m2(const Polygon& a, const Polygon& b);

// Interior on the left of every edge: outer counter-clockwise, holes clockwise.
Polygon with_interior_on_the_left(Polygon polygon);

bool boxes_meet(const Box2& a, const Box2& b, double margin_m) noexcept;

// Distance to the polygon as an area: 0 inside and on the border.
double distance_to_area_m(const Polygon& polygon, Point2 point) noexcept;

}  // namespace zonepack::packer
