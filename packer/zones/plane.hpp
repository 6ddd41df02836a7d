// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// Plane geometry that only the packer needs. Metres in the map frame.
namespace zonepack::packer {

// Where two segments cross or touch (within kBorderTolerance_m); one of the common points where
// they overlap.
std::optional<Point2> meeting_point(const Segment2& a, const Segment2& b) noexcept;

inline constexpr std::size_t kMostSelfCrossings = 10'000;

// How much work measuring a drawing may take, so that outlines which cross each other everywhere
// end in a message. One step compares two edges or passes one edge of a strip, some 10 ns.
class MeasuringSteps {
 public:
  explicit MeasuringSteps(std::uint64_t steps) noexcept : left_(steps) {}
  // False when the steps are used up, then for ever.
  bool take(std::uint64_t steps) noexcept {
    left_ = steps > left_ ? 0 : left_ - steps;
    return left_ > 0;
  }

 private:
  std::uint64_t left_;
};

// Two edges of one ring that meet without being neighbours, or neighbours that fold back onto each
// other. Edge i runs from vertex i to the next.
struct SelfCrossing {
  std::size_t edge_a = 0, edge_b = 0;
  Point2 at;
};

// In the order of the edges, at most `most` of them; empty for a simple ring. O(n^2).
std::vector<SelfCrossing> self_crossings(const Ring& ring, std::size_t most = kMostSelfCrossings);

// The common area of two polygons, which may be non-convex and have holes. The plane is cut into
// horizontal strips at every vertex and at every crossing of the two outlines: between them no
// edges cross, so the common width is linear in y and the width at half height times the height is
// exact up to rounding. Each polygon must not cross itself. nullopt when the steps do not suffice.
std::optional<double> common_area_m2(const Polygon& a, const Polygon& b, MeasuringSteps& steps);

// The common area of the two as pieces between the same strips, for a picture: each a
// quadrilateral, at most kMostRegionPieces; fewer when the steps do not suffice.
inline constexpr std::size_t kMostRegionPieces = 400;
std::vector<Ring> common_region(const Polygon& a, const Polygon& b, MeasuringSteps& steps);

// Interior on the left of every edge: outer counter-clockwise, holes clockwise.
Polygon with_interior_on_the_left(Polygon polygon);

bool boxes_meet(const Box2& a, const Box2& b, double margin_m) noexcept;

// Distance to the polygon as an area: 0 inside and on the border.
double distance_to_area_m(const Polygon& polygon, Point2 point) noexcept;

}  // namespace zonepack::packer
