// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/floor_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "runtime/report/chart.hpp"
#include "runtime/report/floor_plan_dots.hpp"
#include "runtime/report/floor_plan_marks.hpp"
#include "runtime/report/format.hpp"
#include "runtime/report/legend.hpp"
#include "runtime/report/plan_label.hpp"
#include "runtime/report/plan_view.hpp"
#include "runtime/report/script_json.hpp"
#include "runtime/report/ticks.hpp"

namespace zonepack::report {
namespace {

constexpr double kPlanLeft = 40, kPlanRight = 14, kPlanAxisBelow = 40, kMostHeight = 760;
constexpr double kMargin_m = 0.4;
constexpr double kRasterShown_m = 2;          // how far a grid beyond zones and signatures is shown
constexpr double kArrowEvery = 110;           // pixels of route
constexpr Color kZoneLine{0x3a, 0x5f, 0x8a};  // not to be taken for a wall
constexpr Style kRouteHalo{.stroke = kWhite, .stroke_width = 5.5, .opacity = 0.8, .round = true};

bool is_finite(Point2 p) noexcept { return std::isfinite(p.x_m) && std::isfinite(p.y_m); }

double distance_px(Px a, Px b) noexcept { return distance_m(Point2{a.x, a.y}, Point2{b.x, b.y}); }

Box2 area_of(const FloorPlan& plan) noexcept {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Box2 box{{kInf, kInf}, {-kInf, -kInf}};
  const auto add = [&box](Point2 p) {
    if (!is_finite(p)) return;
    box.min = {std::min(box.min.x_m, p.x_m), std::min(box.min.y_m, p.y_m)};
    box.max = {std::max(box.max.x_m, p.x_m), std::max(box.max.y_m, p.y_m)};
  };
  for (const PlanZone& zone : plan.zones) std::ranges::for_each(zone.polygon.outer, add);
  std::ranges::for_each(plan.signatures, add);
  for (const PlanOrphan& orphan : plan.orphans) add(orphan.p_map);
  for (const PlanFault& fault : plan.faults) {
    for (const Ring& ring : fault.areas) std::ranges::for_each(ring, add);
    for (const Segment2& line : fault.lines) {
      add(line.p);
      add(line.q);
    }
  }
  if (!(box.min.x_m <= box.max.x_m)) {
    for (const PlanRoutePoint& point : plan.route) add(point.p_map);
  }
  if (!(box.min.x_m <= box.max.x_m) && plan.raster) box = plan.raster->area;
  if (!(box.min.x_m <= box.max.x_m)) return {{0, 0}, {10, 5}};
  if (plan.raster) {
    // A laser sees far out of windows; only what is near counts.
    const Box2& grid = plan.raster->area;
    box.min.x_m = std::min(box.min.x_m, std::max(grid.min.x_m, box.min.x_m - kRasterShown_m));
    box.min.y_m = std::min(box.min.y_m, std::max(grid.min.y_m, box.min.y_m - kRasterShown_m));
    box.max.x_m = std::max(box.max.x_m, std::min(grid.max.x_m, box.max.x_m + kRasterShown_m));
    box.max.y_m = std::max(box.max.y_m, std::min(grid.max.y_m, box.max.y_m + kRasterShown_m));
  }
  return {{box.min.x_m - kMargin_m, box.min.y_m - kMargin_m},
          {box.max.x_m + kMargin_m, box.max.y_m + kMargin_m}};
}

std::vector<LegendItem> legend_of(const FloorPlan& plan) {
  std::vector<LegendItem> items;
  if (plan.ramp) items.push_back({Mark::kRamp, kInk, plan.ramp->low + " to " + plan.ramp->high});
  if (!plan.route.empty()) {
    items.push_back({Mark::kThickLine, plan.route.front().color, "route, coloured by zone"});
  }
  if (!plan.true_route.empty()) {
    items.push_back({Mark::kDashedLine, kInk, plan.true_route_name});
  }
  if (!plan.portals.empty()) items.push_back({Mark::kThickLine, kDoor, "portal"});
  if (!plan.signatures.empty()) items.push_back({Mark::kDot, kQuiet, "signature"});
  add_dot_legend(plan, items);
  add_mark_legend(plan, items);
  return items;
}

void draw_axes(Svg& svg, const PlanView& view) {
  const Box2& area = view.area();
  const double bottom = view.corner().y + view.height();
  const Style tick{.stroke = kWall};
  const TextStyle label{.size = 11, .color = kQuiet};
  const auto draw = [&](double low, double high, bool across, const auto& at) {
    const Ticks ticks =
        make_ticks(low, high, static_cast<int>((high - low) * view.px_per_m() / 70) + 1);
    for (std::size_t i = 0; i < ticks.values.size(); ++i) {
      const Px p = view(at(ticks.values[i]));
      TextStyle style = label;
      if (across) {
        svg.line({p.x, bottom}, {p.x, bottom + 4}, tick);
        style.anchor = Anchor::kMiddle;
        svg.text({p.x, bottom + 16}, ticks.labels[i], style);
      } else {
        svg.line({view.corner().x - 4, p.y}, {view.corner().x, p.y}, tick);
        style.anchor = Anchor::kEnd;
        svg.text({view.corner().x - 7, p.y + 4}, ticks.labels[i], style);
      }
    }
  };
  draw(area.min.x_m, area.max.x_m, !view.turned(), [&](double x) {
    return Point2{x, area.min.y_m};
  });
  draw(area.min.y_m, area.max.y_m, view.turned(), [&](double y) {
    return Point2{area.min.x_m, y};
  });
  svg.rect(view.corner(), view.width(), view.height(), {.stroke = kFaint});

  const double most_px = std::min(140.0, view.width() / 5);  // the words to the right need room
  const Ticks lengths = make_ticks(0, most_px / view.px_per_m(), 1);
  const double bar_m = lengths.values.back() > 0 ? lengths.values.back() : lengths.step;
  const Px bar{view.corner().x, bottom + 28};
  const double bar_px = bar_m * view.px_per_m();
  svg.line(bar, {bar.x + bar_px, bar.y}, {.stroke = kInk, .stroke_width = 2});
  svg.line({bar.x, bar.y - 4}, {bar.x, bar.y + 4}, {.stroke = kInk, .stroke_width = 2});
  svg.line({bar.x + bar_px, bar.y - 4}, {bar.x + bar_px, bar.y + 4},
           {.stroke = kInk, .stroke_width = 2});
  const std::string length = format_number(bar_m, 2) + " m";
  svg.text({bar.x + bar_px + 8, bar.y + 4}, length, {.size = 11});

  std::string axes = view.turned() ? "right: y, down: x, in metres" : "right: x, up: y, in metres";
  const double room = view.width() - bar_px - 24 - text_width_em(length) * 11;
  if (text_width_em(axes) * 11 > room)
    axes = view.turned() ? "right: y, down: x" : "right: x, up: y";
  svg.text({view.corner().x + view.width(), bottom + 32}, axes,
           {.size = 11, .color = kQuiet, .anchor = Anchor::kEnd});
}

struct RoutePiece {
  std::vector<Px> points;
  Color color;
};

// One piece per stretch of one colour; each begins where the previous one ended.
std::vector<RoutePiece> route_pieces(const FloorPlan& plan, const PlanView& view) {
  std::vector<RoutePiece> pieces;
  for (const PlanRoutePoint& point : plan.route) {
    const Px p = view(point.p_map);
    if (!is_finite(point.p_map)) continue;
    if (pieces.empty() || pieces.back().color != point.color) {
      RoutePiece next{{}, point.color};
      if (!pieces.empty()) next.points.push_back(pieces.back().points.back());
      pieces.push_back(std::move(next));
    }
    std::vector<Px>& points = pieces.back().points;
    if (points.empty() || distance_px(points.back(), p) > 0.7) {
      points.push_back(p);
    }
  }
  return pieces;
}

void draw_arrow(Svg& svg, Px tip, double dx, double dy) {
  constexpr double kLong = 5.5, kWide = 3.2;
  const std::vector<Px> head = {{tip.x + dx * kLong, tip.y + dy * kLong},
                                {tip.x - dx * 2 - dy * kWide, tip.y - dy * 2 + dx * kWide},
                                {tip.x - dx * 2 + dy * kWide, tip.y - dy * 2 - dx * kWide}};
  svg.polygon(std::span(&head, 1), {.fill = kInk, .stroke = kWhite, .stroke_width = 0.75});
}

void draw_arrows(Svg& svg, const std::vector<RoutePiece>& pieces) {
  double until_next = kArrowEvery / 2;
  for (const RoutePiece& piece : pieces) {
    for (std::size_t i = 1; i < piece.points.size(); ++i) {
      const Px a = piece.points[i - 1], b = piece.points[i];
      const double length = distance_px(a, b);
      until_next -= length;
      if (until_next > 0 || length == 0) continue;
      draw_arrow(svg, b, (b.x - a.x) / length, (b.y - a.y) / length);
      until_next = kArrowEvery;
    }
  }
}

void draw_routes(Svg& svg, const FloorPlan& plan, const PlanView& view) {
  const std::vector<RoutePiece> pieces = route_pieces(plan, view);
  for (const RoutePiece& piece : pieces) svg.polyline(piece.points, kRouteHalo);
  for (const RoutePiece& piece : pieces) {
    svg.polyline(piece.points, {.stroke = piece.color, .stroke_width = 3.5, .round = true});
  }
  std::vector<Px> truth;
  for (const Point2& p : plan.true_route) {
    if (is_finite(p) && (truth.empty() || distance_px(truth.back(), view(p)) > 0.7)) {
      truth.push_back(view(p));
    }
  }
  svg.polyline(truth, {.stroke = kInk, .stroke_width = 0.9, .opacity = 0.8, .dash = "4 3"});
  draw_arrows(svg, pieces);
  if (pieces.empty()) return;
  const Px start = pieces.front().points.front(), end = pieces.back().points.back();
  svg.circle(start, 6, {.fill = kWhite, .stroke = kInk, .stroke_width = 2, .hint = "start"});
  svg.rect({end.x - 4, end.y - 4}, 8, 8, {.fill = kInk, .stroke = kWhite, .hint = "end"});
}

// Of many, one for each few pixels: a drawing's size has a bound, whatever the map's.
void draw_signatures(Svg& svg, const FloorPlan& plan, const PlanView& view) {
  constexpr std::size_t kMany = 5000;
  constexpr double kCell_px = 3;
  const double radius = plan.signatures.size() > 400 ? 1.2 : 1.9;
  std::set<std::pair<long, long>> taken;
  for (const Point2& p : plan.signatures) {
    const Px at = view(p);
    if (plan.signatures.size() > kMany &&
        !taken.emplace(std::lround(at.x / kCell_px), std::lround(at.y / kCell_px)).second) {
      continue;
    }
    svg.circle(at, radius, {.fill = kInk, .opacity = 0.5});
  }
}

void draw_portals(Svg& svg, const FloorPlan& plan, const PlanView& view) {
  constexpr std::size_t kMany = 5000;
  for (const Segment2& portal : plan.portals) {
    const Px p = view(portal.p), q = view(portal.q);
    if (plan.portals.size() > kMany && distance_px(p, q) < 1) continue;
    svg.line(p, q, {.stroke = kDoor, .stroke_width = 3.5});
  }
}

// What labels should not hide: routes and dots, thinned to a few pixels, and the portals.
std::vector<Px> points_to_keep(const FloorPlan& plan, const PlanView& view) {
  std::vector<Px> points;
  for (const PlanRoutePoint& point : plan.route) {
    const Px p = view(point.p_map);
    if (points.empty() || distance_px(points.back(), p) >= 4) points.push_back(p);
  }
  if (!plan.dots.empty()) {
    for (const Point2& p : plan.true_route) {
      if (points.empty() || distance_px(points.back(), view(p)) >= 4) points.push_back(view(p));
    }
  }
  for (const PlanDots& layer : plan.dots) {
    for (const PlanDot& dot : layer.dots) points.push_back(view(dot.p_map));
  }
  for (const Segment2& portal : plan.portals) {
    for (const double t : {0.0, 0.5, 1.0}) {
      points.push_back(view(Point2{portal.p.x_m + t * (portal.q.x_m - portal.p.x_m),
                                   portal.p.y_m + t * (portal.q.y_m - portal.p.y_m)}));
    }
  }
  return points;
}

struct Label {
  double name_size = 0, note_size = 0;  // fonts, pixels; note 0: no second line
  PlacedLabel place;
  PxBox box;
};

// The first variant that hides nothing, else the one that hides least.
std::optional<Label> choose_label(const PlanZone& zone, const PlanView& view,
                                  const LabelGround& ground) {
  constexpr std::pair<double, double> kSizes[] = {{13, 10.5}, {11, 9}, {12, 0}, {9, 0}, {7, 0}};
  std::optional<Label> best;
  for (const auto& [name_size, note_size] : kSizes) {
    if (note_size > 0 && zone.note.empty()) continue;
    const double width =
        std::max(text_width_em(zone.name, true) * name_size, text_width_em(zone.note) * note_size);
    const double height = name_size * 0.95 + note_size * 1.25;
    const std::optional<PlacedLabel> place = place_label(view(zone.polygon), width, height, ground);
    if (!place || (best && place->hidden >= best->place.hidden)) continue;
    best = {name_size, note_size, *place, box_around(place->center, width, height)};
    if (place->hidden == 0) break;
  }
  return best;
}

void draw_labels(Svg& svg, const FloorPlan& plan, const PlanView& view) {
  LabelGround ground{
      .taken = {}, .keep = points_to_keep(plan, view), .spare = view(plan.signatures)};
  for (const PlanZone& zone : plan.zones) {
    const std::optional<Label> label = choose_label(zone, view, ground);
    if (!label) continue;
    ground.taken.push_back(label->box);
    TextStyle style{.size = label->name_size,
                    .color = ink_on(zone.fill),
                    .bold = true,
                    .anchor = Anchor::kMiddle,
                    .halo = zone.fill};
    svg.text({label->place.center.x, label->box.min.y + style.size * 0.85}, zone.name, style);
    if (label->note_size == 0) continue;
    style.bold = false;
    style.size = label->note_size;
    svg.text({label->place.center.x, label->box.max.y - style.size * 0.1}, zone.note, style);
  }
}

std::string transform_of(const PlanView& view) {
  const Px origin = view(Point2{0, 0}), x = view(Point2{1, 0}), y = view(Point2{0, 1});
  std::string text;
  for (const double value :
       {x.x - origin.x, x.y - origin.y, y.x - origin.x, y.y - origin.y, origin.x, origin.y}) {
    text += (text.empty() ? "" : " ") + format_number(value, 4);
  }
  return text;
}

}  // namespace

Svg draw_floor_plan(const FloorPlan& plan) {
  const std::vector<LegendItem> legend = legend_of(plan);
  const double plot_width = plan.width_px - kPlanLeft - kPlanRight;
  const double top = legend_height(plot_width, legend) + 8;
  const PlanView view(area_of(plan), {kPlanLeft, top}, plot_width, kMostHeight,
                      plan.width_px <= kNarrowWidth_px);

  Svg svg(plan.width_px, top + view.height() + kPlanAxisBelow);
  draw_legend(svg, {kPlanLeft, 0}, plot_width, legend);
  draw_axes(svg, view);
  svg.open_clip(view.corner(), view.width(), view.height());
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    const PlanZone& zone = plan.zones[i];
    svg.polygon(
        view(zone.polygon),
        {.fill = zone.fill, .stroke = kWall, .stroke_width = 1.25, .hint = zone.hint, .zone = i});
  }
  if (plan.raster) {
    draw_raster(svg, plan, view);
    for (const PlanZone& zone : plan.zones) {
      svg.polygon(view(zone.polygon),
                  {.stroke = kZoneLine, .stroke_width = 1.25, .hint = zone.hint});
    }
  }
  draw_signatures(svg, plan, view);
  draw_portals(svg, plan, view);
  draw_routes(svg, plan, view);
  svg.close();
  draw_labels(svg, plan, view);
  if (!plan.dots.empty() || !plan.faults.empty() || !plan.orphans.empty()) {
    svg.open_clip(view.corner(), view.width(), view.height());
    draw_dots(svg, plan, view);
    draw_marks(svg, plan, view);
    svg.close();
  }
  svg.set_data("plan", transform_of(view));
  return svg;
}

FloorPlan narrowed(FloorPlan plan) {
  plan.width_px = kNarrowWidth_px;
  return plan;
}

std::string plan_json(const FloorPlan& plan) {
  std::vector<std::string> names;
  for (const PlanZone& zone : plan.zones) names.push_back(zone.name);
  return "{\"kind\":\"plan\",\"zones\":" + script_strings(names) + "}";
}

std::string dots_json() { return "{\"kind\":\"dots\"}"; }

}  // namespace zonepack::report
