// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/floor_plan_marks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace zonepack::report {
namespace {

constexpr double kBadge = 8;  // radius, pixels

bool is_placed(Point2 p) noexcept { return std::isfinite(p.x_m) && std::isfinite(p.y_m); }

Ring corners_of(const Box2& box) {
  return {box.min, {box.max.x_m, box.min.y_m}, box.max, {box.min.x_m, box.max.y_m}};
}

Point2 middle(const Segment2& line) noexcept {
  return {(line.p.x_m + line.q.x_m) / 2, (line.p.y_m + line.q.y_m) / 2};
}

// Where the number of a fault goes: on its first place, line or area.
std::optional<Point2> place_of(const PlanFault& fault) {
  if (!fault.points.empty()) return fault.points.front();
  if (!fault.lines.empty()) return middle(fault.lines.front());
  const auto drawn =
      std::ranges::find_if(fault.areas, [](const Ring& ring) { return !ring.empty(); });
  if (drawn == fault.areas.end()) return std::nullopt;
  Point2 sum;
  for (const Point2& p : *drawn) sum = {sum.x_m + p.x_m, sum.y_m + p.y_m};
  const auto count = static_cast<double>(drawn->size());
  return Point2{sum.x_m / count, sum.y_m / count};
}

void draw_fault(Svg& svg, const PlanFault& fault, const PlanView& view) {
  std::vector<std::vector<Px>> rings;
  for (const Ring& ring : fault.areas) rings.push_back(view(ring));
  if (!rings.empty()) {
    svg.polygon(rings, {.fill = kLimit, .opacity = 0.3, .hint = fault.hint});
    svg.polygon(rings, {.stroke = kLimit, .stroke_width = 1.5, .hint = fault.hint});
  }
  for (const Segment2& line : fault.lines) {
    svg.line(view(line.p), view(line.q),
             {.stroke = kLimit, .stroke_width = 4, .round = true, .hint = fault.hint});
  }
  for (const Point2& p : fault.points) {
    if (!is_placed(p)) continue;
    svg.circle(view(p), 6, {.stroke = kLimit, .stroke_width = 2.5, .hint = fault.hint});
  }
}

// Numbers beside their places, each moved down until it hides none before it.
void draw_numbers(Svg& svg, const FloorPlan& plan, const PlanView& view) {
  std::vector<Px> taken;
  for (const PlanFault& fault : plan.faults) {
    const std::optional<Point2> place = place_of(fault);
    if (fault.number.empty() || !place || !is_placed(*place)) continue;
    Px at = view(*place);
    at.x += kBadge + 6;
    const auto hides = [&](Px other) {
      return std::hypot(at.x - other.x, at.y - other.y) < 2 * kBadge;
    };
    for (int tries = 0; tries < 20 && std::ranges::any_of(taken, hides); ++tries) {
      at.y += 2 * kBadge;
    }
    taken.push_back(at);
    svg.circle(at, kBadge,
               {.fill = kLimit, .stroke = kWhite, .stroke_width = 1.5, .hint = fault.hint});
    svg.text({at.x, at.y + 3.5}, fault.number,
             {.size = 10, .color = kWhite, .bold = true, .anchor = Anchor::kMiddle});
  }
}

}  // namespace

void draw_raster(Svg& svg, const FloorPlan& plan, const PlanView& view) {
  if (!plan.raster) return;
  const Box2& area = plan.raster->area;
  const Box2& all = view.area();
  // Even-odd: the frame around the picture. A picture that is larger than the plan has none.
  const Box2 inner{{std::clamp(area.min.x_m, all.min.x_m, all.max.x_m),
                    std::clamp(area.min.y_m, all.min.y_m, all.max.y_m)},
                   {std::clamp(area.max.x_m, all.min.x_m, all.max.x_m),
                    std::clamp(area.max.y_m, all.min.y_m, all.max.y_m)}};
  const std::vector<std::vector<Px>> frame{view(corners_of(all)), view(corners_of(inner))};
  svg.polygon(frame, {.fill = kUnseen, .opacity = kUnseenOpacity});
  const double width = (area.max.x_m - area.min.x_m) * view.px_per_m();
  const double height = (area.max.y_m - area.min.y_m) * view.px_per_m();
  const Point2 upper_left = view.turned() ? area.min : Point2{area.min.x_m, area.max.y_m};
  svg.image(view(upper_left), width, height, view.turned(), plan.raster->png, true);
}

void draw_marks(Svg& svg, const FloorPlan& plan, const PlanView& view) {
  for (const PlanFault& fault : plan.faults) draw_fault(svg, fault, view);
  const double radius = plan.signatures.size() + plan.orphans.size() > 400 ? 2.2 : 3;
  for (const PlanOrphan& orphan : plan.orphans) {
    if (!is_placed(orphan.p_map)) continue;
    svg.circle(view(orphan.p_map), radius, {.fill = kLimit, .hint = orphan.hint});
  }
  draw_numbers(svg, plan, view);
}

void add_mark_legend(const FloorPlan& plan, std::vector<LegendItem>& items) {
  if (!plan.orphans.empty()) items.push_back({Mark::kDot, kLimit, "signature in no zone"});
  if (!plan.faults.empty()) items.push_back({Mark::kBlock, kLimit, "fault"});
  if (!plan.raster) return;
  items.push_back({Mark::kBlock, kOccupied, "occupied"});
  items.push_back({Mark::kBlock, mix(kWhite, kUnseen, kUnseenOpacity), "not seen"});
}

}  // namespace zonepack::report
