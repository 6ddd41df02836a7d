// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "packer/tune/changes.hpp"
#include "packer/zones/plane.hpp"
#include "packer/zones/shared_border.hpp"
#include "packer/zones/zone_checks.hpp"

// The union of overlapping polygons, as an arrangement of their edges on a grid of 0.1 mm, the
// precision of a zone file: edges are cut where they meet, those inside of another polygon and
// those that run back and forth are dropped, and the rest is walked along.
namespace zonepack::packer::tune {
namespace {

constexpr double kGrid_m = 1e-4;
constexpr double kMeets_m = 3e-4;  // nearer than this, a corner lies on an edge
constexpr double kLap_m = 2e-3;    // how far the filling of a wall reaches into the rooms
constexpr double kLeastHole_m2 = 0.05;
constexpr double kAreaOff = 0.02;  // of the sum of all areas

using Node = std::pair<std::int64_t, std::int64_t>;

Node node_of(Point2 p) { return {std::llround(p.x_m / kGrid_m), std::llround(p.y_m / kGrid_m)}; }
Point2 point_of(Node n) {
  return {static_cast<double>(n.first) * kGrid_m, static_cast<double>(n.second) * kGrid_m};
}

struct Edge {
  Point2 p, q;
  std::size_t polygon = 0;
};

// The nodes along an edge, where others end on it or cross it.
std::vector<Node> cut_up(const Edge& edge, const std::vector<Edge>& edges) {
  std::vector<std::pair<double, Node>> stops;
  const double length = distance_m(edge.p, edge.q);
  const auto add = [&](Point2 at) {
    const double along = ((at.x_m - edge.p.x_m) * (edge.q.x_m - edge.p.x_m) +
                          (at.y_m - edge.p.y_m) * (edge.q.y_m - edge.p.y_m)) /
                         length;
    stops.emplace_back(along, node_of(at));
  };
  for (const Edge& other : edges) {
    bool touches = false;
    for (const Point2 end : {other.p, other.q}) {
      if (distance_m(Segment2{edge.p, edge.q}, end) > kMeets_m) continue;
      add(end);
      touches = true;
    }
    for (const Point2 end : {edge.p, edge.q}) {
      touches = touches || distance_m(Segment2{other.p, other.q}, end) <= kMeets_m;
    }
    if (touches) continue;
    if (const auto at = meeting_point({edge.p, edge.q}, {other.p, other.q})) add(*at);
  }
  std::sort(stops.begin(), stops.end());
  std::vector<Node> nodes{node_of(edge.p)};
  for (const auto& [along, node] : stops) {
    if (along > 0 && along < length && node != nodes.back()) nodes.push_back(node);
  }
  if (node_of(edge.q) != nodes.back()) nodes.push_back(node_of(edge.q));
  return nodes;
}

// How far left `to` leads, coming along `along`, radians.
double left_turn(Point2 along, Point2 to) {
  return std::atan2(along.x_m * to.y_m - along.y_m * to.x_m,
                    along.x_m * to.x_m + along.y_m * to.y_m);
}

Point2 step(Node from, Node to) {
  const Point2 p = point_of(from), q = point_of(to);
  return {q.x_m - p.x_m, q.y_m - p.y_m};
}

// Rings along the directed edges, each turning left as far as it can where several leave, so that
// pieces that touch in a point come apart.
std::vector<Ring> walk(std::map<Node, std::vector<Node>> out) {
  std::vector<Ring> rings;
  while (!out.empty()) {
    const Node start = out.begin()->first;
    Ring ring;
    Node at = start, before = start;
    do {
      const auto leaving = out.find(at);
      if (leaving == out.end()) return {};  // not closed
      auto next = leaving->second.begin();
      if (at != start) {
        const Point2 along = step(before, at);
        for (auto it = next; it != leaving->second.end(); ++it) {
          if (left_turn(along, step(at, *it)) > left_turn(along, step(at, *next))) next = it;
        }
      }
      ring.push_back(point_of(at));
      before = at;
      at = *next;
      leaving->second.erase(next);
      if (leaving->second.empty()) out.erase(leaving);
    } while (at != start);
    rings.push_back(std::move(ring));
  }
  return rings;
}

std::vector<Ring> union_of(const std::vector<Polygon>& polygons) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    for_each_edge(polygons[i], [&](const Segment2& e) { edges.push_back({e.p, e.q, i}); });
  }
  std::map<std::pair<Node, Node>, std::vector<std::size_t>> pieces;  // polygons by directed piece
  for (const Edge& edge : edges) {
    const std::vector<Node> nodes = cut_up(edge, edges);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      pieces[{nodes[i], nodes[i + 1]}].push_back(edge.polygon);
    }
  }
  std::map<Node, std::vector<Node>> out;
  for (const auto& [piece, owners] : pieces) {
    const auto& [p, q] = piece;
    if (pieces.contains({q, p})) continue;  // a border of two
    const Point2 a = point_of(p), b = point_of(q);
    const Point2 middle{(a.x_m + b.x_m) / 2, (a.y_m + b.y_m) / 2};
    bool inside = false;
    for (std::size_t i = 0; i < polygons.size() && !inside; ++i) {
      if (std::ranges::find(owners, i) != owners.end()) continue;
      inside = side_of(polygons[i], middle) == Side::kInside &&
               distance_to_border_m(polygons[i], middle) > kGrid_m;
    }
    if (!inside) out[p].push_back(q);
  }
  return walk(std::move(out));
}

// A strip across the wall along a piece of the border in its middle.
Polygon filling(const Segment2& piece, double half_m) {
  const double length = distance_m(piece.p, piece.q);
  const double x = (piece.q.x_m - piece.p.x_m) / length, y = (piece.q.y_m - piece.p.y_m) / length;
  const auto corner = [&](Point2 p, double side) {
    return Point2{p.x_m - side * y * half_m, p.y_m + side * x * half_m};
  };
  return {{corner(piece.p, -1), corner(piece.q, -1), corner(piece.q, 1), corner(piece.p, 1)}, {}};
}

// Without corners that lie on the line between their neighbours.
Ring straightened(const Ring& ring) {
  Ring out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 before = out.empty() ? ring.back() : out.back();
    const Point2 after = ring[(i + 1) % ring.size()];
    if (distance_m(Segment2{before, after}, ring[i]) > kGrid_m) out.push_back(ring[i]);
  }
  return out;
}

}  // namespace

std::optional<Polygon> joined(const Polygon& a, const Polygon& b) {
  const std::vector<Polygon> both{with_interior_on_the_left(a), with_interior_on_the_left(b)};
  const auto border = shared_borders(both[0], both[1], kThickestWall_m + kMeets_m, kLeastSeam_m);
  if (!border || border->empty()) return std::nullopt;
  std::vector<Polygon> all = both;
  double wall_m2 = 0;
  for (const Segment2& piece : *border) {
    double half = 0;
    for (const double t : {0.25, 0.5, 0.75}) {
      const Point2 at{piece.p.x_m + t * (piece.q.x_m - piece.p.x_m),
                      piece.p.y_m + t * (piece.q.y_m - piece.p.y_m)};
      half = std::max({half, distance_to_border_m(a, at), distance_to_border_m(b, at)});
    }
    if (half <= kMeets_m) continue;
    all.push_back(filling(piece, half + kLap_m));
    wall_m2 += area_m2(all.back());
  }
  const std::vector<Ring> rings = union_of(all);
  Polygon polygon;
  for (const Ring& raw : rings) {
    const Ring ring = straightened(raw);
    if (ring.size() < 3) continue;
    const double area = twice_signed_area(ring) / 2;
    if (area > 0) {
      if (area < kLeastHole_m2) continue;
      if (!polygon.outer.empty()) return std::nullopt;  // two pieces
      polygon.outer = ring;
    } else if (area < -kLeastHole_m2) {
      polygon.holes.push_back(ring);
    }
  }
  if (polygon.outer.empty()) return std::nullopt;
  const double sum = area_m2(a) + area_m2(b) + wall_m2;
  if (std::abs(area_m2(polygon) - sum) > kAreaOff * sum) return std::nullopt;
  if (!outline_faults(polygon).empty()) return std::nullopt;
  return polygon;
}

}  // namespace zonepack::packer::tune
