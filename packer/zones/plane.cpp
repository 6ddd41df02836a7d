// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/plane.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "packer/zones/edge_rows.hpp"

namespace zonepack::packer {
namespace {

double cross(Point2 o, Point2 a, Point2 b) noexcept {
  return (a.x_m - o.x_m) * (b.y_m - o.y_m) - (a.y_m - o.y_m) * (b.x_m - o.x_m);
}

std::vector<Segment2> edges_of(const Polygon& polygon) {
  std::vector<Segment2> edges;
  for_each_edge(polygon, [&](const Segment2& edge) { edges.push_back(edge); });
  return edges;
}

// The edges of an outline that pass a height which only grows.
class PassingEdges {
 public:
  explicit PassingEdges(const std::vector<Segment2>& edges) {
    for (const Segment2& e : edges) {
      if (e.p.y_m != e.q.y_m) waiting_.push_back(e);
    }
    std::sort(waiting_.begin(), waiting_.end(),
              [](const Segment2& a, const Segment2& b) { return low(a) > low(b); });
  }

  // The x at which the edges pass height y, ascending; even-odd pairs are inside. y is not below
  // that of the call before.
  const std::vector<double>& passes_at(double y) {
    while (!waiting_.empty() && low(waiting_.back()) <= y) {
      passing_.push_back(waiting_.back());
      waiting_.pop_back();
    }
    xs_.clear();
    for (std::size_t i = 0; i < passing_.size();) {
      const Segment2& e = passing_[i];
      if (std::max(e.p.y_m, e.q.y_m) <= y) {
        passing_[i] = passing_.back();
        passing_.pop_back();
        continue;
      }
      xs_.push_back(e.p.x_m + (y - e.p.y_m) / (e.q.y_m - e.p.y_m) * (e.q.x_m - e.p.x_m));
      ++i;
    }
    std::sort(xs_.begin(), xs_.end());
    return xs_;
  }

 private:
  static double low(const Segment2& e) noexcept { return std::min(e.p.y_m, e.q.y_m); }

  std::vector<Segment2> waiting_, passing_;
  std::vector<double> xs_;
};

// Those that come into the box, give or take the tolerance.
std::vector<Segment2> edges_in(const std::vector<Segment2>& edges, const Box2& box) {
  std::vector<Segment2> inside;
  for (const Segment2& e : edges) {
    if (boxes_meet(box_of(e), box, kBorderTolerance_m)) inside.push_back(e);
  }
  return inside;
}

// The stretches of a row that lie in both, from the places where edges pass it.
std::vector<std::pair<double, double>> common_spans(const std::vector<double>& a,
                                                    const std::vector<double>& b) {
  std::vector<std::pair<double, double>> spans;
  std::size_t i = 0, j = 0;
  while (i + 1 < a.size() && j + 1 < b.size()) {
    const double from = std::max(a[i], b[j]), to = std::min(a[i + 1], b[j + 1]);
    if (from < to) spans.emplace_back(from, to);
    if (a[i + 1] < b[j + 1]) {
      i += 2;
    } else {
      j += 2;
    }
  }
  return spans;
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

constexpr std::size_t kMostHeights =
    1'000'000;  // of the strips between two outlines, before sorting

// The heights that part the common rows of two polygons into strips in which no edges begin, end or
// cross; ascending. nullopt when the steps do not suffice.
std::optional<std::vector<double>> strips_of(const Polygon& a, const Polygon& b,
                                             const std::vector<Segment2>& edges_a,
                                             const std::vector<Segment2>& edges_b,
                                             MeasuringSteps& steps) {
  const Box2 box_a = bounds(a.outer), box_b = bounds(b.outer);
  const double low = std::max(box_a.min.y_m, box_b.min.y_m);
  const double high = std::min(box_a.max.y_m, box_b.max.y_m);
  std::vector<double> ys{low, high};
  const auto add = [&](double y) {
    if (y > low && y < high) ys.push_back(y);
  };
  for (const Segment2& e : edges_a) add(e.p.y_m);
  for (const Segment2& e : edges_b) add(e.p.y_m);
  const std::vector<Segment2> near_a = edges_in(edges_a, box_b), near_b = edges_in(edges_b, box_a);
  Stretches rows = rows_of(near_b);
  for (const Segment2& e : near_a) {
    const Box2 box = box_of(e);
    std::uint64_t compared = 1;
    for (const std::uint32_t i : rows.touching(box.min.y_m - kBorderTolerance_m,
                                               box.max.y_m + kBorderTolerance_m, compared)) {
      if (const auto at = meeting_point(e, near_b[i])) add(at->y_m);
    }
    if (!steps.take(compared) || ys.size() > kMostHeights) return std::nullopt;
  }
  std::sort(ys.begin(), ys.end());
  ys.erase(std::unique(ys.begin(), ys.end()), ys.end());
  return ys;
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

std::vector<SelfCrossing> self_crossings(const Ring& ring, std::size_t most) {
  std::vector<SelfCrossing> found;
  const std::size_t n = ring.size();
  const auto edge = [&](std::size_t i) { return Segment2{ring[i], ring[(i + 1) % n]}; };
  for (std::size_t i = 0; i < n && found.size() < most; ++i) {
    const Segment2 a = edge(i);
    for (std::size_t j = i + 1; j < n && found.size() < most; ++j) {
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

std::optional<double> common_area_m2(const Polygon& a, const Polygon& b, MeasuringSteps& steps) {
  if (!boxes_meet(bounds(a.outer), bounds(b.outer), 0)) return 0;
  const std::vector<Segment2> edges_a = edges_of(a), edges_b = edges_of(b);
  const std::optional<std::vector<double>> heights = strips_of(a, b, edges_a, edges_b, steps);
  if (!heights) return std::nullopt;
  const std::vector<double>& ys = *heights;
  double area = 0;
  PassingEdges passing_a(edges_a), passing_b(edges_b);
  for (std::size_t i = 0; i + 1 < ys.size(); ++i) {
    const double middle = ys[i] + (ys[i + 1] - ys[i]) / 2;
    const std::vector<double>& xs_a = passing_a.passes_at(middle);
    const std::vector<double>& xs_b = passing_b.passes_at(middle);
    area += common_width(xs_a, xs_b) * (ys[i + 1] - ys[i]);
    if (!steps.take(1 + xs_a.size() + xs_b.size())) return std::nullopt;
  }
  return area;
}

std::vector<Ring> common_region(const Polygon& a, const Polygon& b, MeasuringSteps& steps) {
  std::vector<Ring> pieces;
  if (!boxes_meet(bounds(a.outer), bounds(b.outer), 0)) return pieces;
  const std::vector<Segment2> edges_a = edges_of(a), edges_b = edges_of(b);
  const std::optional<std::vector<double>> heights = strips_of(a, b, edges_a, edges_b, steps);
  if (!heights) return pieces;
  const std::vector<double>& ys = *heights;
  PassingEdges passing_a(edges_a), passing_b(edges_b);
  for (std::size_t i = 0; i + 1 < ys.size(); ++i) {
    // No edges cross within a strip, so its spans just above the bottom and just below the top are
    // the same ones in the same order.
    const double inset = (ys[i + 1] - ys[i]) * 1e-6;
    const auto low =
        common_spans(passing_a.passes_at(ys[i] + inset), passing_b.passes_at(ys[i] + inset));
    const auto high = common_spans(passing_a.passes_at(ys[i + 1] - inset),
                                   passing_b.passes_at(ys[i + 1] - inset));
    if (!steps.take(1 + low.size() + high.size()) || low.size() != high.size()) return pieces;
    for (std::size_t k = 0; k < low.size(); ++k) {
      if (pieces.size() == kMostRegionPieces) return pieces;
      pieces.push_back({{low[k].first, ys[i]},
                        {low[k].second, ys[i]},
                        {high[k].second, ys[i + 1]},
                        {high[k].first, ys[i + 1]}});
    }
  }
  return pieces;
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
