// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/report/chart.hpp"
#include "runtime/report/floor_plan.hpp"
#include "runtime/run/figures/baseline.hpp"
#include "runtime/run/figures/run_trace.hpp"

// The figures of a run report. Colours stand for zones, the same in every figure.
namespace zonepack {

// One colour a zone: zones joined by a portal never share one while the palette lasts, and zones
// that the robot visited are served first.
std::vector<report::Color> zone_colors(const RunTrace& trace);

// The zones the robot was in, one block a stay.
std::vector<report::TimelineBlock> zone_timeline(const RunTrace& trace,
                                                 const std::vector<report::Color>& colors);

// Stretches of time in which a flag of the samples was set.
std::vector<report::TimeSpan> spans_where(const RunTrace& trace, bool TraceSample::*flag);

report::FloorPlan route_plan(const RunTrace& trace, const std::vector<report::Color>& colors);
report::Chart loading_chart(const RunTrace& trace, const std::vector<BaselineRow>& baseline);
report::Chart signatures_chart(const RunTrace& trace, const std::vector<BaselineRow>& baseline);
report::Chart bytes_chart(const RunTrace& trace);
report::Chart pose_error_chart(const RunTrace& trace);

}  // namespace zonepack
