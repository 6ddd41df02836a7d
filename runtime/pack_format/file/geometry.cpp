// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace zonepack {

double twice_signed_area(const Ring& ring) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2& a = ring[i];
    const Point2& b = ring[(i + 1) % ring.size()];
    sum += a.x_m * b.y_m - b.x_m * a.y_m;
  }
  return sum;
}

double area_m2(const Polygon& polygon) noexcept {
  double area = std::abs(twice_signed_area(polygon.outer)) / 2;
  for (const Ring& hole : polygon.holes) area -= std::abs(twice_signed_area(hole)) / 2;
  return area;
}

Box2 bounds(const Ring& ring) noexcept {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Box2 box{{kInf, kInf}, {-kInf, -kInf}};
  for (const Point2& p : ring) {
    box.min = {std::min(box.min.x_m, p.x_m), std::min(box.min.y_m, p.y_m)};
    box.max = {std::max(box.max.x_m, p.x_m), std::max(box.max.y_m, p.y_m)};
  }
  return box;
}

Point2 nearest_point(const Segment2& segment, Point2 point) noexcept {
  const double dx = segment.q.x_m - segment.p.x_m;
  const double dy = segment.q.y_m - segment.p.y_m;
  const double length2 = dx * dx + dy * dy;
  if (length2 == 0) return segment.p;
  const double t = ((point.x_m - segment.p.x_m) * dx + (point.y_m - segment.p.y_m) * dy) / length2;
  const double s = std::clamp(t, 0.0, 1.0);
  return {segment.p.x_m + s * dx, segment.p.y_m + s * dy};
}

double distance_m(Point2 a, Point2 b) noexcept {
  const double dx = a.x_m - b.x_m;
  const double dy = a.y_m - b.y_m;
  return std::sqrt(dx * dx + dy * dy);
}

double distance_m(const Segment2& segment, Point2 point) noexcept {
  return distance_m(nearest_point(segment, point), point);
}

double distance_to_border_m(const Polygon& polygon, Point2 point) noexcept {
  double least = std::numeric_limits<double>::infinity();
  for_each_edge(polygon,
                [&](const Segment2& edge) { least = std::min(least, distance_m(edge, point)); });
  return least;
}

Side side_of(const Polygon& polygon, Point2 point) noexcept {
  bool inside = false;
  bool border = false;
  for_each_edge(polygon, [&](const Segment2& edge) {
    border = border || distance_m(edge, point) <= kBorderTolerance_m;
    // Even-odd rule: edges of holes cross the ray too and turn inside back into outside.
    if ((edge.p.y_m > point.y_m) != (edge.q.y_m > point.y_m)) {
      const double t = (point.y_m - edge.p.y_m) / (edge.q.y_m - edge.p.y_m);
      if (point.x_m < edge.p.x_m + t * (edge.q.x_m - edge.p.x_m)) inside = !inside;
    }
  });
  if (border) return Side::kBorder;
  return inside ? Side::kInside : Side::kOutside;
}

}  // namespace zonepack
