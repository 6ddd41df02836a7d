// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/plane.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace zonepack::packer {
namespace {

double cross(Point2 o, Point2 a, Point2 b) noexcept {
  return (a.x_m - o.x_m) * (b.y_m - o.y_m) - (a.y_m - o.y_m) * (b.x_m - o.x_m);
}

Box2 box_of(const Segment2& s) noexcept {
  return {{std::min(s.p.x_m, s.q.x_m), std::min(s.p.y_m, s.q.y_m)},
          {std::max(s.p.x_m, s.q.x_m), std::max(s.p.y_m, s.q.y_m)}};
}

std::vector<Segment2> edges_of(const Polygon& polygon) {
  std::vector<Segment2> edges;
  for_each_edge(polygon, [&](const Segment2& edge) { edges.push_back(edge); });
  return edges;
}

// The x at which the edges pass height y, ascending; even-odd pairs are inside.
void passes_at(const std::vector<Segment2>& edges, double y, std::vector<double>& xs) {
  xs.clear();
  for (const Segment2& e : edges) {
    if ((e.p.y_m > y) == (e.q.y_m > y)) continue;
    xs.push_back(e.p.x_m + (y - e.p.y_m) / (e.q.y_m - e.p.y_m) * (e.q.x_m - e.p.x_m));
  }
  std::sort(xs.begin(), xs.end());
}

double common_width(const std::vector<double>& a, const std::vector<double>& b) {
  double width = 0;
  std::size_t i = 0, j = 0;
  while (i + 1 < a.size() && j + 1 < b.size()) {
    width += std::max(0.0, std::min(a[i + 1], b[j + 1]) - std::max(a[i], b[j]));
    if (a[i + 1] < b[j + 1]) {
      i += 2;
    } else {
      j += 2;
    }
  }
  return width;
}

}  // namespace

std::optional<Point2> meeting_point(const Segment2& a, const Segment2& b) noexcept {
  if (!boxes_meet(box_of(a), box_of(b), kBorderTolerance_m)) return std::nullopt;
  const double ap = cross(b.p, b.q, a.p), aq = cross(b.p, b.q, a.q);
  const double bp = cross(a.p, a.q, b.p), bq = cross(a.p, a.q, b.q);
  if (((ap > 0 && aq < 0) || (ap < 0 && aq > 0)) && ((bp > 0 && bq < 0) || (bp < 0 && bq > 0))) {
    const double t = ap / (ap - aq);
    return Point2{a.p.x_m + t * (a.q.x_m - a.p.x_m), a.p.y_m + t * (a.q.y_m - a.p.y_m)};
  }
  for (const Point2 p : {a.p, a.q}) {
    if (distance_m(b, p) <= kBorderTolerance_m) return p;
  }
  for (const Point2 p : {b.p, b.q}) {
    if (distance_m(a, p) <= kBorderTolerance_m) return p;
  }
  return std::nullopt;
}

std::vector<SelfCrossing> self_crossings(const Ring& ring) {
  std::vector<SelfCrossing> found;
  const std::size_t n = ring.size();
  const auto edge = [&](std::size_t i) { return Segment2{ring[i], ring[(i + 1) % n]}; };
  for (std::size_t i = 0; i < n; ++i) {
    const Segment2 a = edge(i);
    for (std::size_t j = i + 1; j < n; ++j) {
      const Segment2 b = edge(j);
      const bool next = j == i + 1;
      const bool before = i == 0 && j == n - 1;
      if (!next && !before) {
        if (const auto at = meeting_point(a, b)) found.push_back({i, j, *at});
        continue;
      }
      // Neighbours share a vertex; they fold back when a far end lies on the other edge.
      const Point2 far_a = next ? a.p : a.q;
      const Point2 far_b = next ? b.q : b.p;
      if (distance_m(b, far_a) <= kBorderTolerance_m) {
        found.push_back({i, j, far_a});
      } else if (distance_m(a, far_b) <= kBorderTolerance_m) {
        found.push_back({i, j, far_b});
      }
    }
  }
  return found;
}

double common_area_m2(const Polygon& a, const Polygon& b) {
  const Box2 box_a = bounds(a.outer), box_b = bounds(b.outer);
  if (!boxes_meet(box_a, box_b, 0)) return 0;
  const double low = std::max(box_a.min.y_m, box_b.min.y_m);
  const double high = std::min(box_a.max.y_m, box_b.max.y_m);
  const std::vector<Segment2> edges_a = edges_of(a), edges_b = edges_of(b);

  std::vector<double> ys{low, high};
  const auto add = [&](double y) {
    if (y > low && y < high) ys.push_back(y);
  };
  for (const Segment2& e : edges_a) add(e.p.y_m);
  for (const Segment2& e : edges_b) add(e.p.y_m);
  for (const Segment2& e : edges_a) {
    for (const Segment2& f : edges_b) {
      if (const auto at = meeting_point(e, f)) add(at->y_m);
    }
  }
  std::sort(ys.begin(), ys.end());
  ys.erase(std::unique(ys.begin(), ys.end()), ys.end());

  double area = 0;
  std::vector<double> xs_a, xs_b;
  for (std::size_t i = 0; i + 1 < ys.size(); ++i) {
    const double middle = ys[i] + (ys[i + 1] - ys[i]) / 2;
    passes_at(edges_a, middle, xs_a);
    passes_at(edges_b, middle, xs_b);
    area += common_width(xs_a, xs_b) * (ys[i + 1] - ys[i]);
  }
  return area;
}

Polygon with_interior_on_the_left(Polygon polygon) {
  if (twice_signed_area(polygon.outer) < 0) {
    std::reverse(polygon.outer.begin() + 1, polygon.outer.end());
  }
  for (Ring& hole : polygon.holes) {
    if (twice_signed_area(hole) > 0) std::reverse(hole.begin() + 1, hole.end());
  }
  return polygon;
}

bool boxes_meet(const Box2& a, const Box2& b, double margin_m) noexcept {
  return a.min.x_m <= b.max.x_m + margin_m && b.min.x_m <= a.max.x_m + margin_m &&
         a.min.y_m <= b.max.y_m + margin_m && b.min.y_m <= a.max.y_m + margin_m;
}

double distance_to_area_m(const Polygon& polygon, Point2 point) noexcept {
  return side_of(polygon, point) == Side::kOutside ? distance_to_border_m(polygon, point) : 0;
}

}  // namespace zonepack::packer
