// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/cut.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "packer/zones/findings.hpp"

namespace zonepack::packer {
namespace {

constexpr double kEqual = 1e-9;  // relative: two areas, two sides

// Counter-clockwise, without collinear points (monotone chain).
Ring convex_hull(Ring points) {
  std::sort(points.begin(), points.end(),
            [](Point2 a, Point2 b) { return a.x_m < b.x_m || (a.x_m == b.x_m && a.y_m < b.y_m); });
  const auto turns_left = [](Point2 o, Point2 a, Point2 b) {
    return (a.x_m - o.x_m) * (b.y_m - o.y_m) - (a.y_m - o.y_m) * (b.x_m - o.x_m) > 0;
  };
  Ring hull;
  const auto add = [&](Point2 p, std::size_t fixed) {
    while (hull.size() >= fixed + 2 && !turns_left(hull[hull.size() - 2], hull.back(), p)) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Point2 p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto it = points.rbegin() + 1; it != points.rend(); ++it) add(*it, lower);
  hull.pop_back();
  return hull;
}

double extent(const Ring& ring, const Axis& axis) noexcept {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Point2 p : ring) {
    low = std::min(low, axis.at(p));
    high = std::max(high, axis.at(p));
  }
  return high - low;
}

Axis to_greater_x(Axis axis) noexcept {
  const bool backwards = axis.ux < -kEqual || (axis.ux <= kEqual && axis.uy < 0);
  return backwards ? Axis{-axis.ux, -axis.uy} : axis;
}

bool nearer_to_x(const Axis& a, const Axis& b) noexcept {
  return std::abs(a.ux) > std::abs(b.ux) + kEqual;
}

// Where an outline crosses the cut.
struct Crossing {
  double across = 0;  // position along the cut
  Point2 point;
  bool up = false;      // from below to above
  std::size_t run = 0;  // the run of vertices that begins here
};

// The vertices on one side of the cut, from the crossing where the outline enters the side to the
// one where it leaves.
struct Run {
  std::size_t enter = 0, leave = 0;  // places in the sorted list of passes
  Ring vertices;
};

class Cutter {
 public:
  Cutter(const Axis& axis, double place) : axis_(axis), place_(place) {}

  void add(const Ring& ring, bool hole) {
    const std::size_t n = ring.size();
    const auto above = [&](std::size_t i) { return axis_.at(ring[i % n]) > place_; };
    std::size_t first = 0;
    while (first < n && above(first) == above(first + 1)) ++first;
    if (first == n) {
      (above(0) ? above_ : below_).whole.emplace_back(ring, hole);
      return;
    }
    const std::size_t first_crossing = crossings_.size();
    for (std::size_t i = first; i < first + n; ++i) {
      if (above(i) != above(i + 1)) {
        crossings_.push_back(crossing(ring[i % n], ring[(i + 1) % n], runs_.size()));
        runs_.push_back({crossings_.size() - 1, crossings_.size(), {}});
      }
      runs_.back().vertices.push_back(ring[(i + 1) % n]);
    }
    runs_.back().leave = first_crossing;
  }

  Pieces pieces() {
    sort_crossings();
    trace(false, below_);
    trace(true, above_);
    return {assembled(below_), assembled(above_)};
  }

 private:
  struct SidePieces {
    std::vector<std::pair<Ring, bool>> whole;  // rings that the cut does not touch; true: a hole
    std::vector<Polygon> polygons;
  };

  Crossing crossing(Point2 p, Point2 q, std::size_t run) const {
    const double from = axis_.at(p), to = axis_.at(q);
    const double t = (place_ - from) / (to - from);
    const Point2 point{p.x_m + t * (q.x_m - p.x_m), p.y_m + t * (q.y_m - p.y_m)};
    return {axis_.across().at(point), point, from < to, run};
  }

  void sort_crossings() {
    std::vector<std::size_t> order(crossings_.size()), place(crossings_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return crossings_[a].across < crossings_[b].across;
    });
    // With the interior on the left, the inside of the polygon begins at every upward crossing.
    // Only two crossings at one point, at the tip of a needle, can be in the wrong order.
    const auto fits = [&](std::size_t i) { return crossings_[order[i]].up == (i % 2 == 0); };
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      if (!fits(i)) std::swap(order[i], order[i + 1]);
    }
    std::vector<Crossing> sorted;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (!fits(i)) {
        throw std::runtime_error("an outline cannot be cut at " +
                                 point_text(crossings_[order[i]].point) +
                                 ", where its edges run into each other; simplify it there");
      }
      place[order[i]] = i;
      sorted.push_back(crossings_[order[i]]);
    }
    crossings_ = std::move(sorted);
    for (Run& run : runs_) {
      run.enter = place[run.enter];
      run.leave = place[run.leave];
    }
  }

  // Follows the runs on one side; where one leaves it, the cut leads to the neighbouring crossing.
  void trace(bool above, SidePieces& side) {
    std::vector<bool> done(crossings_.size());
    for (std::size_t start = 0; start < crossings_.size(); ++start) {
      if (crossings_[start].up != above || done[start]) continue;
      Ring ring;
      std::size_t at = start;
      do {
        done[at] = true;
        const Run& run = runs_[crossings_[at].run];
        ring.push_back(crossings_[at].point);
        ring.insert(ring.end(), run.vertices.begin(), run.vertices.end());
        ring.push_back(crossings_[run.leave].point);
        at = run.leave ^ 1u;
      } while (at != start);
      side.polygons.push_back({std::move(ring), {}});
    }
  }

  static std::vector<Polygon> assembled(SidePieces& side) {
    for (auto& [ring, hole] : side.whole) {
      if (!hole) side.polygons.push_back({std::move(ring), {}});
    }
    for (auto& [ring, hole] : side.whole) {
      if (hole) holder_of(ring, side.polygons).holes.push_back(std::move(ring));
    }
    return std::move(side.polygons);
  }

  static Polygon& holder_of(const Ring& hole, std::vector<Polygon>& polygons) {
    for (Polygon& polygon : polygons) {
      for (const Point2 p : hole) {
        if (side_of({polygon.outer, {}}, p) == Side::kInside) return polygon;
      }
    }
    return polygons.front();
  }

  const Axis axis_;
  const double place_;
  std::vector<Crossing> crossings_;
  std::vector<Run> runs_;
  SidePieces below_, above_;
};

}  // namespace

Axis length_of(const Polygon& polygon) {
  const Ring hull = convex_hull(polygon.outer);
  Axis best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point2 p = hull[i], q = hull[(i + 1) % hull.size()];
    const double length = distance_m(p, q);
    Axis along{(q.x_m - p.x_m) / length, (q.y_m - p.y_m) / length};
    Axis across = along.across();
    double long_side = extent(hull, along), short_side = extent(hull, across);
    const bool square = std::abs(long_side - short_side) <= kEqual * long_side;
    if (square ? nearer_to_x(across, along) : long_side < short_side) std::swap(along, across);
    const double area = long_side * short_side;
    if (area < least * (1 - kEqual) || (area <= least * (1 + kEqual) && nearer_to_x(along, best))) {
      least = std::min(least, area);
      best = along;
    }
  }
  return to_greater_x(best);
}

Pieces cut(const Polygon& polygon, const Axis& axis, double place) {
  Cutter cutter(axis, place);
  cutter.add(polygon.outer, false);
  for (const Ring& hole : polygon.holes) cutter.add(hole, true);
  return cutter.pieces();
}

double place_between(const Polygon& polygon, const Axis& axis, double from, double to) {
  const double middle = from + (to - from) / 2;
  std::vector<double> stops{from, to};
  double nearest = std::numeric_limits<double>::infinity();
  for_each_edge(polygon, [&](const Segment2& edge) {
    const double at = axis.at(edge.p);
    nearest = std::min(nearest, std::abs(at - middle));
    if (at > from && at < to) stops.push_back(at);
  });
  if (nearest > (to - from) / 10) return middle;
  std::sort(stops.begin(), stops.end());
  std::size_t widest = 0;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    if (stops[i + 1] - stops[i] > stops[widest + 1] - stops[widest]) widest = i;
  }
  return stops[widest] + (stops[widest + 1] - stops[widest]) / 2;
}

}  // namespace zonepack::packer
