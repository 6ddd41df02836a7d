// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/report/floor_plan.hpp"
#include "runtime/report/legend.hpp"
#include "runtime/report/plan_view.hpp"

// Single places on a floor plan, such as the fixes of a localizer. For the page's script each dot
// carries its moment (data-t, milliseconds).
namespace zonepack::report {

// The layers in their order, the first at the bottom. Skips dots that are not finite.
void draw_dots(Svg& svg, const FloorPlan& plan, const PlanView& view);

// "name (count)" for each layer, also for an empty one.
void add_dot_legend(const FloorPlan& plan, std::vector<LegendItem>& items);

}  // namespace zonepack::report
