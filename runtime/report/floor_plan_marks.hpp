// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/report/floor_plan.hpp"
#include "runtime/report/legend.hpp"
#include "runtime/report/plan_view.hpp"

// What a floor plan shows besides zones and routes: the occupancy grid below, and what is wrong.
namespace zonepack::report {

inline constexpr Color kUnseen{0xd5, 0xd8, 0xdc};  // where the grid saw nothing
inline constexpr double kUnseenOpacity = 0.6;
inline constexpr Color kOccupied{0x2b, 0x2f, 0x36};  // walls and furniture

// The grid and, around it, the colour of what it did not see.
void draw_raster(Svg& svg, const FloorPlan& plan, const PlanView& view);

// Faulty areas, lines and places, then the orphans, then the numbers of the faults on top.
void draw_marks(Svg& svg, const FloorPlan& plan, const PlanView& view);

void add_mark_legend(const FloorPlan& plan, std::vector<LegendItem>& items);

}  // namespace zonepack::report
