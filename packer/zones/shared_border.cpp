// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/shared_border.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "packer/zones/edge_rows.hpp"
#include "packer/zones/plane.hpp"

namespace zonepack::packer {
namespace {

constexpr double kMaxSlope = 0.268;     // tan(15 degrees)
constexpr double kLeastPiece_m = 1e-9;  // anything shorter is a touch at a corner
constexpr double kCollinear_m = 1e-6;   // pieces this close to one line are one piece

double length(const Segment2& s) noexcept { return distance_m(s.p, s.q); }

// Rounding must not invent coordinates: a point next to a vertex becomes the vertex.
Point2 at_vertex(Point2 p, const Segment2& a, const Segment2& b) noexcept {
  for (const Point2 v : {a.p, a.q, b.p, b.q}) {
    if (distance_m(p, v) <= kBorderTolerance_m) return v;
  }
  return p;
}

// The part of edge a along which edge b runs in the opposite direction, moved halfway to b.
std::optional<Segment2> shared_piece(const Segment2& a, const Segment2& b, double separation_m) {
  const double length_a = length(a);
  if (length_a == 0) return std::nullopt;
  const double ux = (a.q.x_m - a.p.x_m) / length_a, uy = (a.q.y_m - a.p.y_m) / length_a;
  const auto along = [&](Point2 p) { return (p.x_m - a.p.x_m) * ux + (p.y_m - a.p.y_m) * uy; };
  const auto off = [&](Point2 p) { return (p.y_m - a.p.y_m) * ux - (p.x_m - a.p.x_m) * uy; };

  const double run = along(b.p) - along(b.q);
  const double rise = off(b.p) - off(b.q);
  if (run <= 0 || std::abs(rise) > kMaxSlope * run) return std::nullopt;
  const double slope = rise / run;
  const auto off_at = [&](double s) { return off(b.q) + slope * (s - along(b.q)); };

  double from = std::max(0.0, along(b.q));
  double to = std::min(length_a, along(b.p));
  if (slope != 0) {
    const double s1 = along(b.q) + (-separation_m - off(b.q)) / slope;
    const double s2 = along(b.q) + (separation_m - off(b.q)) / slope;
    from = std::max(from, std::min(s1, s2));
    to = std::min(to, std::max(s1, s2));
  } else if (std::abs(off(b.q)) > separation_m) {
    return std::nullopt;
  }
  if (to - from < kLeastPiece_m) return std::nullopt;
  const auto midway = [&](double s) {
    const double half = off_at(s) / 2;
    return at_vertex({a.p.x_m + s * ux - half * uy, a.p.y_m + s * uy + half * ux}, a, b);
  };
  return Segment2{midway(from), midway(to)};
}

// Joins two segments that continue or overlap each other in one line; the result has the direction
// of a.
std::optional<Segment2> joined(const Segment2& a, const Segment2& b) {
  if (!boxes_meet(box_of(a), box_of(b), 2 * kCollinear_m)) return std::nullopt;
  const std::array<Point2, 4> ends{a.p, a.q, b.p, b.q};
  Segment2 whole = a;
  for (const Point2 p : ends) {
    for (const Point2 q : ends) {
      if (distance_m(p, q) > length(whole)) whole = {p, q};
    }
  }
  if (length(whole) > length(a) + length(b) + kCollinear_m) return std::nullopt;
  for (const Point2 p : ends) {
    if (distance_m(whole, p) > kCollinear_m) return std::nullopt;
  }
  const double dot = (whole.q.x_m - whole.p.x_m) * (a.q.x_m - a.p.x_m) +
                     (whole.q.y_m - whole.p.y_m) * (a.q.y_m - a.p.y_m);
  if (dot < 0) std::swap(whole.p, whole.q);
  return whole;
}

void join_collinear(std::vector<Segment2>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size();) {
      if (const auto whole = joined(pieces[i], pieces[j])) {
        pieces[i] = *whole;
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
        j = i + 1;
      } else {
        ++j;
      }
    }
  }
}

}  // namespace

std::optional<std::vector<Segment2>> shared_borders(const Polygon& a, const Polygon& b,
                                                    double separation_m, double min_length_m) {
  std::vector<Segment2> pieces;
  if (!boxes_meet(bounds(a.outer), bounds(b.outer), separation_m)) return pieces;
  // A piece lies on one edge and at most this far from the other, up to rounding.
  const double reach_m = separation_m + kCollinear_m;
  const Box2 box_b = bounds(b.outer);
  std::vector<Segment2> edges_b;
  for_each_edge(b, [&](const Segment2& edge) { edges_b.push_back(edge); });
  Stretches rows = rows_of(edges_b);
  for_each_edge(a, [&](const Segment2& edge_a) {
    const Box2 box = box_of(edge_a);
    if (!boxes_meet(box, box_b, reach_m) || pieces.size() > kMostBorderPieces) return;
    std::uint64_t compared = 0;
    for (const std::uint32_t i :
         rows.touching(box.min.y_m - reach_m, box.max.y_m + reach_m, compared)) {
      if (!boxes_meet(box, box_of(edges_b[i]), reach_m)) continue;
      if (const auto piece = shared_piece(edge_a, edges_b[i], separation_m)) {
        pieces.push_back(*piece);
      }
    }
  });
  if (pieces.size() > kMostBorderPieces) return std::nullopt;
  join_collinear(pieces);
  std::erase_if(pieces, [&](const Segment2& piece) { return length(piece) < min_length_m; });
  return pieces;
}

std::optional<Point2> nearest_point(const std::vector<Segment2>& pieces, Point2 point) noexcept {
  std::optional<Point2> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const Segment2& piece : pieces) {
    const Point2 candidate = zonepack::nearest_point(piece, point);
    const double distance = distance_m(candidate, point);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace zonepack::packer
