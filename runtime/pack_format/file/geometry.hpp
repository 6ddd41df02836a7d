// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

// Plane geometry of zones, the same for the packer and the robot, so that a point is in the same
// zone on both. Metres in the map frame. Only + - * / sqrt: the same bits on every machine.
namespace zonepack {

struct Point2 {
  double x_m = 0;
  double y_m = 0;
  friend bool operator==(const Point2&, const Point2&) = default;
};

inline Point2 operator-(Point2 a, Point2 b) noexcept { return {a.x_m - b.x_m, a.y_m - b.y_m}; }
inline double dot(Point2 a, Point2 b) noexcept { return a.x_m * b.x_m + a.y_m * b.y_m; }

struct Segment2 {
  Point2 p, q;
};

// Closed without repeating the first vertex; either orientation.
using Ring = std::vector<Point2>;

struct Box2 {
  Point2 min, max;
};

struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

// Where a point is relative to a polygon. On the border: within kBorderTolerance_m of an edge.
enum class Side { kOutside, kBorder, kInside };
inline constexpr double kBorderTolerance_m = 1e-9;

Side side_of(const Polygon& polygon, Point2 point) noexcept;

// Twice the signed area; positive when counter-clockwise.
double twice_signed_area(const Ring& ring) noexcept;

// Square metres, without the holes.
double area_m2(const Polygon& polygon) noexcept;

Box2 bounds(const Ring& ring) noexcept;

Point2 nearest_point(const Segment2& segment, Point2 point) noexcept;
double distance_m(Point2 a, Point2 b) noexcept;
double distance_m(const Segment2& segment, Point2 point) noexcept;

// Distance to the nearest edge, holes included; not signed.
double distance_to_border_m(const Polygon& polygon, Point2 point) noexcept;

// Calls fn(Segment2) for every edge of the outer ring, then of every hole.
template <typename Fn>
void for_each_edge(const Polygon& polygon, Fn&& fn) {
  const auto ring_edges = [&fn](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      fn(Segment2{ring[i], ring[(i + 1) % ring.size()]});
    }
  };
  ring_edges(polygon.outer);
  for (const Ring& hole : polygon.holes) ring_edges(hole);
}

}  // namespace zonepack
