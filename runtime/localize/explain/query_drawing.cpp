// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/explain/query_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "runtime/localize/explain/png_text.hpp"
#include "runtime/localize/solve/sighting.hpp"
#include "runtime/report/plan_view.hpp"

namespace zonepack::localize {
namespace {

using report::Color;
using report::PlanView;
using report::Px;
using report::Style;
using report::Svg;

constexpr double kWidth = 900;
constexpr double kMargin_m = 4;  // around what the plan shows
constexpr Color kInlier{0x11, 0x99, 0x33}, kOther{0xCC, 0x33, 0x11}, kPoint{0xEE, 0x99, 0x00};
constexpr Color kGround{0xF2, 0xF2, 0xEE}, kWall{0x99, 0x99, 0x99}, kGuess{0x33, 0x66, 0xCC};

void draw_robot(Svg& svg, const PlanView& view, const Pose2& pose, Color color, bool filled) {
  const auto at = [&](double ahead_m, double left_m) {
    const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
    return view({pose.x_m + c * ahead_m - s * left_m, pose.y_m + s * ahead_m + c * left_m});
  };
  std::vector<std::vector<Px>> arrow{{at(0.5, 0), at(-0.3, 0.28), at(-0.15, 0), at(-0.3, -0.28)}};
  Style style;
  if (filled) style.fill = color;
  style.stroke = color;
  style.stroke_width = 1.5;
  svg.polygon(arrow, style);
}

}  // namespace

Svg draw_matches(const GreyImage& image, const QueryResult& result) {
  const double zoom = kWidth / image.width;
  Svg svg(kWidth, image.height * zoom);
  svg.image({0, 0}, kWidth, image.height * zoom, false, png_text(image));
  svg.open_clip({0, 0}, kWidth, image.height * zoom);
  for (const bool inlier : {false, true}) {
    for (const DrawnMatch& match : result.drawn) {
      if (match.inlier != inlier) continue;
      const Px seen{match.x_px * zoom, match.y_px * zoom};
      const Px put{match.map_x_px * zoom, match.map_y_px * zoom};
      Style line;
      line.stroke = inlier ? kInlier : kOther;
      line.stroke_width = 1.5;
      svg.line(seen, put, line);
      Style ring = line;
      ring.hint = inlier ? "a match that the pose explains" : "a match that disagrees";
      svg.circle(seen, inlier ? 5 : 4, ring);
      Style dot;
      dot.fill = kPoint;
      if (inlier) svg.circle(put, 1.8, dot);
    }
  }
  svg.close();
  return svg;
}

Svg draw_place(const Catalog& catalog, const std::vector<MapFeatures>& map,
               const QueryResult& result, const std::optional<Pose2>& guess) {
  // What was found and where it was looked for; the whole map where neither is known.
  Box2 area{{1e9, 1e9}, {-1e9, -1e9}};
  const auto take = [&](double x, double y, double margin) {
    area.min.x_m = std::min(area.min.x_m, x - margin);
    area.min.y_m = std::min(area.min.y_m, y - margin);
    area.max.x_m = std::max(area.max.x_m, x + margin);
    area.max.y_m = std::max(area.max.y_m, y + margin);
  };
  if (guess) take(guess->x_m, guess->y_m, kMargin_m);
  if (result.found) {
    take(result.pose.x_m, result.pose.y_m, kMargin_m);
    for (const DrawnMatch& match : result.drawn) {
      if (match.inlier) take(double{match.p_map.x()}, double{match.p_map.y()}, 1);
    }
  } else if (!guess) {
    for (const CatalogZone& zone : catalog.zones) {
      for (const Point2& p : zone.polygon.outer) take(p.x_m, p.y_m, 1);
    }
  }
  const PlanView view(area, {0, 0}, kWidth, kWidth * 0.8);
  Svg svg(kWidth, view.height());
  svg.open_clip({0, 0}, view.width(), view.height());
  for (const CatalogZone& zone : catalog.zones) {
    Style style;
    style.fill = kGround;
    style.stroke = kWall;
    svg.polygon(view(zone.polygon), style);
  }
  Style point;
  point.fill = kPoint;
  for (const DrawnMatch& match : result.drawn) {
    if (!match.inlier) continue;
    svg.circle(view({double{match.p_map.x()}, double{match.p_map.y()}}), 2, point);
  }
  for (const MapFeatures& one : map) {
    const Pose2 pose = flatten(one.T_map_base);
    const Px from = view({pose.x_m, pose.y_m});
    const Px to =
        view({pose.x_m + 0.35 * std::cos(pose.yaw_rad), pose.y_m + 0.35 * std::sin(pose.yaw_rad)});
    const bool matched = std::any_of(
        result.drawn.begin(), result.drawn.end(),
        [&](const DrawnMatch& match) { return match.inlier && match.signature == one.id; });
    Style style;
    style.stroke = matched ? kInlier : kWall;
    style.stroke_width = matched ? 2 : 1;
    const std::string hint = "signature " + std::to_string(one.id);
    style.hint = hint;
    svg.line(from, to, style);
    svg.circle(from, matched ? 3.5 : 2.5, style);
  }
  if (guess) draw_robot(svg, view, *guess, kGuess, false);
  if (result.found) draw_robot(svg, view, result.pose, result.accepted ? kInlier : kOther, true);
  for (const CatalogZone& zone : catalog.zones) {
    Point2 middle{0, 0};
    for (const Point2& p : zone.polygon.outer) {
      middle.x_m += p.x_m / static_cast<double>(zone.polygon.outer.size());
      middle.y_m += p.y_m / static_cast<double>(zone.polygon.outer.size());
    }
    report::TextStyle text;
    text.anchor = report::Anchor::kMiddle;
    text.halo = kGround;
    svg.text(view(middle), zone.name, text);
  }
  svg.close();
  return svg;
}

}  // namespace zonepack::localize
