// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/floor_plan_dots.hpp"

#include "runtime/report/chart.hpp"
#include "runtime/report/format.hpp"

namespace zonepack::report {
namespace {

constexpr double kDotRadius = 3, kRingRadius = 5;  // pixels
constexpr double kOnPhone = 0.5;                   // of these

}  // namespace

void draw_dots(Svg& svg, const FloorPlan& plan, const PlanView& view) {
  const double size = plan.width_px <= kNarrowWidth_px ? kOnPhone : 1;
  for (const PlanDots& layer : plan.dots) {
    for (const PlanDot& dot : layer.dots) {
      Style style{.hint = dot.hint, .moment_s = dot.t_s};
      if (layer.ring) {
        style.stroke = layer.color;
        style.stroke_width = 1.5;
      } else {
        style.fill = layer.color;
        style.stroke = kWhite;
        style.stroke_width = 0.6;
      }
      svg.circle(view(dot.p_map), size * (layer.ring ? kRingRadius : kDotRadius), style);
    }
  }
}

void add_dot_legend(const FloorPlan& plan, std::vector<LegendItem>& items) {
  for (const PlanDots& layer : plan.dots) {
    items.push_back({layer.ring ? Mark::kRing : Mark::kBigDot, layer.color,
                     layer.name + " (" + format_count(layer.dots.size()) + ")"});
  }
}

}  // namespace zonepack::report
