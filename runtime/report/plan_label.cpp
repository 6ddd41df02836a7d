// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/plan_label.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "runtime/pack_format/file/geometry.hpp"

namespace zonepack::report {
namespace {

constexpr int kGrid = 28;
constexpr double kLeastClearance = 1.5;  // pixels between label and border
constexpr double kEnoughClearance = 10;  // more is no better
constexpr double kPointCost = 1.5;       // clearance to give up for one readable point
constexpr double kSpareCost = 0.8;
constexpr double kAround = 4;            // pixels around the label that points should leave free
constexpr double kOffCenterCost = 0.02;  // a pixel

Point2 as_point(Px p) noexcept { return {p.x, p.y}; }

Polygon as_polygon(std::span<const std::vector<Px>> rings) {
  Polygon polygon;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    Ring& ring = i == 0 ? polygon.outer : polygon.holes.emplace_back();
    for (const Px& p : rings[i]) ring.push_back(as_point(p));
  }
  return polygon;
}

bool overlap(const PxBox& a, const PxBox& b) noexcept {
  return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
}

bool inside(const PxBox& box, Px p) noexcept {
  return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y;
}

// Distance between the box and the nearest edge; 0 when an edge enters the box.
double clearance(const Polygon& polygon, const PxBox& box) noexcept {
  double least = std::numeric_limits<double>::infinity();
  const Segment2 sides[] = {{as_point(box.min), {box.max.x, box.min.y}},
                            {{box.max.x, box.min.y}, as_point(box.max)},
                            {as_point(box.max), {box.min.x, box.max.y}},
                            {{box.min.x, box.max.y}, as_point(box.min)}};
  const auto crosses = [](const Segment2& a, const Segment2& b) {
    const auto turn = [](Point2 p, Point2 q, Point2 r) {
      return (q.x_m - p.x_m) * (r.y_m - p.y_m) - (q.y_m - p.y_m) * (r.x_m - p.x_m);
    };
    return turn(a.p, a.q, b.p) * turn(a.p, a.q, b.q) < 0 &&
           turn(b.p, b.q, a.p) * turn(b.p, b.q, a.q) < 0;
  };
  for_each_edge(polygon, [&](const Segment2& edge) {
    if (inside(box, {edge.p.x_m, edge.p.y_m})) least = 0;
    for (const Segment2& side : sides) {
      if (crosses(edge, side)) least = 0;
      least = std::min({least, distance_m(edge, side.p), distance_m(side, edge.p)});
    }
  });
  return least;
}

LabelGround within(const PxBox& area, const LabelGround& everything) {
  LabelGround ground;
  const auto is_inside = [&](Px p) { return inside(area, p); };
  std::ranges::copy_if(everything.taken, std::back_inserter(ground.taken),
                       [&](const PxBox& box) { return overlap(area, box); });
  std::ranges::copy_if(everything.keep, std::back_inserter(ground.keep), is_inside);
  std::ranges::copy_if(everything.spare, std::back_inserter(ground.spare), is_inside);
  return ground;
}

}  // namespace

PxBox box_around(Px center, double width, double height) noexcept {
  return {{center.x - width / 2, center.y - height / 2},
          {center.x + width / 2, center.y + height / 2}};
}

std::optional<PlacedLabel> place_label(std::span<const std::vector<Px>> rings, double width,
                                       double height, const LabelGround& everything) {
  if (rings.empty() || rings[0].size() < 3) return std::nullopt;
  const Polygon polygon = as_polygon(rings);
  const Box2 area = bounds(polygon.outer);
  if (area.max.x_m - area.min.x_m < width || area.max.y_m - area.min.y_m < height) {
    return std::nullopt;
  }
  const Point2 middle{(area.min.x_m + area.max.x_m) / 2, (area.min.y_m + area.max.y_m) / 2};
  const LabelGround ground =
      within({{area.min.x_m, area.min.y_m}, {area.max.x_m, area.max.y_m}}, everything);
  std::optional<PlacedLabel> best;
  double best_score = -std::numeric_limits<double>::infinity();
  for (int row = 1; row < kGrid; ++row) {
    for (int column = 1; column < kGrid; ++column) {
      const Px center{area.min.x_m + (area.max.x_m - area.min.x_m) * column / kGrid,
                      area.min.y_m + (area.max.y_m - area.min.y_m) * row / kGrid};
      const PxBox box = box_around(center, width, height);
      if (side_of(polygon, as_point(center)) != Side::kInside) continue;
      if (std::ranges::any_of(ground.taken,
                              [&](const PxBox& other) { return overlap(box, other); })) {
        continue;
      }
      const double free = clearance(polygon, box);
      if (free < kLeastClearance) continue;
      const PxBox around = box_around(center, width + 2 * kAround, height + 2 * kAround);
      const auto is_near = [&](Px p) { return inside(around, p); };
      const auto hidden = std::ranges::count_if(ground.keep, is_near);
      const auto spare = std::ranges::count_if(ground.spare, is_near);
      const double score = std::min(free, kEnoughClearance) -
                           kPointCost * static_cast<double>(hidden) -
                           kSpareCost * static_cast<double>(spare) -
                           kOffCenterCost * distance_m(middle, as_point(center));
      if (score > best_score) {
        best_score = score;
        best = {center, static_cast<std::size_t>(hidden)};
      }
    }
  }
  return best;
}

}  // namespace zonepack::report
